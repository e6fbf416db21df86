"""Compiled files of Python, which a full disk cuts short without an error."""

from importlib.machinery import SourcelessFileLoader
from importlib.util import cache_from_source
from pathlib import Path

CUT_SHORT = (
    "Python's compiled code was cut short, as a full disk does, and is removed: make room and run"
    " the same command again"
)
_PACKAGE = Path(__file__).parents[1]


def remove_cut_files(folder: Path = _PACKAGE) -> int:
    """Remove this Python's compiled files below a folder that are not whole; return how many."""
    tag = cache_from_source("x.py").removeprefix("__pycache__/x")
    n_removed = 0
    for path in folder.rglob(f"__pycache__/*{tag}"):
        try:
            SourcelessFileLoader(path.stem, str(path)).get_code(path.stem)
        except (EOFError, ImportError, TypeError, ValueError):
            path.unlink(missing_ok=True)
            n_removed += 1
    return n_removed
