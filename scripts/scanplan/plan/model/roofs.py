"""Where a building has a ceiling: what is outside has none, and what is mirrored hardly any."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.ray_set import RaySet
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_CELL_M = 0.25
_OVERHEAD_M = 2.1  # above the floor: heads of doors are lower, and what stands in rooms
_BEFORE_M = np.array([0.4, 0.65, 0.9, 1.15])  # a surface: clear of its own top, and within a room
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
    """

    keys: IntArray
    usual: float

    def share_before(self, walls: Sequence[PlanWall]) -> FloatArray:
        """Return how much of the ground before each wall (n,) has a ceiling, over the usual share.

        Of what was seen from both sides the ground before one of them counts: a facade has a
        ceiling on one. NaN where nothing is known of ceilings.
        """
        return np.array([_share_before(self.keys, wall) for wall in walls]) / self.usual

    def share_above(self, ground: BaseGeometry) -> float:
        """Return how much of some ground has a ceiling, over the usual share; NaN: not known."""
        low_m, high_m = np.reshape(ground.bounds, (2, 2))
        axes = [np.arange(a + _CELL_M / 2, b, _CELL_M) for a, b in zip(low_m, high_m, strict=True)]
        places_m = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
        within_m = places_m[shapely.contains_xy(ground, *places_m.T)]
        if not len(within_m):
            return math.nan
        return float(_are_known(self.keys, within_m).mean()) / self.usual


def find_roof(walls: Sequence[PlanWall], rays: RaySet) -> Roof:
    """Find where a building has a ceiling.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        All surfaces, whatever they are sides of.
    rays : ray_set.RaySet
    """
    if rays.planar:
        return Roof(np.empty(0, np.int64), math.nan)
    scan = np.repeat(np.arange(len(rays.scan_ids)), np.diff(rays.first))
    is_overhead = rays.xyz_m[:, 2] > rays.ground_z_m + _OVERHEAD_M
    is_overhead &= rays.xyz_m[:, 2] > rays.sensors_m[scan, 2]
    keys = np.unique(_number_cells(rays.xyz_m[is_overhead, :2]))
    shares = [_share_before(keys, wall) for wall in walls]
    usual = float(np.quantile(shares, _USUAL)) if shares else 0.0
    return Roof(keys, usual if usual >= _LEAST_USUAL else math.nan)


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
