"""A sheet's DXF as elements: by the extended data of what scanplan drew, and by lines of others.

Walls are known by their lines (a layer that is off), openings and rooms by their blocks, furniture
by its outlines. Whoever moves the sides of a wall, and not its line, is understood, too: what two
sides enclose is compared as well (`side_strips`).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import shapely
from ezdxf.document import Drawing as Document
from ezdxf.entities.insert import Insert
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.enums import InsertUnits
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.const import DXFError
from ezdxf.units import conversion_factor

from scanplan.design.layer_words import kind_of_layer
from scanplan.edited.elements import Drawing, Element
from scanplan.errors import StageError
from scanplan.exports.data.element_ids import JOINED
from scanplan.exports.dxf_document import APPLICATION, STAMP, WALL_FACT
from scanplan.exports.sheet.symbols import AJAR
from scanplan.project import user_file
from scanplan.types import FilePath, FloatArray

KINDS = {
    "DOOR": "door",
    # of releases before
    "DOOR-1": "door",
    "DOOR-2": "door",
    "DOORWAY": "door",
    "SWING-LEFT": "door",
    "SWING-RIGHT": "door",
    "SWING-2": "door",
    "SLIDING": "sliding door",
    "WINDOW": "window",
    "PASSAGE": "passage",
    "PARTING": "passage",
    "GLASS": "glass",
    "GAP": "gap",
}
"""Openings by the blocks that they are drawn with."""
_HINGES = {"SWING-LEFT": 0, "SWING-RIGHT": 1, "SWING-2": 0}
"""At which end of its line a leaf hangs, in the side of the wall that it opens to."""
_OURS = (
    *("LWPOLYLINE", "HATCH", "INSERT", "DIMENSION", "TEXT", "MTEXT", "LINE", "ARC", "POLYLINE"),
    *("VIEWPORT", "GEODATA"),
)


def read_dxf(path: FilePath) -> Drawing:
    """Read the model space of a drawing.

    Raises
    ------
    StageError
        If it is damaged, states no unit, or has none of scanplan's walls.
    """
    user_file.find_file(path, "name a file")
    try:
        document = readfile(path)
        if document.units not in [*InsertUnits][1:]:
            fault = f"states no unit ($INSUNITS is {document.units})"
            raise StageError(f"{path}: {fault}; export it in metres")
        per_unit_m = conversion_factor(InsertUnits(document.units), InsertUnits.Meters)
        elements = _leave_holes([*_list_elements(document, per_unit_m)])
    except (OSError, DXFError, ValueError, ArithmeticError) as error:
        fault = f"cannot be read as DXF ({str(error).strip()[:120]})"
        raise StageError(f"{path}: {fault}; export it again") from None
    if not any(element.kind == "wall" for element in elements):
        fault = f"has no wall with extended data of {APPLICATION}"
        raise StageError(f"{path}: {fault}; edit plan.dxf, and keep the layer of walls' lines")
    other: dict[str, int] = {}
    for entity in document.modelspace():
        if entity.dxftype() not in _OURS:
            other[entity.dxftype()] = other.get(entity.dxftype(), 0) + 1
    return Drawing(_find_hosts(elements), other)


def _list_elements(document: Document, per_unit_m: float) -> Iterator[Element]:
    for entity in document.modelspace():
        facts = read_facts(entity)
        if isinstance(entity, Insert):
            if entity.dxf.name.startswith(STAMP):
                yield _read_stamp(document, entity, facts)
            elif "opening" in facts or entity.dxf.name.removesuffix(AJAR) in KINDS:
                yield _read_opening(entity, facts, per_unit_m)
        elif isinstance(entity, LWPolyline):
            corners_m = np.array([c[:2] for c in entity.get_points("xyb")]) * per_unit_m
            if "furniture" in facts and entity.closed and len(corners_m) > 2:
                kind = "column" if kind_of_layer(entity.dxf.layer) == "column" else "furniture"
                key, outline = str(facts["furniture"]), shapely.Polygon(corners_m)
                yield Element("furniture", key, outline=outline, facts={"kind": kind})
            elif "wall" in facts and not entity.closed and len(corners_m) > 1:
                is_bent = any(corner[2] for corner in entity.get_points("xyb")[:-1])
                line_m = corners_m[[0, -1]]
                joined = str(facts.get(JOINED, "")).split()
                yield Element("wall", str(facts["wall"]), line_m, is_bent=is_bent, joined=joined)


def _leave_holes(elements: Sequence[Element]) -> list[Element]:
    """Return elements without the holes of outlines, which are outlines of the same piece."""
    outer: dict[str, Element] = {}
    for element in elements:
        if element.outline is not None:
            known = outer.setdefault(element.key, element)
            assert known.outline is not None
            if element.outline.area > known.outline.area:
                outer[element.key] = element
    return [of for of in elements if of.outline is None or outer[of.key] is of]


def read_facts(entity: Any) -> dict[str, Any]:
    """Return what the extended data of an entity say: values by names."""
    if not entity.has_xdata(APPLICATION):
        return {}
    values = [tag.value for tag in entity.get_xdata(APPLICATION) if tag.code != 1001]
    return dict(zip(values[::2], values[1::2], strict=False))


def _read_opening(insert: Insert, facts: dict[str, Any], per_unit_m: float) -> Element:
    name = insert.dxf.name.removesuffix(AJAR)
    start_m = np.array([insert.dxf.insert.x, insert.dxf.insert.y]) * per_unit_m
    turn = math.radians(insert.dxf.rotation)
    direction = np.array([math.cos(turn), math.sin(turn)])
    width_m = insert.dxf.xscale * per_unit_m
    line_m = np.array([start_m, start_m + width_m * direction])
    said: dict[str, Any] = {"kind": KINDS.get(name, name.casefold())}
    if name in _HINGES:
        left = np.array([-direction[1], direction[0]]) * math.copysign(1.0, insert.dxf.yscale)
        line_m = line_m - facts.get(WALL_FACT, 0.0) / 2 * left
        said["opens_m"] = line_m[_HINGES[name]] + abs(width_m) * left
    key = str(facts.get("opening", insert.dxf.handle))
    return Element("opening", key, line_m, facts=said)


def _read_stamp(document: Document, insert: Insert, known: dict[str, Any]) -> Element:
    """Return a room by its attributes, or by the text of its block where that was edited."""
    tags = {attribute.dxf.tag: attribute.dxf.text for attribute in insert.attribs}
    block = document.blocks[insert.dxf.name]
    texts = [entity.dxf.text for entity in block if entity.dxftype() == "TEXT"]
    number = tags.get("NUMBER", "")
    facts = {"name": tags.get("NAME", ""), "shown": texts[0] if texts else "", "number": number}
    # stamps of older releases state the plan's own number alone
    return Element("room", str(known.get("room", number or insert.dxf.handle)), facts=facts)


def _find_hosts(elements: list[Element]) -> list[Element]:
    """Return elements with each opening in the wall that is nearest to its middle."""
    walls = [element for element in elements if element.kind == "wall"]
    lines = np.array([shapely.LineString(wall.line_m) for wall in walls], object)

    def host_of(element: Element) -> str:
        assert element.middle is not None
        return walls[int(np.argmin(shapely.distance(lines, element.middle)))].key

    return [
        replace(element, host=host_of(element)) if element.kind == "opening" else element
        for element in elements
    ]


def list_sides(path: FilePath) -> list[FloatArray]:
    """Return the sides of walls (n, 2) that are drawn, metres: outlines without extended data."""
    document = readfile(path)
    per_unit_m = conversion_factor(InsertUnits(document.units), InsertUnits.Meters)
    paths: list[FloatArray] = []
    for entity in document.modelspace():
        if kind_of_layer(entity.dxf.layer) != "wall" or read_facts(entity):
            continue
        if isinstance(entity, LWPolyline):
            corners_m = np.array([c[:2] for c in entity.get_points("xyb")]) * per_unit_m
            closed = [*corners_m, corners_m[0]] if entity.closed else corners_m
            paths.append(np.array(closed))
        elif entity.dxftype() == "LINE":
            ends = [(p.x, p.y) for p in (entity.dxf.start, entity.dxf.end)]
            paths.append(np.array(ends) * per_unit_m)
    return paths
