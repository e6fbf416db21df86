"""How many rays scans sent to a line, told by those that come back elsewhere, and what became of them.

Of the rays themselves nothing is known but their returns: how many a scan sends at an elevation is told by how many it
usually gets back there.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.rays import ray_set, usual_returns
from scanplan.rays.face_profile import COLUMN_M

_LEAST_RAYS = 20.0  # half of so many are not lost by chance
_LEAST_RAYS_A_SCAN = 3.0  # fewer and the count expected is mostly rounding
_MOST_STOPPED = 0.15  # a frame or a plant may stop these; more and the line is hidden
_BEFORE_M = 0.1  # returns farther before a line are of something else
_DEEP_M = 0.6  # no wall is thicker
_MOST_AWAY_M = 10.0  # further off rays are few and much stands before a line
_WIDTH = 5  # columns that are judged together


@dataclass(frozen=True, eq=False)
class SentRays:
    """Rays that scans sent to the columns of a line at some heights, (s, n) each.

    Attributes
    ----------
    sent : array
        How many there ought to be.
    stopped : array
        That ended before the line.
    back : array
        That ended at the line or beyond.
    in_wall : array
        Of these, at the line or no further behind it than a wall is thick.
    """

    sent: np.ndarray
    stopped: np.ndarray
    back: np.ndarray
    in_wall: np.ndarray

    def reached(self, *, least_scans):
        """Return how many rays reached the columns (n,) and those around each, came back, and ended in the wall.

        NaN where too few are to be expected for anything to be said, or fewer scans than `least_scans` sent any.
        """
        sent, stopped, back, in_wall = map(
            _together, (self.sent, self.stopped, self.back, self.in_wall)
        )
        # where things hide the line from a scan it tells nothing: rays along the tops of furniture get lost
        clear = stopped < _MOST_STOPPED * sent
        reached, back, in_wall = (
            (rows * clear).sum(axis=0) for rows in (sent - stopped, back, in_wall)
        )
        scans = (clear & (sent >= _LEAST_RAYS_A_SCAN)).sum(axis=0)
        enough = (scans >= least_scans) & (reached >= _LEAST_RAYS)
        return tuple(np.where(enough, rows, np.nan) for rows in (reached, back, in_wall))


def count_sent_rays(rays, line, low_m, count, heights_m):
    """Return the rays that scans sent to the columns of a line.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of scans in space.
    line : lines.Line
    low_m : float
        Where along it the first column begins.
    count : int
        Number of columns of 5 cm.
    heights_m : (float, float)
        Above the floor.

    Returns
    -------
    Sent
        Of the scans near enough.
    """
    side_m, there_m = line.offset_m(rays.sensors_m[:, :2]), line.along_m(rays.sensors_m[:, :2])
    beyond_m = np.maximum(np.maximum(low_m - there_m, there_m - (low_m + COLUMN_M * count)), 0)
    most_m = np.tan(usual_returns.GRAZING_RAD) * side_m
    near = (np.hypot(side_m, beyond_m) <= _MOST_AWAY_M) & (beyond_m <= most_m)
    scans = np.flatnonzero((side_m >= ray_set.LEAST_SIDE_M) & near)
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
    xyz_m, scan = ray_set.points_between(
        rays, line.at(np.clip(edges_m, low_m, low_m + COLUMN_M * count)), scans
    )
    before_m, of_scan_m, sensor_z_m = (
        line.offset_m(xyz_m[:, :2]),
        side_m.take(scan),
        rays.sensors_m[:, 2].take(scan),
    )
    share = of_scan_m / np.maximum(of_scan_m - before_m, 1e-6)
    z_m = sensor_z_m + share * (xyz_m[:, 2] - sensor_z_m) - rays.floor_z_m
    inside = np.flatnonzero((z_m >= heights_m[0]) & (z_m < heights_m[1]))
    scan, before_m = scan.take(inside), before_m.take(inside)
    off_m = share.take(inside) * (line.along_m(xyz_m.take(inside, axis=0)[:, :2]) - there_m[scan])
    counts = np.abs(off_m) < most_m[scan]
    column = np.floor((there_m[scan] + off_m - low_m) / COLUMN_M).astype(np.int64)
    counts &= (column >= 0) & (column < count)
    cell = np.searchsorted(scans, scan) * count + column
    stopped, back = before_m > _BEFORE_M, before_m <= _BEFORE_M
    there = [counts & ended for ended in (stopped, back, back & (before_m >= -_DEEP_M))]
    return SentRays(
        sent, *(np.bincount(cell[t], minlength=sent.size).reshape(sent.shape) for t in there)
    )


def _below(usual, elevation_rad):
    """Return the running sums (s, n) at elevations (s, c), straight between the steps."""
    per_deg = (usual.shape[1] - 1) / 180
    at = np.clip((np.rad2deg(elevation_rad) + 90) * per_deg, 0, usual.shape[1] - 1.001)
    row, scan = at.astype(np.int64), np.arange(len(usual))[:, None]
    return usual[scan, row] + (at - row) * (usual[scan, row + 1] - usual[scan, row])


def _together(rows):
    """Return running sums over `_WIDTH` columns around each, of rows (s, n)."""
    sums = np.cumsum(np.pad(rows, ((0, 0), (_WIDTH // 2 + 1, _WIDTH // 2))), axis=1, dtype=float)
    return sums[:, _WIDTH:] - sums[:, :-_WIDTH]
