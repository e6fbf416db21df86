"""Where along a line its points are, and where the rays of the scan pass through it instead."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry import intervals
from scanplan.rays import scan_view

_COLUMN_M = 0.1
_MOST_COLUMNS = 10_000  # farther than 1 km is no building
_PAUSE_SHARE = 1 / 2  # of the reach: wider than beams apart at grazing angles, narrower than a door


@dataclass(frozen=True)
class LineColumns:
    """What rays tell of the columns of a line.

    Attributes
    ----------
    first_m, width_m : float
        Where the first column begins, and how wide each is.
    is_open : (n,) bool
        Rays pass through, below the top of a door and above any sill.
    is_shut : (n,) bool
        None does, and rays end there, on the line or before it, below the top of a door.
    """

    first_m: float
    width_m: float
    is_open: np.ndarray
    is_shut: np.ndarray

    def of(self, where_m):
        """Return the columns of positions (k,) that are within them."""
        return ((where_m - self.first_m) / self.width_m).astype(np.int64)

    def open_between(self, where_m):
        """Tell between which of consecutive positions (k,), rising, columns are open: (k - 1,) bool."""
        before = np.concatenate([[0], np.cumsum(self.is_open)])
        column = self.of(where_m)
        return before[column[1:]] > before[np.minimum(column[:-1] + 1, column[1:])]


def classify_columns(scan, normal, offset_m, where_m, height_m, *, sill_m, door_m):
    """Tell which columns of a line are open and which shut.

    Parameters
    ----------
    scan : scan_view.ScanView
    normal : (2,) float
        Of the line, towards the sensor.
    offset_m : float
        normal . xy = offset, relative to the sensor; not positive.
    where_m, height_m : (n,) float
        Points on the line: along it, and above the floor; n >= 1.
    sill_m : float
        Rays pass over what is no higher than this, and the column is open.
    door_m : float
        What is higher says nothing of what is below.

    Returns
    -------
    Columns
    """
    first_m, width_m = where_m.min(), max(_COLUMN_M, np.ptp(where_m) / _MOST_COLUMNS)
    n = int(np.ptp(where_m) / width_m) + 1
    low = height_m <= door_m
    top_m = np.full(n, -np.inf)
    np.maximum.at(top_m, ((where_m[low] - first_m) / width_m).astype(np.int64), height_m[low])
    crossed = scan_view.find_plane_crossings(
        scan, normal, offset_m, (first_m, first_m + n * width_m)
    )
    raised = (crossed.height_m > scan_view.SKIRTING_M) & (crossed.height_m <= door_m)
    at, until = (
        np.clip((m - first_m) / width_m, 0, n - 1).astype(np.int64)
        for m in (crossed.at_m, crossed.until_m)
    )
    through = raised & crossed.behind & (crossed.height_m > top_m[at] + scan_view.CLEAR_M)
    begin, end = np.minimum(at, until)[through], np.maximum(at, until)[through]
    change = np.bincount(begin, minlength=n + 1) - np.bincount(end + 1, minlength=n + 1)
    is_open = (np.cumsum(change)[:n] > 0) & (top_m < sill_m)
    stopped = np.bincount(at[raised & crossed.before], minlength=n) > 0
    return LineColumns(first_m, width_m, is_open, ~is_open & (stopped | np.isfinite(top_m)))


def find_runs(where_m, max_gap_m, min_points):
    """Return the first and last (k, 2) of each run of positions without a gap, of runs of enough points."""
    where_m = np.sort(where_m)
    parts = np.split(where_m, intervals.find_run_starts(where_m, where_m, max_gap_m))
    return np.array([(p[0], p[-1]) for p in parts if len(p) >= max(min_points, 1)]).reshape(-1, 2)


def grow_runs(found, where_m, max_gap_m, line_columns):
    """Let runs go on through further positions up to a gap or an opening, and join those that meet.

    Parameters
    ----------
    found : (k, 2) float
        First and last of each run, rising.
    where_m : (n,) float
        Further positions.
    max_gap_m : float
    line_columns : Columns

    Returns
    -------
    (j, 2) float64
    """
    if len(found) == 0:
        return found
    where_m = np.sort(np.concatenate([where_m, found.ravel()]))
    breaks = np.flatnonzero((np.diff(where_m) > max_gap_m) | line_columns.open_between(where_m)) + 1
    begins, ends = where_m[np.r_[0, breaks]], where_m[np.r_[breaks - 1, len(where_m) - 1]]
    joined = []
    for first, last in found:
        first_m, last_m = (
            begins[np.searchsorted(begins, first, "right") - 1],
            ends[np.searchsorted(ends, last)],
        )
        if joined and first_m <= joined[-1][1]:
            joined[-1][1] = last_m
        else:
            joined.append([first_m, last_m])
    return np.array(joined)


def extend_run_ends(first, last, where_m, reach_rad, offset_m):
    """Move a run's ends through positions that go on without a pause, within the reach of a neighbourhood."""
    ends = []
    for sign, end in ((-1, first), (1, last)):
        reach_m = reach_rad * np.hypot(end, offset_m)
        beyond = np.sort(sign * (where_m - end))
        beyond = np.concatenate([[0.0], beyond[(beyond > 0) & (beyond <= reach_m)]])
        pauses = np.flatnonzero(np.diff(beyond) > reach_m * _PAUSE_SHARE)
        ends.append(end + sign * beyond[pauses[0] if len(pauses) else -1])
    return ends
