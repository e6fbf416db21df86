"""The plan as a building model: IFC4, one storey."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry import Polygon

from scanplan.exports.ifc_model import Frame, IfcModel
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import FloatArray

_LEAF_M = 0.04  # thickness of a door leaf and a window, usual; nothing thinner is drawn
# ASSUME where the scans show no lintel or sill, metres above the floor
_DOOR_M = 2.0  # a usual door's clear height
_SILL_M = 0.9  # a usual balustrade's height
_ID_DIGITS = 3  # of coordinates in identifiers: a millimetre, below any plan's precision
_FILLED_BY = {"door": "IfcDoor", "window": "IfcWindow"}
_EVIDENCE = "Scanplan_Evidence"  # property set: IFC keeps the prefix Pset_ for its own
_WALL_QUANTITIES = "Qto_WallBaseQuantities"  # IFC4's own
_SPACE_QUANTITIES = "Qto_SpaceBaseQuantities"


def format_ifc(plan: FloorPlan) -> str:
    """Return a plan as the text of an IFC4 file in metres.

    Project, site, building and storey; an IfcWall of every wall, as high as the storey or up to
    where it was seen to end below the ceiling, with what is known of it as properties; an
    IfcOpeningElement with IfcDoor or IfcWindow in its wall; an IfcSpace of every room. Where on
    earth the site lies and where north is are not known and left out.

    Parameters
    ----------
    plan : floorplan.FloorPlan

    Returns
    -------
    str
        The same for the same plan. The GlobalId of a wall, opening or room follows from the plan's
        name and its place, and stays while these do.
    """
    floor_m, _ = plan.storey_m
    model = IfcModel(plan.name, floor_m)
    walls = [_add_wall(model, plan, row) for row in range(len(plan.walls["wall"]))]
    fillings = [
        _add_opening(model, plan, row, walls) for row in range(len(plan.openings["opening"]))
    ]
    model.contain([*walls, *(filling for filling in fillings if filling is not None)])
    spaces = [_add_space(model, plan, row) for row in range(len(plan.rooms["room"]))]
    model.aggregate(model.storey, spaces)
    return model.text()


def _add_wall(model: IfcModel, plan: FloorPlan, row: int) -> entity_instance:
    line = floorplan.centrelines_m(plan.walls)[row]
    height_m = float(plan.heights_m[row])
    frame = Frame(line)
    number = str(plan.walls["wall"][row])
    wall = model.root(
        "IfcWall",
        _id_words(line),
        Name=f"Wall {number}",
        Tag=number,
        ObjectPlacement=frame.placement(model),
        PredefinedType="NOTDEFINED",
    )
    body = model.prism(frame.move_here(plan.bodies[row]), 0.0, height_m)
    wall.Representation = model.shape([body], np.array([(0, 0), (frame.length_m, 0)]))
    _describe_wall(model, plan, row, wall)
    left_m, right_m = plan.sides_m
    quantities = {
        "Length": ("IfcQuantityLength", frame.length_m),
        "Width": ("IfcQuantityLength", float(left_m[row] + right_m[row])),
        "Height": ("IfcQuantityLength", height_m),
    }
    model.measure(wall, _WALL_QUANTITIES, quantities)
    return wall


def _describe_wall(model: IfcModel, plan: FloorPlan, row: int, wall: entity_instance) -> None:
    floor_m, _ = plan.storey_m
    columns = plan.walls
    is_low = bool(plan.low[row])
    height_from = "top of the wall" if is_low else floorplan.HEIGHTS[plan.height_from]

    def known_m(name: str, above_m: float = 0.0) -> tuple[str, float | None]:
        return "IfcLengthMeasure", _known(columns[name][row] - above_m)

    properties = {
        "State": ("IfcLabel", str(columns["state"][row])),
        "VerifyOnSite": ("IfcBoolean", bool(columns["verify"][row])),
        "ThicknessMeasured": ("IfcBoolean", bool(plan.thick[row])),
        "OffsetStandardDeviation": known_m("sigma_offset_m"),
        "StartStandardDeviation": known_m("sigma_end0_m"),
        "EndStandardDeviation": known_m("sigma_end1_m"),
        "Residual": known_m("rmse_m"),
        "HeightMeasured": ("IfcBoolean", is_low or plan.height_from == "ceiling"),
        "HeightFrom": ("IfcLabel", height_from),
        "SeenFromHeight": known_m("z_min_m", floor_m),
        "SeenToHeight": known_m("z_max_m", floor_m),
        "Points": ("IfcInteger", int(columns["n_points"][row])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
    }
    model.describe(wall, _EVIDENCE, properties)


def _add_opening(
    model: IfcModel, plan: FloorPlan, row: int, walls: list[entity_instance]
) -> entity_instance | None:
    """Add an opening to its wall, and return the door or window in it; None of a passage."""
    line = floorplan.centrelines_m(plan.openings)[row]
    frame = Frame(line)
    kind = plan.openings["type"][row]
    extent_m = _vertical_extent_m(plan, row)
    attributes = {
        "Name": f"{kind.capitalize()} {plan.openings['opening'][row]}",
        "ObjectPlacement": frame.placement(model),
    }
    void = None
    host = plan.hosts[row]
    if host >= 0 and plan.gaps[row].intersects(plan.bodies[host]):
        gap = frame.move_here(plan.gaps[row])
        void = _add_void(model, walls[host], line, gap, extent_m, attributes)
    if kind not in _FILLED_BY:
        return None
    filling = _add_filling(model, kind, line, frame.length_m, extent_m, attributes)
    if void is not None:
        model.root(
            "IfcRelFillsElement",
            _id_words(line),
            RelatingOpeningElement=void,
            RelatedBuildingElement=filling,
        )
    _describe_filling(model, plan, row, filling)
    return filling


def _add_void(
    model: IfcModel,
    wall: entity_instance,
    line: FloatArray,
    gap: Polygon,
    extent_m: tuple[float, float],
    attributes: dict[str, Any],
) -> entity_instance:
    """Cut an opening, `gap` in its own frame, out of a wall."""
    key = _id_words(line)
    void = model.root("IfcOpeningElement", key, PredefinedType="OPENING", **attributes)
    void.Representation = model.shape([model.prism(gap, *extent_m)])
    model.root("IfcRelVoidsElement", key, RelatingBuildingElement=wall, RelatedOpeningElement=void)
    return void


def _add_filling(
    model: IfcModel,
    kind: str,
    line: FloatArray,
    width_m: float,
    extent_m: tuple[float, float],
    attributes: dict[str, Any],
) -> entity_instance:
    """Add a door or window."""
    low_m, high_m = extent_m
    filling = model.root(
        _FILLED_BY[kind],
        _id_words(line),
        OverallHeight=high_m - low_m,
        OverallWidth=width_m,
        PredefinedType=kind.upper(),
        **attributes,
    )
    leaf = shapely.box(0, -_LEAF_M / 2, width_m, _LEAF_M / 2)
    filling.Representation = model.shape([model.prism(leaf, low_m, high_m)])
    return filling


def _describe_filling(model: IfcModel, plan: FloorPlan, row: int, filling: entity_instance) -> None:
    columns = plan.openings
    properties = {
        "SillMeasured": ("IfcBoolean", bool(np.isfinite(columns["sill_m"][row]))),
        "LintelMeasured": ("IfcBoolean", bool(np.isfinite(columns["lintel_m"][row]))),
        "Rays": ("IfcInteger", int(columns["n_rays"][row])),
        "JoinsRooms": ("IfcLabel", f"{columns['room_a'][row]} and {columns['room_b'][row]}"),
    }
    model.describe(filling, _EVIDENCE, properties)


def _vertical_extent_m(plan: FloorPlan, row: int) -> tuple[float, float]:
    """Return from where to where above the floor an opening reaches, as usual where not known."""
    columns = plan.openings
    kind = columns["type"][row]
    sill_m = columns["sill_m"][row]
    lintel_m = columns["lintel_m"][row]
    host = plan.hosts[row]
    _, storey_m = plan.storey_m
    wall_m = float(plan.heights_m[host]) if host >= 0 else storey_m
    usual_low_m = _SILL_M if kind == "window" else 0.0
    usual_high_m = wall_m if kind == "passage" else _DOOR_M
    low_m = max(sill_m if np.isfinite(sill_m) else usual_low_m, 0.0)
    high_m = min(lintel_m if np.isfinite(lintel_m) else usual_high_m, wall_m)
    if high_m > low_m + _LEAF_M:
        return float(low_m), float(high_m)
    return 0.0, float(wall_m)


def _add_space(model: IfcModel, plan: FloorPlan, row: int) -> entity_instance:
    _, height_m = plan.storey_m
    columns = plan.rooms
    area = plan.areas[row]
    number = str(columns["room"][row])
    space = model.root(
        "IfcSpace",
        _id_words(shapely.get_coordinates(area)),
        Name=number,
        LongName=f"Room {number}",
        ObjectPlacement=model.placement((0, 0, 0), (1, 0), model.storey.ObjectPlacement),
        CompositionType="ELEMENT",
        PredefinedType="INTERNAL",
    )
    solids = [model.prism(part, 0.0, height_m) for part in shapely.get_parts(area)]
    space.Representation = model.shape(solids)
    properties = {
        "Closed": ("IfcBoolean", bool(columns["closed"][row])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
    }
    model.describe(space, _EVIDENCE, properties)
    quantities = {
        "NetFloorArea": ("IfcQuantityArea", float(columns["area_m2"][row])),
        "NetPerimeter": ("IfcQuantityLength", float(columns["perimeter_m"][row])),
        "Height": ("IfcQuantityLength", height_m),
    }
    model.measure(space, _SPACE_QUANTITIES, quantities)
    return space


def _id_words(coordinates: FloatArray) -> Iterable[float]:
    """Return the words that an identifier follows from: coordinates to a millimetre."""
    # + 0.0 turns a negative zero into zero
    return (np.round(np.asarray(coordinates, float).ravel(), _ID_DIGITS) + 0.0).tolist()


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
