"""What kind of file a recording is by its first bytes, whatever it is named."""

from pathlib import Path

from scanplan.errors import StageError

_HEADS = {
    b"#ROSBAG V": (".bag", "a ROS 1 bag"),
    b"SQLite format 3\0": (".db3", "an SQLite database, as ROS 2 records"),
    b"\x89MCAP0\r\n": (".mcap", "an MCAP file"),
    b"\x1f\x8b": ("", "packed by gzip"),
    b"\x28\xb5\x2f\xfd": ("", "packed by zstd"),
    b"BZh": ("", "packed by bzip2"),
    b"PK\x03\x04": ("", "a zip archive"),
    b"\xfd7zXZ\0": ("", "packed by xz"),
    b"%PDF": ("", "a PDF"),
}
"""How files begin, the suffix of a recording that does so, and what it is."""

_NAMES = {".bag": "a ROS 1 bag (.bag)", ".db3": "a ROS 2 bag (.db3)", ".mcap": "an MCAP file"}


def check_kind(path: Path) -> None:
    """Refuse a recording that plainly is another kind of file than its name says.

    One that begins as nothing that is known may be a damaged recording: it is left to its reader.

    Parameters
    ----------
    path : pathlib.Path
        A file, or a rosbag2 folder.

    Raises
    ------
    StageError
        With what was found, and what to do.
    """
    for file in sorted(path.iterdir()) if path.is_dir() else [path]:
        if file.suffix in _NAMES and file.is_file():
            _check_file(file)


def _check_file(path: Path) -> None:
    with path.open("rb") as file:
        head = file.read(512)
    for begins, (suffix, kind) in _HEADS.items():
        if head.startswith(begins):
            if suffix != path.suffix:
                raise StageError(f"{path}: is {_refuse(path)} but {kind}; {_remedy(suffix)}")
            return
    if head and _is_text(head):
        shown = head.decode(errors="ignore").split("\n")[0].strip()[:30]
        raise StageError(
            f"{path}: is {_refuse(path)} but text that begins with {shown!r}; {_remedy('')}"
        )


def _refuse(path: Path) -> str:
    return f"not {_NAMES[path.suffix]}"


def _remedy(suffix: str) -> str:
    if suffix:
        return f"rename it to *{suffix}, in a metadata.yaml beside it too"
    return "unpack it, copy it again from the robot, or take it out of the dataset"


def _is_text(head: bytes) -> bool:
    """Return whether bytes are letters of UTF-8; their last may be cut in two."""
    try:
        text = head.decode()
    except UnicodeDecodeError as error:
        if error.start < len(head) - 3:
            return False
        text = head[: error.start].decode()
    return all(letter.isprintable() or letter in "\t\n\r\f" for letter in text)
