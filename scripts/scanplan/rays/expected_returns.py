"""Expected returns of a surface, from the same scan's returns elsewhere.

The missing-return test.

Of the rays themselves nothing is known but their returns. How many a scan sends at an elevation is
estimated by how many it usually gets back there; a planar scan's beams are evenly spread, but for
where it does not look and what is too far. Whatever is opaque returns the rays that reach it; glass
lets most through, to where there may be nothing, and mirrors others away.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.rays import usual_returns
from scanplan.rays.azimuth_sectors import number_sectors
from scanplan.rays.face_rays import FaceRays
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, ON_M, STRAY_SHARE, STRETCH_M
from scanplan.types import Array, BoolArray, FloatArray, IntArray

GRAZING_RAD = np.deg2rad(75)
"""Angle between ray and surface normal from which on returns get lost."""
NEAR_M = 10.0
"""Farther sensors say nothing of missing returns.

Their rays are few, and much stands before the surface.
"""

_GRAZING = np.tan(GRAZING_RAD)
_WIDTH = 5  # columns that are judged together: single ones expect too few rays


@dataclass(frozen=True, eq=False)
class SentRays:
    """Rays of some views to the columns of surfaces at some heights, (v, n) each.

    Attributes
    ----------
    view : (v,) int64
        Index of each view.
    expected : array
        How many returns there ought to be.
    occluded : array
        That ended before the surface.
    returned : array
        That ended at the surface or beyond.
    width : int
        So many columns around each are judged together.
    """

    view: IntArray
    expected: FloatArray
    occluded: IntArray
    returned: IntArray
    width: int = _WIDTH

    def missing(self) -> FloatArray:
        """Return how many rays of each single view that reached a column are nowhere, (v, n)."""
        expected, occluded, clear = self._sum_clear()
        returned = sum_neighbours(self.returned, self.width)
        says = clear & (expected >= FEW)
        return np.maximum(expected - occluded - returned, 0.0) * says / self.width

    def _sum_clear(self) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Return what is expected and occluded of each column and those around it, (v, n).

        And where a view says anything: where things hide the surface from it, it does not, as rays
        along the tops of furniture get lost.
        """
        expected = sum_neighbours(self.expected, self.width)
        occluded = sum_neighbours(self.occluded, self.width)
        return expected, occluded, occluded < STRAY_SHARE * expected


@dataclass(frozen=True, eq=False)
class WatchedColumns:
    """Columns of a surface, and the views that look at them from its side and near enough.

    Attributes
    ----------
    rays : ray_set.RaySet
    looking, scan : (v,) int64
        Index of each view, and its scan.
    distance_m : (v, n) float64
        From its sensor to the middle of each column, level.
    column_deg : (v, n) float64
        The azimuth that a column fills.
    is_asked : (v, n) bool
        Of others nothing is expected: it sees them too obliquely, or rays there were left out.
    azimuth_rad : (v, n) float64
        Towards each column.
    width : int
        As of `SentRays`.
    cell, height_m, is_returned : (k,) int64, float64, bool
        Of the views' rays to the columns: view and column, `v * n + column`; how high above the
        floor; and whether it ended at the surface or beyond.
    """

    rays: RaySet
    looking: IntArray
    scan: IntArray
    distance_m: FloatArray
    column_deg: FloatArray
    is_asked: BoolArray
    azimuth_rad: FloatArray
    width: int
    cell: IntArray
    height_m: FloatArray
    is_returned: BoolArray

    def per_deg_below(self, height_m: float) -> FloatArray:
        """Return how many returns to a degree of azimuth are usual below a height, (t, v, n).

        For each of the ways in which a sensor may be tilted. Of planar scans all are above the
        floor, and below any height there.
        """
        if self.rays.planar:
            if height_m <= 0:
                return np.zeros((1, *self.distance_m.shape))
            return self.rays.beams.per_deg_at(self.scan, self.azimuth_rad, self.distance_m)[None]
        rise_m = height_m + self.rays.floor_z_m - self.rays.sensors_m[self.scan, 2, None]
        up_m = self.rays.up[self.scan, 2, None] * rise_m + self._lean * self.distance_m
        sine = up_m / np.hypot(rise_m, self.distance_m)
        elevation_rad = np.arcsin(np.clip(sine, -1, 1))
        return usual_returns.count_below(self.rays.usual, self.scan[:, None], elevation_rad)

    @cached_property
    def _lean(self) -> FloatArray:
        """How much the sensor's axis leans towards each column, (v, n): its level part."""
        way = np.stack([np.cos(self.azimuth_rad), np.sin(self.azimuth_rad)], axis=-1)
        return np.einsum("vnk,vk->vn", way, self.rays.up[self.scan, :2])

    def expect_returns(self, low_per_deg: FloatArray, high_per_deg: FloatArray) -> FloatArray:
        """Return the returns (v, n) to be expected between heights, of `per_deg_below` of both.

        However the sensor is tilted: single beams are in one row of heights or the next.
        """
        return (high_per_deg - low_per_deg).min(axis=0) * self.column_deg * self.is_asked

    def count_sent(self, heights_m: tuple[float, float], expected: FloatArray) -> SentRays:
        """Return the rays that were sent to the columns between heights above the floor."""
        bottom_m, top_m = heights_m
        is_inside = (self.height_m >= bottom_m) & (self.height_m < top_m)
        occluded, returned = (
            np.bincount(self.cell[kind], minlength=expected.size).reshape(expected.shape)
            for kind in (is_inside & ~self.is_returned, is_inside & self.is_returned)
        )
        return SentRays(self.looking, expected, occluded, returned, self.width)


