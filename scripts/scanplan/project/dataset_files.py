"""What a dataset folder holds: the files that the stages read, found without opening a recording.

Standard library only: this runs while the workflow is being parsed.
"""

import os
import re
from collections.abc import Iterable
from pathlib import Path

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.project import dataset_entries, texts
from scanplan.project.dataset_entries import POSES_FILE, ROSBAG2_SUFFIXES
from scanplan.project.dataset_entries import is_rosbag2_metadata as is_rosbag2_metadata

SETTINGS_FILE = "dataset.yaml"
TRUTH_FILES = ("truth.geojson", "truth_poses.tum")
RESERVED = "thesis"
"""Name under results/ that the thesis's experiments have to themselves."""
OF_LABORATORY = ("comparison", RESERVED, "thesis_more")
"""Targets of the laboratory's workflow, `workflow/thesis/Snakefile`."""
TARGETS = ("all", *OF_LABORATORY)
"""What a command may ask for beside files."""
_TAKEN = (*TARGETS, "summary.html", "summary.parquet", "floors.csv", "floors.html")
"""What else stands under results/, or is asked for by its name."""
_FILE_SUFFIXES = (
    *(".bag", ".mcap", ".db3"),
    *dataset_entries.STATION_SUFFIXES,
    *dataset_entries.MERGED_SUFFIXES,
)
"""Of files that are a dataset by themselves."""
_SURVEY_SUFFIXES = (".yaml", ".yml")
_PACKED_SUFFIXES = (".gz", ".zip", ".tar", ".tgz", ".7z", ".xz", ".bz2")
_PERIODIC = re.compile(r"(.+)\1{19,}$")
_ACCEPTED = (
    "*.bag, *.mcap, *.db3, rosbag2 folders (metadata.yaml), *.pcd|*.ply with poses.tum,"
    " stations (*.e57, *.ptx), *.las|*.laz with a trajectory (trajectory.txt), a merged cloud"
    " (*.las, *.laz, *.ply, *.pcd, *.e57), or a grid map (*.yaml with its image)"
)


def dataset_name(path: FilePath) -> str:
    """Return the name that a dataset's results carry.

    Parameters
    ----------
    path : path-like
        A dataset folder, a single recording or the file of a simulated survey.

    Returns
    -------
    str
        The folder's name or the file's without its suffix; characters other than A-Z, a-z, 0-9,
        ``_``, ``.`` and ``-`` become ``_``.

    Raises
    ------
    StageError
        If no letter or digit is left, or the name starts with a dot or repeats itself endlessly.
    """
    path = Path(os.path.normpath(Path.cwd() / path))
    is_file = _is_dataset_file(path) or path.suffix in _SURVEY_SUFFIXES
    is_file = is_file and not path.is_dir()
    return name_results(str(path), path.stem if is_file else path.name)


def name_results(place: str, text: str) -> str:
    """Return the name of results that a text makes: see `dataset_name`.

    Parameters
    ----------
    place : str
        Where the text is from, for the message.
    """
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", text)
    texts.check_path(name)
    if name.startswith(".") or not re.search(r"[A-Za-z0-9]", name):
        raise StageError(
            f"{place}: no name for results can be made of it; rename it to letters, digits, _ . -"
        )
    if _PERIODIC.search(name):
        raise StageError(
            f"{place}: Snakemake takes a name that repeats itself so often for a fault of its"
            " rules; rename it"
        )
    return name


def check_results_name(place: str, name: str) -> None:
    """Refuse a name of results that something else has.

    Parameters
    ----------
    place : str
        What bears the name, for the message.

    Raises
    ------
    StageError
    """
    if name.casefold() in _TAKEN:
        fault = f"{name} is a target of the workflow, or a file or folder of its own under results/"
        raise StageError(f"{place}: {fault}; choose another name")


def is_survey_file(path: FilePath) -> bool:
    """Return whether a dataset is given as the file that describes its simulation."""
    return Path(path).suffix in _SURVEY_SUFFIXES and not Path(path).is_dir()


