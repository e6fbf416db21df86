"""The plan as a project of openPlan3D, an editor of floor plans: centimetres, y downwards."""

import json
from datetime import UTC, datetime
from typing import Any

import numpy as np
import shapely

from scanplan.exports.data import element_ids
from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.data.openplan_walls import DrawnWall, draw_walls, list_around
from scanplan.exports.model_origin import ModelOrigin
from scanplan.exports.opening_extents import vertical_extent_m
from scanplan.exports.sheet.openings import find_swings
from scanplan.geometry.polygons import long_axis_m
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import WIDEST_LEAF_M
from scanplan.store.schemas import COLUMN, LEAF

PER_M = 100.0
"""Units of a project for a metre: it is in centimetres."""
DIGITS = 3
"""Of its numbers: a hundredth of a millimetre."""
TAKE_BACK = "scanplan take"
"""The command that takes an edited project back, named in each."""
DOORS = {"door": "single", "passage": "opening", "gap": "opening"}
"""Openings that are doors of a project, by our types, and what they are called there."""
_WINDOWS = {"window": "standard", "glass": "fixed"}
_THING = "imported_object"  # what the editor draws of which it has no picture
_ROUND = 0.9  # of the square around a column: of a circle it is 0.785

Item = dict[str, Any]


def format_openplan(plan: FloorPlan, ids: ElementIds, origin: ModelOrigin | None = None) -> str:
    """Return a plan as the JSON of a project of openPlan3D with one floor.

    Walls have their thickness and height, and end where the lines of others cross, so that rooms
    close; curved ones are in pieces of quadratic curves. Doors open as leaves were seen, else to
    the left. A room that walls do not close is a text, its name. What lies in no wall is left out,
    as are leaves.

    Parameters
    ----------
    ids : dict of str to sequence of str
        The GlobalIds of walls, openings and rooms, which a project that comes back is known by.

    Returns
    -------
    str
        The same for the same plan, ids and origin.
    """
    walls = draw_walls(plan, ids["wall"])
    floor = {
        "id": "floor",
        "name": plan.name,
        "level": 0,
        "elevation": 0,
        "walls": [_wall_item(wall) for wall in walls],
        "rooms": [],
        "doors": [],
        "windows": [],
        "furniture": [],
        "stairs": [],
        "columns": [],
        "textAnnotations": [],
        **{name: [] for name in ("guides", "measurements", "annotations")},
        "groups": [],
    }
    for row, beside in enumerate(list_around(walls, plan.areas)):
        if beside:
            floor["rooms"].append(_room_item(plan, ids, row, beside))
        else:
            floor["textAnnotations"].append(_text_item(plan, ids, row))
    swings = find_swings(plan)
    for row, kind in enumerate(plan.openings["type"].tolist()):
        hosts = [wall for wall in walls if wall.row == plan.hosts[row] and plan.hosts[row] >= 0]
        if not hosts:
            continue
        item = _opening_item(plan, row, hosts) | {"id": ids["opening"][row]}
        if kind in DOORS:
            swing = swings.get(row)
            floor["doors"].append(item | _say_swing(plan, row, item, swing))
        else:
            floor["windows"].append(item)
    for row, kind in enumerate(np.asarray(plan.furniture["kind"], str).tolist()):
        if kind != LEAF:
            table = "columns" if kind == COLUMN else "furniture"
            floor[table].append(_thing_item(plan, row, kind))
    made = _state_time(origin)
    project = {
        "id": element_ids.derive_id("openplan", plan.name),
        "name": plan.name,
        "description": f"By scanplan; {TAKE_BACK} takes what is changed here back.",
        "floors": [floor],
        "activeFloorId": "floor",
        "createdAt": made,
        "updatedAt": made,
    }
    return json.dumps(project, ensure_ascii=False, indent=1) + "\n"


def place_point(place_m: Any) -> dict[str, float]:
    """Return a place (2,) of the map as a point of a project."""
    x_m, y_m = place_m
    # + 0.0 turns a negative zero into zero
    return {"x": _cm(x_m), "y": _cm(-y_m)}


def _cm(length_m: float) -> float:
    return round(PER_M * float(length_m), DIGITS) + 0.0


def _wall_item(wall: DrawnWall) -> Item:
    item = {
        "id": wall.key,
        "start": place_point(wall.line_m[0]),
        "end": place_point(wall.line_m[1]),
        "thickness": _cm(wall.thickness_m),
        "height": _cm(wall.height_m),
        "color": "#444444",
    }
    return item if wall.control_m is None else item | {"curvePoint": place_point(wall.control_m)}


