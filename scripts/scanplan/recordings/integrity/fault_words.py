"""What is wrong with a recording that its reader gave up, in words for people."""

import os
import re
from pathlib import Path

from rosbags.rosbag1.reader import Header, ReaderError, RecordType
from rosbags.serde import SerdeError

INDEX = "its index is damaged"
"""What is wrong where a reader fails before the first message."""

MESSAGES = "some of its messages are damaged"
"""What is wrong where it fails at the messages."""

GONE = "it is no longer there"
"""What is wrong with one that was there when the run began."""

_MCAP_MAGIC = b"\x89MCAP0\r\n"
_SQLITE_MAGIC = b"SQLite format 3\0"
_BEGINNING = "its beginning is overwritten"
_TELLING = re.compile("supported|etadata|YAML|rofile|missing:")
"""In what readers say of recordings that are whole, and of another kind than they read."""


def describe_fault(path: Path, error: Exception, part: str) -> str:
    """Return what is wrong with a recording at which its reader failed.

    Parameters
    ----------
    path : pathlib.Path
        A file, or a rosbag2 folder.
    error : Exception
        What the reader raised, or a check of this project.
    part : str
        `INDEX` or `MESSAGES`: what is damaged where nothing more is found.
    """
    text = " ".join(str(error).split())
    if not path.exists():
        return GONE
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if type(error).__name__ == "ReaderError" and _TELLING.search(text):
        return text.rstrip(".")
    if isinstance(error, SerdeError):
        return text.rstrip(".")
    for file in sorted(path.iterdir()) if path.is_dir() else [path]:
        if shape := _describe_shape(file):
            return shape if file == path else f"{file.name}: {shape}"
    if type(error) is ValueError:  # of a check of this project, in words of its own
        return f"{part}: {text}"
    if isinstance(error, EOFError):
        return "it is cut off"
    if isinstance(error, MemoryError):
        return f"{part}, or there is too little memory"
    return part


def _describe_shape(path: Path) -> str | None:
    """Return what is wrong with a file as a whole; None where nothing is or its kind unknown."""
    describe = _SHAPES.get(path.suffix)
    if describe is None or not path.is_file():
        return None
    try:
        return describe(path) if path.stat().st_size else "it is empty"
    except (OSError, MemoryError):
        return None


def _describe_rosbag1(path: Path) -> str | None:
    with path.open("rb") as file:
        if not file.read(16).startswith(b"#ROSBAG V"):
            return _BEGINNING
        file.seek(0)
        file.readline()
        try:
            index_place = Header.read(file, RecordType.BAGHEADER).get_uint64("index_pos")
        except (ReaderError, ValueError):
            return _BEGINNING if file.read(1) else "it is cut off"
    if index_place == 0:
        return "it was not closed when it was recorded: its index is missing"
    return _describe_cut(path, index_place + 1)


def _describe_mcap(path: Path) -> str | None:
    with path.open("rb") as file:
        if file.read(len(_MCAP_MAGIC)) != _MCAP_MAGIC:
            return _BEGINNING
        file.seek(-len(_MCAP_MAGIC), os.SEEK_END)
        if file.read() != _MCAP_MAGIC:
            return "its end is missing: it is cut off, or was not closed when it was recorded"
    return None


def _describe_sqlite(path: Path) -> str | None:
    with path.open("rb") as file:
        head = file.read(32)
    if not head.startswith(_SQLITE_MAGIC):
        return _BEGINNING
    # https://www.sqlite.org/fileformat.html: a page of 65,536 bytes is stated as 1
    page_size = int.from_bytes(head[16:18])
    return _describe_cut(path, int.from_bytes(head[28:]) * (65536 if page_size == 1 else page_size))


def _describe_cut(path: Path, least_size: int) -> str | None:
    size = path.stat().st_size
    if size >= least_size:
        return None
    return f"it is cut off: it has {size:,} of at least {least_size:,} bytes"


_SHAPES = {".bag": _describe_rosbag1, ".mcap": _describe_mcap, ".db3": _describe_sqlite}
