"""The entries of a dataset's folders: recordings, clouds with poses, and what is wrong with them.

Standard library only: this runs while the workflow is being parsed.
"""

import io
import os
import re
from collections.abc import Sequence
from pathlib import Path

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.project import texts, user_file

POSES_FILE = "poses.tum"
SCANS_FOLDER = "scans"
ROSBAG2_SUFFIXES = (".db3", ".mcap", ".db3.zstd", ".mcap.zstd")
_PLACEHOLDER = re.compile(r"<[a-z][a-z0-9_]*>|[{}]+")
_CLOUD_SUFFIXES = (".pcd", ".ply")
_STAMP = re.compile(r"\d+\.\d+|\d{16,}")
STATION_SUFFIXES = (".e57", ".ptx")
_LAS_SUFFIXES = (".las", ".laz")
MERGED_SUFFIXES = (*_LAS_SUFFIXES, *_CLOUD_SUFFIXES)
"""Of clouds that may be merged ones; stations' files may be, too."""
_IMAGE = re.compile(r"^image\s*:\s*[\"']?([^\"'#\n]+)", re.MULTILINE)
_TRAJECTORIES = ("trajectory.txt", "trajectory.csv", "trajectory.tum")


def is_rosbag2_metadata(file: FilePath) -> bool:
    """Return whether a file is the description that stands in every rosbag2 folder."""
    if not Path(file).is_file() or not os.access(file, os.R_OK):
        return False
    with Path(file).open("rb") as content:
        # its first key: a file of any size may have the name
        return b"rosbag2_bagfile_information" in content.read(io.DEFAULT_BUFFER_SIZE)


def visible(folder: Path) -> list[Path]:
    """Return the entries of a folder that are not hidden, sorted."""
    return sorted(entry for entry in folder.iterdir() if not entry.name.startswith("."))


def list_recordings(folder: Path) -> list[Path]:
    """Return the files of all recordings in a folder and one level below.

    Raises
    ------
    StageError
        If a rosbag2 folder has no storage.
    """
    subfolders = [e for e in visible(folder) if e.is_dir() and e.name != SCANS_FOLDER]
    bags = []
    rosbag2_files = []
    for place in (folder, *subfolders):
        bags += [e for e in visible(place) if e.suffix == ".bag" and not e.is_dir()]
        rosbag2_files += _list_rosbag2_files(place)
    return bags + rosbag2_files


def _list_rosbag2_files(folder: Path) -> list[Path]:
    """Return the files of a rosbag2 folder; without metadata.yaml those that stand alone."""
    # what is no file is refused later: a recording on a disk that is not there is not to be lost
    entries = [e for e in visible(folder) if not e.is_dir()]
    metadata = folder / "metadata.yaml"
    if metadata not in entries or not is_rosbag2_metadata(metadata):
        return [e for e in entries if e.name.endswith((".db3", ".mcap"))]
    storage = [e for e in entries if e.name.endswith(ROSBAG2_SUFFIXES)]
    if not storage:
        raise StageError(
            f"{metadata}: describes a rosbag2 recording,"
            " but no .db3 or .mcap stands beside it; add it"
        )
    return [metadata, *storage]


def list_scans(folder: Path) -> list[Path]:
    """Return the clouds and the poses of a folder of scans; nothing where there is neither.

    Clouds stand in scans/, or else beside the poses.

    Raises
    ------
    StageError
        If there is only one of the two.
    """
    scans = folder / SCANS_FOLDER
    poses = folder / POSES_FILE
    clouds = _list_by_suffix(scans, _CLOUD_SUFFIXES) if scans.is_dir() else []
    if not poses.is_file():
        _check_unposed(clouds, poses)
        return []
    beside = clouds or _list_by_suffix(folder, _CLOUD_SUFFIXES)
    if not beside:
        raise StageError(
            f"{poses}: has no clouds beside it; put *.pcd or *.ply files there, or into {scans}"
        )
    return [*beside, poses]


def is_stamp(name: str) -> bool:
    """Return whether a name is a stamp: seconds with a point, or 16 and more digits of ns."""
    return bool(_STAMP.fullmatch(name))


def _check_unposed(scans: list[Path], poses: Path) -> None:
    if scans:
        raise StageError(
            f"{scans[0]}: is a scan without a pose; write {poses} with lines"
            " `t tx ty tz qx qy qz qw`"
        )


