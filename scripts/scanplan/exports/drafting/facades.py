"""Which walls that were seen from one side are facades: nothing of the building is behind them."""

from dataclasses import replace

import numpy as np
import shapely

from scanplan.exports import envelope
from scanplan.geometry.lines import left_normals
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_shapes
from scanplan.types import BoolArray

_NEAR_M = 0.05  # behind a face: its own line, and those of doubles of it, are nearer
_ACROSS_M = 4.0  # to the next wall or room: over ground as wide as a room that no scan shows whole
_SHARES = np.linspace(0.05, 0.95, 10)  # of places along a wall, its corners left out


def find_facades(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) have nothing of the building behind the most of their face.

    None of which both sides were seen. Of the building are walls, rooms, and what these enclose:
    ground that no scan shows. What is seen through a window alone is not: no wall of it was seen.
    """
    lines_m = centrelines_m(plan.walls)
    along_m = lines_m[:, 1] - lines_m[:, 0]
    left = left_normals(lines_m)
    left_m, right_m = plan.sides_m
    # what is assumed lies behind
    behind = np.where((left_m > right_m)[:, None], left, -left)[:, None]
    places_m = lines_m[:, None, 0] + along_m[:, None] * _SHARES[:, None]
    ways_m = np.stack([places_m + _NEAR_M * behind, places_m + _ACROSS_M * behind], axis=2)
    ways = line_shapes(ways_m.reshape(-1, 2, 2))
    tree = shapely.STRtree([*line_shapes(lines_m), *plan.areas])
    way, _ = tree.query(ways, predicate="intersects")
    is_blocked = np.isin(np.arange(len(ways)), way).reshape(len(lines_m), len(_SHARES))
    no_floor = {name: values[:0] for name, values in plan.free.items()}
    building = envelope.outline_plan(replace(plan, free=no_floor))
    is_blocked |= shapely.contains_xy(building, ways_m[:, :, 1, 0], ways_m[:, :, 1, 1])
    return ~plan.thick & (is_blocked.mean(axis=1) < 1 / 2)
