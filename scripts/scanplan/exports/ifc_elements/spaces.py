"""Rooms, floor and ceilings of a building model."""

import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry.base import BaseGeometry

from scanplan.exports.ifc_elements.storey_plan import (
    EVIDENCE,
    StoreyPlan,
    describe_doubt,
)
from scanplan.exports.ifc_model import IfcModel
from scanplan.exports.model_colours import colour_of
from scanplan.geometry import overlays
from scanplan.plan.floorplan import HEIGHTS, FloorPlan
from scanplan.types import Array


def add_spaces(model: IfcModel, storey: StoreyPlan) -> list[entity_instance]:
    """Add the rooms of a plan, in the order of its table."""
    return [_add_space(model, storey, row) for row in range(len(storey.plan.areas))]


def add_floors(model: IfcModel, storey: StoreyPlan) -> list[entity_instance]:
    """Add a slab below each connected part of rooms and walls, where the floor was seen."""
    plan = storey.plan
    if not np.isfinite(plan.floor_z_m):
        return []
    slabs = []
    parts = floor_parts(plan)
    for number, part in enumerate(parts):
        slab = model.root(
            "IfcSlab",
            (number,),
            Name=model.origin.locale.say(
                "Floor slab"
                if len(parts) == 1
                else f"Floor slab, part {number + 1} of {len(parts)}"
            ),
            ObjectPlacement=_on_floor(model),
            PredefinedType="FLOOR",
        )
        _build_layer(model, slab, part, (-plan.assumed_thickness_m, 0.0), "slab")
        common = {"IsExternal": ("IfcBoolean", False)}
        model.describe(slab, "Pset_SlabCommon", common, unknown=["LoadBearing"])
        _describe_level(model, slab, "floor")
        area_m2 = part.area
        quantities = {
            "Width": plan.assumed_thickness_m,
            "Perimeter": part.length,
            "GrossArea": area_m2,
            "NetArea": area_m2,
            "GrossVolume": area_m2 * plan.assumed_thickness_m,
            "NetVolume": area_m2 * plan.assumed_thickness_m,
        }
        model.measure(slab, "Qto_SlabBaseQuantities", quantities)
        slabs.append(slab)
    return slabs


def floor_parts(plan: FloorPlan) -> Array:
    """Return the connected parts of rooms and walls, Polygons, the largest first."""
    parts = shapely.get_parts(overlays.unite_areas([*plan.areas, *plan.bodies]))
    return parts[np.argsort(-shapely.area(parts), kind="stable")]


def add_ceilings(
    model: IfcModel, storey: StoreyPlan, spaces: list[entity_instance]
) -> list[entity_instance]:
    """Add a ceiling above each room, where the ceiling was seen; none elsewhere."""
    plan = storey.plan
    if plan.height_from != "ceiling":
        return []
    _, height_m = plan.storey_m
    ceilings = []
    for space, area in zip(spaces, plan.areas, strict=True):
        ceiling = model.root(
            "IfcCovering",
            (space.GlobalId,),
            Name=f"{model.origin.locale.say('Ceiling of')} {space.LongName}",
            ObjectPlacement=_on_floor(model),
            PredefinedType="CEILING",
        )
        extent_m = (height_m, height_m + plan.assumed_thickness_m)
        _build_layer(model, ceiling, area, extent_m, "ceiling")
        model.describe(ceiling, "Pset_CoveringCommon", {"IsExternal": ("IfcBoolean", False)})
        _describe_level(model, ceiling, "ceiling")
        quantities = {
            "Width": plan.assumed_thickness_m,
            "GrossArea": area.area,
            "NetArea": area.area,
        }
        model.measure(ceiling, "Qto_CoveringBaseQuantities", quantities)
        model.join("IfcRelCoversSpaces", [ceiling], RelatingSpace=space)
        ceilings.append(ceiling)
    return ceilings


def _add_space(model: IfcModel, storey: StoreyPlan, row: int) -> entity_instance:
    plan = storey.plan
    _, height_m = plan.storey_m
    columns = plan.rooms
    area = plan.areas[row]
    space = model.known(
        "IfcSpace",
        storey.ids["room"][row],
        Name=plan.room_numbers[row],
        LongName=plan.room_names[row],
        ObjectType=str(columns["use"][row]) or None,
        ObjectPlacement=_on_floor(model),
        CompositionType="ELEMENT",
        PredefinedType="INTERNAL",
    )
    _build_layer(model, space, area, (0.0, height_m), colour_of(columns, row, "space"))
    model.describe(space, "Pset_SpaceCommon", {"IsExternal": ("IfcBoolean", False)})
    if use := str(columns["use"][row]):
        occupied = {"OccupancyType": ("IfcLabel", use)}
        model.describe(space, "Pset_SpaceOccupancyRequirements", occupied)
    properties = {
        "Closed": ("IfcBoolean", bool(columns["closed"][row])),
        "HeightFrom": ("IfcLabel", model.origin.locale.say(HEIGHTS[plan.height_from])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
        **describe_doubt(model.origin.locale, columns, row),
    }
    model.describe(space, EVIDENCE, properties)
    area_m2, net_m2 = float(columns["area_m2"][row]), float(plan.net_areas_m2[row])
    perimeter_m = float(columns["perimeter_m"][row])
    quantities = {
        "Height": height_m,
        "GrossPerimeter": perimeter_m,
        "NetPerimeter": perimeter_m,
        "GrossFloorArea": area_m2,
        "NetFloorArea": net_m2,
        "GrossVolume": area_m2 * height_m,
        "NetVolume": net_m2 * height_m,
    }
    model.measure(space, "Qto_SpaceBaseQuantities", quantities)
    return space


def _build_layer(
    model: IfcModel,
    product: entity_instance,
    area: BaseGeometry,
    extent_m: tuple[float, float],
    colour: str,
) -> None:
    """Give a product the shape of an area (map frame) between two heights above the floor."""
    solids = [model.prism(part, *extent_m) for part in shapely.get_parts(area)]
    model.colour(solids, colour)
    product.Representation = model.shape(solids, symbol=model.outline(area))


def _describe_level(model: IfcModel, product: entity_instance, level: str) -> None:
    """State that the height of a surface was seen, and how thick it is was not."""
    properties = {
        "HeightFrom": ("IfcLabel", model.origin.locale.say(level)),
        "ThicknessMeasured": ("IfcBoolean", False),
    }
    model.describe(product, EVIDENCE, properties)


def _on_floor(model: IfcModel) -> entity_instance:
    return model.placement((0, 0, 0), (1, 0), model.storey.ObjectPlacement)
