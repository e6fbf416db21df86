"""The storeys of a design in IFC."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.design.curved_ground import find_curved_ground
from scanplan.design.drawn_storey import (
    DrawnColumn,
    DrawnOpening,
    DrawnSpace,
    DrawnStorey,
    DrawnWall,
    Solid,
)
from scanplan.design.ifc_file import IfcBuilding, IfcPart
from scanplan.geometry import overlays
from scanplan.geometry.arcs import turn_rad
from scanplan.types import FloatArray

_LEAST_HIGH_M = 0.5  # of a wall: a lower one is a plinth or a kerb
_LOW_M, _HIGH_M = 0.3, 2.0  # above the floor: what reaches in between stands in a storey
_LEAST_STOREY_M = 1.0  # to the next floor: a level that is nearer is one of the same storey
_STRAIGHT = 0.9  # of the rectangle between a wall's sides: mitres leave out, or add, as much
_SILL_M = 0.05  # a hole that begins lower can be gone through
_GLASS_M = 0.3  # a window that begins lower is a pane down to the floor to whoever scans it
_FILLINGS = {"door": "door", "glass": "window"}
"""What parts are that are in no hole."""
_SIDES = 2  # of a wall
_SIDE_DECIMALS = 3  # of where a side lies: parts of it lie within a millimetre
_GRID_M = 1e-4  # of corners: a tenth of a millimetre
_LEAST_M2 = 1e-4  # of a triangle seen from above: an upright one has nothing


def list_storeys(model: IfcBuilding) -> list[DrawnStorey]:
    """Return the storeys of a building model in which walls stand, from below."""
    drawn = (_draw_storey(model, row) for row in range(len(model.storeys)))
    return [storey for storey in drawn if storey.walls]


def _draw_storey(model: IfcBuilding, row: int) -> DrawnStorey:
    name, floor_m = model.storeys[row]
    above_m = [z_m - floor_m for _, z_m in model.storeys if z_m > floor_m + _LEAST_STOREY_M]
    within = {part.guid: _stand(part, floor_m) for part in model.parts}
    top_m = max((solid.high_m for solid in within.values()), default=0.0)
    height_m = min(above_m, default=top_m)
    parts = [p for p in model.parts if _is_within(within[p.guid], height_m)]
    holes: dict[str, list[BaseGeometry]] = defaultdict(list)
    for part in parts:
        if part.kind == "opening":
            holes[part.host].append(within[part.guid].ground)
    walls: list[DrawnWall] = []
    columns: list[DrawnColumn] = []
    others: list[Solid] = []
    for part in parts:
        solid = within[part.guid]
        if part.kind != "wall" or solid.ground.is_empty:
            continue
        wall = _draw_wall(part, solid, holes[part.guid])
        if part.ifc_class.startswith("IfcColumn"):
            columns.append(DrawnColumn(part.guid, part.name, solid))
        elif wall is not None:
            walls.append(wall)
        else:
            others.append(solid)
    rows = {wall.guid: i for i, wall in enumerate(walls)}
    openings = [
        _draw_opening(part, within[part.guid], walls, rows)
        for part in parts
        if part.kind == "opening" and part.host in rows and not within[part.guid].ground.is_empty
    ]
    spaces = [space for p in parts if p.kind == "space" for space in _draw_space(p, within[p.guid])]
    return DrawnStorey(
        name, float(floor_m), float(height_m), walls, openings, spaces, columns, others
    )


def _stand(part: IfcPart, floor_m: float) -> Solid:
    """Return the ground that a part covers, and how high above a floor it reaches."""
    z_m = part.triangles_m[..., 2]
    low_m, high_m = float(z_m.min()) - floor_m, float(z_m.max()) - floor_m
    return Solid(_cover(part.triangles_m), low_m, high_m)


def _cover(triangles_m: FloatArray) -> BaseGeometry:
    """Return the ground below triangles: walls lean nowhere, so that their tops cover it all."""
    shapes = shapely.polygons(triangles_m[..., :2])
    flat = np.asarray(shapes, object)[shapely.area(shapes) > _LEAST_M2]
    return overlays.unite_areas(flat, grid=_GRID_M)


def _is_within(solid: Solid, height_m: float) -> bool:
    reach_m = min(solid.high_m, _HIGH_M, height_m) - max(solid.low_m, _LOW_M)
    return reach_m > 0 and solid.high_m > _LEAST_HIGH_M


def _draw_wall(part: IfcPart, solid: Solid, holes: Sequence[BaseGeometry]) -> DrawnWall | None:
    """Return a wall along its own axis, or its arc; None of one that has corners.

    Where a hole is as high as the wall, nothing of its ground is left.
    """
    line_m, thickness_m = _middle(part.along, solid.ground)
    length_m = float(np.hypot(*(line_m[1] - line_m[0])))
    if length_m <= thickness_m and not part.has_axis:
        line_m, thickness_m = _middle(np.array([-part.along[1], part.along[0]]), solid.ground)
        length_m = float(np.hypot(*(line_m[1] - line_m[0])))
    middle = shapely.LineString(line_m)
    strip = overlays.buffer_shapes(middle, thickness_m / 2, cap_style="flat")
    filled = overlays.unite_areas(
        [solid.ground, *overlays.intersect_areas(np.array(holes, object), strip)]
    )
    share = filled.area / (length_m * thickness_m)
    if not _STRAIGHT <= share <= 1 / _STRAIGHT:
        curved = find_curved_ground(solid.ground)
        if len(curved) != 1 or curved[0].ground.area < _STRAIGHT * solid.ground.area:
            return None
        (of,) = curved
        return DrawnWall(part.guid, part.name, of.ends_m, of.thickness_m, solid, of.centre_m)
    return DrawnWall(part.guid, part.name, line_m, thickness_m, solid)


def _middle(along: FloatArray, ground: BaseGeometry) -> tuple[FloatArray, float]:
    """Return the middle line (2, 2) of some ground in a direction, and its width.

    From side to side: a spur of a mitre is no part of its width.
    """
    across = np.array([-along[1], along[0]])
    corners_m = shapely.get_coordinates(ground)
    along_m = corners_m @ along
    low_m, high_m = _find_sides(along, across, ground)
    ends_m = np.array([along_m.min(), along_m.max()])
    return ends_m[:, None] * along + (low_m + high_m) / 2 * across, high_m - low_m


def _find_sides(along: FloatArray, across: FloatArray, ground: BaseGeometry) -> tuple[float, float]:
    """Return where across a direction the first and the last side of some ground lie."""
    off_m = shapely.get_coordinates(ground) @ across
    rings_m = [shapely.get_coordinates(r) for r in shapely.get_rings(shapely.get_parts(ground))]
    starts_m = np.concatenate([ring_m[:-1] for ring_m in rings_m])
    steps_m = np.concatenate([np.diff(ring_m, axis=0) for ring_m in rings_m])
    is_side = np.abs(steps_m @ across) <= _GRID_M
    sides_m, lengths_m = (
        ((starts_m + steps_m / 2) @ across)[is_side],
        np.abs(steps_m @ along)[is_side],
    )
    _, of = np.unique(sides_m.round(_SIDE_DECIMALS), return_inverse=True)
    total_m = np.bincount(of, lengths_m)
    at_m = np.bincount(of, lengths_m * sides_m) / total_m
    long = at_m[total_m >= total_m.max(initial=0.0) / 2]
    if len(long) < _SIDES:
        return float(off_m.min()), float(off_m.max())
    return float(long.min()), float(long.max())


def _draw_opening(
    part: IfcPart, solid: Solid, walls: list[DrawnWall], rows: Mapping[str, int]
) -> DrawnOpening:
    wall = rows[part.host]
    line_m = _find_jambs(walls[wall], shapely.get_coordinates(solid.ground))
    return describe_opening(part, line_m, (solid.low_m, solid.high_m), wall)


def describe_opening(
    part: IfcPart, line_m: FloatArray, extent_m: tuple[float, float], wall: int = -1
) -> DrawnOpening:
    """Return a hole, a door or a window as an opening.

    Parameters
    ----------
    line_m : (2, 2) float
        From jamb to jamb.
    extent_m : (float, float)
        From where to where above the floor it reaches.
    wall : int
        Row of its wall, -1 if it is in none.
    """
    low_m, high_m = extent_m
    empty = "passage" if low_m < _SILL_M else "window"
    kind = part.fills or _FILLINGS.get(part.kind, empty)
    kind = "glass" if kind == "window" and low_m < _GLASS_M else kind
    guid = part.filler or part.guid
    return DrawnOpening(guid, part.name, wall, line_m, kind, max(low_m, 0.0), high_m)


def _find_jambs(wall: DrawnWall, corners_m: FloatArray) -> FloatArray:
    """Return from where to where (2, 2) in the middle of a wall a hole reaches."""
    if wall.centre_m is None:
        along = (wall.line_m[1] - wall.line_m[0]) / np.hypot(*(wall.line_m[1] - wall.line_m[0]))
        place_m = (corners_m - wall.line_m[0]) @ along
        return wall.line_m[0] + np.array([[place_m.min()], [place_m.max()]]) * along
    first = wall.line_m[0] - wall.centre_m
    turned = turn_rad(corners_m - wall.centre_m, first)
    jambs = complex(*first) * np.exp(1j * np.array([turned.min(), turned.max()]))
    return wall.centre_m + np.column_stack([jambs.real, jambs.imag])


def _draw_space(part: IfcPart, solid: Solid) -> Iterator[DrawnSpace]:
    areas = shapely.get_parts(solid.ground)
    if len(areas):
        largest = max(areas.tolist(), key=lambda area: area.area)
        if isinstance(largest, Polygon):
            yield DrawnSpace(part.guid, part.name, largest)
