"""Whether a .pcd is as long as its header states, and unpacks to no more than is allowed.

Open3D takes memory for all points that the header states, and for what they are said to unpack to,
before it reads one.
"""

import io
import struct
from pathlib import Path

from scanplan.errors import StageError
from scanplan.recordings.integrity.unpacking import MOST_UNPACKED_BYTES

_SIZES = struct.Struct("<II")
"""What compressed points begin with: bytes that are packed, and that they unpack to."""


def check_pcd_size(path: Path) -> None:
    """Refuse a .pcd whose points need more than fits into the file or into memory.

    Raises
    ------
    StageError
        If its header cannot be read, states more than `MOST_UNPACKED_BYTES`, more than the file
        holds, or two sizes that contradict each other.
    """
    with path.open("rb") as file:
        # a header has a few hundred bytes
        head = file.read(io.DEFAULT_BUFFER_SIZE)
    length = path.stat().st_size
    try:
        stated, begin = _read_header(head)
        needed = int(stated["POINTS"][0]) * _point_bytes(stated)
        form = stated["DATA"][0].lower()
        packed, unpacked = 0, needed
        if form == "binary_compressed":
            packed, unpacked = _SIZES.unpack_from(head, begin)
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


def _read_header(head: bytes) -> tuple[dict[str, list[str]], int]:
    """Return the words behind each key of the header, and where what follows it begins."""
    stated: dict[str, list[str]] = {}
    begin = 0
    for line in head.splitlines(keepends=True):
        begin += len(line)
        key, *words = line.decode("ascii").split() or [""]
        stated[key] = words
        if key == "DATA":
            return stated, begin
    raise LookupError("DATA")


def _point_bytes(stated: dict[str, list[str]]) -> int:
    sizes = list(map(int, stated["SIZE"]))
    counts = list(map(int, stated.get("COUNT", ["1"] * len(sizes))))
    if min(sizes + counts) < 0:
        raise ValueError("negative size")
    return sum(size * count for size, count in zip(sizes, counts, strict=True))
