"""Panes along a line: told by the rays that never came back.

Whatever is opaque sends back the rays that reach it, be it the wall, what stands before it, or what is seen through
its openings. Glass lets most through, to where there may be nothing, and mirrors others away. Of the rays themselves
nothing is known but their returns: how many a scan sent at an elevation is told by those that come back elsewhere.
"""

import numpy as np

from scanplan import usualreturns
from scanplan.plan import rays as sights
from scanplan.plan.profiles import COLUMN_M

_BANDS_M = ((0.2, 0.7), (0.9, 1.6))  # between skirting and sill; above sills and below the lintels of low doors
_LEAST_LENGTH_M = 0.3  # narrower panes are in doors and stairs
_LEAST_RAYS = 20.0  # half of so many are not lost by chance
_LEAST_RAYS_A_SCAN = 3.0  # fewer and the count expected is mostly rounding
_LEAST_SCANS = 3  # two may share what stands too near to be measured
_MOST_STOPPED = 0.15  # a frame or a plant may stop these; more and the line is hidden
_LEAST_SHARE = 0.5  # of the rays; a dark or glossy wall still gives more back
_BEFORE_M = 0.1  # returns farther before a line are of something else
_MOST_AWAY_M = 10.0  # further off rays are few and much stands before a line
_WIDTH = 5  # columns that are judged together


def find(rays, line, low_m, high_m):
    """Find where along a line less than half of the rays come back that reach it, low and at the height of a chest.

    A wall below a window is wall, and so is one above an oven: both bands of height have to show it. Where few rays are
    to be expected nothing is said.

    Parameters
    ----------
    rays : rays.Rays
        Of scans in space.
    line : faceline.Line
    low_m, high_m : float
        The stretch of the line to look at.

    Returns
    -------
    (n, 2) float64
        From where to where along the line, in order.
    """
    count = max(int(np.ceil((high_m - low_m) / COLUMN_M)), 1)
    lost = np.full(count, True)
    for heights_m in _BANDS_M:
        if lost.any():
            lost &= _lost(*map(_together, _rays(rays, line, low_m, count, heights_m)))
    edges_m = low_m + COLUMN_M * np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]]).astype(np.int8)))
    spans_m = edges_m.reshape(-1, 2)
    return spans_m[np.diff(spans_m, axis=1)[:, 0] >= _LEAST_LENGTH_M]


def _lost(sent, stopped, back):
    """Tell in which columns (n,) too few rays came back, from what was (s, n) of each scan."""
    # where things hide the line from a scan it tells nothing: rays along the tops of furniture get lost
    clear = stopped < _MOST_STOPPED * sent
    reached, back = ((rows * clear).sum(axis=0) for rows in (sent - stopped, back))
    # nor does one alone: something may stand nearer to it than it can measure
    scans = (clear & (sent >= _LEAST_RAYS_A_SCAN)).sum(axis=0)
    return (scans >= _LEAST_SCANS) & (reached >= _LEAST_RAYS) & (back < _LEAST_SHARE * reached)


def _together(rows):
    """Return running sums over `_WIDTH` columns around each, of rows (s, n)."""
    sums = np.cumsum(np.pad(rows, ((0, 0), (_WIDTH // 2 + 1, _WIDTH // 2))), axis=1, dtype=float)
    return sums[:, _WIDTH:] - sums[:, :-_WIDTH]


def _rays(rays, line, low_m, count, heights_m):
    """Return how many rays (s, count) scans sent to the columns of a line, ended before it, came back from beyond."""
    side_m, there_m = line.offset_m(rays.sensors_m[:, :2]), line.along_m(rays.sensors_m[:, :2])
    beyond_m = np.maximum(np.maximum(low_m - there_m, there_m - (low_m + COLUMN_M * count)), 0)
    most_m = np.tan(usualreturns.GRAZING_RAD) * side_m
    near = (np.hypot(side_m, beyond_m) <= _MOST_AWAY_M) & (beyond_m <= most_m)
    scans = np.flatnonzero((side_m >= sights.LEAST_SIDE_M) & near)
    middle_m = low_m + COLUMN_M * (np.arange(count) + 0.5)
    # scans in rows, columns of the line in columns
    away_m = middle_m - there_m[scans, None]
    far_m = np.hypot(away_m, side_m[scans, None])
    looks = np.abs(away_m) < most_m[scans, None]
    up_m = np.array(heights_m) + rays.floor_z_m - rays.sensors_m[scans, 2, None]
    low, high = (_below(rays.usual[scans], np.arctan2(up_m[:, i, None], far_m)) for i in (0, 1))
    width_deg = np.rad2deg(COLUMN_M * side_m[scans, None] / far_m**2)
    sent = (high - low) * width_deg * looks
    edges_m = there_m[scans] + np.array([[-1], [1]]) * most_m[scans]
    rows = sights.rows_between(rays, line.at(np.clip(edges_m, low_m, low_m + COLUMN_M * count)), scans)
    xyz_m, scan = rays.stacked.xyz_m[rows], rays.stacked.scan[rows]
    before_m = line.offset_m(xyz_m[:, :2])
    share = side_m[scan] / np.maximum(side_m[scan] - before_m, 1e-6)
    z_m = rays.sensors_m[scan, 2] + share * (xyz_m[:, 2] - rays.sensors_m[scan, 2]) - rays.floor_z_m
    inside = np.flatnonzero((z_m >= heights_m[0]) & (z_m < heights_m[1]))
    scan, before_m = scan[inside], before_m[inside]
    off_m = share[inside] * (line.along_m(xyz_m[inside, :2]) - there_m[scan])
    counts = np.abs(off_m) < most_m[scan]
    column = np.floor((there_m[scan] + off_m - low_m) / COLUMN_M).astype(np.int64)
    counts &= (column >= 0) & (column < count)
    cell = np.searchsorted(scans, scan) * count + column
    there = (counts & (before_m > _BEFORE_M), counts & (before_m <= _BEFORE_M))
    stopped, back = (np.bincount(cell[t], minlength=sent.size).reshape(sent.shape) for t in there)
    return sent, stopped, back


def _below(usual, elevation_rad):
    """Return the running sums (s, n) at elevations (s, c), straight between the steps."""
    per_deg = (usual.shape[1] - 1) / 180
    at = np.clip((np.rad2deg(elevation_rad) + 90) * per_deg, 0, usual.shape[1] - 1.001)
    row, scan = at.astype(np.int64), np.arange(len(usual))[:, None]
    return usual[scan, row] + (at - row) * (usual[scan, row + 1] - usual[scan, row])
