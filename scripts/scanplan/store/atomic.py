"""Files that appear whole or not at all."""

import glob
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil

from scanplan.plain_types import FilePath

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
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    _remove_leftovers(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    _unfinished.add(temporary)
    try:
        yield temporary
    finally:
        temporary.unlink(missing_ok=True)
        _unfinished.discard(temporary)


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
        temporary.unlink(missing_ok=True)


def is_process_alive(pid: int) -> bool:
    """Return whether a process exists and is not just waiting to be reaped."""
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


def _remove_leftovers(path: Path) -> None:
    """Remove the temporary files of `path` whose writers were killed."""
    for leftover in path.parent.glob(f".{glob.escape(path.stem)}.*.part{path.suffix}"):
        parts = leftover.name.split(".")
        writer = parts[-3] if path.suffix else parts[-2]
        if writer.isdigit() and not is_process_alive(int(writer)):
            leftover.unlink(missing_ok=True)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
