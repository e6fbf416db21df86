"""What stands in free floor and holds on to nothing beyond it, and how deep that is."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import rectangle_sides_m
from scanplan.plan import wall_ground
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

_GAP_M = 0.15  # no wider than twice as much nobody goes between two parts of one thing
_BEHIND_M = 0.1  # is solid of what was seen from one side


def find_island_depths_m(walls: Sequence[PlanWall], floor: BaseGeometry) -> FloatArray:
    """Return how deep the island is that each wall is a part of.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free; without any all walls hold on to what lies beyond.

    Returns
    -------
    (n,) float64
        The shorter side of the rectangle around the island, metres; inf of what holds on to what
        lies beyond the floor: the walls of a building do.
    """
    depth_m = np.full(len(walls), math.inf)
    if floor.is_empty or not walls:
        return depth_m
    strips = wall_ground.wall_strips(walls, _BEHIND_M)
    grown = overlays.buffer_shapes(np.array(strips, object), _GAP_M, join_style="mitre")
    around = overlays.buffer_shapes(
        shapely.box(*shapely.total_bounds([floor, *grown])), 2 * _GAP_M, join_style="mitre"
    )
    beyond = free_space.difference_on_grid(around, overlays.simplify_shapes(floor, CELL_M / 2))
    beyond = overlays.buffer_shapes(beyond, _GAP_M / 2, quad_segs=2)
    solid = list(free_space.union_on_grid([*grown, beyond]).geoms)
    is_held = shapely.intersects(np.array(solid, object), around.exterior)
    middles = shapely.points([wall.at((wall.low_m + wall.high_m) / 2) for wall in walls])
    wall, part = shapely.STRtree(solid).query(middles, predicate="intersects")
    for row, of in zip(wall.tolist(), part.tolist(), strict=True):
        if not is_held[of]:
            depth_m[row] = rectangle_sides_m(solid[of])[0] - 2 * _GAP_M
    return depth_m
