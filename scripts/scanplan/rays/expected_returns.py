"""Expected returns of a surface, from the same scan's returns elsewhere.

The missing-return test.

Of the rays themselves nothing is known but their returns. How many a scan sends at an elevation is
estimated by how many it usually gets back there; a planar scan's beams are evenly spread, but for
where it does not look and what is too far. Whatever is opaque returns the rays that reach it; glass
lets most through, to where there may be nothing, and mirrors others away.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.rays import usual_returns
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
ALL_HEIGHTS_M = (-np.inf, np.inf)
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


def count_sent_rays(
    rays: RaySet,
    face: FaceRays,
    low_m: float,
    count: int,
    column_m: float,
    heights_m: tuple[float, float],
) -> SentRays:
    """Return the rays that were sent to the columns of a surface.

    Parameters
    ----------
    face : face_rays.FaceRays
        Of these, with what is occluded within `NEAR_M`.
    low_m : float
        Where along its line the first column begins.
    count : int
        Number of columns.
    heights_m : (float, float)
        From where to where above the floor; `ALL_HEIGHTS_M` of planar scans.

    Returns
    -------
    SentRays
        Of the views from the side of the line's normal and from near enough.
    """
    views = face.views
    is_looking, expected = expect_returns(rays, face, low_m, count, column_m, heights_m)
    high_m = low_m + column_m * count
    bottom_m, top_m = heights_m
    grazing_m = _GRAZING * views.side_m
    view, along_m, height_m = face.view, face.along_m, face.height_m
    is_inside = is_looking.take(view) & (along_m >= low_m) & (along_m < high_m)
    is_inside &= (height_m >= bottom_m) & (height_m < top_m)
    is_inside &= np.abs(along_m - views.sensor_along_m.take(view)) < grazing_m.take(view)
    (rows,) = np.nonzero(is_inside)
    behind_m = face.behind_m.take(rows)
    column = ((along_m.take(rows) - low_m) / column_m).astype(np.int64)
    row = np.cumsum(is_looking) - 1
    cell = row.take(view.take(rows)) * count + np.minimum(column, count - 1)
    is_returned = behind_m >= -ON_M
    occluded, returned = (
        np.bincount(cell[kind], minlength=expected.size).reshape(expected.shape)
        for kind in (~is_returned, is_returned)
    )
    # of one beam there are few; as many columns on either side
    width = 2 * round(STRETCH_M / column_m) + 1 if rays.planar else _WIDTH
    (looking,) = np.nonzero(is_looking)
    return SentRays(looking, expected, occluded, returned, width)


def expect_returns(
    rays: RaySet,
    face: FaceRays,
    low_m: float,
    count: int,
    column_m: float,
    heights_m: tuple[float, float],
) -> tuple[BoolArray, FloatArray]:
    """Return which views look at the columns, and the returns (v, n) to be expected of these.

    Parameters as of `count_sent_rays`.
    """
    views = face.views
    high_m = low_m + column_m * count
    beyond_m = np.maximum(low_m - views.sensor_along_m, views.sensor_along_m - high_m)
    grazing_m = _GRAZING * views.side_m  # along the line, from where the sensor stands
    is_near = np.hypot(views.side_m, np.maximum(beyond_m, 0)) <= NEAR_M
    is_looking = is_near & (beyond_m <= grazing_m) & (views.side_m >= views.least_side_m)
    (looking,) = np.nonzero(is_looking)
    away_m = low_m + column_m * (np.arange(count) + 0.5) - views.sensor_along_m[looking, None]
    distance_m = np.hypot(away_m, views.side_m[looking, None])
    if rays.planar:
        # from the shortest way to the plane
        turn_rad = np.arctan2(away_m, views.side_m[looking, None])
        normal_x, normal_y = views.normal[looking].T[:, :, None]
        azimuth_rad = np.arctan2(-normal_y, -normal_x) + turn_rad
        per_deg = rays.beams.per_deg_at(views.scan[looking], azimuth_rad, distance_m)
    else:
        per_deg = _returns_per_deg(rays, views.scan[looking], distance_m, heights_m)
    expected = per_deg * np.rad2deg(column_m * views.side_m[looking, None] / distance_m**2)
    expected *= np.abs(away_m) < grazing_m[looking, None]
    return is_looking, expected


def _returns_per_deg(
    rays: RaySet,
    scans: IntArray,
    distance_m: FloatArray,
    heights_m: tuple[float, float],
) -> FloatArray:
    """Return how many returns scans (s,) usually have to a degree of azimuth, (s, n).

    Parameters
    ----------
    distance_m : (s, n) float64
        How far away, level.
    heights_m : (float, float)
        From where to where.
    """
    low, high = (
        usual_returns.count_below(
            rays.usual,
            scans[:, None],
            np.arctan2(height_m + rays.floor_z_m - rays.sensors_m[scans, 2, None], distance_m),
        )
        for height_m in heights_m
    )
    return high - low


def sum_neighbours(rows: Array, width: int) -> FloatArray:
    """Return running sums over so many columns around each, of rows (s, n)."""
    n_rows, n_columns = rows.shape
    # numpy's own padding takes ten times as long as the sums
    padded = np.zeros((n_rows, n_columns + width))
    padded[:, width // 2 + 1 : width // 2 + 1 + n_columns] = rows
    sums = np.cumsum(padded, axis=1)
    return sums[:, width:] - sums[:, :-width]
