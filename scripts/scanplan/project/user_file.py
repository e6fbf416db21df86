"""Files that a person writes: regular ones, of a size that people write, text in UTF-8.

Standard library only: this runs while the workflow is being parsed.
"""

import os
import stat
from pathlib import Path

from scanplan.errors import StageError
from scanplan.plain_types import FilePath

_MOST_BYTES = 4 * 2**20
"""Some ten thousand datasets of a list, or corrections as GeoJSON: read within a second."""
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def find_file(path: FilePath, remedy: str) -> Path | None:
    """Return the path of a file that may be there; None where nothing is.

    Raises
    ------
    StageError
        If what is there is no regular file, but a link that leads nowhere, a folder or a pipe: the
        remedy is told.
    """
    if not os.path.lexists(path):
        return None
    check_regular(path, remedy)
    return Path(path)


def read_text(path: FilePath, remedy: str, most_bytes: int = _MOST_BYTES) -> str:
    """Read a file that a person has written.

    Parameters
    ----------
    remedy : str
        What the messages end with.

    Raises
    ------
    StageError
        If there is no such file, it is not regular or cannot be read, is larger than people write,
        or no text in UTF-8.
    """
    check_regular(path, remedy)
    try:
        n_bytes = Path(path).stat().st_size
        if n_bytes > most_bytes:
            limit = f"has {n_bytes:,} bytes, at most {most_bytes:,} are read"
            raise StageError(f"{path}: {limit}; leave out what is not needed")
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            return file.read()
    except UnicodeDecodeError as error:
        fault = f"is no text in UTF-8 (byte {error.start + 1})"
        raise StageError(f"{path}: {fault}; {remedy}") from None
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {remedy}") from None


def check_regular(path: FilePath, remedy: str) -> None:
    """Refuse what is no regular file before it is opened: to open a pipe may wait for ever.

    Raises
    ------
    StageError
    """
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        fault = "is a link that leads nowhere" if Path(path).is_symlink() else "does not exist"
        raise StageError(f"{path}: {fault}; {remedy}") from None
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {remedy}") from None
    if not stat.S_ISREG(mode):
        kind = _KINDS.get(stat.S_IFMT(mode), "no regular file")
        raise StageError(f"{path}: is {kind}, expected a file; {remedy}")
