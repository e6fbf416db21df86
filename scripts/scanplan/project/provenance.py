"""What the results under results/<name>/ were made of, so that no dataset takes the place of another of its name."""

import os
from pathlib import Path

from scanplan.errors import StageError
from scanplan.store import atomic

DEMO = "the simulated demo"
_RECORD = "source.txt"


def identify_source(path):
    """Return what identifies a dataset: its place, links followed; relative to here where it lies below.

    So a project that is moved with its datasets keeps its results.

    Parameters
    ----------
    path : path-like or None
        As given on the command line; the demo if None.
    """
    if path is None:
        return DEMO
    place, here = os.path.realpath(path), os.path.realpath(".")
    return os.path.relpath(place, here) if os.path.commonpath([place, here]) == here else place


def check_sources(found, replaced=()):
    """Refuse to make results of one dataset in the place of those of another.

    Parameters
    ----------
    found : dict of str to str
        The datasets of a run: name and `identify_source`.
    replaced : str or sequence of str
        Names of those whose results may be replaced.

    Raises
    ------
    StageError
    """
    replaced = [replaced] if isinstance(replaced, str) else list(replaced)
    for name in replaced:
        if name not in found:
            raise StageError(
                f"replace: {name} is no dataset of this run; it has {', '.join(found)}"
            )
    for name, new in found.items():
        old = _recorded(name)
        if old and new not in old and name not in replaced:
            raise StageError(
                f"results/{name}: was made of {old[0]}, not of {new}; rename {new}, move results/{name} away, or have"
                f" it replaced by `--config replace={name}` (make run: REPLACE={name})"
            )


def begin_results(name, source):
    """Note what the results of a dataset are to be made of, before any is.

    What they were made of so far stays beneath: until a whole run has ended, some of them still are.
    """
    _note(name, [source, *(old for old in _recorded(name) if old != source)])


def end_results(name, source):
    """Note that all results of a dataset are made of one source."""
    _note(name, [source])


def _note(name, sources):
    atomic.write_text(_place(name), "".join(f"{source}\n" for source in sources))


def discard_lone_note(name):
    """Remove the note, and the folder, where there are no results that it would be of."""
    if _is_lone(_place(name)):
        _place(name).unlink()
        for folder, _, _ in os.walk(_place(name).parent, topdown=False):
            Path(folder).rmdir()


def _place(name):
    return Path("results", name, _RECORD)


def _recorded(name):
    """What results were made of, the newest first; nothing where there are none, or nobody noted it."""
    place = _place(name)
    return (
        place.read_text(encoding="utf-8").splitlines()
        if place.is_file() and not _is_lone(place)
        else []
    )


def _is_lone(place):
    """Tell whether there is a note and nothing else, but for folders that a killed run left empty."""
    return place.is_file() and all(
        entry == place or entry.is_dir() for entry in place.parent.rglob("*")
    )
