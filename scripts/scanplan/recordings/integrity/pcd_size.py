"""Whether a .pcd is as long as its header states, and unpacks to no more than is allowed.

Open3D takes memory for all points that the header states, and for what they are said to unpack to,
before it reads one.
"""

import struct
from pathlib import Path
from typing import BinaryIO

from scanplan.errors import StageError
from scanplan.recordings.integrity.unpacking import MOST_UNPACKED_BYTES

_LONGEST_HEADER_BYTES = 2**16
_SIZES = struct.Struct("<II")
"""What compressed points begin with: bytes that are packed, and that they unpack to."""


def check_pcd_size(path: Path) -> int:
    """Return how many points a .pcd states; refuse one that states more than is there or fits.

    Raises
    ------
    StageError
        If its header cannot be read, states more than `MOST_UNPACKED_BYTES`, more than the file
        holds, or two sizes that contradict each other.
    """
    length = path.stat().st_size
    try:
        with path.open("rb") as file:
            stated = _read_header(file)
            begin, sizes = file.tell(), file.read(_SIZES.size)
        n_points = _count_points(stated)
        needed = n_points * _point_bytes(stated)
        form = stated["DATA"][0].lower()
        packed, unpacked = 0, needed
        if form == "binary_compressed":
            packed, unpacked = _SIZES.unpack(sizes)
            packed += _SIZES.size
        # numbers in text are as long as they are written
        least = {"ascii": 0, "binary": needed, "binary_compressed": packed}[form]
    except (ValueError, LookupError, struct.error):
        raise StageError(f"{path}: damaged: its header cannot be read; write it again") from None
    if begin + least > length or needed > unpacked:
        raise StageError(
            f"{path}: damaged: its points need {needed} bytes, its {form} data have"
            f" {min(length - begin, unpacked)}; write it again"
        )
    if max(needed, unpacked) > MOST_UNPACKED_BYTES:
        raise StageError(
            f"{path}: {length} bytes are said to unpack to {max(needed, unpacked)}, above"
            f" {MOST_UNPACKED_BYTES}; divide the cloud, or write it with fewer fields"
        )
    return n_points


def _read_header(file: BinaryIO) -> dict[str, list[str]]:
    """Return the words behind each key of the header, and leave the file where that ends."""
    stated: dict[str, list[str]] = {}
    while "DATA" not in stated:
        line = file.readline(_LONGEST_HEADER_BYTES)
        if not line or file.tell() > _LONGEST_HEADER_BYTES:
            raise LookupError("DATA")
        # comments may be of any letters
        key, *words = line.decode("latin-1").split() or [""]
        stated[key] = words
    return stated


def _count_points(stated: dict[str, list[str]]) -> int:
    if "POINTS" in stated:
        return int(stated["POINTS"][0])
    return int(stated["WIDTH"][0]) * int(stated["HEIGHT"][0])


def _point_bytes(stated: dict[str, list[str]]) -> int:
    sizes = list(map(int, stated["SIZE"]))
    counts = list(map(int, stated.get("COUNT", ["1"] * len(sizes))))
    if min(sizes + counts) < 0:
        raise ValueError("negative size")
    return sum(size * count for size, count in zip(sizes, counts, strict=True))
