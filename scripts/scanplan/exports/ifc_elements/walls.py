"""Walls of a building model, their types and layers."""

from collections import defaultdict

import numpy as np
from ifcopenshell import entity_instance

from scanplan.exports.data.element_ids import JOINED
from scanplan.exports.ifc_elements.storey_plan import (
    EVIDENCE,
    NOMINAL,
    StoreyPlan,
    describe_doubt,
    known,
)
from scanplan.exports.ifc_model import Frame, IfcModel
from scanplan.exports.model_colours import colour_of
from scanplan.exports.opening_extents import vertical_extent_m
from scanplan.exports.sheet.locale import Locale
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan

JOINED_WALLS = "JoinedWalls"
"""Property of a wall of a regular plan: numbers and GlobalIds of the walls that it is, too."""
_STANDARD = "STANDARD"  # IFC's word for walls of one thickness along their path


def add_walls(model: IfcModel, storey: StoreyPlan) -> list[entity_instance]:
    """Add the walls of a plan, in the order of its table."""
    walls = [_add_wall(model, storey, row) for row in range(len(storey.plan.bodies))]
    _give_types(model, storey, walls)
    return walls


def _add_wall(model: IfcModel, storey: StoreyPlan, row: int) -> entity_instance:
    plan = storey.plan
    height_m = float(plan.heights_m[row])
    frame = Frame(floorplan.centrelines_m(plan.walls)[row])
    circles_m = frame.move_circles_here(plan.circles_m)
    number = str(plan.walls["wall"][row])
    wall = model.known(
        "IfcWall",
        storey.ids["wall"][row],
        Name=_name_wall(model.origin.locale, storey, row),
        Tag=number,
        ObjectPlacement=frame.placement(model),
    )
    body = model.prism(frame.move_here(plan.bodies[row]), 0.0, height_m, circles_m)
    state = "wall" if plan.walls["state"][row] == "observed" else "inferred wall"
    model.colour([body], colour_of(plan.walls, row, state))
    axis = np.array([(0, 0), (frame.length_m, 0)])
    centre_m = frame.place_here(plan.wall_shapes.centres_m[row])
    curve = model.arc(axis, centre_m) if plan.wall_shapes.is_bent[row] else None
    around = model.outline(frame.move_here(plan.bodies[row]), circles_m)
    wall.Representation = model.shape([body], axis, curve, around)
    if model.is_editable:
        wall.PredefinedType = _STANDARD
    common = {"IsExternal": ("IfcBoolean", bool(storey.external[row]))}
    model.describe(wall, "Pset_WallCommon", common, unknown=["LoadBearing"])
    _describe_wall(model, storey, row, wall)
    _measure_wall(model, storey, row, wall)
    return wall


def _name_wall(locale: Locale, storey: StoreyPlan, row: int) -> str:
    """Return the number that a wall has in tables and on sheets, and what tells it from others."""
    plan = storey.plan
    thickness_m = float(plan.walls["thickness_m"][row])
    radius_m = float(plan.walls["arc_radius_m"][row])
    words = [
        f"{locale.title('wall')} {plan.walls['wall'][row]}",
        "exterior" if storey.external[row] else "interior",
        locale.size(thickness_m) if storey.is_thickness_measured[row] else "thickness assumed",
        f"radius {locale.measure(radius_m)}" if plan.wall_shapes.is_bent[row] else "",
        f"{locale.measure(float(plan.heights_m[row]))} high" if plan.low[row] else "",
        "inferred" if plan.walls["state"][row] == "inferred" else "",
    ]
    return ", ".join(map(locale.say, filter(None, words)))


def _measure_wall(model: IfcModel, storey: StoreyPlan, row: int, wall: entity_instance) -> None:
    plan = storey.plan
    length_m = float(plan.lengths_m[row])
    height_m = float(plan.heights_m[row])
    left_m, right_m = plan.sides_m
    body = plan.bodies[row]
    open_m2, open_m3 = _cut_out(plan, row)
    # doors and passages reach the floor, where windows have wall below them
    open_areas = plan.gaps[(plan.hosts == row) & (plan.openings["type"] != "window")]
    model.measure(
        wall,
        "Qto_WallBaseQuantities",
        {
            "Length": length_m,
            "Width": left_m[row] + right_m[row],
            "Height": height_m,
            "GrossFootprintArea": body.area,
            "NetFootprintArea": overlays.subtract_areas(
                body, overlays.unite_areas(open_areas)
            ).area,
            "GrossSideArea": length_m * height_m,
            "NetSideArea": length_m * height_m - open_m2,
            "GrossVolume": body.area * height_m,
            "NetVolume": body.area * height_m - open_m3,
        },
    )


def _cut_out(plan: FloorPlan, row: int) -> tuple[float, float]:
    """Return the area, seen from the side, and the volume of the openings in a wall."""
    area_m2 = volume_m3 = 0.0
    for opening in np.flatnonzero(plan.hosts == row).tolist():
        low_m, high_m = vertical_extent_m(plan, opening)
        area_m2 += float(plan.openings["width_m"][opening]) * (high_m - low_m)
        volume_m3 += overlays.intersect_areas(plan.bodies[row], plan.gaps[opening]).area * (
            high_m - low_m
        )
    return area_m2, volume_m3