def watch_columns(
    rays: RaySet, face: FaceRays, low_m: float, count: int, column_m: float
) -> WatchedColumns:
    """Return the columns of a surface as views look at them, whatever the height.

    Parameters
    ----------
    face : face_rays.FaceRays
        Of these, with what is occluded within `NEAR_M`.
    low_m : float
        Where along its line the first column begins.
    count : int
        Number of columns.
    """
    views = face.views
    high_m = low_m + column_m * count
    beyond_m = np.maximum(low_m - views.sensor_along_m, views.sensor_along_m - high_m)
    grazing_m = _GRAZING * views.side_m  # along the line, from where the sensor stands
    is_near = np.hypot(views.side_m, np.maximum(beyond_m, 0)) <= NEAR_M
    is_looking = is_near & (beyond_m <= grazing_m) & (views.side_m >= views.least_side_m)
    (looking,) = np.nonzero(is_looking)
    side_m = views.side_m[looking, None]
    away_m = low_m + column_m * (np.arange(count) + 0.5) - views.sensor_along_m[looking, None]
    distance_m = np.hypot(away_m, side_m)
    is_asked = np.abs(away_m) < grazing_m[looking, None]
    scan = views.scan[looking]
    normal = views.normal[looking]
    # from the shortest way to the plane, as the line's direction is its normal turned to the right
    azimuth_rad = np.arctan2(-normal[:, 1:], -normal[:, :1]) + np.arctan2(away_m, side_m)
    if rays.left_out.any():
        sector = number_sectors((azimuth_rad + np.pi) % (2 * np.pi) - np.pi)
        is_asked &= ~rays.left_out[scan[:, None], sector]
    if not rays.planar:
        for row, number in enumerate(scan.tolist()):
            for begin_rad, wide_rad in rays.sweep_gaps[number].tolist():
                is_asked[row] &= (azimuth_rad[row] - begin_rad) % (2 * np.pi) >= wide_rad
    view, along_m = face.view, face.along_m
    is_inside = is_looking.take(view) & (along_m >= low_m) & (along_m < high_m)
    is_inside &= np.abs(along_m - views.sensor_along_m.take(view)) < grazing_m.take(view)
    (rows,) = np.nonzero(is_inside)
    column = ((along_m.take(rows) - low_m) / column_m).astype(np.int64)
    row = np.cumsum(is_looking) - 1
    return WatchedColumns(
        rays=rays,
        looking=looking,
        scan=scan,
        distance_m=distance_m,
        column_deg=np.rad2deg(column_m * side_m / distance_m**2),
        is_asked=is_asked,
        azimuth_rad=azimuth_rad,
        # of one beam there are few; as many columns on either side
        width=2 * round(STRETCH_M / column_m) + 1 if rays.planar else _WIDTH,
        cell=row.take(view.take(rows)) * count + np.minimum(column, count - 1),
        height_m=face.height_m.take(rows),
        is_returned=face.behind_m.take(rows) >= -ON_M,
    )


def sum_neighbours(rows: Array, width: int) -> FloatArray:
    """Return running sums over so many columns around each, of rows (s, n)."""
    n_rows, n_columns = rows.shape
    # numpy's own padding takes ten times as long as the sums
    padded = np.zeros((n_rows, n_columns + width))
    padded[:, width // 2 + 1 : width // 2 + 1 + n_columns] = rows
    sums = np.cumsum(padded, axis=1)
    return sums[:, width:] - sums[:, :-width]
