"""Files that appear whole or not at all."""

import glob
import os
from contextlib import contextmanager
from pathlib import Path

import psutil

_UNFINISHED = set()
_SHELLS = {"sh", "bash", "dash", "zsh"}


def _supervisor():
    """Nearest ancestor process that is no shell: the workflow run that started this stage, or None."""
    try:
        return next((p for p in psutil.Process().parents() if p.name() not in _SHELLS), None)
    except psutil.Error:
        return None


_SUPERVISOR = _supervisor()


def is_orphaned():
    """Tell whether the workflow run that started this process has ended.

    A stage that survives its killed run must not write over what a newer run made.
    """
    return _SUPERVISOR is not None and not (_SUPERVISOR.is_running() and _at_work(_SUPERVISOR.pid))


@contextmanager
def replace_file(path):
    """Give a path to write to; on success it becomes `path` (fsync, rename), otherwise nothing is left of it.

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
        if is_orphaned():
            raise SystemExit(f"{path}: not written, the run that asked for it has ended")
        temporary.replace(path)


@contextmanager
def scratch_file(path):
    """Give a path beside `path` for a file that is needed meanwhile; nothing is left of it afterwards.

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
    _UNFINISHED.add(temporary)
    try:
        yield temporary
    finally:
        temporary.unlink(missing_ok=True)
        _UNFINISHED.discard(temporary)


def write_text(path, text):
    """Write `text` (UTF-8, newlines as given) to `path`, whole or not at all."""
    write_bytes(path, text.encode())


def write_bytes(path, content):
    """Write bytes to `path`, whole or not at all."""
    with replace_file(path) as temporary:
        temporary.write_bytes(content)


def _remove_leftovers(path):
    """Remove what processes that were killed while they wrote `path` left beside it."""
    for leftover in path.parent.glob(f".{glob.escape(path.stem)}.*.part{path.suffix}"):
        writer = leftover.name.split(".")[-3] if path.suffix else leftover.name.split(".")[-2]
        if writer.isdigit() and not _at_work(int(writer)):
            leftover.unlink(missing_ok=True)


def discard_unfinished():
    """Remove what this process has begun to write and not finished: for one that is about to end itself."""
    for temporary in list(_UNFINISHED):
        temporary.unlink(missing_ok=True)


def _at_work(pid):
    """Tell whether a process is there and not just waiting to be reaped."""
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


def _sync(path):
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
