"""Openings of a building model, and the doors and windows in them."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry import Polygon

from scanplan.exports.ifc_elements.storey_plan import (
    EVIDENCE,
    NOMINAL,
    StoreyPlan,
    describe_doubt,
)
from scanplan.exports.ifc_model import Frame, IfcModel
from scanplan.exports.model_colours import colour_of
from scanplan.exports.opening_extents import LEAF_M, vertical_extent_m
from scanplan.exports.sheet.leaves import Swing
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.marks import Symbol
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import WAYS

_FILLED_BY = {"door": "IfcDoor", "window": "IfcWindow", "glass": "IfcWindow"}
_LISTED_AS = {"door": "doors", "window": "windows"}  # lists of the catalogue
_OPERATIONS = {
    "SWING-LEFT": "SINGLE_SWING_LEFT",
    "SWING-RIGHT": "SINGLE_SWING_RIGHT",
    "SWING-2": "DOUBLE_DOOR_SINGLE_SWING",
    # to which side is not known
    "SLIDING": "USERDEFINED",
}
"""IFC's words for how doors open, by the block that they are drawn with."""


@dataclass(frozen=True)
class Opening:
    """An opening of the plan as the model has it.

    Attributes
    ----------
    void : entity or None
        The IfcOpeningElement in its wall; None if it is in none.
    filling : entity or None
        What stands in the storey: the door or window; of a passage in no wall an IfcVirtualElement,
        None of one in a wall.
    """

    void: entity_instance | None
    filling: entity_instance | None

    @property
    def element(self) -> entity_instance | None:
        """What bounds the rooms here: the filling, or else the void."""
        return self.filling or self.void


def add_openings(
    model: IfcModel, storey: StoreyPlan, walls: list[entity_instance]
) -> list[Opening]:
    """Add the openings of a plan, in the order of its table."""
    rows = range(len(storey.plan.openings["opening"]))
    openings = [_add_opening(model, storey, row, walls) for row in rows]
    _give_types(model, storey, openings)
    return openings


def _add_opening(
    model: IfcModel, storey: StoreyPlan, row: int, walls: list[entity_instance]
) -> Opening:
    plan = storey.plan
    line_m = floorplan.centrelines_m(plan.openings)[row]
    swing = storey.swings.get(row)
    # a door opens to the left of its own line
    frame = Frame(line_m[::-1] if swing is not None and swing.is_reversed else line_m)
    kind = plan.openings["type"][row]
    extent_m = vertical_extent_m(plan, row)
    attributes = {
        "Name": _name_opening(model.origin.locale, storey, row),
        "Tag": str(plan.openings["opening"][row]),
        "ObjectType": str(kind),
        "ObjectPlacement": frame.placement(model),
    }
    global_id = storey.ids["opening"][row]
    void = None
    host = plan.hosts[row]
    if host >= 0 and plan.gaps[row].intersects(plan.bodies[host]):
        # a passage is its opening; that of a door or window is known by it
        own_id = global_id if kind not in _FILLED_BY else model.guid("void", global_id)
        hole = frame.move_here(plan.gaps[row])
        void = _add_void(model, own_id, hole, extent_m, attributes)
        if kind in _FILLED_BY:
            said = model.origin.locale.say
            void.Name = f"{said('Opening of')} {said(kind)} {attributes['Tag']}"
        model.join("IfcRelVoidsElement", void, RelatingBuildingElement=walls[host])
        _describe_opening(model, storey, row, void)
        cut = overlays.intersect_areas(plan.bodies[host], plan.gaps[row])
        depth_m = float(shapely.area(cut)) / frame.length_m
        _measure_void(model, void, frame.length_m, extent_m, depth_m)
    if kind not in _FILLED_BY:
        if void is not None:
            return Opening(void, None)
        return Opening(None, _add_bound(model, storey, row, frame, attributes))
    colour = colour_of(plan.openings, row, kind)
    if model.is_editable:
        attributes["PredefinedType"] = "DOOR" if kind == "door" else "WINDOW"
    if swing is not None:
        attributes |= _state_operation(_OPERATIONS[swing.way])
    thickness_m = float(plan.openings["thickness_m"][row])
    if np.isnan(thickness_m):
        thickness_m = plan.assumed_thickness_m
    symbol = _list_curves(model, kind, frame.length_m, thickness_m, swing)
    attributes["OverallHeight"] = extent_m[1] - extent_m[0]
    attributes["OverallWidth"] = frame.length_m
    filling = model.known(_FILLED_BY[kind], global_id, **attributes)
    leaf = model.prism(shapely.box(0, -LEAF_M / 2, frame.length_m, LEAF_M / 2), *extent_m)
    model.colour([leaf], colour)
    filling.Representation = model.shape([leaf], symbol=symbol if model.is_editable else ())
    if void is not None:
        model.join("IfcRelFillsElement", filling, RelatingOpeningElement=void)
    _describe_filling(model, storey, row, filling)
    return Opening(void, filling)


def _state_operation(operation: str) -> dict[str, str]:
    """Return the attributes that say how a door, or a type of doors, opens."""
    own = {"UserDefinedOperationType": "SLIDING"} if operation == "USERDEFINED" else {}
    return {"OperationType": operation, **own}


def _name_opening(locale: Locale, storey: StoreyPlan, row: int) -> str:
    """Return the number that an opening has in tables, its width, and what it joins."""
    columns = storey.plan.openings
    kind, width_m = columns["type"][row], float(columns["width_m"][row])
    joined = storey.name_joined_rooms(row)
    if len(joined) == 1 and kind in WAYS and storey.leads_outside(row):
        joined = [*joined, locale.say("outside")]
    noun = locale.title(kind)
    words = [f"{noun} {columns['opening'][row]}", locale.measure(width_m)]
    return ", ".join([*words, *filter(None, [f" {locale.say('to')} ".join(joined)])])


