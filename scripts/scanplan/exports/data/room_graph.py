"""The rooms and the ways between them, for robots: which door leads where."""

import json
from typing import Any

import numpy as np
import shapely

from scanplan.exports.data.element_tables import Rows
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import FloatArray

_PLACE = {"frame": "map", "unit": "m"}
WHEELCHAIR_M = 0.9
"""Clear width of doors for wheelchairs (DIN 18040)."""
_NARROWED_M = 0.05  # doors of a survey are seen too narrow by up to as much


def format_room_graph(plan: FloorPlan, rows: dict[str, Rows]) -> str:
    """Return rooms, doors and passages, and the graph that they make, as the text of a JSON file.

    Parameters
    ----------
    rows : dict
        See `element_tables.tabulate_elements`.

    Returns
    -------
    str
        `rooms` with outline and a place inside; `ways`, each with its ends, its width as measured
        and by the catalogue, null where it has none, and a place to go through in either room;
        `graph`, of each room by its number the ways and the rooms that they lead to, null for one
        that no scan shows; `wheelchair`, which rooms are joined by ways at least 0.9 m wide, by
        the catalogue where that has their width, the group with most floor first, which of them
        such a way leads to from where no scan shows a room, and which ways were measured too
        narrow by so little that a tape must tell. Metres in the map frame, as in `map.yaml`.
    """
    ways = [_describe_way(plan, rows["openings"], row) for row in _list_ways(plan)]
    rooms = [_describe_room(plan, rows["rooms"], row) for row in range(len(plan.areas))]
    graph = {str(room["room"]): _list_exits(ways, room["room"]) for room in rooms}
    content = {"name": plan.name, **_PLACE, "rooms": rooms, "ways": ways, "graph": graph}
    content["wheelchair"] = _find_accessible(rooms, ways)
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def is_wide(width_m: float, nominal_m: float | None) -> bool:
    """Return whether a wheelchair passes a way, by the catalogue's width where there is one."""
    return (width_m if nominal_m is None else nominal_m) >= WHEELCHAIR_M


def _list_ways(plan: FloorPlan) -> list[int]:
    return np.flatnonzero(np.isin(plan.openings["type"], floorplan.WAYS)).tolist()


def _describe_room(plan: FloorPlan, rows: Rows, row: int) -> dict[str, Any]:
    polygons = shapely.get_parts(plan.areas[row])
    return {
        **{name: values[row] for name, values in rows.items() if name not in ("x_m", "y_m")},
        "place_m": _round([rows["x_m"][row], rows["y_m"][row]]),
        "outlines_m": [
            [_round(shapely.get_coordinates(ring)) for ring in shapely.get_rings(polygon)]
            for polygon in polygons
        ],
    }


def _describe_way(plan: FloorPlan, rows: Rows, row: int) -> dict[str, Any]:
    line_m = floorplan.centrelines_m(plan.openings)[row]
    along = (line_m[1] - line_m[0]) / np.linalg.norm(line_m[1] - line_m[0])
    # a rover that fits through stands clear of the wall as far from it as the way is wide
    step_m = rows["width_m"][row] * np.array([-along[1], along[0]])
    middle_m = line_m.mean(axis=0)
    joined = [rows["room_a"][row], rows["room_b"][row]]
    through_m = _find_places(plan, middle_m, step_m, joined)
    stated = ("p_true", "verify", "about", "doubt", "corrected")
    doubt = {name: rows[name][row] for name in stated if name in rows}
    return {
        "opening": rows["opening"][row],
        "global_id": rows["global_id"][row],
        "type": rows["type"][row],
        "rooms": joined,
        "width_m": _round(rows["width_m"][row]),
        "nominal_width_m": rows["nominal_width_m"][row],
        "ends_m": _round(line_m),
        "through_m": _round(through_m),
        **doubt,
    }


def _find_places(
    plan: FloorPlan, middle_m: FloatArray, step_m: FloatArray, rooms: list[int | None]
) -> FloatArray:
    """Return places (2, 2) on both sides of a way, in the order of the rooms that they are in.

    Each is a step from the middle of the way, or, if that is beyond the room, in the middle of the
    longest stretch of the step that lies in it.
    """
    areas = dict(zip(plan.rooms["room"].tolist(), plan.areas, strict=True))
    sides_m = np.array([middle_m + step_m, middle_m - step_m])

    def off_m(ordered_m: FloatArray) -> float:
        pairs = zip(rooms, map(shapely.Point, ordered_m), strict=True)
        return sum(areas[room].distance(place) for room, place in pairs if room in areas)

    def find_place(side_m: FloatArray, room: int | None) -> FloatArray:
        if room not in areas or areas[room].covers(shapely.Point(side_m)):
            return side_m
        ahead = shapely.LineString([middle_m, side_m])
        inside = [
            part
            for part in shapely.get_parts(overlays.intersect_lines(areas[room], ahead))
            if part.length
        ]
        longest = max(inside, key=lambda part: part.length, default=ahead)
        return shapely.get_coordinates(longest.interpolate(0.5, normalized=True))[0]

    ordered_m = min((sides_m, sides_m[::-1]), key=off_m)
    return np.array([find_place(*side) for side in zip(ordered_m, rooms, strict=True)])


def _list_exits(ways: list[dict[str, Any]], room: int) -> list[dict[str, Any]]:
    exits = []
    for way in ways:
        one, other = way["rooms"]
        if room in (one, other):
            exits.append({"opening": way["opening"], "to": other if room == one else one})
    return exits


def _find_accessible(rooms: list[dict[str, Any]], ways: list[dict[str, Any]]) -> dict[str, Any]:
    """Return which rooms ways that are wide enough join, lead to from outside, and may be so."""
    areas_m2 = {room["room"]: room["area_m2"] for room in rooms}
    wide = [way["rooms"] for way in ways if is_wide(way["width_m"], way["nominal_width_m"])]
    group_of = {room: {room} for room in areas_m2}
    for one, other in wide:
        if one in group_of and other in group_of and group_of[one] is not group_of[other]:
            joined = group_of[one] | group_of[other]
            group_of |= dict.fromkeys(joined, joined)
    groups = {min(group): sorted(group) for group in group_of.values()}
    ordered = sorted(
        groups.values(), key=lambda group: (-sum(areas_m2[room] for room in group), group)
    )
    entered = {room for ends in wide if None in ends for room in ends} & set(areas_m2)
    nearly_m = (WHEELCHAIR_M - _NARROWED_M, WHEELCHAIR_M)
    to_tape = [
        way["opening"]
        for way in ways
        if nearly_m[0] <= way["width_m"] < nearly_m[1]
        and (way["nominal_width_m"] is None or is_wide(way["width_m"], way["nominal_width_m"]))
    ]
    return {
        "least_width_m": WHEELCHAIR_M,
        "groups": ordered,
        "from_outside": sorted({room for way in entered for room in group_of[way]}),
        "to_tape": to_tape,
    }


def _round(values: Any) -> Any:
    # to a millimetre; + 0.0 turns a negative zero into zero
    return (np.round(np.asarray(values, float), 3) + 0.0).tolist()
