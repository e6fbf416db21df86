"""Whether SQLite can open a file: it keeps a path, with `-journal` behind it, in 512 bytes."""

import os

from scanplan.errors import StageError
from scanplan.plain_types import FilePath

LONGEST = 504
"""Bytes of the whole path, measured with SQLite 3.40."""


def check_sqlite_path(path: FilePath, remedy: str) -> None:
    """Refuse a file whose path is too long for SQLite.

    Parameters
    ----------
    remedy : str
        What can be done instead of moving it.

    Raises
    ------
    StageError
    """
    whole = os.path.realpath(path)
    if len(os.fsencode(whole)) > LONGEST:
        raise StageError(
            f"{path}: its whole path has {len(os.fsencode(whole))} bytes, and SQLite opens none of"
            f" more than {LONGEST}; work in a folder with a shorter path, or {remedy}"
        )
