"""A drive as points in the map with the time of each, .las or .laz, and the sensor's trajectory."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from scanplan.errors import StageError
from scanplan.project import dataset_entries
from scanplan.recordings import frame_edges, map_origin, trajectory_file
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.las_points import LasBlock, list_blocks
from scanplan.recordings.motion.pose_kind import LOCALISER
from scanplan.recordings.posed_scans import UntimedScans
from scanplan.stage import log
from scanplan.types import Array, FloatArray, IntArray

_SLICE_S = 0.1  # a scan: a walk's 0.1 m, and one turn of most sensors
_MOST_WAITING = 10_000_000  # points of scans that are read together: 120 MB
_WEEK_S = 7 * 24 * 3600
_UNIX_S = 315_964_782.0  # of GPS's begin, less the 18 leap seconds since then, as of 2017
_CLOCKS = (
    *((0.0, np.inf), (1e9, np.inf), (0.0, _WEEK_S), (1e9, _WEEK_S)),
    *((_UNIX_S, np.inf), (1e9 + _UNIX_S, np.inf), (_UNIX_S, _WEEK_S)),
)
"""What is added to the points' times, and after how long clocks begin anew: LAS has GPS seconds
less 1e9, or those of the week; so may trajectories, which may be in Unix time, too."""
_LEAST_COVERED = 0.5  # of points by the trajectory: less is another clock, or another drive


class _Slicing(NamedTuple):
    """How times of points become numbers of scans."""

    begin_s: float
    n_slices: int
    add_s: float
    again_s: float

    def number(self, time_s: FloatArray) -> IntArray:
        """Return in which slice each time is, -1 for none."""
        since_s = time_s + self.add_s - self.begin_s
        since_s = np.where(np.isfinite(since_s), since_s, -1.0)
        since_s = since_s if np.isinf(self.again_s) else since_s % self.again_s
        is_inside = np.isfinite(time_s) & (since_s >= 0) & (since_s < self.n_slices * _SLICE_S)
        return np.where(is_inside, since_s / _SLICE_S, -1).astype(np.int64)


class LasDrive(UntimedScans):
    """Points in the map, cut into scans of a tenth of a second, each seen from where it was taken.

    Files are gone through block by block: once to count, and then for the scans that are asked for,
    as many at a time as fit; blocks without any are left out. Points may lie in any order.

    Parameters
    ----------
    files : sequence of str
        The clouds, and the trajectory.
    reading : CloudReading
        By default the poses are a localiser's.

    Raises
    ------
    StageError
        If a file is damaged, its points have no time, or the trajectory is of another time.
    """

    def __init__(self, files: Sequence[str], reading: CloudReading) -> None:
        self._unit_m = reading.units.cloud_m
        paths = [Path(file) for file in files]
        path = next(filter(dataset_entries.is_trajectory, paths))
        clouds = [file for file in paths if not dataset_entries.is_trajectory(file)]
        time_s, xyz_m = trajectory_file.read_trajectory(path)
        xyz_m = reading.units.pose_m * xyz_m
        xyz_m = xyz_m - (origin_m := map_origin.find_origin(str(path), xyz_m))
        blocks = [block for cloud in clouds for block in list_blocks(cloud)]
        self._slicing = _find_clock(blocks, time_s, path)
        self._blocks, counts = _count_points(blocks, self._slicing)
        self._slices = np.flatnonzero(counts)
        self._counts = counts[self._slices]
        since_s = (self._slices + 0.5) * _SLICE_S
        places_m = [np.interp(since_s, time_s - time_s[0], column) for column in xyz_m.T]
        self._places_m = np.column_stack(places_m) + origin_m
        stamps_ns = _to_ns(time_s[0], since_s)
        t_ns, first = np.unique(_to_ns(time_s[0], time_s - time_s[0]), return_index=True)
        level = np.tile([0.0, 0.0, 0.0, 1.0], (len(t_ns), 1))
        track = frame_edges.FrameEdge("map", "sensor", xyz_m[first], level, t_ns)
        super().__init__(str(path), track, stamps_ns, LOCALISER, reading)
        self._asked = np.arange(len(stamps_ns))
        self._waiting: dict[int, FloatArray] = {}

    def read_ahead(self, scan_ids: Sequence[int]) -> None:
        """Take note of which scans will be read, so that some are read together."""
        self._asked = np.asarray(scan_ids, np.int64)
        self._waiting = {}

    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return the points of a scan from where it was taken, axes as the map's."""
        if scan_id not in self._waiting:
            ahead = self._asked[self._asked > scan_id]
            ahead = np.insert(ahead, 0, scan_id)
            n_points = np.cumsum(self._counts[ahead])
            n_fitting = int(np.searchsorted(n_points, _MOST_WAITING, "right"))
            self._waiting = self._read_group(ahead[: max(1, n_fitting)])
        return self._waiting.pop(scan_id), None

    def _read_group(self, scan_ids: IntArray) -> dict[int, FloatArray]:
        of_slice = np.full(self._slicing.n_slices, -1)
        of_slice[self._slices[scan_ids]] = scan_ids
        parts: dict[int, list[FloatArray]] = {int(scan_id): [] for scan_id in scan_ids}
        for block, first, last in self._blocks:
            if (of_slice[first : last + 1] < 0).all():
                continue
            points = block.read()
            slices = self._slicing.number(_times(block, points.time_s))
            owner = np.where(slices >= 0, of_slice[slices], -1)
            rows = np.argsort(owner, kind="stable")
            rows = rows[owner[rows] >= 0]
            found, begins = np.unique(owner[rows], return_index=True)
            for one, of_one in zip(found.tolist(), np.split(rows, begins[1:]), strict=True):
                seen_m = self._unit_m * points.xyz_m[of_one] - self._places_m[one]
                parts[one].append(seen_m.astype(np.float32))
        return {one: np.concatenate(part) for one, part in parts.items()}


