"""Blocks that stand alone on the floor of a room: thicker than walls, and longer than a column."""

from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import rectangle_sides_m
from scanplan.plan.furniture.pocket import is_large
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M
from scanplan.rays.face_raster import CELL_M


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
