"""What a dataset folder holds: the files that the stages read, found without opening a recording.

Standard library only: this runs while the workflow is being parsed.
"""

import os
import re
from pathlib import Path

from scanplan.errors import StageError

POSES_FILE = "poses.tum"
SCANS_FOLDER = "scans"
SETTINGS_FILE = "dataset.yaml"
TRUTH_FILES = ("truth.geojson", "truth_poses.tum")
_BAG_SUFFIXES = (".bag", ".mcap", ".db3")
_SURVEY_SUFFIXES = (".yaml", ".yml")
_ROSBAG2_SUFFIXES = (".db3", ".mcap", ".db3.zstd", ".mcap.zstd")
_PACKED_SUFFIXES = (".gz", ".zip", ".tar", ".tgz", ".7z", ".xz", ".bz2")
_CLOUD_SUFFIXES = (".pcd", ".ply")
_ACCEPTED = (
    "*.bag, *.mcap, *.db3, rosbag2 folders (metadata.yaml), or scans/*.pcd|*.ply with poses.tum"
)


def dataset_name(path):
    """Return the name that a dataset's results carry.

    Parameters
    ----------
    path : path-like
        A dataset folder, a single recording or the file of a simulated survey.

    Returns
    -------
    str
        The folder's name or the file's without its suffix; characters other than A-Z, a-z, 0-9, ``_``, ``.`` and
        ``-`` become ``_``.

    Raises
    ------
    StageError
        If no letter or digit is left, or the name starts with a dot.
    """
    path = Path(os.path.normpath(Path.cwd() / path))
    single = path.suffix in (*_BAG_SUFFIXES, *_SURVEY_SUFFIXES) and not path.is_dir()
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", path.stem if single else path.name)
    if name.startswith(".") or not re.search(r"[A-Za-z0-9]", name):
        raise StageError(
            f"{path}: no name for results can be made of it; rename it to letters, digits, _ . -"
        )
    return name


def is_survey_file(path):
    """Tell whether a dataset is given as the file that describes its simulation."""
    return Path(path).suffix in _SURVEY_SUFFIXES and not Path(path).is_dir()


def is_rosbag2_metadata(file):
    """Tell whether a file is the description that stands in every rosbag2 folder."""
    return os.access(file, os.R_OK) and b"rosbag2_bagfile_information" in Path(file).read_bytes()


def find_files(path):
    """List every file of a dataset that the stages read.

    Recordings are looked for in the folder and one level below: a subfolder with metadata.yaml is one rosbag2
    recording, the .bag, .db3 and .mcap files of one without are recordings of their own.

    Parameters
    ----------
    path : path-like
        A dataset folder, a rosbag2 folder, or a single recording (.bag, .mcap, .db3).

    Returns
    -------
    list of str
        Sorted; `path` is the start of each.

    Raises
    ------
    StageError
        If nothing is there, nothing of it is accepted, recordings and a scan folder stand side by side, or a file is
        empty or was not closed by the recorder.
    """
    path = Path(path)
    if not path.exists():
        raise StageError(
            f"{path}: does not exist; give a dataset folder or a recording with `--config dataset=PATH`"
        )
    try:
        recordings, scans = (
            ([path], []) if path.is_file() else (_recordings(path), _scan_folder(path))
        )
        _check_unfinished(path)
    except OSError as error:
        raise StageError(
            f"{path}: cannot be read ({error.strerror}); check its permissions"
        ) from None
    if path.is_file() and path.suffix not in _BAG_SUFFIXES:
        raise StageError(
            f"{path}: is no recording; accepted are a dataset folder or {', '.join(_BAG_SUFFIXES)}"
        )
    if recordings and scans:
        raise StageError(
            f"{path}: holds both recordings ({recordings[0].name}) and {SCANS_FOLDER}/ with {POSES_FILE};"
            " keep one of the two"
        )
    files = sorted(recordings + scans)
    if not files:
        packed = [e.name for e in _visible(path) if e.suffix.lower() in _PACKED_SUFFIXES]
        remedy = f"; unpack {', '.join(packed)}" if packed else ""
        raise StageError(f"{path}: holds nothing to read{remedy}; accepted are {_ACCEPTED}")
    for file in files:
        _check_file(file)
    return [str(file) for file in files]


