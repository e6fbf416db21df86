"""Runs of points along a line: cut where they pause, grown and joined through further points."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from scanplan.extraction.segment_limits import SegmentLimits
from scanplan.geometry.lines import Line
from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays.face_raster import CELL_M, SCAN_COLUMN_M, Places
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import ON_M, SKIRTING_M
from scanplan.types import BoolArray, FloatArray, IntArray

_PAUSE_SHARE = 1 / 2  # of the reach: wider than beams apart at grazing angles, narrower than a door


@dataclass(frozen=True, eq=False)
class LineColumns:
    """Columns along a line, as the rays of one scan show them.

    Attributes
    ----------
    first_m : float
        Where the first begins.
    is_open : (c,) bool
        Which a ray goes through above what ends rays there: a way leads through.
    is_stopped : (c,) bool
        Which rays end lower than a door: at the line, or before it above the skirting.
    """

    first_m: float
    is_open: BoolArray
    is_stopped: BoolArray

    def of(self, where_m: FloatArray) -> IntArray:
        """Return the columns (n,) of places, the first or the last for those beyond."""
        return _column_of(where_m, self.first_m, len(self.is_open))


def find_runs(where_m: FloatArray, max_gap_m: float, min_points: int) -> FloatArray:
    """Return first and last (k, 2) of each run of enough positions without a gap."""
    if len(where_m) == 0:
        return np.empty((0, 2))
    where_m = np.sort(where_m)
    (pauses,) = np.nonzero(where_m[1:] - where_m[:-1] > max_gap_m)
    first = np.concatenate([[0], pauses + 1])
    last = np.concatenate([pauses, [len(where_m) - 1]])
    is_run = last - first + 1 >= min_points
    return np.column_stack([where_m[first[is_run]], where_m[last[is_run]]])


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
    where_m, height_m : (n,) float
        Along the line, and above the floor.
    n_own : int
        The first so many points make runs; the others only prolong and join them.
    """
    if n_own == 0:
        return np.empty((0, 2))
    columns = _look_at_columns(scan, line, where_m, height_m, limits)
    column = columns.of(where_m)
    makes = (height_m <= limits.door_height_m) & ~columns.is_open[column]
    runs = find_runs(where_m[:n_own][makes[:n_own]], limits.max_gap_m, limits.min_points)
    joins = (columns.is_stopped & ~columns.is_open)[column]
    return grow_runs(runs, where_m[joins], limits.corner_m, columns)


def grow_runs(
    found: FloatArray, where_m: FloatArray, max_gap_m: float, columns: LineColumns
) -> FloatArray:
    """Let runs go on through further positions up to a gap or an opening, and join those that meet.

    Parameters
    ----------
    found : (k, 2) float
        First and last of each run, rising.
    where_m : (n,) float
        Further positions.

    Returns
    -------
    (j, 2) float64
    """
    if len(found) == 0:
        return found
    where_m = np.sort(np.concatenate([where_m, found.ravel()]))
    is_break = (where_m[1:] - where_m[:-1] > max_gap_m) | _opens_between(where_m, columns)
    (breaks,) = np.nonzero(is_break)
    begins_m = where_m[np.concatenate([[0], breaks + 1])]
    ends_m = where_m[np.concatenate([breaks, [len(where_m) - 1]])]
    firsts_m = begins_m[np.searchsorted(begins_m, found[:, 0], "right") - 1]
    lasts_m = ends_m[np.searchsorted(ends_m, found[:, 1])]
    joined: list[list[float]] = []
    for first_m, last_m in zip(firsts_m.tolist(), lasts_m.tolist(), strict=True):
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


class LineRays(NamedTuple):
    """The rays of one scan at a line.

    Attributes
    ----------
    occupied, free, occluded : face_raster.Places
        Where rays end at the line, go through it, and would have met it.
    free_until_m : (n,) float
        Until where along the line each ray through leaves the thinnest wall: columns up to there
        are free, too.
    """

    occupied: Places
    free: Places
    free_until_m: FloatArray
    occluded: Places