def find_files(path: FilePath) -> list[str]:
    """List every file of a dataset that the stages read.

    Recordings are looked for in the folder and one level below: a subfolder with metadata.yaml is
    one rosbag2 recording, the .bag, .db3 and .mcap files of one without are recordings of their
    own.

    Parameters
    ----------
    path : path-like
        A dataset folder, a rosbag2 folder, or a single recording (.bag, .mcap, .db3, .e57, .ptx)
        or merged cloud (.las, .laz, .ply, .pcd).

    Returns
    -------
    list of str
        Sorted; `path` is the start of each.

    Raises
    ------
    StageError
        If nothing is there, nothing of it is accepted, recordings of two kinds stand side by side,
        or a file is empty or was not closed by the recorder.
    """
    path = Path(path)
    if not path.exists():
        raise StageError(
            f"{path}: does not exist; give a dataset folder or a recording with"
            " `make run DATASET=PATH`, `scanplan PATH` or `--config dataset=PATH`"
        )
    try:
        kinds = [[path]] if path.is_file() else _list_kinds(path)
        dataset_entries.check_unfinished(path)
    except OSError as error:
        raise StageError(
            f"{path}: cannot be read ({error.strerror}); check its permissions"
        ) from None
    if path.is_file() and not _is_dataset_file(path):
        raise StageError(
            f"{path}: is no recording; accepted are a dataset folder or {', '.join(_FILE_SUFFIXES)}"
        )
    filled = [kind for kind in kinds if kind]
    if len(filled) > 1:
        raise StageError(
            f"{path}: holds recordings of two kinds, both {filled[0][0].name} and"
            f" {filled[1][0].name}; keep one of the two"
        )
    files = sorted(file for kind in filled for file in kind)
    if not files:
        packed = [
            e.name for e in dataset_entries.visible(path) if e.suffix.lower() in _PACKED_SUFFIXES
        ]
        remedy = f"; unpack {', '.join(packed)}" if packed else ""
        raise StageError(f"{path}: holds nothing to read{remedy}; accepted are {_ACCEPTED}")
    for file in files:
        dataset_entries.check_file(file)
    return [str(file) for file in files]


def _list_kinds(folder: Path) -> list[list[Path]]:
    """Return the files of each kind of recording that a folder holds.

    Beside a robot's recordings others are exports of them, which are not read.
    """
    kinds = [dataset_entries.list_recordings(folder), dataset_entries.list_scans(folder)]
    if any(kinds):
        return kinds
    return [
        dataset_entries.list_stations(folder),
        dataset_entries.list_clouds(folder),
        dataset_entries.list_grid_map(folder),
    ]


def _is_dataset_file(path: Path) -> bool:
    # stations' programs write suffixes in capitals, recorders do not
    is_cloud = dataset_entries.is_of_stations(path) or dataset_entries.is_merged(path)
    return path.suffix in _FILE_SUFFIXES or is_cloud


def group_recordings(files: Iterable[str]) -> list[str]:
    """Return the recordings to open: each file, or the rosbag2 folder that it belongs to.

    Parameters
    ----------
    files : sequence of str
        As `find_files` gives them.

    Returns
    -------
    list of str
        Sorted, each once.
    """
    paths = [Path(file) for file in files]
    folders = {path.parent for path in paths if path.name == "metadata.yaml"}
    recordings = set()
    for path in paths:
        is_part = path.name.endswith((*ROSBAG2_SUFFIXES, ".yaml"))
        recordings.add(path.parent if is_part and path.parent in folders else path)
    return [str(recording) for recording in sorted(recordings)]


def is_scan_folder(files: Iterable[str]) -> bool:
    """Return whether the files are recorded clouds with a pose file and not bags."""
    return any(Path(file).name == POSES_FILE for file in files)


def is_of_stations(files: Iterable[str]) -> bool:
    """Return whether the files are those of stations."""
    return any(dataset_entries.is_of_stations(Path(file)) for file in files)


def is_las_drive(files: Iterable[str]) -> bool:
    """Return whether the files are points in the map with a trajectory."""
    return any(dataset_entries.is_trajectory(Path(file)) for file in files)


def is_merged_cloud(files: Iterable[str]) -> bool:
    """Return whether the files are clouds that nothing tells from where they were seen."""
    return all(dataset_entries.is_merged(Path(file)) for file in files)


def is_grid_map(files: Iterable[str]) -> bool:
    """Return whether the files are a grid map: a description and an image."""
    paths = [Path(file) for file in files]
    described = [path for path in paths if path.suffix in _SURVEY_SUFFIXES]
    return len(paths) == 2 and len(described) == 1 and not is_rosbag2_metadata(described[0])
