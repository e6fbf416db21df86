"""Lines of a file of text, none of which may be of any length."""

from collections.abc import Iterator
from functools import partial
from itertools import islice
from typing import BinaryIO

from scanplan.errors import StageError

LONGEST = 2**16
"""Bytes of a line: a point with a thousand numbers."""


def iterate_lines(file: BinaryIO, where: str) -> Iterator[bytes]:
    """Yield the lines that a file goes on with.

    Parameters
    ----------
    where : str
        Which file, for the error.

    Raises
    ------
    StageError
        If one is longer than `LONGEST`.
    """
    for line in iter(partial(file.readline, LONGEST), b""):
        if len(line) == LONGEST and not line.endswith(b"\n"):
            raise StageError(
                f"{where}: damaged: a line has more than {LONGEST} bytes; copy or export it again"
            )
        yield line


def take_lines(file: BinaryIO, n_lines: int, where: str) -> list[bytes]:
    """Return so many lines, fewer at the file's end; raises as `iterate_lines`."""
    return list(islice(iterate_lines(file, where), n_lines))
