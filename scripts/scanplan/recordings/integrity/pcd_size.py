"""Whether a .pcd is as long as its header states, and unpacks to no more than is allowed.

Open3D takes memory for all points that the header states, and for what they are said to unpack to,
before it reads one.
"""

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from scanplan.errors import StageError
from scanplan.recordings.integrity.unpacking import MOST_UNPACKED_BYTES

_LONGEST_HEADER_BYTES = 2**16
_SIZES = struct.Struct("<II")
"""What compressed points begin with: bytes that are packed, and that they unpack to."""
TEXT = "ascii"
PACKED = "binary_compressed"


@dataclass(frozen=True)
class PcdHeader:
    """What stands before the data.

    Attributes
    ----------
    form : str
        `TEXT`, `binary` or `PACKED`.
    begin : int
        The first byte behind it.
    n_points : int
    fields : tuple of (str, str, int)
        Name, numpy's type, and how many of it a point has.
    needed : int
        Bytes of all points, unpacked.
    """

    form: str
    begin: int
    n_points: int
    fields: tuple[tuple[str, str, int], ...]
    needed: int


def read_pcd_header(path: Path) -> PcdHeader:
    """Return what a .pcd states.

    Raises
    ------
    StageError
        If its header cannot be read, states more than the file holds, or two sizes that contradict
        each other.
    """
    length = path.stat().st_size
    try:
        with path.open("rb") as file:
            stated = _read_header(file)
            begin, sizes = file.tell(), file.read(_SIZES.size)
        fields = _list_fields(stated)
        n_points = _count_points(stated)
        needed = n_points * sum(int(kind[1:]) * count for _, kind, count in fields)
        form = stated["DATA"][0].lower()
        packed, unpacked = 0, needed
        if form == PACKED:
            packed, unpacked = _SIZES.unpack(sizes)
            packed += _SIZES.size
        # numbers in text are as long as they are written
        least = {TEXT: 0, "binary": needed, PACKED: packed}[form]
    except (ValueError, LookupError, struct.error):
        raise StageError(f"{path}: damaged: its header cannot be read; write it again") from None
    if begin + least > length or needed > unpacked:
        raise StageError(
            f"{path}: damaged: its points need {needed} bytes, its {form} data have"
            f" {min(length - begin, unpacked)}; write it again"
        )
    return PcdHeader(form, begin, n_points, fields, max(needed, unpacked))


def check_pcd_size(path: Path) -> int:
    """Return how many points a .pcd states; refuse one that memory is not to be taken for.

    Raises
    ------
    StageError
        As of `read_pcd_header`, or if they unpack to more than `MOST_UNPACKED_BYTES`.
    """
    header = read_pcd_header(path)
    if header.needed > MOST_UNPACKED_BYTES:
        raise StageError(
            f"{path}: {path.stat().st_size} bytes are said to unpack to {header.needed}, above"
            f" {MOST_UNPACKED_BYTES}; divide the cloud, or write it with fewer fields"
        )
    return header.n_points


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


def _list_fields(stated: dict[str, list[str]]) -> tuple[tuple[str, str, int], ...]:
    sizes = list(map(int, stated["SIZE"]))
    counts = list(map(int, stated.get("COUNT", ["1"] * len(sizes))))
    if min(sizes + counts) < 0:
        raise ValueError("negative size")
    # what is no name or type is told by whoever reads points
    names = stated.get("FIELDS", [""] * len(sizes))
    types = stated.get("TYPE", ["F"] * len(sizes))
    rows = zip(names, types, sizes, counts, strict=True)
    return tuple((name, f"{kind.lower()}{size}", count) for name, kind, size, count in rows)