def _describe_wall(model: IfcModel, storey: StoreyPlan, row: int, wall: entity_instance) -> None:
    plan, locale = storey.plan, model.origin.locale
    floor_m, _ = plan.storey_m
    columns = plan.walls
    is_low = bool(plan.low[row])
    is_thick = storey.is_thickness_measured[row]
    height_from = "top of the wall" if is_low else floorplan.HEIGHTS[plan.height_from]

    def known_m(name: str, above_m: float = 0.0) -> tuple[str, float | None]:
        return "IfcLengthMeasure", known(columns[name][row] - above_m)

    properties = {
        "State": ("IfcLabel", locale.say(str(columns["state"][row]))),
        **describe_doubt(locale, columns, row),
        "ThicknessMeasured": ("IfcBoolean", bool(is_thick and columns["n_points"][row])),
        "OffsetStandardDeviation": known_m("sigma_offset_m"),
        "Radius": known_m("arc_radius_m"),
        "RadiusStandardDeviation": known_m("sigma_radius_m"),
        "StartStandardDeviation": known_m("sigma_end0_m"),
        "EndStandardDeviation": known_m("sigma_end1_m"),
        "Residual": known_m("rmse_m"),
        "HeightMeasured": ("IfcBoolean", is_low or plan.height_from == "ceiling"),
        "HeightFrom": ("IfcLabel", locale.say(height_from)),
        "SeenFromHeight": known_m("z_min_m", floor_m),
        "SeenToHeight": known_m("z_max_m", floor_m),
        "Points": ("IfcInteger", int(columns["n_points"][row])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
    }
    model.describe(wall, EVIDENCE, properties)
    if storey.catalogue is not None:
        model.describe(wall, NOMINAL, _list_changes(locale, storey, row))


def _list_changes(
    locale: Locale, storey: StoreyPlan, row: int
) -> dict[str, tuple[str, str | float | None]]:
    """Return what a wall of a regular plan was, and what it has been changed by."""
    columns = storey.plan.walls
    changed_m = float(columns["thickness_changed_m"][row])
    measured_m = known(columns["thickness_m"][row] - changed_m)
    return {
        "ThicknessFrom": ("IfcLabel", locale.say(str(columns["thickness_from"][row]))),
        "MeasuredThickness": (
            "IfcLengthMeasure",
            measured_m if storey.is_thickness_measured[row] else None,
        ),
        "ThicknessDeviation": ("IfcLengthMeasure", changed_m),
        "Displacement": ("IfcLengthMeasure", float(columns["moved_m"][row])),
        "Rotation": ("IfcPlaneAngleMeasure", float(np.radians(columns["turned_deg"][row]))),
        "PerhapsFurniture": ("IfcBoolean", bool(columns["perhaps"][row])),
        JOINED_WALLS: ("IfcText", str(storey.ids.get(JOINED, columns[JOINED])[row]) or None),
    }


def _give_types(model: IfcModel, storey: StoreyPlan, walls: list[entity_instance]) -> None:
    """Give walls of one nominal thickness, measured or assumed, a type with a layer of it."""
    left_m, right_m = storey.plan.sides_m
    rows_of = defaultdict(list)
    for row, is_thick in enumerate(storey.is_thickness_measured.tolist()):
        name, thickness_m = storey.name_type("walls", left_m[row] + right_m[row])
        # what is assumed is of no maker
        rows_of[is_thick, thickness_m, name if is_thick else ""].append(row)
    for (is_thick, thickness_m, listed), rows in sorted(rows_of.items()):
        locale = model.origin.locale
        assumed = "" if is_thick else f", {locale.say('thickness assumed')}"
        own = f"{locale.title('wall')} {locale.size(thickness_m)}"
        name = (listed or own) + assumed
        not_known = locale.title("not known") + assumed
        material = model.new("IfcMaterial", not_known, None, locale.say("not known"))
        layer = model.new("IfcMaterialLayer", material, thickness_m)
        layers = model.new("IfcMaterialLayerSet", [layer], name)
        predefined = _STANDARD if model.is_editable else "NOTDEFINED"
        wall_type = model.root("IfcWallType", (name,), Name=name, PredefinedType=predefined)
        if code := storey.find_code("walls", listed):
            model.classify([wall_type, *(walls[row] for row in rows)], code)
        model.join("IfcRelAssociatesMaterial", [wall_type], RelatingMaterial=layers)
        model.join("IfcRelDefinesByType", [walls[row] for row in rows], RelatingType=wall_type)
        for row in rows:
            # the layer lies to the left of a line on the right surface
            usage = model.new(
                "IfcMaterialLayerSetUsage", layers, "AXIS2", "POSITIVE", -float(right_m[row])
            )
            model.join("IfcRelAssociatesMaterial", [walls[row]], RelatingMaterial=usage)
