"""Reading what stands, hangs and lies in a drawn building, and what is seen outside it."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely import LineString, Point

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.lab.buildings.details.feature_reading import DrawnPart
from scanplan.lab.buildings.details.things import (
    DrawnCeiling,
    DrawnColumn,
    DrawnFacade,
    DrawnFurniture,
    DrawnGround,
    DrawnMirror,
    DrawnPlatform,
    DrawnStairs,
    DrawnVoid,
    DrawnWall,
    Plane,
)

COLUMN_TYPES = ("column", "pilaster")
MATERIALS = ("wall", "glass")


def read_wall(part: DrawnPart, ceiling_m: float) -> DrawnWall:
    """Return a wall no higher than the ceiling.

    Raises
    ------
    StageError
        If a value is not what it may be: of a tapering wall its number of vertices, of a pane its
        thickness.
    """
    thickness_m = part.number("thickness_m", 0.01, 2.0)
    is_glass = part.choice("material", MATERIALS, "wall") == "glass"
    if is_glass:
        thickness_m = part.number("thickness_m", 0.01, 0.05)
    line_m = LineString(shapely.remove_repeated_points(part.geometry_m))
    end_thickness_m = None
    if part.has("end_thickness_m"):
        end_thickness_m = part.number("end_thickness_m", 0.01, 2.0)
        if len(line_m.coords) != 2 or is_glass:
            raise StageError(
                f"{part.where}: end_thickness_m is {end_thickness_m:g}, and it has"
                f" {len(line_m.coords)} vertices; expected a wall of 2 that is no glass"
            )
    return DrawnWall(
        line_m=line_m,
        thickness_m=thickness_m,
        height_m=part.number("height_m", 0.01, ceiling_m, default=ceiling_m),
        end_thickness_m=end_thickness_m,
        is_glass=is_glass,
        is_curved=part.switch("curved"),
    )


def read_furniture(part: DrawnPart, ceiling_m: float) -> DrawnFurniture:
    """Return a box no higher than the ceiling."""
    height_m = part.number("height_m", 0.01, ceiling_m)
    name = part.values.get("type")
    if name is not None and not isinstance(name, str):
        raise StageError(f"{part.where}: type is {name!r}; expected a word, such as cupboard")
    base_m = part.number("base_m", 0.0, height_m - 0.001, default=0.0)
    return DrawnFurniture(part.geometry_m, height_m, base_m, name or None)


def read_column(part: DrawnPart, ceiling_m: float) -> DrawnColumn:
    """Return a column, up to the ceiling where no height is drawn."""
    height_m = part.number("height_m", 0.01, ceiling_m, default=ceiling_m)
    return DrawnColumn(part.geometry_m, height_m, part.choice("type", COLUMN_TYPES, "column"))


def read_ceiling(part: DrawnPart, ceiling_m: float) -> DrawnCeiling:
    """Return a lowered or sloping ceiling, or a beam.

    Raises
    ------
    StageError
        If a value is not what it may be, or its underside leaves the space from floor to ceiling.
    """
    is_beam = part.kind == "beam"
    name = "underside_m" if is_beam else "height_m"
    height_m = part.number(name, 0.01, ceiling_m)
    rise_x = 0.0 if is_beam else part.number("rise_x", -10.0, 10.0, default=0.0)
    rise_y = 0.0 if is_beam else part.number("rise_y", -10.0, 10.0, default=0.0)
    corners_m = shapely.get_coordinates(part.geometry_m)
    x0, y0 = corners_m[0]
    underside = Plane(height_m - rise_x * x0 - rise_y * y0, rise_x, rise_y)
    heights_m = underside.heights(corners_m)
    within = (heights_m >= 0.01 - 1e-6) & (heights_m <= ceiling_m + 1e-6)
    if not within.all():
        row = int(np.argmin(within))
        x, y = corners_m[row]
        raise StageError(
            f"{part.where}: its underside is at {heights_m[row]:.3f} m at ({x:g}, {y:g}); expected"
            f" 0.01 to {ceiling_m:g}, change {name}, rise_x or rise_y"
        )
    return DrawnCeiling(part.geometry_m, underside, is_beam)


def read_void(part: DrawnPart) -> DrawnVoid:
    """Return a hole in the floor."""
    return DrawnVoid(part.geometry_m, part.number("depth_m", 0.1, 50.0, default=3.0))


def read_stairs(part: DrawnPart, voids: Sequence[DrawnVoid]) -> DrawnStairs:
    """Return stairs.

    Raises
    ------
    StageError
        If their polygon has not four corners, a value is not what it may be, or they lead down
        and not into a void.
    """
    corners = len(part.geometry_m.exterior.coords) - 1
    if corners != 4 or part.geometry_m.interiors:
        raise StageError(
            f"{part.where}: has {corners} corners and {len(part.geometry_m.interiors)} holes;"
            " expected 4 corners, the lowest step's edge first"
        )
    rise_m = part.number("rise_m", -50.0, 50.0)
    steps = part.number("steps", 1, 1000)
    if steps != int(steps) or rise_m == 0.0:
        raise StageError(
            f"{part.where}: steps is {steps:g}, rise_m {rise_m:g}; expected a whole number and a"
            " rise other than 0"
        )
    hole = overlays.unite_areas([void.footprint_m for void in voids])
    beside_m2 = overlays.subtract_areas(part.geometry_m, hole).area
    if rise_m < 0 and beside_m2 > 0.01 * part.geometry_m.area:
        raise StageError(
            f"{part.where}: lead down by {-rise_m:g} m, {beside_m2:.2f} m2 of them beside any void;"
            " draw a void under them"
        )
    return DrawnStairs(part.geometry_m, rise_m, int(steps))


def read_platform(part: DrawnPart, ceiling_m: float) -> DrawnPlatform:
    """Return a higher part of the floor."""
    return DrawnPlatform(part.geometry_m, part.number("height_m", 0.01, ceiling_m))


def read_mirror(part: DrawnPart, ceiling_m: float, walls: Sequence[DrawnWall]) -> DrawnMirror:
    """Return a mirror.

    Raises
    ------
    StageError
        If a value is not what it may be, or the mirror is within a wall, where no ray meets it.
    """
    sill_m = part.number("sill_m", 0.0, ceiling_m, default=0.0)
    lintel_m = part.number("lintel_m", sill_m + 0.01, ceiling_m)
    mirror = DrawnMirror(part.geometry_m, sill_m, lintel_m)
    middle = part.geometry_m.interpolate(0.5, normalized=True)
    for wall in walls:
        inside_m = min(wall.thickness_m, wall.last_thickness_m) / 2 - wall.line_m.distance(middle)
        if inside_m > mirror.thickness_m / 2 - 0.001:
            raise StageError(
                f"{part.where}: at ({middle.x:g}, {middle.y:g}), {inside_m:.3f} m within a wall;"
                " draw it along the wall's face"
            )
    return mirror


def read_ground(part: DrawnPart) -> DrawnGround:
    """Return ground outside."""
    return DrawnGround(part.geometry_m, part.number("z_m", -50.0, 50.0, default=-0.15))


def read_facade(part: DrawnPart) -> DrawnFacade:
    """Return a front outside."""
    return DrawnFacade(part.geometry_m, part.number("height_m", 0.01, 200.0))


def read_room_name(part: DrawnPart) -> tuple[str, Point]:
    """Return the name of a room and a point in it."""
    return str(part.values.get("name", "")), part.geometry_m.representative_point()
