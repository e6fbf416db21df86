"""Where along a line its points are, and where the rays of the scan pass through it instead."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import sightlines

_COLUMN_M = 0.1
_LEAST_M = 0.01
_PAUSE_SHARE = 1 / 2  # of the reach: wider than beams apart at grazing angles, narrower than a door


@dataclass(frozen=True)
class Columns:
    """What rays tell of the columns of a line, 0.1 m each.

    Attributes
    ----------
    first_m : float
        Where the first column begins.
    is_open : (n,) bool
        Rays pass through below the top of a door, and above any sill.
    is_shut : (n,) bool
        Rays end there, on the line or before it, below the top of a door, and none passes through.
    """

    first_m: float
    is_open: np.ndarray
    is_shut: np.ndarray

    def of(self, where_m):
        """Return the columns of positions (k,)."""
        return np.clip(((where_m - self.first_m) / _COLUMN_M).astype(np.int64), 0, len(self.is_open) - 1)

    def open_between(self, where_m):
        """Tell between which of consecutive positions (k,), rising, columns are open: (k - 1,) bool."""
        before = np.concatenate([[0], np.cumsum(self.is_open)])
        column = self.of(where_m)
        return before[column[1:]] > before[np.minimum(column[:-1] + 1, column[1:])]


def columns(where_m, height_m, scan_xyz_m, line, *, least_m, door_m):
    """Tell which columns of a line are open and which shut.

    ASSUME no wall is thinner than 8 cm: where a ray is that little behind the line there is none. Of a doorway at
    grazing incidence a ray may show no more than the reveal.

    Parameters
    ----------
    where_m, height_m : (n,) float
        Points on the line: along it, and relative to the sensor; n >= 1.
    scan_xyz_m : (k, 3) float
        All points of the scan, relative to the sensor.
    line : (normal (2,), offset_m, floor_m)
        normal . xy = offset; the normal points to the sensor, the offset is not positive. Height of the floor.
    least_m, door_m : float
        Above the floor: a lower sill makes no wall; what is higher says nothing of what is below.
    """
    normal, offset_m, floor_m = line
    first_m, n = where_m.min(), int(np.ptp(where_m) / _COLUMN_M) + 1
    sill_m = np.full(n, -np.inf)
    height_m = height_m - floor_m
    low = height_m <= door_m
    np.maximum.at(sill_m, ((where_m[low] - first_m) / _COLUMN_M).astype(np.int64), height_m[low])
    across_m = scan_xyz_m[:, 0] * normal[0] + scan_xyz_m[:, 1] * normal[1]
    along_m = (scan_xyz_m[:, 0] * normal[1] - scan_xyz_m[:, 1] * normal[0] - 0.0)
    part = offset_m / np.minimum(across_m, -_LEAST_M)
    crossed_m = along_m * part
    passed_m = scan_xyz_m[:, 2] * part - floor_m
    raised = (passed_m > sightlines.SKIRTING_M) & (passed_m <= door_m) & (across_m < -_LEAST_M)
    (behind,) = np.nonzero(raised & (across_m < offset_m - sightlines.ON_M))
    deep_m = along_m[behind] * ((offset_m - sightlines.ON_M) / across_m[behind])
    at, deep = (np.floor((x - first_m) / _COLUMN_M) for x in (crossed_m[behind], deep_m))
    begin, end = np.minimum(at, deep), np.maximum(at, deep)
    over = passed_m[behind] > sill_m[np.clip(at, 0, n - 1).astype(np.int64)] + sightlines.CLEAR_M
    some = (begin < n) & (end >= 0) & over
    begin, end = (np.clip(x[some], 0, n - 1).astype(np.int64) for x in (begin, end))
    change = np.bincount(begin, minlength=n + 1) - np.bincount(end + 1, minlength=n + 1)
    is_open = (np.cumsum(change)[:n] > 0) & (sill_m < least_m)
    stopped = np.floor((crossed_m[raised & (across_m > offset_m + sightlines.ON_M)] - first_m) / _COLUMN_M)
    stopped = stopped[(stopped >= 0) & (stopped < n)].astype(np.int64)
    is_shut = ~is_open & (np.isfinite(sill_m) | (np.bincount(stopped, minlength=n) > 0))
    return Columns(first_m, is_open, is_shut)


def runs(where_m, max_gap_m, min_points):
    """Return the first and last (k, 2) of each run of positions without a gap, of runs of enough points."""
    where_m = np.sort(where_m)
    parts = np.split(where_m, np.flatnonzero(np.diff(where_m) > max_gap_m) + 1)
    return np.array([(p[0], p[-1]) for p in parts if len(p) >= max(min_points, 1)]).reshape(-1, 2)


def grown(found, where_m, max_gap_m, passages):
    """Let runs go on through further positions up to a gap or an opening, and join those that meet.

    Parameters
    ----------
    found : (k, 2) float
        First and last of each run, rising.
    where_m : (n,) float
        All positions, those of the runs among them.
    max_gap_m : float
    passages : Columns

    Returns
    -------
    (j, 2) float64
    """
    if len(found) == 0:
        return found
    where_m = np.sort(where_m)
    breaks = np.flatnonzero((np.diff(where_m) > max_gap_m) | passages.open_between(where_m)) + 1
    begins, ends = where_m[np.r_[0, breaks]], where_m[np.r_[breaks - 1, len(where_m) - 1]]
    joined = []
    for first, last in found:
        first = min(first, begins[np.searchsorted(begins, first, "right") - 1])
        last = max(last, ends[np.searchsorted(ends, last, "left")])
        if joined and first <= joined[-1][1]:
            joined[-1][1] = max(last, joined[-1][1])
        else:
            joined.append([first, last])
    return np.array(joined).reshape(-1, 2)


def prolonged(first, last, where_m, reach_rad, offset_m):
    """Move a run's ends through positions that go on without a pause, within the reach of a neighbourhood."""
    ends = []
    for sign, end in ((-1, first), (1, last)):
        reach_m = reach_rad * np.hypot(end, offset_m)
        beyond = np.sort(sign * (where_m - end))
        beyond = np.concatenate([[0.0], beyond[(beyond > 0) & (beyond <= reach_m)]])
        pauses = np.flatnonzero(np.diff(beyond) > reach_m * _PAUSE_SHARE)
        ends.append(end + sign * beyond[pauses[0] if len(pauses) else -1])
    return ends
