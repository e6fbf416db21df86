"""How many returns a surface ought to give, by what the same scan gets back elsewhere.

The missing-return test.

Of the rays themselves nothing is known but their returns. How many a scan sends at an elevation is
estimated by how many it usually gets back there. Whatever is opaque returns the rays that reach it;
glass lets most through, to where there may be nothing, and mirrors others away.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from scanplan.types import Array, FloatArray, IntArray

if TYPE_CHECKING:
    from scanplan.rays.face_rays import FaceRays
    from scanplan.rays.ray_set import RaySet

GRAZING_RAD = np.deg2rad(75)
"""Angle between ray and surface normal from which on returns get lost."""
NEAR_M = 10.0
"""Farther sensors say nothing of missing returns.

Their rays are few, and much stands before the surface.
"""

_ROWS_PER_DEG = 10  # of elevation: beams of a VLP-16 are 2 degrees apart, of dense sensors 0.2
_SECTORS = 72  # of 5 degrees: wider than what is between two firings
_LEAST_RAYS = 20.0  # half of so many are not lost by chance
_LEAST_RAYS_A_SCAN = 3.0  # fewer, and the count expected is mostly rounding
_MOST_OCCLUDED = 0.15  # a frame or a plant may stop these; more, and the surface is hidden
_BEFORE_M = 0.1  # returns farther before a surface are of something else
_DEEP_M = 0.6  # no wall is thicker
_WIDTH = 5  # columns that are judged together: single ones expect too few rays


def count_returns_below(azimuth_rad: FloatArray, xyz_m: FloatArray) -> FloatArray:
    """Count a scan's returns below elevations, per degree of azimuth around which there are any.

    Parameters
    ----------
    azimuth_rad : (n,) float
    xyz_m : (n, 3) float
        Relative to the sensor.

    Returns
    -------
    (1801,) float64
        Below each elevation from -90 degrees on, in steps of 0.1 degrees.
    """
    sector = ((azimuth_rad + np.pi) / (2 * np.pi) * _SECTORS).astype(np.int64)
    sector = np.minimum(sector, _SECTORS - 1)
    seen_deg = max(np.count_nonzero(np.bincount(sector)), 1) * 360 / _SECTORS
    elevation_deg = np.rad2deg(np.arctan2(xyz_m[:, 2], np.hypot(xyz_m[:, 0], xyz_m[:, 1])))
    n_rows = 180 * _ROWS_PER_DEG
    row = np.clip((elevation_deg + 90) * _ROWS_PER_DEG, 0, n_rows - 1).astype(np.int64)
    return np.concatenate([[0.0], np.cumsum(np.bincount(row, minlength=n_rows))]) / seen_deg


@dataclass(frozen=True, eq=False)
class SentRays:
    """Rays that scans sent to the columns of a surface at some heights, (s, n) each.

    Attributes
    ----------
    expected : array
        How many returns there ought to be.
    occluded : array
        That ended before the surface.
    returned : array
        That ended at the surface or beyond.
    in_wall : array
        Of these, at the surface or no further behind it than a wall is thick.
    """

    expected: FloatArray
    occluded: IntArray
    returned: IntArray
    in_wall: IntArray

    @property
    def missing_share(self) -> float:
        """Share of the expected returns that are nowhere; 0 where none is expected."""
        expected = self.expected.sum()
        returned = self.occluded.sum() + self.returned.sum()
        return float(max(0.0, 1 - returned / expected)) if expected > 0 else 0.0

    def reached(self, *, least_scans: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return how many rays reached the columns (n,) and those around each.

        In all, of these those that came back, and those that ended in the wall.

        NaN where too few are to be expected for anything to be said, or fewer scans than
        `least_scans` sent any.
        """
        expected = _sum_neighbours(self.expected)
        occluded = _sum_neighbours(self.occluded)
        # where things hide the surface from a scan it says nothing: rays along the tops of
        # furniture get lost
        clear = occluded < _MOST_OCCLUDED * expected
        reached = ((expected - occluded) * clear).sum(axis=0)
        returned = (_sum_neighbours(self.returned) * clear).sum(axis=0)
        in_wall = (_sum_neighbours(self.in_wall) * clear).sum(axis=0)
        n_scans = (clear & (expected >= _LEAST_RAYS_A_SCAN)).sum(axis=0)
        enough = (n_scans >= least_scans) & (reached >= _LEAST_RAYS)
        known = [np.where(enough, rows, np.nan) for rows in (reached, returned, in_wall)]
        return known[0], known[1], known[2]