def _add_void(
    model: IfcModel,
    global_id: str,
    hole: Polygon,
    extent_m: tuple[float, float],
    attributes: dict[str, Any],
) -> entity_instance:
    """Add an opening, `hole` in its own frame."""
    void = model.known("IfcOpeningElement", global_id, PredefinedType="OPENING", **attributes)
    void.Representation = model.shape([model.prism(hole, *extent_m)])
    return void


def _add_bound(
    model: IfcModel, storey: StoreyPlan, row: int, frame: Frame, attributes: Mapping[str, Any]
) -> entity_instance:
    """Add where rooms end and nothing stands: a line."""
    global_id = storey.ids["opening"][row]
    bound = model.known("IfcVirtualElement", global_id, **attributes)
    line_m = np.array([(0.0, 0.0), (frame.length_m, 0.0)])
    bound.Representation = model.shape([], line_m)
    _describe_opening(model, storey, row, bound)
    return bound


def _list_curves(
    model: IfcModel, kind: str, width_m: float, thickness_m: float, swing: Swing | None
) -> list[entity_instance]:
    """Return what a door or window is drawn with in plan, in its own frame."""
    # hinged in the side of the wall that it opens to
    y_m = 0.0 if swing is None or swing.block == "SLIDING" else thickness_m / 2
    ends_m = np.array([[0.0, y_m], [width_m, y_m]])
    symbol = Symbol(kind, ends_m, thickness_m, "", "")
    if swing is not None:
        symbol = replace(symbol, kind="swing", block=swing.block)
    return [model.path(path) for path in symbol_paths(symbol)]


def _measure_void(
    model: IfcModel,
    void: entity_instance,
    width_m: float,
    extent_m: tuple[float, float],
    depth_m: float,
) -> None:
    height_m = extent_m[1] - extent_m[0]
    area_m2 = width_m * height_m
    quantities = {
        "Width": width_m,
        "Height": height_m,
        "Depth": depth_m,
        "Area": area_m2,
        "Volume": area_m2 * depth_m,
    }
    model.measure(void, "Qto_OpeningElementBaseQuantities", quantities)


def _describe_filling(
    model: IfcModel, storey: StoreyPlan, row: int, filling: entity_instance
) -> None:
    noun = filling.is_a().removeprefix("Ifc")
    common = {"IsExternal": ("IfcBoolean", storey.leads_outside(row))}
    model.describe(filling, f"Pset_{noun}Common", common)
    width_m, height_m = filling.OverallWidth, filling.OverallHeight
    quantities = {
        "Width": width_m,
        "Height": height_m,
        "Perimeter": 2 * (width_m + height_m),
        "Area": width_m * height_m,
    }
    model.measure(filling, f"Qto_{noun}BaseQuantities", quantities)
    _describe_opening(model, storey, row, filling)


def _describe_opening(
    model: IfcModel, storey: StoreyPlan, row: int, product: entity_instance
) -> None:
    columns, locale = storey.plan.openings, model.origin.locale
    joined = f" {locale.say('and')} ".join(storey.name_joined_rooms(row))
    properties = {
        **describe_doubt(locale, columns, row),
        "SillMeasured": ("IfcBoolean", bool(np.isfinite(columns["sill_m"][row]))),
        "LintelMeasured": ("IfcBoolean", bool(np.isfinite(columns["lintel_m"][row]))),
        "Rays": ("IfcInteger", int(columns["n_rays"][row])),
        "JoinsRooms": ("IfcLabel", joined or None),
    }
    model.describe(product, EVIDENCE, properties)
    if storey.catalogue is not None:
        changed_m = float(columns["width_changed_m"][row])
        changes = {
            "MeasuredWidth": ("IfcLengthMeasure", float(columns["width_m"][row]) - changed_m),
            "WidthDeviation": ("IfcLengthMeasure", changed_m),
        }
        model.describe(product, NOMINAL, changes)


def _give_types(model: IfcModel, storey: StoreyPlan, openings: list[Opening]) -> None:
    """Give doors that open alike, and windows, of one nominal width a type."""
    kinds = storey.plan.openings["type"]
    fillings_of = defaultdict(list)
    for kind, opening in zip(kinds, openings, strict=True):
        filling = opening.filling
        if filling is not None and kind in _FILLED_BY:
            name, width_m = storey.name_type(_LISTED_AS.get(kind, ""), filling.OverallWidth)
            operation = (filling.OperationType if kind == "door" else None) or "NOTDEFINED"
            fillings_of[kind, width_m, operation, name].append(filling)
    for (kind, width_m, operation, listed), fillings in sorted(fillings_of.items()):
        of_doors = kind == "door"
        locale = model.origin.locale
        name = listed or f"{locale.title(kind)} {locale.size(width_m)}"
        if operation != "NOTDEFINED":
            words = operation.lower().replace("_", " ").replace("userdefined", "sliding")
            name += f", {locale.say(words)}"
        attributes = {"PredefinedType": "DOOR" if of_doors else "WINDOW"}
        attributes |= _state_operation(operation) if of_doors else {"PartitioningType": operation}
        product_type = model.root(f"{_FILLED_BY[kind]}Type", (name,), Name=name, **attributes)
        if code := storey.find_code(_LISTED_AS.get(kind, "windows"), listed):
            model.classify([product_type, *fillings], code)
        model.join("IfcRelDefinesByType", fillings, RelatingType=product_type)