def _list_by_suffix(folder: Path, suffixes: Sequence[str]) -> list[Path]:
    return [entry for entry in visible(folder) if entry.suffix.lower() in suffixes]


def list_stations(folder: Path) -> list[Path]:
    """Return the files of stations in a folder."""
    return [e for e in visible(folder) if is_of_stations(e) and not e.is_dir()]


def is_of_stations(file: Path) -> bool:
    """Return whether a file is one of stations, by its name."""
    return file.suffix.lower() in STATION_SUFFIXES


def list_clouds(folder: Path) -> list[Path]:
    """Return the clouds in a folder, and beside .las and .laz the trajectory, where there is one.

    Raises
    ------
    StageError
        If there is more than one trajectory, or clouds are named by stamps, as scans are.
    """
    files = [entry for entry in visible(folder) if not entry.is_dir()]
    clouds = [file for file in files if is_merged(file)]
    stamped = [file for file in _list_by_suffix(folder, _CLOUD_SUFFIXES) if is_stamp(file.stem)]
    _check_unposed(stamped if len(stamped) > 1 else [], folder / POSES_FILE)
    timed = [file for file in clouds if file.suffix.lower() in _LAS_SUFFIXES]
    trajectories = [file for file in files if is_trajectory(file)]
    if timed and len(trajectories) > 1:
        raise StageError(
            f"{timed[0]}: {len(trajectories)} of {', '.join(_TRAJECTORIES)} beside it; give one,"
            " with lines `t x y z`: where the sensor was"
        )
    return [*timed, *trajectories] if timed and trajectories else clouds


def is_merged(file: Path) -> bool:
    """Return whether a file may be a merged cloud, by its name."""
    return file.suffix.lower() in MERGED_SUFFIXES


def is_trajectory(file: Path) -> bool:
    """Return whether a file says where the sensor of a .las was, by its name."""
    return file.name in _TRAJECTORIES


def list_grid_map(folder: Path) -> list[Path]:
    """Return the description of a grid map and its image; nothing where there is none.

    Raises
    ------
    StageError
        If there are several, or its image is not beside it.
    """
    found = []
    for file in visible(folder):
        if file.suffix not in (".yaml", ".yml") or not file.is_file():
            continue
        with file.open("rb") as content:
            # a file of any size may have the name
            text = content.read(io.DEFAULT_BUFFER_SIZE).decode(errors="replace")
        image = _IMAGE.search(text)
        if image and re.search(r"^resolution\s*:", text, re.MULTILINE):
            found.append((file, folder / image[1].strip()))
    if len(found) > 1:
        raise StageError(
            f"{folder}: has {len(found)} grid maps ({', '.join(file.name for file, _ in found)});"
            " give each a folder of its own"
        )
    for file, image_path in found:
        if not image_path.is_file():
            raise StageError(f"{file}: its image {image_path} is not there; add it")
        return [file, image_path]
    return []


def check_unfinished(path: Path) -> None:
    """Refuse a dataset with a bag that its recorder did not close.

    Raises
    ------
    StageError
    """
    entries = [path] if path.is_file() else visible(path)
    for entry in entries:
        if entry.name.endswith(".bag.active"):
            raise StageError(
                f"{entry}: the recorder did not close it;"
                " `rosbag reindex` it and rename it to *.bag"
            )


def check_file(file: Path) -> None:
    """Refuse what is no file, one that is empty or badly named, or that its recorder left open.

    Raises
    ------
    StageError
    """
    texts.check_path(file)
    if named := _PLACEHOLDER.search(str(file)):
        raise StageError(
            f"{file}: Snakemake takes {named[0]} in a name for a placeholder; rename it"
        )
    user_file.check_regular(file, "copy it again, or remove it")
    if file.stat().st_size == 0:
        raise StageError(f"{file}: is empty (0 bytes); remove it or copy it again")
    wal = file.with_name(file.name + "-wal")
    if file.suffix == ".db3" and wal.exists() and wal.stat().st_size:
        raise StageError(
            f"{wal}: the recorder did not close the recording, messages are still in it;"
            f" merge them by `sqlite3 {file.name} 'PRAGMA wal_checkpoint(TRUNCATE)'`"
            " in a copy of the folder"
        )