def count_sent_rays(
    rays: "RaySet",
    face: "FaceRays",
    low_m: float,
    count: int,
    column_m: float,
    heights_m: tuple[float, float],
) -> SentRays:
    """Return the rays that scans sent to the columns of a surface.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of scans in space.
    face : face_rays.FaceRays
        Of these, with what is occluded within `NEAR_M`.
    low_m : float
        Where along the line the first column begins.
    count : int
        Number of columns.
    column_m : float
    heights_m : (float, float)
        Above the floor.

    Returns
    -------
    SentRays
        Of the scans on the side of the line's normal and near enough.
    """
    sensor_m = face.line.along_m(rays.sensors_m[:, :2])
    high_m = low_m + column_m * count
    beyond_m = np.maximum(np.maximum(low_m - sensor_m, sensor_m - high_m), 0)
    grazing_m = np.tan(GRAZING_RAD) * face.side_m  # along the line, from where the sensor stands
    is_near = (np.hypot(face.side_m, beyond_m) <= NEAR_M) & (beyond_m <= grazing_m)
    scans = np.flatnonzero((face.side_m >= face.least_side_m) & is_near)
    middle_m = low_m + column_m * (np.arange(count) + 0.5)
    away_m = middle_m - sensor_m[scans, None]
    expected = _expect_returns(rays, scans, face.side_m[scans, None], away_m, column_m, heights_m)
    expected *= np.abs(away_m) < grazing_m[scans, None]
    row = np.full(len(sensor_m), -1)
    row[scans] = np.arange(len(scans))
    is_inside = (face.height_m >= heights_m[0]) & (face.height_m < heights_m[1])
    is_inside &= (row >= 0).take(face.scan) & (face.along_m >= low_m) & (face.along_m < high_m)
    is_inside &= np.abs(face.along_m - sensor_m.take(face.scan)) < grazing_m.take(face.scan)
    rows = np.flatnonzero(is_inside)
    behind_m = face.behind_m.take(rows)
    column = ((face.along_m.take(rows) - low_m) / column_m).astype(np.int64)
    cell = row.take(face.scan.take(rows)) * count + np.minimum(column, count - 1)
    is_returned = behind_m >= -_BEFORE_M
    kinds = (~is_returned, is_returned, is_returned & (behind_m <= _DEEP_M))
    occluded, returned, in_wall = (
        np.bincount(cell[kind], minlength=expected.size).reshape(expected.shape) for kind in kinds
    )
    return SentRays(expected, occluded, returned, in_wall)


def _expect_returns(
    rays: "RaySet",
    scans: IntArray,
    side_m: FloatArray,
    away_m: FloatArray,
    column_m: float,
    heights_m: tuple[float, float],
) -> FloatArray:
    """Return how many returns scans (s,) usually have in the direction of columns (s, n).

    Parameters
    ----------
    side_m : (s, 1) float64
        How far the sensors lie from the line.
    away_m : (s, n) float64
        How far the columns lie from there, along the line.
    """
    distance_m = np.hypot(away_m, side_m)
    usual = rays.usual[scans]
    low, high = (
        _below(
            usual,
            np.arctan2(height_m + rays.floor_z_m - rays.sensors_m[scans, 2, None], distance_m),
        )
        for height_m in heights_m
    )
    return (high - low) * np.rad2deg(column_m * side_m / distance_m**2)


def _below(usual: FloatArray, elevation_rad: FloatArray) -> FloatArray:
    """Return the running sums (s, n) at elevations (s, c), straight between the steps."""
    at = np.clip((np.rad2deg(elevation_rad) + 90) * _ROWS_PER_DEG, 0, usual.shape[1] - 1.001)
    row, scan = at.astype(np.int64), np.arange(len(usual))[:, None]
    return usual[scan, row] + (at - row) * (usual[scan, row + 1] - usual[scan, row])


def _sum_neighbours(rows: Array) -> FloatArray:
    """Return running sums over `_WIDTH` columns around each, of rows (s, n)."""
    sums = np.cumsum(np.pad(rows, ((0, 0), (_WIDTH // 2 + 1, _WIDTH // 2))), axis=1, dtype=float)
    return sums[:, _WIDTH:] - sums[:, :-_WIDTH]
