"""Runs of points along a line: cut where they pause, grown and joined through further points."""

from collections.abc import Sequence

import numpy as np

from scanplan.extraction.segment_limits import SegmentLimits
from scanplan.geometry.lines import Line
from scanplan.rays.face_raster import BELOW_CEILING_M, SCAN_COLUMN_M, FaceRaster, rasterise_rays
from scanplan.rays.face_rays import ON_M, SKIRTING_M, cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray

_PAUSE_SHARE = 1 / 2  # of the reach: wider than beams apart at grazing angles, narrower than a door
_EDGE_ON_M = 1e-6  # a line nearer to the sensor is seen edge on, and divides by about 0


def find_runs(where_m: FloatArray, max_gap_m: float, min_points: int) -> FloatArray:
    """Return first and last (k, 2) of each run of enough positions without a gap."""
    where_m = np.sort(where_m)
    parts = np.split(where_m, np.flatnonzero(np.diff(where_m) > max_gap_m) + 1)
    least = max(min_points, 1)
    return np.array([(p[0], p[-1]) for p in parts if len(p) >= least]).reshape(-1, 2)


def find_upright_runs(
    scan: RaySet,
    line: Line,
    where_m: FloatArray,
    height_m: FloatArray,
    n_own: int,
    limits: SegmentLimits,
) -> FloatArray:
    """Return the first and last (k, 2) of each run of points on a line in space.

    Parameters
    ----------
    scan : ray_set.RaySet
    line : lines.Line
    where_m, height_m : (n,) float
        Along the line, and above the floor.
    n_own : int
        The first so many points make runs; the others only prolong and join them.
    limits : SegmentLimits
    """
    if n_own == 0:
        return np.empty((0, 2))
    raster = _rasterise_scan(scan, line, where_m, height_m, limits.door_height_m)
    column = raster.column_of(where_m)
    heights_m = {"low_m": SKIRTING_M, "door_m": limits.door_height_m}
    is_open = raster.is_open(limits.min_height_m, **heights_m)
    is_closed = raster.is_stopped(**heights_m) & ~is_open
    makes = (height_m <= limits.door_height_m) & ~is_open[column]
    runs = find_runs(where_m[:n_own][makes[:n_own]], limits.max_gap_m, limits.min_points)
    return grow_runs(runs, where_m[is_closed[column]], limits.corner_m, raster, is_open)


def grow_runs(
    found: FloatArray,
    where_m: FloatArray,
    max_gap_m: float,
    raster: FaceRaster,
    is_open: BoolArray,
) -> FloatArray:
    """Let runs go on through further positions up to a gap or an opening, and join those that meet.

    Parameters
    ----------
    found : (k, 2) float
        First and last of each run, rising.
    where_m : (n,) float
        Further positions.
    max_gap_m : float
    raster : face_raster.FaceRaster
    is_open : (c,) bool
        Which of its columns a way leads through.

    Returns
    -------
    (j, 2) float64
    """
    if len(found) == 0:
        return found
    where_m = np.sort(np.concatenate([where_m, found.ravel()]))
    is_break = (np.diff(where_m) > max_gap_m) | _opens_between(where_m, raster, is_open)
    breaks = np.flatnonzero(is_break) + 1
    begins_m = where_m[np.r_[0, breaks]]
    ends_m = where_m[np.r_[breaks - 1, len(where_m) - 1]]
    joined = []
    for first, last in found:
        first_m = begins_m[np.searchsorted(begins_m, first, "right") - 1]
        last_m = ends_m[np.searchsorted(ends_m, last)]
        if joined and first_m <= joined[-1][1]:
            joined[-1][1] = last_m
        else:
            joined.append([first_m, last_m])
    return np.array(joined)


def extend_run_ends(
    first: float, last: float, where_m: FloatArray, reach_rad: float, offset_m: float
) -> Sequence[float]:
    """Return a run's ends, moved through positions that go on without a pause, within a reach.

    Parameters
    ----------
    first, last : float
        The run along its line.
    where_m : (n,) float
        Further positions.
    reach_rad : float
        As an angle seen from the sensor.
    offset_m : float
        Of the line from the sensor.
    """
    ends = []
    for sign, end in ((-1, first), (1, last)):
        reach_m = reach_rad * np.hypot(end, offset_m)
        beyond_m = np.sort(sign * (where_m - end))
        beyond_m = np.concatenate([[0.0], beyond_m[(beyond_m > 0) & (beyond_m <= reach_m)]])
        pauses = np.flatnonzero(np.diff(beyond_m) > reach_m * _PAUSE_SHARE)
        ends.append(end + sign * beyond_m[pauses[0] if len(pauses) else -1])
    return ends


def _opens_between(where_m: FloatArray, raster: FaceRaster, is_open: BoolArray) -> BoolArray:
    """Return between which of consecutive positions (k,), rising, a column is open, (k - 1,)."""
    n_open_before = np.concatenate([[0], np.cumsum(is_open)])
    column = raster.column_of(where_m)
    after = np.minimum(column[:-1] + 1, column[1:])
    return n_open_before[column[1:]] > n_open_before[after]


def _rasterise_scan(
    scan: RaySet, line: Line, where_m: FloatArray, height_m: FloatArray, door_height_m: float
) -> FaceRaster:
    """Return the raster of a line.

    The points given, below a door's height, are what is occupied; rays go on through the thinnest
    wall.
    """
    span_m = where_m.min(), where_m.max()
    face = cast_at_face(scan, line, *span_m, at_m=ON_M, least_side_m=_EDGE_ON_M)
    free = face.is_free(ON_M)
    occluded = face.is_occluded
    sensor_m = np.zeros(2)
    slope = (face.along_m[free] - line.along_m(sensor_m)) / np.abs(line.offset_m(sensor_m))
    low = height_m <= door_height_m
    return rasterise_rays(
        (where_m[low], height_m[low]),
        (face.along_m[free], face.height_m[free]),
        (face.along_m[occluded], face.height_m[occluded]),
        span_m=span_m,
        column_m=SCAN_COLUMN_M,
        high_m=max(BELOW_CEILING_M, door_height_m),
        free_until_m=face.along_m[free] + slope * ON_M,
    )
