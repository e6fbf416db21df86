"""Files that appear whole or not at all."""

import errno
import glob
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil

from scanplan.errors import StageError
from scanplan.plain_types import FilePath

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# what a disk, or a network between it and this computer, fails with
_BROKEN = (errno.EIO, errno.ESTALE, errno.EREMOTEIO, errno.ETIMEDOUT, errno.ENOTCONN)
# what file systems say that have no way to wait for the disk
_UNSYNCED = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)
_REFUSED = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOTDIR, errno.EISDIR, errno.EEXIST)
_WRITER = re.compile(r"\.(\d+)\.part")
_unfinished: set[Path] = set()
_refusals: list[Callable[[], bool]] = []


def refuse_to_write_when(is_over: Callable[[], bool]) -> None:
    """Make `replace_file` ask `is_over()` before it replaces a file, and leave the old one if so.

    The processes of a stage register here whether the run that asked for their files has ended.
    """
    _refusals.append(is_over)


@contextmanager
def replace_file(path: FilePath) -> Iterator[Path]:
    """Give a path to write to; on success it becomes `path` (fsync, rename), else it is removed.

    Parameters
    ----------
    path : path-like
        The file that is to appear. Its folder is made where it is missing.

    Yields
    ------
    pathlib.Path
        A name in the same folder, with the same suffix.

    Raises
    ------
    SystemExit
        If the workflow run that asked for the file has ended meanwhile.
    StageError
        If the file cannot be written.
    """
    with scratch_file(path) as temporary:
        yield temporary
        _sync(temporary)
        if any(is_over() for is_over in _refusals):
            raise SystemExit(f"{path}: not written, the run that asked for it has ended")
        temporary.replace(path)


@contextmanager
def scratch_file(path: FilePath) -> Iterator[Path]:
    """Give a path beside `path` for a temporary file; it is removed afterwards.

    Parameters
    ----------
    path : path-like
        What the file belongs to. Its folder is made where it is missing.

    Yields
    ------
    pathlib.Path
        A name in the same folder, with the same suffix.

    Raises
    ------
    StageError
        If the folder cannot be written to, or there is no space left.
    """
    path = Path(path)
    with explain_unwritable(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_leftovers(path.parent, f".{glob.escape(path.stem)}.*.part{path.suffix}")
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    _unfinished.add(temporary)
    try:
        with explain_unwritable(path):
            yield temporary
    finally:
        _unfinished.discard(temporary)
        # where nothing can be removed, what kept it from being written is told
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


@contextmanager
def explain_unwritable(path: FilePath) -> Iterator[None]:
    """Turn what the system says of a place that cannot be written to into one line with a remedy.

    Errors of other places are left as they are.
    """
    try:
        yield
    except OSError as error:
        places = {str(path), str(Path(path).parent), *map(str, _unfinished)}
        is_of_place = error.errno in _REFUSED and str(error.filename) in places
        if error.errno not in (*_FULL, *_BROKEN) and not is_of_place:
            raise
        raise describe_unwritable(path, error) from None


def describe_unwritable(path: FilePath, error: OSError) -> StageError:
    """Return what to raise where the system refuses to write to a file or a folder."""
    remedy = "make it a place that can be written to, or move away what stands there"
    if error.errno in _BROKEN:
        remedy = "the disk or the way to it fails: check it; the same command goes on from here"
    if error.errno in _FULL:
        remedy = _describe_room(Path(path))
    return StageError(f"{path}: cannot be written ({os.strerror(error.errno or 0)}); {remedy}")


def _describe_room(path: Path) -> str:
    folder = next(place for place in (path, *path.absolute().parents) if place.is_dir())
    usage = shutil.disk_usage(folder)
    return (
        f"{usage.free / 1e6:.0f} of {usage.total / 1e6:.0f} MB are free there, or a limit on the"
        " size of files is reached: make room for twice the size of the recordings; the same"
        " command goes on from here"
    )


def write_text(path: FilePath, text: str) -> None:
    """Write `text` (UTF-8, newlines as given) to `path`, whole or not at all."""
    write_bytes(path, text.encode())


def write_bytes(path: FilePath, content: bytes) -> None:
    """Write bytes to `path`, whole or not at all."""
    with replace_file(path) as temporary:
        temporary.write_bytes(content)


def discard_unfinished() -> None:
    """Remove the temporary files of this process; for one that is about to end itself."""
    for temporary in list(_unfinished):
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def is_process_alive(pid: int) -> bool:
    """Return whether a process exists and is not just waiting to be reaped."""
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


def remove_leftovers(folder: Path, pattern: str = "**/.*.part*") -> None:
    """Remove the temporary files in a folder whose writers were killed."""
    for leftover in folder.glob(pattern):
        writer = _WRITER.search(leftover.name)
        if writer and not is_process_alive(int(writer[1])):
            with suppress(OSError):
                leftover.unlink(missing_ok=True)


def _sync(path: Path) -> None:
    # Windows writes out none that is open for reading alone
    descriptor = os.open(path, os.O_RDWR if sys.platform == "win32" else os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _UNSYNCED:
            raise
    finally:
        os.close(descriptor)