def sort_into_columns(
    rays: LineRays,
    *,
    span_m: tuple[float, float],
    sill_m: float,
    door_m: float,
) -> LineColumns:
    """Sort the rays of one scan into columns of 10 cm along a line.

    Parameters
    ----------
    span_m : (float, float)
        From where to where; rays beyond count for the first and the last column.
    sill_m : float
        What is no higher does not close a column.
    door_m : float
        What is higher says nothing of what is below.
    """
    occupied, free, free_until_m, occluded = rays
    n_columns = int((span_m[1] - span_m[0]) / SCAN_COLUMN_M) + 1
    top_row = np.full(n_columns, -1)
    low, row = _low_rows(occupied[1], 0.0, door_m)
    np.maximum.at(top_row, _column_of(occupied[0][low], span_m[0], n_columns), row)
    over, row = _low_rows(free[1], SKIRTING_M, door_m)
    begin = _column_of(free[0][over], span_m[0], n_columns)
    end = _column_of(free_until_m[over], span_m[0], n_columns)
    column, ray = _count_through(np.minimum(begin, end), np.maximum(begin, end))
    is_open = np.zeros(n_columns, bool)
    is_open[column[row[ray] > top_row[column]]] = True
    is_stopped = top_row >= 0
    before, _ = _low_rows(occluded[1], SKIRTING_M, door_m)
    is_stopped[_column_of(occluded[0][before], span_m[0], n_columns)] = True
    return LineColumns(span_m[0], is_open & ((top_row + 1) * CELL_M <= sill_m), is_stopped)


def _look_at_columns(
    scan: RaySet, line: Line, where_m: FloatArray, height_m: FloatArray, limits: SegmentLimits
) -> LineColumns:
    """Return a line's columns: points given are at it, rays go on through the thinnest wall."""
    span_m = float(where_m.min()), float(where_m.max())
    face = cast_at_face(scan, line, *span_m, at_m=ON_M, least_side_m=ROUNDING)
    (free,) = np.nonzero(face.is_free(ON_M))
    (occluded,) = np.nonzero(face.is_occluded)
    free_m = face.along_m.take(free)
    slope = (free_m - face.views.sensor_along_m) / np.abs(face.views.side_m)
    rays = LineRays(
        occupied=(where_m, height_m),
        free=(free_m, face.height_m.take(free)),
        free_until_m=free_m + slope * ON_M,
        occluded=(face.along_m.take(occluded), face.height_m.take(occluded)),
    )
    return sort_into_columns(
        rays,
        span_m=span_m,
        sill_m=limits.min_height_m,
        door_m=limits.door_height_m,
    )


def _column_of(along_m: FloatArray, first_m: float, n_columns: int) -> IntArray:
    """Return the columns (n,) of places, the first or the last for those beyond."""
    column = ((along_m - first_m) / SCAN_COLUMN_M).astype(np.int64)
    return np.minimum(np.maximum(column, 0), n_columns - 1)


def _low_rows(height_m: FloatArray, low_m: float, door_m: float) -> tuple[IntArray, IntArray]:
    """Return which heights (n,) are between two, and the row of 5 cm that each of these is in."""
    row = np.maximum(height_m / CELL_M, 0).astype(np.int64)
    (low,) = np.nonzero((row >= round(low_m / CELL_M)) & (row < round(door_m / CELL_M)))
    return low, row[low]


def _count_through(begin: IntArray, end: IntArray) -> tuple[IntArray, IntArray]:
    """Return each number from begin to end, both included, and of which pair (n,) it is."""
    count = end - begin + 1
    pair = np.repeat(np.arange(len(count)), count)
    return np.arange(len(pair)) + np.repeat(begin + count - np.cumsum(count), count), pair


def _opens_between(where_m: FloatArray, columns: LineColumns) -> BoolArray:
    """Return between which of consecutive positions (k,), rising, a column is open, (k - 1,)."""
    n_open_before = np.concatenate([[0], np.cumsum(columns.is_open)])
    column = columns.of(where_m)
    after = np.minimum(column[:-1] + 1, column[1:])
    return n_open_before[column[1:]] > n_open_before[after]
