"""A building model as elements: the storey in which most walls stand."""

from collections import Counter
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np
import shapely

from scanplan.design.drawn_storey import DrawnOpening, DrawnWall
from scanplan.design.ifc_design import describe_opening, list_storeys
from scanplan.design.ifc_file import IfcBuilding, IfcPart, parse_ifc
from scanplan.edited.elements import Drawing, Element
from scanplan.errors import StageError
from scanplan.exports.ifc_elements.storey_plan import NOMINAL
from scanplan.exports.ifc_elements.walls import JOINED_WALLS
from scanplan.geometry import overlays
from scanplan.project import user_file
from scanplan.types import FilePath, FloatArray

_KNOWN = (
    *("IfcWall", "IfcOpeningElement", "IfcDoor", "IfcWindow", "IfcSpace", "IfcColumn"),
    *("IfcSanitaryTerminal", "IfcElectricAppliance", "IfcStair", "IfcVirtualElement"),
    *("IfcFurnishingElement", "IfcSlab", "IfcCovering", "IfcSpatialElement", "IfcAnnotation"),
)
_GRID_M = 1e-4  # of corners: a tenth of a millimetre
_LEAST_M2 = 1e-6
_THINGS = (
    *("IfcColumn", "IfcFurni", "IfcSystemFurniture", "IfcSanitaryTerminal"),
    *("IfcElectricAppliance", "IfcStair"),
)
_FILLINGS = ("IfcDoor", "IfcWindow")
_BARE = ("passage", "gap")
_OWN_KINDS = {"passage": _BARE, "window": ("window", "glass"), "glass": ("window", "glass")}
"""What of its kind an opening may be that says so itself, as ours do."""
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
    frames = _Frames(model, scale_m)
    straight = {
        wall.guid
        for wall in storey.walls
        if wall.centre_m is None and not _is_bent(model.by_guid(wall.guid))
    }
    elements = [_wall(model, wall) for wall in storey.walls if wall.guid in straight]
    elements += [_bent(frames, guid) for guid in _list_bent(parts, straight)]
    elements += [
        _opening(frames, opening, storey.walls[opening.wall].guid)
        for opening in storey.openings
        if storey.walls[opening.wall].guid in straight
    ]
    known = {element.key for element in elements}
    elements += _list_others(frames, building, storey.floor_m, known)
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


def _wall(model: Any, wall: DrawnWall) -> Element:
    facts = {"thickness_m": wall.thickness_m, "height_m": wall.solid.high_m}
    product = model.by_guid(wall.guid)
    said = ifcopenshell.util.element.get_pset(product, NOMINAL, JOINED_WALLS) or ""
    joined = [piece.split()[-1] for piece in str(said).split(",") if piece.strip()]
    return Element("wall", wall.guid, wall.line_m, facts=facts, joined=joined)


def _list_bent(parts: Mapping[str, IfcPart], straight: Container[str]) -> list[str]:
    return [g for g, p in parts.items() if p.ifc_class == "IfcWall" and g not in straight]


def _is_bent(wall: Any) -> bool:
    """Return whether a wall runs along an arc, by its axis if it has one."""
    return any(
        line.is_a("IfcTrimmedCurve") and line.BasisCurve.is_a("IfcCircle")
        for shape in wall.Representation.Representations
        if shape.RepresentationIdentifier == "Axis"
        for line in shape.Items
    )


@dataclass(frozen=True)
class _Frames:
    """The frames of a model's products."""

    model: Any
    scale_m: float

    def find(self, guid: str) -> tuple[FloatArray, FloatArray]:
        """Return where a product's own frame begins (2,), metres, and the way of its x axis."""
        product = self.model.by_guid(guid)
        placed = ifcopenshell.util.placement.get_local_placement(product.ObjectPlacement)
        return placed[:2, 3] * self.scale_m, placed[:2, 0]

    def lie_along(self, part: IfcPart) -> FloatArray:
        """Return from where to where (2, 2) a part reaches along its own x axis."""
        start_m, direction = self.find(part.guid)
        at_m = (part.triangles_m[..., :2] - start_m) @ direction
        return start_m + np.array([[at_m.min()], [at_m.max()]]) * direction


def _bent(frames: _Frames, guid: str) -> Element:
    """Return a curved wall by where its own axes lie, as it is moved as a whole or not at all."""
    start_m, direction = frames.find(guid)
    return Element("wall", guid, np.array([start_m, start_m + direction]), is_bent=True)


def _opening(frames: _Frames, opening: DrawnOpening, host: str) -> Element:
    product = frames.model.by_guid(opening.guid)
    facts = {"kind": opening.kind, "sill_m": opening.sill_m, "lintel_m": opening.lintel_m}
    own = product.ObjectType
    if own in _OWN_KINDS.get(opening.kind, ()):
        facts["kind"] = own
    operation = getattr(product, "OperationType", None)
    if operation in _HINGES:
        start_m, direction = frames.find(opening.guid)
        width_m = float(np.hypot(*(opening.line_m[1] - opening.line_m[0])))
        at_m = start_m + _HINGES[operation] * width_m * direction
        facts["opens_m"] = at_m + width_m * np.array([-direction[1], direction[0]])
    return Element("opening", opening.guid, opening.line_m, facts=facts, host=host)


def _list_others(
    frames: _Frames, building: IfcBuilding, floor_m: float, known: set[str]
) -> Iterator[Element]:
    """Yield openings of curved walls and of none, along their own axes; of rooms' bounds, too."""
    for part in building.parts:
        guid = part.filler or part.guid
        if guid in known or not (part.kind == "opening" or part.ifc_class in _FILLINGS):
            continue
        known.add(guid)
        z_m = part.triangles_m[..., 2] - floor_m
        extent_m = float(z_m.min()), float(z_m.max())
        opening = describe_opening(part, frames.lie_along(part), extent_m)
        yield _opening(frames, opening, part.host)
    for bound in frames.model.by_type("IfcVirtualElement"):
        if bound.Representation is not None:
            yield _virtual(frames, bound)


def _virtual(frames: _Frames, bound: Any) -> Element:
    """Return where nothing stands between rooms, along its line."""
    start_m, direction = frames.find(bound.GlobalId)
    (line,) = bound.Representation.Representations[0].Items
    corners = line.Points.CoordList if line.is_a("IfcIndexedPolyCurve") else [
        point.Coordinates for point in line.Points
    ]  # fmt: skip
    at_m = frames.scale_m * np.array([corners[0][0], corners[-1][0]])
    facts = {"kind": bound.ObjectType if bound.ObjectType in _BARE else "passage"}
    return Element("opening", bound.GlobalId, start_m + at_m[:, None] * direction, facts=facts)


def _room(space: Any) -> Element:
    facts = {"name": str(space.LongName or space.Name or ""), "use": str(space.ObjectType or "")}
    facts |= {"number": str(space.Name or "")} if space.LongName else {}
    return Element("room", space.GlobalId, facts=facts)


def _is_thing(ifc_class: str) -> bool:
    return ifc_class.startswith(_THINGS)


def _flat(triangle_m: FloatArray) -> shapely.Polygon:
    return shapely.Polygon(triangle_m[:, :2])
