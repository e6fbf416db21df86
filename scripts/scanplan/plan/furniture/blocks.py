"""Blocks that stand alone on the floor of a room: thicker than walls, and longer than a column."""

from collections.abc import Callable, Sequence

from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import rectangle_sides_m
from scanplan.plan import wall_ground
from scanplan.plan.faces.face_tree import FaceTree
from scanplan.plan.furniture.pocket import Pocket, faces_on, is_large
from scanplan.plan.plan_wall import PlanWall, list_faces
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M
from scanplan.rays.face_raster import CELL_M


def find_blocks(
    walls: Sequence[PlanWall],
    floor: BaseGeometry,
    measure_thickness_m: Callable[[Sequence[PlanWall]], float],
    *,
    max_thickness_m: float,
    max_depth_m: float,
) -> list[Pocket]:
    """Find blocks that stand alone, seen from two sides like walls.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free.
    measure_thickness_m : callable
        Says how thick walls usually are.
    max_thickness_m, max_depth_m : float
        Of a wall, of furniture.

    Returns
    -------
    list of Pocket
        Their grounds, and all surfaces on them; none where no other wall's thickness is known.
    """
    most = {"max_thickness_m": max_thickness_m, "max_depth_m": max_depth_m}
    faces = FaceTree(list_faces(walls))
    unpaired_m = measure_thickness_m(walls)
    solid = overlays.unite_areas(wall_ground.wall_strips(walls, unpaired_m))
    ground_before = overlays.subtract_areas(floor, solid)
    alone = []
    others = []
    for wall in (wall for wall in walls if wall.right):
        ground = wall_ground.wall_strips([wall], unpaired_m)[0]
        near = faces.within(ground, CORNER_M)
        # a wall that begins at another has floor on most sides, too
        is_alone = not wall.openings and len(faces_on(ground, near)) == len(near)
        if is_alone and _stands_alone(ground, ground_before, **most):
            alone.append((wall, ground, near))
        else:
            others.append(wall)
    blocks = []
    for wall, ground, near in alone:
        # what stands alone may be a partition, which is thinner; an island says nothing of walls
        known = [*others, *(one for one, *_ in alone if one.thickness_m < wall.thickness_m)]
        if known and _is_thick(ground, measure_thickness_m(known)):
            blocks.append(Pocket(overlays.buffer_shapes(ground, CELL_M, join_style="mitre"), near))
    return blocks


def is_block(
    ground: BaseGeometry,
    part: BaseGeometry,
    unpaired_m: float,
    *,
    max_thickness_m: float,
    max_depth_m: float,
) -> bool:
    """Return whether ground stands alone, no wall and no column."""
    most = {"max_thickness_m": max_thickness_m, "max_depth_m": max_depth_m}
    return _is_thick(ground, unpaired_m) and _stands_alone(ground, part, **most)


def _is_thick(ground: BaseGeometry, wall_m: float) -> bool:
    """Return whether ground is clearly wider than walls are thick."""
    return rectangle_sides_m(overlays.buffer_shapes(ground, -CELL_M))[0] > 2 * wall_m


def _stands_alone(
    ground: BaseGeometry, part: BaseGeometry, *, max_thickness_m: float, max_depth_m: float
) -> bool:
    """Return whether floor is around ground longer than a column and no larger than furniture."""
    if rectangle_sides_m(overlays.buffer_shapes(ground, -CELL_M))[1] <= max_thickness_m or is_large(
        ground, max_depth_m
    ):
        return False
    around = overlays.subtract_areas(overlays.buffer_shapes(ground, CORNER_M), ground)
    return overlays.intersect_areas(around, part).area >= ALONG_SHARE * around.area
