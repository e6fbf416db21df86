"""Provenance: what the results under results/<name>/ were made of.

So no dataset takes the place of another of its name.
"""

import hashlib
import io
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.store import atomic

DEMO = "the simulated demo"
RECORD = "source.txt"
"""File that says what the results beside it were made of."""


def identify_source(path: FilePath | None) -> str:
    """Return what identifies a dataset: its place, links followed.

    The place is relative to here where it lies below, so that a project that is moved with its
    datasets keeps its results.

    Parameters
    ----------
    path : path-like or None
        As given on the command line; the demo if None.
    """
    if path is None:
        return DEMO
    place = os.path.realpath(path)
    here = os.path.realpath(".")
    return os.path.relpath(place, here) if os.path.commonpath([place, here]) == here else place


def check_sources(sources: Mapping[str, str], replaced: str | Sequence[str] = ()) -> None:
    """Refuse to make results of one dataset in the place of those of another.

    Parameters
    ----------
    sources : dict of str to str
        The datasets of a run: name and `identify_source`.
    replaced : str or sequence of str
        Names of those whose results may be replaced.

    Raises
    ------
    StageError
        If the results of a dataset were made of another one, or `replaced` names none of the run.
    """
    replaced = [replaced] if isinstance(replaced, str) else list(replaced)
    for name in replaced:
        if name not in sources:
            raise StageError(
                f"replace: {name} is no dataset of this run; it has {', '.join(sources)}"
            )
    for name, new in sources.items():
        old = _recorded_sources(name)
        if old and new not in old and name not in replaced:
            raise StageError(
                f"results/{name}: was made of {old[0]}, not of {new}; rename {new}, move"
                f" results/{name} away, or have it replaced by `--config replace={name}`"
                f" (make run: REPLACE={name}; scanplan: --replace {name})"
            )


def begin_results(name: str, source: str) -> None:
    """Note what the results of a dataset are to be made of, before any is.

    What they were made of so far stays beneath: until a whole run has ended, some of them still
    are.
    """
    older = [old for old in _recorded_sources(name) if old != source]
    _write_note(name, [source, *older])


def end_results(name: str, source: str) -> None:
    """Note that all results of a dataset are made of one source."""
    _write_note(name, [source])


def _write_note(name: str, sources: Sequence[str]) -> None:
    atomic.write_text(_note_of(name), "".join(f"{source}\n" for source in sources))


def discard_lone_note(name: str) -> None:
    """Remove the note, and the folder, where there are no results that it would be of."""
    note = _note_of(name)
    if _is_lone(note):
        note.unlink()
        remove_empty_folders(name)


def remove_empty_folders(name: str) -> None:
    """Remove the empty folders of a dataset's results.

    None where results/<name> is a link: what it leads to was there before.
    """
    place = Path("results", name)
    inner = [] if place.is_symlink() else os.walk(place, topdown=False)
    for folder, _, _ in inner:
        # one that is not empty, or the root of a disk, stays
        with suppress(OSError):
            Path(folder).rmdir()


def _note_of(name: str) -> Path:
    return Path("results", name, RECORD)


def _recorded_sources(name: str) -> list[str]:
    """Return what results were made of, the newest first; nothing where no note says so."""
    note = _note_of(name)
    if not note.is_file() or _is_lone(note):
        return []
    try:
        return note.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        raise StageError(
            f"{note}: is no text in UTF-8: it does not say what the results beside it were made"
            f" of; move results/{name} away, or remove {note} to keep them"
        ) from None


def _is_lone(note: Path) -> bool:
    """Return whether there is a note and nothing else but folders that a killed run left empty."""
    if not note.is_file():
        return False
    return all(entry == note or entry.is_dir() for entry in note.parent.rglob("*"))


@cache
def digest_recordings(files: tuple[str, ...]) -> str:
    """Return a digest of recordings by their names, sizes, beginnings and ends.

    A file that is replaced by an older one has other bytes there: an index, counts and stamps. Its
    time alone would not tell, as copies keep it.

    Raises
    ------
    StageError
        If one is no longer there, or cannot be read.
    """
    digest = hashlib.sha256()
    for file in map(Path, files):
        try:
            size = file.stat().st_size
            digest.update(f"{file.name} {size}\n".encode())
            with file.open("rb") as content:
                digest.update(content.read(io.DEFAULT_BUFFER_SIZE))
                content.seek(max(0, size - io.DEFAULT_BUFFER_SIZE))
                digest.update(content.read())
        except OSError as error:
            raise StageError(
                f"{file}: cannot be read ({error.strerror}), and could when the run began; put it"
                " back, the same command goes on from here"
            ) from None
    return digest.hexdigest()
