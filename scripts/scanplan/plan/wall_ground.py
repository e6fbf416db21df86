"""The ground that walls and their openings stand on, as plain strips: what parts free floor."""

from collections.abc import Sequence

import numpy as np
from shapely.geometry import Polygon

from scanplan.plan.openings import Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.free_space import GRID_M


def wall_strips(walls: Sequence[PlanWall], unpaired_m: float) -> list[Polygon]:
    """Return the ground that walls stand on, with their openings: a polygon per wall.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    unpaired_m : float
        How thick a wall is taken for of which one side is known; it lies behind that.
    """
    return [_ground(wall, wall.low_m, wall.high_m, unpaired_m) for wall in walls]


def opening_polygon(wall: PlanWall, gap: Opening, unpaired_m: float) -> Polygon:
    """Return the ground of an opening in a wall, a polygon a little deeper than the wall."""
    return _ground(wall, gap.low_m, gap.high_m, unpaired_m).buffer(GRID_M, join_style="mitre")


def _ground(wall: PlanWall, low_m: float, high_m: float, unpaired_m: float) -> Polygon:
    is_single = np.isnan(wall.thickness_m)
    left_m = 0.0 if is_single else wall.half_m
    right_m = -unpaired_m if is_single else -wall.half_m
    start, end = wall.line.at(np.array([low_m, high_m]))
    across = np.array([right_m, left_m])[:, None] * wall.line.normal
    return Polygon([start + across[0], end + across[0], end + across[1], start + across[1]])
