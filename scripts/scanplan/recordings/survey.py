"""A survey as the stages see it: clouds and poses, from bags, a folder of scans, or stations."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

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


@dataclass(frozen=True, kw_only=True)
class Reading:
    """How recordings are read: the section `input` of the settings.

    Attributes
    ----------
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
        Whether to move points to where they would have been seen at their scan's stamp, where the
        sensor's motion is given.
    pose_kind : str, optional
        Of which kind the poses are (`pose_kind.find_pose_kind`); found by default.
    storey : int, optional
        Which of a merged cloud, 0 the lowest; by default the one with most floor.
    """

    cloud_topic: str | Sequence[str] | None = None
    pose_topic: str | None = None
    base_frame: str | None = None
    base_from_sensor: Sequence[float] | None = None
    ros2_release: str = "humble"
    min_range_m: float = 0.0
    max_range_m: float = math.inf
    cloud_unit: str = "m"
    pose_unit: str = "m"
    max_damaged_share: float = 0.0
    salvage: bool = False
    deskew: bool = True
    pose_kind: str = FOUND
    storey: int | None = None

    def of_clouds(self) -> CloudReading:
        """Return what of it readers of clouds go by."""
        return CloudReading(
            limits=RangeLimits(self.min_range_m, self.max_range_m),
            base_from_sensor=self.base_from_sensor,
            units=Units(self.cloud_unit, self.pose_unit),
            max_damaged_share=self.max_damaged_share,
            pose_kind=self.pose_kind,
        )


@contextmanager
def open_survey(
    files: Sequence[str],
    reading: Reading,
    *,
    motion: SensorMotion | None = None,
    known_t_ns: Mapping[int, int] | None = None,
) -> Iterator[Survey]:
    """Open all recordings of a dataset as one survey.

    Parameters
    ----------
    files : sequence of str
        As `dataset_files.find_files` gives them.
    motion : trajectory.SensorMotion, optional
        How the sensor moved.
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
    clouds = reading.of_clouds()
    if scaled := clouds.units.describe():
        log.log_line(scaled)
    with ExitStack() as stack:
        survey = _open_points(files, reading.storey, clouds)
        if survey is None:
            survey = _open_recordings(files, stack, reading, known_t_ns)
        yield DeskewedSurvey(survey, motion) if reading.deskew and motion is not None else survey


def is_as_recorded(survey: Survey) -> bool:
    """Return whether scans are messages of bags as they are, which stamps suffice to read again."""
    return getattr(survey, "as_recorded", False)


@contextmanager
def open_colours(
    files: Sequence[str], reading: Reading
) -> Iterator[Callable[[int], Array | None] | None]:
    """Open what tells the colours of a dataset's points.

    Parameters
    ----------
    files, reading
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

    with open_survey(files, reading) as survey:
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
    reading: Reading,
    known_t_ns: Mapping[int, int] | None,
) -> Survey:
    clouds = reading.of_clouds()
    # rosbags costs a second to import: where it is needed alone
    if dataset_files.is_scan_folder(files):
        from scanplan.recordings import scan_folder

        return scan_folder.ScanFolder(files, clouds)
    if dataset_files.is_grid_map(files):
        from scanplan.recordings import grid_map_scans

        return grid_map_scans.GridMapScans(files, clouds)
    if dataset_files.is_las_drive(files):
        from scanplan.recordings import las_drive

        return las_drive.LasDrive(files, clouds)
    from scanplan.recordings import bags, recorded_survey

    opened = [
        stack.enter_context(
            bags.open_bag(path, ros2_release=reading.ros2_release, salvage=reading.salvage)
        )
        for path in dataset_files.group_recordings(files)
    ]
    names = reading.cloud_topic
    open_topic = partial(
        recorded_survey.BagSurvey,
        opened,
        pose_topic=reading.pose_topic,
        base_frame=reading.base_frame,
        reading=clouds,
    )
    if names is None or isinstance(names, str):
        from scanplan.recordings import nodding_sweeps

        survey = open_topic(cloud_topic=names, known_t_ns=known_t_ns)
        return nodding_sweeps.take_nods(survey) if known_t_ns is None else survey
    from scanplan.recordings import scanner_drives

    surveys = [open_topic(cloud_topic=name) for name in names]
    return scanner_drives.ScannerDrives(surveys, max_damaged_share=reading.max_damaged_share)
