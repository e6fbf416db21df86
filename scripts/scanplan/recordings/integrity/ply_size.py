"""What a .ply states of its points: whether the file holds them, and of which form they are.

Open3D only warns where one is cut short: it returns the stated number of points, and as the missing
ones what happened to lie in memory. Coordinates of different types it mixes up without a word.
"""

from dataclasses import dataclass
from pathlib import Path

from scanplan.errors import StageError

NUMPY_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
"""By what PLY calls them; the order of bytes is the file's."""
_END = b"end_header"
_LONGEST_HEADER_BYTES = 2**16
TEXT = "ascii"
_FORMS = (TEXT, "binary_little_endian", "binary_big_endian")


@dataclass(frozen=True)
class PlyHeader:
    """What stands before the data.

    Attributes
    ----------
    form : str
        `TEXT`, `binary_little_endian` or `binary_big_endian`.
    begin : int
        The first byte behind it.
    n_points : int
    types : tuple of (str, str)
        Name and type of each property of a point, of `NUMPY_TYPES`; of a list nothing.
    n_before : int
        Other elements before the points.
    needed : int
        Bytes, or in text numbers, that the points and what is before them have; elements with
        lists, whose lengths nothing states, count as nothing.
    """

    form: str
    begin: int
    n_points: int
    types: tuple[tuple[str, str], ...]
    n_before: int
    needed: int


def read_ply_header(path: Path) -> PlyHeader:
    """Return what a .ply states.

    Raises
    ------
    StageError
        If its header cannot be read, or a binary file holds less than it states.
    """
    with path.open("rb") as file:
        head, mark, rest = file.read(_LONGEST_HEADER_BYTES).partition(_END)
    # the mark's line ends in a line feed, behind a carriage return if the others do
    begin = len(head) + len(mark) + rest.find(b"\n") + 1
    try:
        header = _parse_header([line.split() for line in head.decode("ascii").splitlines()], begin)
    except (ValueError, LookupError, StopIteration):
        header = None
    if not mark or header is None:
        raise StageError(f"{path}: damaged: its header cannot be read; write it again")
    if header.form != TEXT:
        _check_there(path, header.needed, path.stat().st_size - begin, "bytes")
    return header


def check_ply_size(path: Path) -> int:
    """Return how many points a .ply states; refuse one that Open3D would not read as it is.

    Raises
    ------
    StageError
        If its header cannot be read, states more than the file holds, or coordinates of several
        types.
    """
    header = read_ply_header(path)
    types = {kind for name, kind in header.types if name in ("x", "y", "z")}
    if len(types) > 1:
        raise StageError(
            f"{path}: x, y, z are of several types ({', '.join(sorted(types))}); write it again"
            " with one"
        )
    if header.form == TEXT:
        n_numbers = len(path.read_bytes()[header.begin :].split())
        _check_there(path, header.needed, n_numbers, "numbers")
    return header.n_points


def _check_there(path: Path, needed: int, there: int, unit: str) -> None:
    if there < needed:
        raise StageError(
            f"{path}: damaged: its points need {needed} {unit}, {there} are there; write it again"
        )


def _parse_header(lines: list[list[str]], begin: int) -> PlyHeader:
    form = next(words[1] for words in lines if words[:1] == ["format"])
    elements: list[tuple[str, int, list[tuple[str, str]]]] = []
    for words in lines:
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            if words[1] != "list" and words[1] not in NUMPY_TYPES:
                raise ValueError("no type of a .ply")
            elements[-1][2].append((words[-1], words[1].removeprefix("list")))
    if form not in _FORMS or min(count for _, count, _ in elements) < 0:
        raise ValueError("no form or count of a .ply")
    place = next(i for i, (name, _, _) in enumerate(elements) if name == "vertex")
    needed = sum(_size(count, types, form) for _, count, types in elements[: place + 1])
    n_before = sum(count for _, count, _ in elements[:place])
    _, n_points, types = elements[place]
    return PlyHeader(form, begin, n_points, tuple(types), n_before, needed)


def _size(count: int, types: list[tuple[str, str]], form: str) -> int:
    """Return the bytes of elements, or in text their numbers; nothing of those with lists."""
    if not all(kind for _, kind in types):
        return 0
    return count * sum(1 if form == TEXT else int(NUMPY_TYPES[kind][1:]) for _, kind in types)
