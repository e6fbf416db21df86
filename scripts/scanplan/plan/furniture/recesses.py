"""Ground that no ray of a planar scanner reached, and the walls that fronts may stand before."""

import math
from collections.abc import Iterator, Sequence

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.plan_faces import PlanFaces
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M, END_M, FURNITURE_M2
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M

POCKET_M2 = 2 * FURNITURE_M2
"""Of two desks or a table, with the floor that they hide."""
DEEPEST_M = math.sqrt(POCKET_M2)
"""No table and its shadow are deeper."""


def find_holes(known: BaseGeometry) -> Iterator[Polygon]:
    """Yield the holes of known ground up to furniture size, dilated by one cell."""
    for part in free_space.polygon_parts(known).geoms:
        for ring in part.interiors:
            hole = overlays.buffer_shapes(Polygon(ring), CELL_M, join_style="mitre")
            if hole.area <= POCKET_M2:
                yield hole


def find_recesses(
    fronts: Sequence[FaceInterval], faces: PlanFaces, floor: BaseGeometry, max_depth_m: float
) -> Iterator[tuple[FaceInterval, Polygon]]:
    """Yield fronts, and the hidden ground between each and walls that it may stand before.

    Parameters
    ----------
    fronts : sequence of intervals.FaceInterval
    faces : plan_faces.PlanFaces
        All of the plan.
    floor : shapely geometry
        That was seen free.
    max_depth_m : float
        Of furniture, from its front to its back.
    """
    seen_floor = overlays.buffer_shapes(floor, CELL_M)
    for front in fronts:
        for wall, _ in _find_walls_behind(front, faces, max_depth_m):
            foot_m = wall.line.at(wall.line.along_m(front.ends))
            between = Polygon([*front.ends, *foot_m[::-1]])
            hidden = free_space.difference_on_grid(between, seen_floor)
            largest = max(hidden.geoms, key=lambda part: part.area, default=None)
            if largest is not None and largest.area >= ALONG_SHARE * between.area:
                yield front, overlays.buffer_shapes(largest, CELL_M, join_style="mitre")


def stands_before_facade(
    front: FaceInterval, hidden: Polygon, faces: PlanFaces, max_depth_m: float
) -> bool:
    """Return whether the building ends at a wall that a front of furniture may stand before.

    Hidden ground behind the front does not go on beyond it. Rooms reach up to it: between the two
    nothing has room but furniture, for a facade seldom steps back from its own line by less than a
    room.
    """
    corners_m = shapely.get_coordinates(hidden)
    return any(
        is_facade and wall.line.offset_m(corners_m).min() >= -CORNER_M
        for wall, is_facade in _find_walls_behind(front, faces, max_depth_m)
    )


def _find_walls_behind(
    front: FaceInterval, faces: PlanFaces, max_depth_m: float
) -> Iterator[tuple[FaceInterval, bool]]:
    """Yield the faces that a front may stand before, and whether the building ends at each.

    Their lines reach farther through the plan than the front's, and farther than they are away from
    it. Or they go on on both sides of it, where it is not one of the piers between niches. The
    building ends at a facade no farther behind, in the mean, than furniture is deep.
    """
    reach_m = faces.reach_on_line_m(front)
    is_pier = faces.is_between_others(front)
    joined_m = faces.joined_m(front)
    # no deeper than a table and its shadow, however short the front
    most_m = min(POCKET_M2 / joined_m, DEEPEST_M)
    near_m = min(POCKET_M2 / joined_m, max_depth_m + END_M)
    for wall in faces.parallel(front, most_m + CORNER_M):
        along_m, off_m = wall.line.along_m(front.ends), wall.line.offset_m(front.ends)
        is_near = bool(off_m.mean() <= near_m)
        is_facade = is_near and faces.is_outermost(wall, along_m)
        if faces.reach_on_line_m(wall) > max(reach_m, faces.gap_on_line_m(wall, along_m)):
            may_stand = off_m.max() <= most_m or is_facade
        else:
            is_behind = is_near and off_m.min() > CORNER_M
            may_stand = is_behind and not is_pier and faces.goes_on_beside(wall, along_m)
        if may_stand:
            yield wall, is_facade
