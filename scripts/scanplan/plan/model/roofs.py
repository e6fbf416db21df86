"""Where a building has a ceiling: what is outside has none, and what is mirrored hardly any."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy import ndimage
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bitmap
from scanplan.geometry.cell_runs import find_cell_runs
from scanplan.plan.model import things
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays import free_space
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import STRETCH_M
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_CELL_M = 0.25
_OVERHEAD_M = 2.1  # above the floor: heads of doors are lower, and what stands in rooms
_BEFORE_M = np.array([0.4, 0.65, 0.9, 1.15])  # a surface: clear of its own top, and within a room
_AROUND_CELLS = 7  # along a square about a place: its room, and not what is behind a wall
_CEILING = 0.9  # of what is overhead near the sensor is no higher: more of it is ceiling than wall
_MOST_RAYS = 20_000
_USUAL = 0.25  # of the surfaces have less of a ceiling before them than is usual
_LEAST_USUAL = 0.5  # of the ground there: who sees less of ceilings does not know what has none


@dataclass(frozen=True, eq=False)
class Roof:
    """The ground above which rays that rose met something, in cells of 0.25 m.

    Attributes
    ----------
    keys : (k,) int64, increasing
        Of the cells.
    usual : float
        Share of the ground before the surfaces of the building that has a ceiling, the lower
        quartile; NaN where too little was seen of ceilings to tell what has none.
    roofed : (w,) float64
        How much of the ground before each of these surfaces has one, over the usual share; NaN
        likewise. Of what was seen from both sides the ground before one of them counts: a facade
        has a ceiling on one.
    above_m : (n, 2, 2) float64
        From where to where rays go higher than the ceilings above the sensor's track.
    """

    keys: IntArray
    usual: float
    roofed: FloatArray
    above_m: FloatArray

    def find_outside(
        self, floor: BaseGeometry, track_m: FloatArray, *, min_area_m2: float
    ) -> shapely.MultiPolygon:
        """Return the ground of a floor around which there is no ceiling, as rays go above it.

        Ground that sensors were on is not of it, nor what is joined to that, such as a yard.

        Parameters
        ----------
        floor : shapely geometry
        track_m : (k, 2) float64
            Where sensors were.
        min_area_m2 : float
            Smaller grounds are left out.
        """
        if math.isnan(self.usual) or floor.is_empty:
            return shapely.MultiPolygon()
        grid = bitmap.fit_grid(np.reshape(floor.bounds, (1, 2, 2)), _CELL_M)
        around = ndimage.uniform_filter(self._draw_on(grid), _AROUND_CELLS, mode="constant")
        is_outside = things.are_outside(around / self.usual)
        is_outside &= bitmap.rasterise_lines(self.above_m, grid)
        is_outside &= bitmap.fill_polygons([floor], grid)
        row, begin, end = find_cell_runs(is_outside)
        low_m = grid.low_m + _CELL_M * np.column_stack([begin, row])
        high_m = grid.low_m + _CELL_M * np.column_stack([end, row + 1])
        ground = free_space.union_on_grid(list(shapely.box(*low_m.T, *high_m.T)))
        places = np.asarray(shapely.points(track_m), object)
        return shapely.MultiPolygon(
            [
                part
                for part in ground.geoms
                if part.area >= min_area_m2 and not shapely.intersects(part, places).any()
            ]
        )

    def _draw_on(self, grid: bitmap.Grid) -> FloatArray:
        """Return 1 for the cells (rows, columns) of a grid that have a ceiling, 0 for others."""
        column, row = (
            _find_cells(self.keys) - np.rint(grid.low_m / _CELL_M).astype(np.int64)[:, None]
        )
        is_within = (row >= 0) & (row < grid.shape[0]) & (column >= 0) & (column < grid.shape[1])
        drawn = np.zeros(grid.shape)
        drawn[row[is_within], column[is_within]] = 1.0
        return drawn


def find_roof(walls: Sequence[PlanWall], rays: RaySet) -> Roof:
    """Find where a building has a ceiling.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        All surfaces, whatever they are sides of.
    rays : ray_set.RaySet
    """
    scan = np.repeat(np.arange(len(rays.scan_ids)), np.diff(rays.first))
    is_overhead = rays.xyz_m[:, 2] > rays.ground_z_m + _OVERHEAD_M
    is_overhead &= rays.xyz_m[:, 2] > rays.sensors_m[scan, 2]
    xyz_m, sensor_m = rays.xyz_m[is_overhead], rays.sensors_m[scan[is_overhead]]
    number = _number_cells(xyz_m[:, :2])
    keys = np.unique(number)
    shares = np.array([_share_before(keys, wall) for wall in walls])
    usual = float(np.quantile(shares, _USUAL)) if len(shares) else 0.0
    if usual < _LEAST_USUAL:
        return Roof(keys, math.nan, np.full(len(shares), math.nan), np.empty((0, 2, 2)))
    is_near = np.isin(number, _cells_around(rays.sensors_m[:, :2]))
    ceiling_z_m = float(np.quantile(xyz_m[is_near, 2], _CEILING)) if is_near.any() else math.inf
    above_m = _find_above(xyz_m, sensor_m, ceiling_z_m + STRETCH_M)
    return Roof(keys, usual, shares / usual, above_m)


def _cells_around(places_m: FloatArray) -> IntArray:
    """Return the numbers (k,) of the cells around places (n, 2) where sensors were."""
    steps = _CELL_M * np.arange(-_AROUND_CELLS, _AROUND_CELLS + 1)
    around_m = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    return np.unique(_number_cells((places_m[:, None] + around_m).reshape(-1, 2)))


def _find_above(xyz_m: FloatArray, sensor_m: FloatArray, high_z_m: float) -> FloatArray:
    """Return from where to where (n, 2, 2) rays go higher than some height."""
    (over,) = np.nonzero(xyz_m[:, 2] > high_z_m)
    # many show the same
    over = over[:: max(len(over) // _MOST_RAYS, 1)]
    end_m, start_m = xyz_m[over], sensor_m[over]
    rise_m = end_m[:, 2] - start_m[:, 2]
    share = np.maximum(high_z_m - start_m[:, 2], 0.0) / rise_m
    from_m = start_m[:, :2] + share[:, None] * (end_m - start_m)[:, :2]
    return np.stack([from_m, end_m[:, :2]], axis=1)


def _share_before(keys: IntArray, wall: PlanWall) -> float:
    return max(
        (_share_before_face(keys, of.ends, of.line.normal) for of in wall.members), default=0.0
    )


def _share_before_face(keys: IntArray, ends_m: FloatArray, normal: FloatArray) -> float:
    steps = max(math.ceil(math.dist(*ends_m) / _CELL_M), 1)
    along = (np.arange(steps) + 0.5) / steps
    foot_m = ends_m[0] + along[:, None] * (ends_m[1] - ends_m[0])
    places_m = foot_m[:, None] + _BEFORE_M[:, None] * normal
    return float(_are_known(keys, places_m.reshape(-1, 2)).mean())


def _are_known(keys: IntArray, places_m: FloatArray) -> BoolArray:
    if not len(keys):
        return np.zeros(len(places_m), bool)
    wanted = _number_cells(places_m)
    return keys[np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)] == wanted


def _number_cells(places_m: Array) -> IntArray:
    """Return one number for the cell that each place (n, 2) lies in."""
    column, row = np.floor(places_m / _CELL_M).astype(np.int64).T
    return (column << 32) + row


def _find_cells(keys: IntArray) -> IntArray:
    """Return column and row (2, k) of cells by their numbers."""
    column = (keys + (1 << 31)) >> 32
    return np.stack([column, keys - (column << 32)])
