"""Surface normals of one scan, from neighbourhoods that grow with the distance to the sensor.

A spinning sensor's points are dense along a ring and sparse between rings: at 5 m and 2 degrees
between beams, 0.02 m against 0.17 m. The k nearest neighbours of a point then lie on its own ring
and their plane is arbitrary. Spacing grows with range in both directions, so a neighbourhood of
constant angle, as seen from the sensor, spans the same few rings at any range.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.moments import FEWEST, group_moments, least_variance_direction
from scanplan.geometry.occupied_cells import TABLE_SIZE, number_occupied
from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays.tolerances import ON_M
from scanplan.types import FloatArray, IntArray

_NEAREST_2D = 5  # neighbours, where beams lie apart: enough that noise does not turn the line
_NEAREST_REACH_2D = 3.0  # reaches: what is farther apart may be of different walls
_FAR_M = 1000.0  # ranges above count as this: no surface of a building is there
_STEEPEST = 4.0  # of z / r, likewise: right above or below the sensor is no wall


@dataclass(frozen=True)
class SurfaceCells:
    """Groups of neighbouring points that share a normal.

    Attributes
    ----------
    of_point : (n,) int64
        The cell of each point.
    members : (n,) int64
        The points, by cell.
    first : (m + 1,) int64
        Those of cell i are `members[first[i] : first[i + 1]]`.
    count : (m,) int64
        Points in each cell.
    mean_m : (m, d) float64
    normal : (m, d) float64
        Unit vectors towards the sensor; NaN where the surroundings are no surface.
    radius_m : (m,) float64
        About how far a cell's points are from their mean.
    """

    of_point: IntArray
    members: IntArray
    first: IntArray
    count: IntArray
    mean_m: FloatArray
    normal: FloatArray
    radius_m: FloatArray

    def points_of(self, cells: IntArray) -> IntArray:
        """Return the indices of the points of the given cells, (k,) int."""
        count = self.count[cells]
        skipped = self.first[cells] - (np.cumsum(count) - count)
        return self.members.take(np.arange(count.sum()) + np.repeat(skipped, count))


def cut_surface_cells(xyz_m: FloatArray, *, reach_deg: float) -> SurfaceCells:
    """Part a 3-D scan into cells of equal angle and find the normal of each.

    The points are binned in (azimuth, z / r, ln r), r the horizontal range: cells of equal angle,
    about cubic in space. A cell's normal is the direction of least variance of the points in it and
    its 26 neighbours.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Points relative to the sensor, axes of the map (z up).
    reach_deg : float
        Half-width of a neighbourhood, as an angle seen from the sensor; at least one and a half
        times the angle between beams.

    Returns
    -------
    SurfaceCells
        No normal where there are too few points, one ring alone, an edge or clutter.
    """
    of_point, moments, normal = _fit_cells(xyz_m, reach_deg)
    mean_m = moments[1:4] / moments[0]
    radius_m = _cell_step_rad(reach_deg) * np.hypot(mean_m[0], mean_m[1])
    return _as_cells(of_point, mean_m.T, normal, radius_m)


def fit_surface_cells(xyz_m: FloatArray, *, reach_deg: float) -> tuple[FloatArray, FloatArray]:
    """Return the moments (10, m) of the points of each cell, and its unit normal (m, 3).

    See `moments.group_moments` and `cut_surface_cells`.
    """
    _, moments, normal = _fit_cells(xyz_m, reach_deg)
    return moments, normal


def estimate_surface_normals(xyz_m: FloatArray, *, reach_deg: float) -> FloatArray:
    """Return unit normals (n, 3) of a 3-D scan's surfaces, see `cut_surface_cells`."""
    of_point, _, normal = _fit_cells(xyz_m, reach_deg)
    return normal[of_point]


def cut_outline_cells(xy_m: FloatArray, *, reach_deg: float) -> SurfaceCells:
    """Return a planar scan as cells of one point, see `estimate_outline_normals`."""
    xy_m = np.asarray(xy_m, float)
    normal = estimate_outline_normals(xy_m, reach_deg=reach_deg)
    return _as_cells(np.arange(len(xy_m)), xy_m, normal, np.zeros(len(xy_m)))


def estimate_outline_normals(xy_m: FloatArray, *, reach_deg: float) -> FloatArray:
    """Return the unit normals of a planar scan's outlines, towards the sensor.

    A point's neighbours are those within `reach_deg` (at least 8 cm), or its five nearest where
    these are not more than three times as far: where the outline is seen at a grazing angle, beams
    lie far apart.

    Parameters
    ----------
    xy_m : (n, 2) float
        Points relative to the sensor.

    Returns
    -------
    (n, 2) float64, NaN where the surroundings are no line
    """
    xy_m = np.asarray(xy_m, float)
    if len(xy_m) < FEWEST[2]:
        return np.full((len(xy_m), 2), np.nan)
    from scipy.spatial import KDTree  # 0.3 s, and scans in space do not need it

    tree = KDTree(xy_m)
    radius = np.maximum(ON_M, np.deg2rad(reach_deg) * np.linalg.norm(xy_m, axis=1))
    nearest = tree.query(xy_m, k=min(_NEAREST_2D + 1, len(xy_m)))[0][:, -1]
    radius = np.maximum(radius, np.minimum(nearest * (1 + ROUNDING), _NEAREST_REACH_2D * radius))
    near = tree.query_ball_point(xy_m, radius, return_sorted=True)
    owner = np.repeat(np.arange(len(xy_m)), [len(n) for n in near])
    moments = group_moments(xy_m[np.concatenate(near).astype(int)], owner, len(xy_m))
    return _towards_sensor(least_variance_direction(moments), xy_m.T)


