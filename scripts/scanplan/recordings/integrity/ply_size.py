"""Whether a .ply is as long as its header states, and of a form that Open3D reads.

Open3D only warns where one is cut short: it returns the stated number of points, and as the missing
ones what happened to lie in memory. Coordinates of different types it mixes up without a word.
"""

from pathlib import Path

from scanplan.errors import StageError

_BYTES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
_END = b"end_header"


def check_ply_size(path: Path) -> int:
    """Return how many points a .ply states; refuse one whose points are not all there.

    Raises
    ------
    StageError
        If its header cannot be read, states more than the file holds, or coordinates of several
        types.
    """
    content = path.read_bytes()
    head, mark, body = content.partition(_END)
    try:
        lines = [line.split() for line in head.decode("ascii").splitlines()]
        form = next(words[1] for words in lines if words[:1] == ["format"])
        needed = _needed_size(lines, in_text=form == "ascii")
        n_points = next(int(words[2]) for words in lines if words[:2] == ["element", "vertex"])
    except (ValueError, LookupError, StopIteration):
        raise StageError(f"{path}: damaged: its header cannot be read; write it again") from None
    types = {words[1] for words in lines if words[:1] == ["property"] and words[-1] in "xyz"}
    if len(types) > 1:
        raise StageError(
            f"{path}: x, y, z are of several types ({', '.join(sorted(types))}); write it again"
            " with one"
        )
    # the mark's line ends in a line feed, behind a carriage return if the others do
    body = body.partition(b"\n")[2]
    there = len(body.split()) if form == "ascii" else len(body)
    if not mark or there < needed:
        unit = "numbers" if form == "ascii" else "bytes"
        raise StageError(
            f"{path}: damaged: its points need {needed} {unit}, {there} are there; write it again"
        )
    return n_points


def _needed_size(header: list[list[str]], *, in_text: bool) -> int:
    """Return how many bytes, or in text how many numbers, all points and what is before them have.

    Elements with lists, whose lengths the header does not state, count as nothing.
    """
    needed = count = 0
    sizes: list[int] = []
    is_reached = False
    for words in [*header, ["element", "", "0"]]:
        if words[:1] == ["element"]:
            needed += count * sum(sizes)
            if is_reached:
                break
            sizes = []
            count = int(words[2])
            is_reached = words[1] == "vertex"
        elif words[:2] == ["property", "list"]:
            count = 0
        elif words[:1] == ["property"]:
            sizes.append(1 if in_text else _BYTES[words[1]])
    return needed