def _to_ns(begin_s: float, since_s: FloatArray) -> IntArray:
    return round(begin_s * 1e9) + np.round(since_s * 1e9).astype(np.int64)


def _times(block: LasBlock, time_s: FloatArray | None) -> FloatArray:
    if time_s is None:
        raise StageError(
            f"{block.path}: its points have no time (point formats 0 and 2); export them with"
            " GPS time, or leave out the trajectory: without it they are a merged cloud"
        )
    return time_s


def _find_clock(blocks: Sequence[LasBlock], time_s: FloatArray, path: Path) -> _Slicing:
    """Return how the points' times become those of a trajectory, by those of the first block."""
    if not blocks:
        raise StageError(f"{path}: the clouds beside it have no points; export them again")
    shown_s = _times(blocks[0], blocks[0].read().time_s)
    n_slices = int((time_s[-1] - time_s[0]) / _SLICE_S) + 1
    clocks = [_Slicing(time_s[0], n_slices, *clock) for clock in _CLOCKS]
    covered = [np.count_nonzero(clock.number(shown_s) >= 0) for clock in clocks]
    # of clocks that are as good the plainest
    return clocks[int(np.argmax(covered))]


def _count_points(
    blocks: Sequence[LasBlock], slicing: _Slicing
) -> tuple[list[tuple[LasBlock, int, int]], IntArray]:
    """Return the blocks with the first and last slice of each, and the points of every slice."""
    counts = np.zeros(slicing.n_slices, np.int64)
    known = []
    for block in blocks:
        slices = slicing.number(_times(block, block.read().time_s))
        slices = slices[slices >= 0]
        if len(slices):
            counts += np.bincount(slices, minlength=slicing.n_slices)
            known.append((block, int(slices.min()), int(slices.max())))
    n_covered = int(counts.sum())
    n_points = sum(block.n_points for block in blocks)
    where = ", ".join(dict.fromkeys(str(block.path) for block in blocks))
    if n_covered < _LEAST_COVERED * n_points:
        first_s = _times(blocks[0], blocks[0].read().time_s)[0]
        end_s = slicing.begin_s + slicing.n_slices * _SLICE_S
        raise StageError(
            f"{where}: {n_covered} of {n_points} points, the first at {first_s:.9g} s, lie within"
            f" the trajectory, {slicing.begin_s:.3f} to {end_s:.3f} s; give the trajectory of this"
            " drive, in the time of the points"
        )
    log.log_line(
        f"{where}: {n_covered:,} of {n_points:,} points within the trajectory, in"
        f" {np.count_nonzero(counts):,} scans of {_SLICE_S} s"
    )
    return known, counts