def _room_item(plan: FloorPlan, ids: ElementIds, row: int, walls: list[str]) -> Item:
    use = str(plan.rooms["use"][row]) if "use" in plan.rooms else ""
    item = {
        "id": ids["room"][row],
        "name": plan.room_names[row],
        "walls": walls,
        "floorTexture": "light-oak",
        "area": round(float(plan.net_areas_m2[row]), 2),
    }
    return item | ({"details": {"roomType": use}} if use else {})


def _text_item(plan: FloorPlan, ids: ElementIds, row: int) -> Item:
    """Return the name of a room as a text, where the editor finds no room by its walls."""
    place = place_point([plan.rooms["x_m"][row], plan.rooms["y_m"][row]])
    style = {"fontSize": 16, "color": "#1e293b", "rotation": 0}
    return {"id": ids["room"][row], **place, "text": plan.room_names[row], **style}


def _opening_item(plan: FloorPlan, row: int, hosts: list[DrawnWall]) -> Item:
    ends_m = floorplan.centrelines_m(plan.openings)[row]
    middle = shapely.Point(ends_m.mean(axis=0))
    host = min(hosts, key=lambda wall: shapely.LineString(wall.line_m).distance(middle))
    axis = shapely.LineString(host.line_m)
    low_m, high_m = vertical_extent_m(plan, row)
    kind = str(plan.openings["type"][row])
    item: Item = {
        "wallId": host.key,
        "position": round(axis.project(middle) / axis.length, 6),
        "width": _cm(plan.openings["width_m"][row]),
        "height": _cm(high_m - low_m),
    }
    if kind in DOORS:
        is_double = kind == "door" and plan.openings["width_m"][row] > WIDEST_LEAF_M
        return item | {"type": "double" if is_double else DOORS[kind]}
    return item | {"type": _WINDOWS[kind], "sillHeight": _cm(low_m)}


def _say_swing(plan: FloorPlan, row: int, item: Item, swing: Any) -> Item:
    """Return how a door opens in the words of the editor.

    Its door is hinged at the end of its wall's way if it is `left`, and opens to the right of that
    way, seen with y upwards, if it is not flipped.
    """
    if swing is None or swing.block.startswith("SLIDING"):
        usual = {"swingDirection": "left", "flipSide": False}
        return usual if swing is None else usual | {"type": "sliding"}
    line_m = floorplan.centrelines_m(plan.openings)[row]
    host_m = floorplan.centrelines_m(plan.walls)[plan.hosts[row]]
    direction = line_m[1] - line_m[0]
    is_along_host = bool(direction @ (host_m[1] - host_m[0]) > 0)
    # of its own line: hinged at its start if opened to the left with the one block, else the other
    is_to_left = not swing.is_reversed
    is_at_start = (swing.way != "SWING-RIGHT") == is_to_left
    is_at_host_end = is_at_start != is_along_host
    return {
        "swingDirection": "left" if is_at_host_end else "right",
        "flipSide": is_to_left == is_along_host,
    }


def _thing_item(plan: FloorPlan, row: int, kind: str) -> Item:
    outline = shapely.from_wkb(plan.furniture["geometry"][row])
    axis_m = long_axis_m(outline)
    way_m = axis_m[1] - axis_m[0]
    long_m = float(np.hypot(*way_m))
    rectangle = shapely.minimum_rotated_rectangle(outline)
    middle_m = axis_m.mean(axis=0)
    rotation_deg = round(float(np.degrees(np.arctan2(-way_m[1], way_m[0]))), 3) + 0.0
    place = {"position": place_point(middle_m), "rotation": rotation_deg}
    number = int(plan.furniture["furniture"][row])
    floor_m, height_m = plan.storey_m
    if kind == COLUMN:
        is_round = outline.area < _ROUND * rectangle.area
        shape = {"shape": "round" if is_round else "square", "diameter": _cm(rectangle.area**0.5)}
        sizes = {**shape, "height": _cm(height_m), "color": "#cccccc"}
        return {"id": f"column-{number}", **place, **sizes}
    top_m = float(plan.furniture["z_max_m"][row]) - floor_m
    sizes = {"width": _cm(long_m), "depth": _cm(max(rectangle.area / long_m, 0.01))}
    sizes |= {"height": _cm(top_m)} if top_m > 0 else {}
    scale = {"scale": {"x": 1, "y": 1, "z": 1}}
    return {"id": f"furniture-{number}", "catalogId": _THING, **place, **scale, **sizes}


def _state_time(origin: ModelOrigin | None) -> str:
    seconds = 0 if origin is None else origin.t_ns // 10**9
    return datetime.fromtimestamp(seconds, UTC).isoformat().replace("+00:00", "Z")
