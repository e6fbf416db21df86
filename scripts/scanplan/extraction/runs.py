"""Runs of points along a line: cut where they pause, grown and joined through further points."""

import numpy as np

_PAUSE_SHARE = 1 / 2  # of the reach: wider than beams apart at grazing angles, narrower than a door


def find_runs(where_m, max_gap_m, min_points):
    """Return first and last (k, 2) of each run of enough positions without a gap."""
    where_m = np.sort(where_m)
    parts = np.split(where_m, np.flatnonzero(np.diff(where_m) > max_gap_m) + 1)
    return np.array([(p[0], p[-1]) for p in parts if len(p) >= max(min_points, 1)]).reshape(-1, 2)


def grow_runs(found, where_m, max_gap_m, raster, is_open):
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
    breaks = (
        np.flatnonzero((np.diff(where_m) > max_gap_m) | _opens_between(where_m, raster, is_open))
        + 1
    )
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


def _opens_between(where_m, raster, is_open):
    """Return between which of consecutive positions (k,), rising, a column is open.

    (k - 1,) bool.
    """
    before = np.concatenate([[0], np.cumsum(is_open)])
    column = raster.column_of(where_m)
    return before[column[1:]] > before[np.minimum(column[:-1] + 1, column[1:])]


def extend_run_ends(first, last, where_m, reach_rad, offset_m):
    """Move a run's ends through positions that go on without a pause, within a reach."""
    ends = []
    for sign, end in ((-1, first), (1, last)):
        reach_m = reach_rad * np.hypot(end, offset_m)
        beyond = np.sort(sign * (where_m - end))
        beyond = np.concatenate([[0.0], beyond[(beyond > 0) & (beyond <= reach_m)]])
        pauses = np.flatnonzero(np.diff(beyond) > reach_m * _PAUSE_SHARE)
        ends.append(end + sign * beyond[pauses[0] if len(pauses) else -1])
    return ends