def list_overlooked(path):
    """Tell of files that seem to belong to a dataset, and are not read.

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
    notes = []
    if path.is_file() or (path / "metadata.yaml").is_file():
        beside = [name for name in (SETTINGS_FILE, *TRUTH_FILES) if (path.parent / name).is_file()]
        if beside:
            notes.append(
                f"{path.parent}: {_listed(beside)} not used, as the dataset is {path.name} alone; to use what stands"
                f" beside it, give the folder {path.parent} as the dataset"
            )
    there = [name for name in TRUTH_FILES if (path / name).is_file()]
    if len(there) == 1:
        (missing,) = set(TRUTH_FILES) - set(there)
        notes.append(
            f"{path / there[0]}: is not used, as {missing} is missing; with both the results are evaluated"
        )
    other = [e.name for e in _visible(path) if _seems_settings(e)] if path.is_dir() else []
    if other:
        notes.append(
            f"{path}: {_listed(other)} not used; settings of a dataset are read from {SETTINGS_FILE}, rename it"
        )
    return notes


def _seems_settings(entry):
    stem, _, suffix = entry.name.lower().partition(".")
    return (
        stem == "dataset"
        and suffix in ("yaml", "yml", "yaml.txt", "json")
        and entry.name != SETTINGS_FILE
    )


def _listed(names):
    return f"{names[0]} is" if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]} are"


def group_recordings(files):
    """Return the recordings to open for a list of files: each file, or the rosbag2 folder it belongs to.

    Parameters
    ----------
    files : sequence of str
        As `find_files` gives them.

    Returns
    -------
    list of str
        Sorted, each once.
    """
    folders = {Path(file).parent for file in files if Path(file).name == "metadata.yaml"}
    owners = {
        file.parent
        if file.parent in folders and file.name.endswith((*_ROSBAG2_SUFFIXES, ".yaml"))
        else file
        for file in map(Path, files)
    }
    return [str(owner) for owner in sorted(owners)]


def is_scan_folder(files):
    """Tell whether the files are recorded clouds with a pose file and not bags."""
    return any(Path(file).name == POSES_FILE for file in files)


def _visible(folder):
    return sorted(entry for entry in folder.iterdir() if not entry.name.startswith("."))


def _recordings(folder):
    entries = _visible(folder)
    places = [folder, *(e for e in entries if e.is_dir() and e.name != SCANS_FOLDER)]
    bags = [e for place in places for e in _visible(place) if e.suffix == ".bag" and e.is_file()]
    return bags + [file for place in places for file in _rosbag2_files(place)]


def _rosbag2_files(folder):
    """Files of a rosbag2 folder; without metadata.yaml those that can be read one by one."""
    entries = [e for e in _visible(folder) if e.is_file()]
    metadata = folder / "metadata.yaml"
    if metadata not in entries or not is_rosbag2_metadata(metadata):
        return [e for e in entries if e.name.endswith((".db3", ".mcap"))]
    storage = [e for e in entries if e.name.endswith(_ROSBAG2_SUFFIXES)]
    if not storage:
        raise StageError(
            f"{metadata}: describes a rosbag2 recording, but no .db3 or .mcap stands beside it; add it"
        )
    return [metadata, *storage]


def _scan_folder(folder):
    scans, poses = folder / SCANS_FOLDER, folder / POSES_FILE
    clouds = (
        [e for e in _visible(scans) if e.suffix.lower() in _CLOUD_SUFFIXES]
        if scans.is_dir()
        else []
    )
    if poses.is_file() and not clouds:
        raise StageError(f"{poses}: has no clouds beside it; put *.pcd or *.ply files into {scans}")
    if clouds and not poses.is_file():
        raise StageError(
            f"{scans}: has no poses; write {poses} with lines `t tx ty tz qx qy qz qw`"
        )
    return [*clouds, poses] if clouds else []


def _check_unfinished(path):
    entries = [path] if path.is_file() else _visible(path)
    for entry in entries:
        if entry.name.endswith(".bag.active"):
            raise StageError(
                f"{entry}: the recorder did not close it; `rosbag reindex` it and rename it to *.bag"
            )


def _check_file(file):
    if file.stat().st_size == 0:
        raise StageError(f"{file}: is empty (0 bytes); remove it or copy it again")
    wal = file.with_name(file.name + "-wal")
    if file.suffix == ".db3" and wal.exists() and wal.stat().st_size:
        raise StageError(
            f"{wal}: the recorder did not close the recording, messages are still in it;"
            f" merge them by `sqlite3 {file.name} 'PRAGMA wal_checkpoint(TRUNCATE)'` in a copy of the folder"
        )
