"""A project of openPlan3D as elements: its first floor, in the frame of the map."""

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from scanplan.edited.elements import Drawing, Element
from scanplan.errors import StageError
from scanplan.exports.data.openplan import PER_M
from scanplan.project import user_file
from scanplan.types import FilePath, FloatArray

_KINDS = {"opening": "passage", "sliding": "sliding door"}
"""What doors of a project are that do not swing, by their types."""
_SWINGING = ("single", "double", "french")
_MOST_BYTES = 2**26  # of a project, with the pictures that people lay into it
_GLASS_M = 0.3  # a fixed window that begins lower is a pane down to the floor
_GLOBAL_ID = re.compile(r"[0-9A-Za-z_$]{22}")  # of a room that is a text: its name
_OTHER = ("stairs", "annotations", "textAnnotations", "measurements", "entourage")
_ELEMENTS = ("walls", "doors", "windows", "rooms", "furniture", "columns")

Item = Mapping[str, Any]


def read_openplan(path: FilePath) -> Drawing:
    """Read a project.

    Raises
    ------
    StageError
        If it is no project, or a number of it is none.
    """
    text = user_file.read_text(path, "save the project as JSON", _MOST_BYTES)
    try:
        project = json.loads(text)
        floors = project["floors"]
        floor = floors[0]
        lists: dict[str, list[Item]] = {
            name: list(floor.get(name) or ()) for name in (*_ELEMENTS, *_OTHER)
        }
        walls: dict[str, Element] = {str(wall["id"]): _read_wall(wall) for wall in lists["walls"]}
        elements = [
            *walls.values(),
            *_read_openings(lists["doors"], walls, _describe_door),
            *_read_openings(lists["windows"], walls, _describe_window),
            *map(_read_room, lists["rooms"]),
            *(_read_text(item) for item in lists["textAnnotations"] if _is_ours(item)),
            *map(_read_piece, lists["furniture"]),
            *map(_read_column, lists["columns"]),
        ]
        name = str(project.get("name", ""))
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        fault = f"is no project of openPlan3D ({type(error).__name__}: {str(error)[:80]})"
        raise StageError(f"{path}: {fault}; export it again as a project") from None
    lists["textAnnotations"] = [i for i in lists["textAnnotations"] if not _is_ours(i)]
    other = {name: len(lists[name]) for name in _OTHER if lists[name]}
    other |= {"further floors": len(floors) - 1} if len(floors) > 1 else {}
    return Drawing(elements, other, name)


def _read_wall(item: Item) -> Element:
    line_m = np.array([_place_m(item["start"]), _place_m(item["end"])])
    if not np.hypot(*(line_m[1] - line_m[0])) > 0:
        raise ValueError(f"wall {item['id']} has no length")
    facts = {"thickness_m": _metres(item["thickness"])}
    facts |= {"height_m": _metres(item["height"])} if "height" in item else {}
    bent = item.get("curvePoint") is not None
    return Element("wall", str(item["id"]), line_m, facts=facts, is_bent=bent)


def _read_openings(
    items: Sequence[Item], walls: Mapping[str, Element], describe: Any
) -> Iterator[Element]:
    for item in items:
        wall = walls[str(item["wallId"])]
        assert wall.line_m is not None
        start_m, end_m = wall.line_m
        middle_m = start_m + _number(item["position"]) * (end_m - start_m)
        width_m = _metres(item["width"])
        if width_m <= 0:
            raise ValueError(f"opening {item['id']} has no width")
        half_m = width_m / 2 * wall.along
        line_m = np.array([middle_m - half_m, middle_m + half_m])
        facts = describe(item, line_m)
        yield Element("opening", str(item["id"]), line_m, facts=facts, host=wall.key)


def _describe_door(item: Item, line_m: FloatArray) -> dict[str, Any]:
    kind = str(item.get("type", "single"))
    facts: dict[str, Any] = {"kind": _KINDS.get(kind, "door")}
    if "height" in item:
        facts["lintel_m"] = _metres(item["height"])
    if kind in _SWINGING:
        # hinged at the end of the wall's way if `left`; to its right if not flipped, y upwards
        hinge = int(item.get("swingDirection", "left") == "left")
        way_m = line_m[1] - line_m[0]
        right_m = np.array([way_m[1], -way_m[0]]) * (-1 if item.get("flipSide") else 1)
        facts["opens_m"] = line_m[hinge] + right_m
    return facts


def _describe_window(item: Item, _line_m: FloatArray) -> dict[str, Any]:
    sill_m = _metres(item.get("sillHeight", 90))
    is_pane = item.get("type") == "fixed" and sill_m < _GLASS_M
    lintel_m = sill_m + _metres(item.get("height", 120))
    return {"kind": "glass" if is_pane else "window", "sill_m": sill_m, "lintel_m": lintel_m}


def _read_room(item: Item) -> Element:
    facts = {"name": str(item.get("name", ""))}
    details = item.get("details") or {}
    facts["use"] = str(details.get("roomType") or "")
    facts["outside"] = str(item.get("roomType") == "outdoor")
    return Element("room", str(item["id"]), facts=facts)


def _is_ours(item: Item) -> bool:
    return bool(_GLOBAL_ID.fullmatch(str(item["id"])))


def _read_text(item: Item) -> Element:
    return Element("room", str(item["id"]), facts={"name": str(item["text"])})


def _read_piece(item: Item) -> Element:
    sizes = [_metres(item.get(name, 100)) for name in ("width", "depth")]
    return _thing(item, "furniture", sizes[0], sizes[1])


def _read_column(item: Item) -> Element:
    across_m = _metres(item["diameter"])
    return _thing(item, "column", across_m, across_m)


def _thing(item: Item, kind: str, along_m: float, across_m: float) -> Element:
    place_m = _place_m(item["position"])
    turn = math.radians(-_number(item.get("rotation", 0)))
    half_m = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [along_m / 2, across_m / 2]
    axes = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    outline = shapely.Polygon(place_m + half_m @ axes)
    return Element("furniture", str(item["id"]), outline=outline, facts={"kind": kind})


def _place_m(point: Item) -> FloatArray:
    return np.array([_metres(point["x"]), -_metres(point["y"])])


def _metres(value: Any) -> float:
    return _number(value) / PER_M


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{str(value)[:40]!r} is no number")
    return float(value)
