"""Files that seem to belong to a dataset, and are not read: what is told of them.

Standard library only: this runs while the workflow is being parsed.
"""

from collections.abc import Sequence
from pathlib import Path

from scanplan.plain_types import FilePath
from scanplan.project import dataset_entries
from scanplan.project.corrections_file import CORRECTIONS_FILES
from scanplan.project.dataset_files import SETTINGS_FILE, TRUTH_FILES

_READ_FILES = {
    (SETTINGS_FILE,): "settings of a dataset are",
    CORRECTIONS_FILES: "corrections are",
    TRUTH_FILES: "the truth is",
}
"""Files of a dataset's folder by what they hold: none is needed, so that one with nearly such a
name would go unnoticed."""
_WRITTEN_SUFFIXES = ("yaml", "yml", "json", "geojson", "tum")


def list_overlooked(path: FilePath) -> list[str]:
    """List the files that seem to belong to a dataset, and are not read.

    Parameters
    ----------
    path : path-like
        A dataset folder, a rosbag2 folder, or a single recording; it is there.

    Returns
    -------
    list of str
        A line for each reason: the files, why they are not read, and the remedy.
    """
    path = Path(path)
    return [*_note_beside(path), *_note_lone_truth(path), *_note_misnamed(path)]


def _note_beside(path: Path) -> list[str]:
    """Say what lies beside a dataset that is a recording alone."""
    if not path.is_file() and not (path / "metadata.yaml").is_file():
        return []
    folder = path.parent
    names = (SETTINGS_FILE, *CORRECTIONS_FILES, *TRUTH_FILES)
    beside = [name for name in names if (folder / name).is_file()]
    if not beside:
        return []
    return [
        f"{folder}: {_list_as_subject(beside)} not used, as the dataset is {path.name} alone;"
        f" to use what stands beside it, give the folder {folder} as the dataset"
    ]


def _note_lone_truth(path: Path) -> list[str]:
    """Say which file of the truth is missing where the other is there."""
    present = [name for name in TRUTH_FILES if (path / name).is_file()]
    if len(present) != 1:
        return []
    (missing,) = set(TRUTH_FILES) - set(present)
    return [
        f"{path / present[0]}: is not used, as {missing} is missing;"
        " with both the results are evaluated"
    ]


def _note_misnamed(path: Path) -> list[str]:
    """Say which files of a folder have nearly the name of one that is read."""
    found = [note_misnamed(path, names, what) for names, what in _READ_FILES.items()]
    return [note for note in found if note]


def note_misnamed(folder: Path, names: Sequence[str], what: str) -> str:
    """Say which files of a folder have nearly one of the names that something is read from.

    Parameters
    ----------
    folder : path
        Or a recording, beside which there is nothing.
    what : str
        What they hold, with its verb: `corrections are`.

    Returns
    -------
    str
        Empty where there is none.
    """
    entries = dataset_entries.visible(folder) if folder.is_dir() else []
    misnamed = [entry.name for entry in entries if _seems_one_of(entry.name, names)]
    if not misnamed:
        return ""
    fault = f"{_list_as_subject(misnamed)} not used"
    return f"{folder}: {fault}; {what} read from {' or '.join(names)}, rename it"


def _seems_one_of(name: str, names: Sequence[str]) -> bool:
    """Return whether a file has the stem of others, in any case, and a suffix of such a file."""
    stem, _, suffix = name.casefold().partition(".")
    stems = {other.partition(".")[0] for other in names}
    seems = stem in stems and suffix.removesuffix(".txt") in _WRITTEN_SUFFIXES
    return seems and name not in names


def _list_as_subject(names: Sequence[str]) -> str:
    return f"{names[0]} is" if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]} are"
