"""Which walls stand between what was seen inside and what lies outside."""

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import BoolArray, FloatArray

NEAR_M = 0.1
"""What touches lies this near: rooms' outlines are this rough, and two settings put a thin wall as
far apart as it is thick."""
_BEYOND_M = 0.5  # behind a surface: past the other side of a wall seen from one side only


def find_external_walls(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) have, along half of one of their sides, nothing of the plan behind.

    What belongs to the plan: rooms, floor that rays went over, walls, and what these enclose. A
    room that no scan shows, at the edge of the survey, is taken for outside.
    """
    inside = outline_plan(plan)
    lines_m = floorplan.centrelines_m(plan.walls)
    along = lines_m[:, 1] - lines_m[:, 0]
    normals = np.column_stack([-along[:, 1], along[:, 0]])
    normals /= np.linalg.norm(along, axis=1, keepdims=True)
    # places along it, its corners left out
    shares = np.linspace(0.05, 0.95, 10)
    places_m = lines_m[:, None, 0] + along[:, None] * shares[:, None]
    normals = np.repeat(normals[:, None], len(shares), axis=1)
    for row in np.flatnonzero(plan.wall_shapes.is_bent).tolist():
        places_m[row], normals[row] = plan.wall_shapes.place_along(row, shares)
    left_m, right_m = plan.sides_m

    def is_open(beyond_m: FloatArray) -> BoolArray:
        probes_m = places_m + normals * beyond_m[:, None, None]
        is_outside = ~shapely.contains_xy(inside, probes_m[..., 0], probes_m[..., 1])
        return is_outside.mean(axis=1) >= 1 / 2

    return is_open(left_m + _BEYOND_M) | is_open(-right_m - _BEYOND_M)


def outline_plan(plan: FloorPlan) -> BaseGeometry:
    """Return what a plan covers: rooms, free floor, walls, and all that these enclose."""
    floor = shapely.from_wkb(np.asarray(plan.free["geometry"], object))
    covered = overlays.unite_areas([*plan.areas, *floor, *plan.bodies])
    closed = overlays.buffer_shapes(covered, _BEYOND_M / 2, join_style="mitre")
    whole = overlays.buffer_shapes(closed, -_BEYOND_M / 2, join_style="mitre")
    filled = [Polygon(part.exterior) for part in shapely.get_parts(whole)]
    outline = overlays.unite_areas(filled)
    shapely.prepare(outline)
    return outline