def _cell_step_rad(reach_deg: float) -> float:
    """Return the edge of a cell, of which a neighbourhood has three."""
    return float(np.deg2rad(reach_deg)) / 1.5


def _fit_cells(xyz_m: FloatArray, reach_deg: float) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the cell (n,) of each point, the cells' moments (10, m) and normals (m, 3)."""
    xyz_m = np.asarray(xyz_m, float).reshape(-1, 3)
    if len(xyz_m) == 0:
        return np.empty(0, np.int64), np.empty((10, 0)), np.empty((0, 3))
    grid = _Grid(xyz_m, _cell_step_rad(reach_deg))
    moments = group_moments(_within(xyz_m), grid.of_point, len(grid.key))
    normal = least_variance_direction(grid.neighbourhood_sums(moments))
    return grid.of_point, moments, _towards_sensor(normal, moments[1:4])


class _Grid:
    """The occupied cells of a scan, sorted by (azimuth, z / r, ln r)."""

    def __init__(self, xyz_m: FloatArray, step: float) -> None:
        horizontal = np.clip(np.hypot(xyz_m[:, 0], xyz_m[:, 1]), ON_M, _FAR_M)
        self.turn = max(3, round(2 * np.pi / step))
        azimuth_rad = np.arctan2(xyz_m[:, 1], xyz_m[:, 0])
        rise = np.clip(xyz_m[:, 2] / horizontal, -_STEEPEST, _STEEPEST)
        azimuth = np.floor(azimuth_rad * (self.turn / (2 * np.pi))).astype(np.int64)
        height = np.floor(rise / step).astype(np.int64)
        distance = np.floor(np.log(horizontal) / step).astype(np.int64)
        # a border of empty cells: the neighbours of one row are not in the next
        height = height - height.min() + 1
        distance = distance - distance.min() + 1
        self.rows = int(height.max()) + 2
        self.shells = int(distance.max()) + 2
        key = ((azimuth % self.turn) * self.rows + height) * self.shells + distance
        self.size = self.turn * self.rows * self.shells
        self.key, self.of_point = number_occupied(key, self.size)
        if self.size <= TABLE_SIZE:
            # runs of equal numbers take a tenth of the time of a running sum
            ends = np.concatenate([[-1], self.key, [self.size]])
            self._before = np.repeat(np.arange(len(self.key) + 1, dtype=np.int32), np.diff(ends))

    def before(self, key: IntArray) -> IntArray:
        """Return the number of occupied cells before each key."""
        return np.searchsorted(self.key, key) if self.size > TABLE_SIZE else self._before.take(key)

    def neighbourhood_sums(self, moments: FloatArray) -> FloatArray:
        """Return each cell's moments (k, m) with those of its occupied neighbours added.

        Azimuth closes after a turn.
        """
        # three neighbours in ln r follow each other: their sum is a difference of running sums
        running = np.zeros((len(self.key) + 1, len(moments)))
        np.cumsum(moments.T, axis=0, out=running[1:])
        row_size = self.rows * self.shells
        azimuth, inside = np.divmod(self.key, row_size)
        beside = np.arange(-1, 2)[:, None]
        turned = (azimuth + beside) % self.turn * row_size + inside
        first = (turned[:, None] + self.shells * beside - 1).reshape(-1, len(self.key))
        total = np.zeros((len(self.key), len(moments)))
        for before, behind in zip(self.before(first), self.before(first + 3), strict=True):
            row = running.take(behind, axis=0)
            row -= running.take(before, axis=0)
            total += row
        return total.T


def _within(xyz_m: FloatArray) -> FloatArray:
    """Return the points, those farther than 1 km moved there.

    Running sums must keep the digits of the near ones.
    """
    distance_m = np.sqrt(np.einsum("ij,ij->i", xyz_m, xyz_m))
    if distance_m.max() <= _FAR_M:
        return xyz_m
    return xyz_m * np.minimum(1, _FAR_M / np.maximum(distance_m, ON_M))[:, None]


def _as_cells(
    of_point: IntArray, mean_m: FloatArray, normal: FloatArray, radius_m: FloatArray
) -> SurfaceCells:
    """Return cells (m,) with the points of each, given the cell of each point (n,)."""
    n_cells = len(mean_m)
    # a radix sort, for numbers of two bytes
    sortable = of_point.astype(np.uint16) if n_cells <= 2**16 else of_point
    members = np.argsort(sortable, kind="stable")
    count = np.bincount(of_point, minlength=n_cells)
    first = np.concatenate([[0], np.cumsum(count)]).astype(np.int64)
    return SurfaceCells(of_point, members, first, count, mean_m, normal, radius_m)


def _towards_sensor(normal: FloatArray, at: FloatArray) -> FloatArray:
    """Return normals (d, m) at places (d, m) as rows (m, d), turned to the sensor."""
    return (normal * -np.where((normal * at).sum(axis=0) > 0, 1, -1)).T
