"""A survey as the stages see it: clouds and poses, from bags, a folder of scans, or stations."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from scanplan.project import dataset_files
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.clouds import RangeLimits
from scanplan.recordings.motion.deskew import DeskewedSurvey
from scanplan.recordings.motion.pose_kind import FOUND
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey_protocol import Survey
from scanplan.recordings.units import Units
from scanplan.stage import log
from scanplan.types import Array


@contextmanager
def open_survey(
    files: Sequence[str],
    *,
    cloud_topic: str | Sequence[str] | None = None,
    pose_topic: str | None = None,
    base_frame: str | None = None,
    base_from_sensor: Sequence[float] | None = None,
    ros2_release: str = "humble",
    min_range_m: float = 0.0,
    max_range_m: float = math.inf,
    cloud_unit: str = "m",
    pose_unit: str = "m",
    max_damaged_share: float = 0.0,
    salvage: bool = False,
    deskew: bool = True,
    pose_kind: str = FOUND,
    motion: SensorMotion | None = None,
    storey: int | None = None,
    known_t_ns: Mapping[int, int] | None = None,
) -> Iterator[Survey]:
    """Open all recordings of a dataset as one survey.

    Parameters
    ----------
    files : sequence of str
        As `dataset_files.find_files` gives them.
    cloud_topic, pose_topic : str, optional
        Where there are several candidates. `cloud_topic` may be several, of the scanners of one
        robot; `pose_topic` may be /tf.
    base_frame : str, optional
        The frame that the poses are of.
    base_from_sensor : (6,) float, optional
        The sensor's extrinsics: x, y, z in metres, roll, pitch, yaw in degrees. By default tf has
        them.
    ros2_release : str
        Whose message definitions hold where a ROS 2 bag carries none.
    min_range_m, max_range_m : float
        Points outside are dropped.
    cloud_unit, pose_unit : str
        What points, and poses and transforms, are recorded in: of `units.METRES`.
    max_damaged_share : float
        So many of the scans that are read may be damaged; they come without points.
    salvage : bool
        Whether to read what is whole of damaged bags.
    deskew : bool
        Whether to move points to where they would have been seen at their scan's stamp, given a
        `motion`.
    pose_kind : str, optional
        Of which kind the poses are (`pose_kind.find_pose_kind`); found by default.
    motion : trajectory.SensorMotion, optional
        How the sensor moved.
    storey : int, optional
        Which of a merged cloud, 0 the lowest; by default the one with most floor.
    known_t_ns : dict of int to int, optional
        Stamps by scan_id of the scans that are asked for, of a survey that is `as_recorded`.

    Yields
    ------
    survey_protocol.Survey

    Raises
    ------
    StageError
        If a recording is damaged or leaves open what to use.
    """
    topics_and_frame = {
        "cloud_topic": cloud_topic,
        "pose_topic": pose_topic,
        "base_frame": base_frame,
    }
    reading = CloudReading(
        limits=RangeLimits(min_range_m, max_range_m),
        base_from_sensor=base_from_sensor,
        units=Units(cloud_unit, pose_unit),
        max_damaged_share=max_damaged_share,
        pose_kind=pose_kind,
    )
    if scaled := reading.units.describe():
        log.log_line(scaled)
    opening = {"ros2_release": ros2_release, "salvage": salvage}
    with ExitStack() as stack:
        survey = _open_points(files, storey, reading)
        if survey is None:
            survey = _open_recordings(files, stack, opening, topics_and_frame, reading, known_t_ns)
        yield DeskewedSurvey(survey, motion) if deskew and motion is not None else survey


def is_as_recorded(survey: Survey) -> bool:
    """Return whether scans are messages of bags as they are, which stamps suffice to read again."""
    return getattr(survey, "as_recorded", False)


@contextmanager
def open_colours(
    files: Sequence[str], **reading: Any
) -> Iterator[Callable[[int], Array | None] | None]:
    """Open what tells the colours of a dataset's points.

    Parameters
    ----------
    files, **reading
        As of `open_survey`.

    Yields
    ------
    callable or None
        Returns of a scan_id the colours (n, 3) uint16 of the points that the survey has of it, in
        their order, or None; there is none where nothing of the dataset has colours.
    """
    if not dataset_files.is_of_stations(files):
        yield None
        return
    from scanplan.recordings.stations.station_scans import StationScans

    with open_survey(files, **reading) as survey:
        if isinstance(survey, StationScans) and survey.has_colours:
            yield survey.read_colours
        else:
            yield None


def _open_points(files: Sequence[str], storey: int | None, reading: CloudReading) -> Survey | None:
    """Return a survey of stations, or of a merged cloud; None of other files."""
    where, paths = ", ".join(files), list(map(Path, files))
    if dataset_files.is_merged_cloud(files):
        from scanplan.recordings.merged import merged_cloud, point_files

        return merged_cloud.MergedCloud(
            where, point_files.list_sources(paths), reading, storey=storey
        )
    if not dataset_files.is_of_stations(files):
        return None
    from scanplan.recordings.stations import e57_stations, ptx_stations, station_scans

    list_stations = {
        ".e57": e57_stations.list_e57_stations,
        ".ptx": ptx_stations.list_ptx_stations,
    }
    found = [one for path in paths for one in list_stations[path.suffix.lower()](path)]
    if station_scans.are_merged(found):
        from scanplan.recordings.merged import merged_cloud

        sources = [station.read_in_world for station in found]
        return merged_cloud.MergedCloud(where, sources, reading, storey=storey)
    return station_scans.StationScans(where, found, reading)


def _open_recordings(
    files: Sequence[str],
    stack: ExitStack,
    opening: Mapping[str, Any],
    topics_and_frame: Mapping[str, Any],
    reading: CloudReading,
    known_t_ns: Mapping[int, int] | None,
) -> Survey:
    # rosbags costs a second to import: where it is needed alone
    if dataset_files.is_scan_folder(files):
        from scanplan.recordings import scan_folder

        return scan_folder.ScanFolder(files, reading)
    if dataset_files.is_grid_map(files):
        from scanplan.recordings import grid_map_scans

        return grid_map_scans.GridMapScans(files, reading)
    if dataset_files.is_las_drive(files):
        from scanplan.recordings import las_drive

        return las_drive.LasDrive(files, reading)
    from scanplan.recordings import bags, recorded_survey

    opened = [
        stack.enter_context(bags.open_bag(path, **opening))
        for path in dataset_files.group_recordings(files)
    ]
    names = topics_and_frame["cloud_topic"]
    if names is None or isinstance(names, str):
        from scanplan.recordings import nodding_sweeps

        survey = recorded_survey.BagSurvey(
            opened, **topics_and_frame, reading=reading, known_t_ns=known_t_ns
        )
        return nodding_sweeps.take_nods(survey) if known_t_ns is None else survey
    from scanplan.recordings import scanner_drives

    surveys = [
        recorded_survey.BagSurvey(
            opened, **{**topics_and_frame, "cloud_topic": name}, reading=reading
        )
        for name in names
    ]
    return scanner_drives.ScannerDrives(surveys, max_damaged_share=reading.max_damaged_share)
