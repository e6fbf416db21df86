"""A building model as elements: the storey in which most walls stand."""

from collections import Counter
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np
import shapely

from scanplan.design.drawn_storey import DrawnStorey, DrawnWall
from scanplan.design.ifc_design import list_storeys
from scanplan.design.ifc_file import parse_ifc
from scanplan.edited.elements import Drawing, Element
from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.project import user_file
from scanplan.types import FilePath, FloatArray

_KNOWN = (
    *("IfcWall", "IfcOpeningElement", "IfcDoor", "IfcWindow", "IfcSpace", "IfcColumn"),
    *("IfcFurnishingElement", "IfcSlab", "IfcCovering", "IfcSpatialElement", "IfcAnnotation"),
)
_GRID_M = 1e-4  # of corners: a tenth of a millimetre
_LEAST_M2 = 1e-6
_HINGES = {"SINGLE_SWING_LEFT": 0, "SINGLE_SWING_RIGHT": 1, "DOUBLE_DOOR_SINGLE_SWING": 0}
"""At which end of its own line a door hangs: it opens to the left of that."""


def read_ifc(path: FilePath) -> Drawing:
    """Read a building model.

    Raises
    ------
    StageError
        If it is no whole model, or has no storey with walls.
    """
    user_file.find_file(path, "name a file")
    data = Path(path).read_bytes()
    building = parse_ifc(data, path)
    storeys = list_storeys(building)
    if not storeys:
        raise StageError(f"{path}: no walls with a shape; export storeys and walls")
    storey = max(storeys, key=lambda of: len(of.walls))
    model: Any = ifcopenshell.file.from_string(data.decode("utf-8", errors="replace"))
    scale_m = ifcopenshell.util.unit.calculate_unit_scale(model)
    parts = {part.guid: part for part in building.parts}
    elements = [_wall(wall) for wall in storey.walls]
    elements += [_bent(model, guid) for guid in _list_bent(parts, storey)]
    elements += [_opening(model, opening, storey.walls, scale_m) for opening in storey.openings]
    elements += [_room(space) for space in model.by_type("IfcSpace")]
    things = {guid: part for guid, part in parts.items() if _is_thing(part.ifc_class)}
    for guid, part in things.items():
        tag = str(model.by_guid(guid).Tag or "")
        flat = [_flat(triangle_m) for triangle_m in part.triangles_m]
        # an upright triangle covers nothing
        ground = overlays.unite_areas([t for t in flat if t.area > _LEAST_M2], grid=_GRID_M)
        kind = "column" if part.ifc_class.startswith("IfcColumn") else "furniture"
        key = tag if tag.isdecimal() else guid
        elements.append(Element("furniture", key, outline=ground, facts={"kind": kind}))
    other = Counter(p.is_a() for p in model.by_type("IfcProduct") if not any(map(p.is_a, _KNOWN)))
    name = str(model.by_type("IfcProject")[0].Name or "") if model.by_type("IfcProject") else ""
    return Drawing(elements, other, name)


def _wall(wall: DrawnWall) -> Element:
    facts = {"thickness_m": wall.thickness_m, "height_m": wall.solid.high_m}
    return Element("wall", wall.guid, wall.line_m, facts=facts)


def _list_bent(parts: Any, storey: DrawnStorey) -> list[str]:
    straight = {wall.guid for wall in storey.walls}
    return [g for g, p in parts.items() if p.ifc_class == "IfcWall" and g not in straight]


def _bent(model: Any, guid: str) -> Element:
    """Return a curved wall by where its own axes lie, as it is moved as a whole or not at all."""
    placed = ifcopenshell.util.placement.get_local_placement(model.by_guid(guid).ObjectPlacement)
    line_m = np.array([placed[:2, 3], placed[:2, 3] + placed[:2, 0]])
    return Element("wall", guid, line_m, is_bent=True)


def _opening(model: Any, opening: Any, walls: Any, scale_m: float) -> Element:
    facts = {"kind": opening.kind, "sill_m": opening.sill_m, "lintel_m": opening.lintel_m}
    product = model.by_guid(opening.guid)
    operation = getattr(product, "OperationType", None)
    if operation in _HINGES:
        placed = ifcopenshell.util.placement.get_local_placement(product.ObjectPlacement)
        start_m, way = placed[:2, 3] * scale_m, placed[:2, 0]
        width_m = float(np.hypot(*(opening.line_m[1] - opening.line_m[0])))
        at_m = start_m + _HINGES[operation] * width_m * way
        facts["opens_m"] = at_m + width_m * np.array([-way[1], way[0]])
    host = walls[opening.wall].guid
    return Element("opening", opening.guid, opening.line_m, facts=facts, host=host)


def _room(space: Any) -> Element:
    facts = {"name": str(space.LongName or space.Name or ""), "use": str(space.ObjectType or "")}
    return Element("room", space.GlobalId, facts=facts)


def _is_thing(ifc_class: str) -> bool:
    return ifc_class.startswith(("IfcColumn", "IfcFurni", "IfcSystemFurniture"))


def _flat(triangle_m: FloatArray) -> shapely.Polygon:
    return shapely.Polygon(triangle_m[:, :2])
