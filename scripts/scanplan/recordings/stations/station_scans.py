"""A survey of stations: few scans of many points, taken standing still, with surveyed poses."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import frame_edges, map_origin
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.motion.pose_kind import STATIONS
from scanplan.recordings.posed_scans import UntimedScans
from scanplan.recordings.stations.angular_grid import STEP_DEG, AngularGrid
from scanplan.stage import log
from scanplan.types import Array, FloatArray

_APART_NS = 3600 * 10**9
"""Between stations, whose files seldom say when: so long that no limit of a drive's pace is met."""
_MOST_BEHIND = 0.08
"""Of directions: simulated stations have 0.002 at most, a real one 0.012, merged clouds 0.10 to
0.67."""
_RIGID = 1e-3  # what files round a pose to stays within it

Block = tuple[FloatArray, Array | None]
"""Points (n, 3) float64 in the sensor's frame, NaN where a beam did not return, and their colours
(n, 3) uint16, black where there is none; None where they are not asked for."""


@dataclass(frozen=True)
class Station:
    """One scan in a file.

    Attributes
    ----------
    name : str
        The file and which of its scans, for errors.
    world_from_sensor : (4, 4) float64
    read_blocks : callable
        Returns an iterator over its points, some at a time; given True, with their colours.
    has_colours : bool
    """

    name: str
    world_from_sensor: FloatArray
    read_blocks: Callable[[bool], Iterator[Block]]
    has_colours: bool = False

    def read_in_world(self) -> Iterator[FloatArray]:
        """Yield its points (n, 3) float64 where its pose puts them."""
        for xyz_m, _ in self.read_blocks(False):
            yield se3.transform_points(self.world_from_sensor, xyz_m)


class StationScans(UntimedScans):
    """Stations in the order of their files; each is thinned as it is read.

    Parameters
    ----------
    where : str
        What they are from, for errors.
    reading : CloudReading
        By default the poses are surveyed.

    Raises
    ------
    StageError
        If there is none, a pose is none, or several have one and the same.
    """

    def __init__(
        self,
        where: str,
        stations: Sequence[Station],
        reading: CloudReading,
    ) -> None:
        self._unit_m = reading.units.cloud_m
        if not stations:
            raise StageError(f"{where}: holds no scan with points; export it again")
        self._stations = stations
        poses = np.array([station.world_from_sensor for station in stations])
        _check_poses(stations, poses)
        stamps_ns = np.arange(1, len(stations) + 1) * _APART_NS
        xyz_m, quat = se3.split_pose(poses)
        xyz_m = reading.units.pose_m * xyz_m
        xyz_m = xyz_m - map_origin.find_origin(where, xyz_m)
        track = frame_edges.FrameEdge("map", "sensor", xyz_m, quat, stamps_ns)
        super().__init__(where, track, stamps_ns, STATIONS, reading)
        log.log_line(
            f"{where}: {len(stations)} stations, of each a point for every {STEP_DEG} degrees of"
            " direction"
        )

    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return the thinned points of a station: see `posed_scans.PosedScans.read_cloud`."""
        station = self._stations[scan_id]
        grid = _thin(station, self._unit_m)
        if grid.share_behind > _MOST_BEHIND:
            raise StageError(
                f"{station.name}: in {grid.share_behind:.0%} of the directions from its scanner"
                " points lie behind others, which no scanner sees: it is a merged cloud, or its"
                f" pose is not where it stood (at most {_MOST_BEHIND:.0%}); export each station as"
                " a scan of its own, with its pose"
            )
        return grid.xyz_m, None

    @property
    def has_colours(self) -> bool:
        """Whether any station has."""
        return any(station.has_colours for station in self._stations)

    def read_colours(self, scan_id: int) -> Array | None:
        """Return the colours (n, 3) uint16 of the points that `scans` yields, if there are any."""
        station = self._stations[scan_id]
        if not station.has_colours:
            return None
        grid = _thin(station, self._unit_m, coloured=True)
        is_in_range = self._limits.include(grid.xyz_m)
        return None if grid.rgb is None else grid.rgb[is_in_range]


def are_merged(stations: Sequence[Station]) -> bool:
    """Return whether scans of one pose, or without any, are parts of a cloud in one frame.

    Of one at least points lie behind others, seen from where its scanner is said to have stood.

    Raises
    ------
    StageError
        If one cannot be read.
    """
    poses = np.array([station.world_from_sensor for station in stations])
    if len(stations) == 0 or not np.isfinite(poses).all() or np.ptp(poses, axis=0).max() > 0:
        return False
    return any(_thin(station).share_behind > _MOST_BEHIND for station in stations)


def _thin(station: Station, unit_m: float = 1.0, *, coloured: bool = False) -> AngularGrid:
    grid = AngularGrid()
    for xyz_m, rgb in station.read_blocks(coloured):
        grid.add(unit_m * xyz_m, rgb)
    return grid


def _check_poses(stations: Sequence[Station], poses: FloatArray) -> None:
    """Refuse poses that are none, and scans that were not placed."""
    for station, pose in zip(stations, poses, strict=True):
        turn = pose[:3, :3]
        is_rigid = np.isfinite(pose).all() and np.abs(turn @ turn.T - np.eye(3)).max() < _RIGID
        if not is_rigid or np.linalg.det(turn) < 0:
            raise StageError(
                f"{station.name}: its pose is no rotation and place in metres; export it again"
            )
    if len(stations) > 1 and np.ptp(poses, axis=0).max() == 0:
        raise StageError(
            f"{stations[-1].name}: all {len(stations)} scans have the same pose: they are not"
            " registered, or it was left out; export them with their poses"
        )
