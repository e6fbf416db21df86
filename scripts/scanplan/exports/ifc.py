"""The plan as a building model: IFC4, one storey."""

import math

import numpy as np
import shapely

from scanplan.exports import ifc_model
from scanplan.plan import floorplan

_LEAF_M = 0.04
# ASSUME where the scans show no sill or lintel, metres above the floor
_DOOR_M, _SILL_M = 2.0, 0.9
_FILLED_BY = {"door": "IfcDoor", "window": "IfcWindow"}


def format_ifc(plan):
    """Return a plan as the text of an IFC4 file in metres.

    Project, site, building and storey; an IfcWall of every wall, as high as the storey or up to where it was seen to
    end below the ceiling, with what is known of it as properties; an IfcOpeningElement with IfcDoor or IfcWindow in its
    wall; an IfcSpace of every room. Where on earth the site lies and where north is are not known and left out.

    Parameters
    ----------
    plan : floorplan.FloorPlan

    Returns
    -------
    str
        The same for the same plan. The GlobalId of a wall, opening or room follows from the plan's name and its
        place, and stays while these do.
    """
    floor_m, height_m = plan.storey_m
    model = ifc_model.IfcModel(plan.name, floor_m)
    walls = [_add_wall(model, plan, i) for i in range(len(plan.walls["wall"]))]
    leaves = [
        _add_opening(model, plan, i, height_m, walls) for i in range(len(plan.openings["opening"]))
    ]
    model.contain([*walls, *filter(None, leaves)])
    model.aggregate(
        model.storey, [_add_space(model, plan, i, height_m) for i in range(len(plan.rooms["room"]))]
    )
    return model.text()


def _frame(line):
    """Return the length of a line (2, 2), its way, and a function that moves a shape into its frame."""
    length_m = math.dist(*line)
    along = (line[1] - line[0]) / length_m
    turn = np.array([along, (-along[1], along[0])])
    return (
        length_m,
        along,
        lambda shape: shapely.transform(shape, lambda xy: (xy - line[0]) @ turn.T),
    )


def _add_wall(model, plan, i):
    line, columns, height_m = (
        floorplan.centrelines_m(plan.walls)[i],
        plan.walls,
        float(plan.heights_m[i]),
    )
    length_m, along, local = _frame(line)
    wall = model.root(
        "IfcWall", _place(line), Name=f"Wall {columns['wall'][i]}", Tag=str(columns["wall"][i]),
        ObjectPlacement=model.placement((*line[0], 0), along, model.storey.ObjectPlacement),
        PredefinedType="NOTDEFINED",
    )  # fmt: skip
    wall.Representation = model.shape(
        [model.prism(local(plan.bodies[i]), 0.0, height_m)], [(0, 0), (length_m, 0)]
    )
    floor_m = plan.storey_m[0]
    number = {
        c: _known(columns[c][i])
        for c in ("sigma_offset_m", "sigma_end0_m", "sigma_end1_m", "rmse_m")
    }
    model.describe(wall, "Scanplan_Evidence", {
        "State": ("IfcLabel", str(columns["state"][i])),
        "VerifyOnSite": ("IfcBoolean", bool(columns["verify"][i])),
        "ThicknessMeasured": ("IfcBoolean", bool(plan.thick[i])),
        "OffsetStandardDeviation": ("IfcLengthMeasure", number["sigma_offset_m"]),
        "StartStandardDeviation": ("IfcLengthMeasure", number["sigma_end0_m"]),
        "EndStandardDeviation": ("IfcLengthMeasure", number["sigma_end1_m"]),
        "Residual": ("IfcLengthMeasure", number["rmse_m"]),
        "HeightMeasured": ("IfcBoolean", bool(plan.low[i]) or plan.height_from == "ceiling"),
        "HeightFrom": ("IfcLabel", "top of the wall" if plan.low[i] else floorplan.HEIGHTS[plan.height_from]),
        "SeenFromHeight": ("IfcLengthMeasure", _known(columns["z_min_m"][i] - floor_m)),
        "SeenToHeight": ("IfcLengthMeasure", _known(columns["z_max_m"][i] - floor_m)),
        "Points": ("IfcInteger", int(columns["n_points"][i])),
        "Scans": ("IfcInteger", int(columns["n_scans"][i])),
    })  # fmt: skip
    model.measure(wall, "Qto_WallBaseQuantities", {
        "Length": ("IfcQuantityLength", length_m),
        "Width": ("IfcQuantityLength", float(sum(side[i] for side in plan.sides_m))),
        "Height": ("IfcQuantityLength", height_m),
    })  # fmt: skip
    return wall


def _add_opening(model, plan, i, height_m, walls):
    """Add an opening to its wall, and return the door or window in it; None of a passage or where it is in no wall."""
    line, columns = floorplan.centrelines_m(plan.openings)[i], plan.openings
    kind, host = columns["type"][i], plan.hosts[i]
    height_m = float(plan.heights_m[host]) if host >= 0 else height_m
    low_m, high_m = _heights(kind, columns["sill_m"][i], columns["lintel_m"][i], height_m)
    name, (length_m, along, local) = f"{kind.capitalize()} {columns['opening'][i]}", _frame(line)
    where = model.placement((*line[0], 0), along, model.storey.ObjectPlacement)
    hole = None
    if host >= 0 and plan.gaps[i].intersects(plan.bodies[host]):
        hole = model.root(
            "IfcOpeningElement",
            _place(line),
            Name=name,
            ObjectPlacement=where,
            PredefinedType="OPENING",
        )
        hole.Representation = model.shape([model.prism(local(plan.gaps[i]), low_m, high_m)])
        model.root(
            "IfcRelVoidsElement",
            _place(line),
            RelatingBuildingElement=walls[host],
            RelatedOpeningElement=hole,
        )
    if kind not in _FILLED_BY:
        return None
    leaf = model.root(
        _FILLED_BY[kind], _place(line), Name=name, ObjectPlacement=where,
        OverallHeight=high_m - low_m, OverallWidth=length_m, PredefinedType=kind.upper(),
    )  # fmt: skip
    leaf.Representation = model.shape(
        [model.prism(shapely.box(0, -_LEAF_M / 2, length_m, _LEAF_M / 2), low_m, high_m)]
    )
    if hole is not None:
        model.root(
            "IfcRelFillsElement",
            _place(line),
            RelatingOpeningElement=hole,
            RelatedBuildingElement=leaf,
        )
    model.describe(leaf, "Scanplan_Evidence", {
        "SillMeasured": ("IfcBoolean", _known(columns["sill_m"][i]) is not None),
        "LintelMeasured": ("IfcBoolean", _known(columns["lintel_m"][i]) is not None),
        "Rays": ("IfcInteger", int(columns["n_rays"][i])),
        "JoinsRooms": ("IfcLabel", f"{columns['room_a'][i]} and {columns['room_b'][i]}"),
    })  # fmt: skip
    return leaf


def _heights(kind, sill_m, lintel_m, height_m):
    """Return from where to where above the floor an opening reaches, where not known as is usual."""
    low_m = sill_m if np.isfinite(sill_m) else (_SILL_M if kind == "window" else 0.0)
    usual_m = height_m if kind == "passage" else _DOOR_M
    high_m = min(lintel_m if np.isfinite(lintel_m) else usual_m, height_m)
    low_m = max(low_m, 0.0)
    return (float(low_m), float(high_m)) if high_m > low_m + _LEAF_M else (0.0, float(height_m))


def _add_space(model, plan, i, height_m):
    area, columns = plan.areas[i], plan.rooms
    space = model.root(
        "IfcSpace", _place(shapely.get_coordinates(area)),
        Name=str(columns["room"][i]), LongName=f"Room {columns['room'][i]}",
        ObjectPlacement=model.placement((0, 0, 0), (1, 0), model.storey.ObjectPlacement),
        CompositionType="ELEMENT", PredefinedType="INTERNAL",
    )  # fmt: skip
    space.Representation = model.shape(
        [model.prism(part, 0.0, height_m) for part in shapely.get_parts(area)]
    )
    model.describe(space, "Scanplan_Evidence", {
        "Closed": ("IfcBoolean", bool(columns["closed"][i])), "Scans": ("IfcInteger", int(columns["n_scans"][i])),
    })  # fmt: skip
    model.measure(space, "Qto_SpaceBaseQuantities", {
        "NetFloorArea": ("IfcQuantityArea", float(columns["area_m2"][i])),
        "NetPerimeter": ("IfcQuantityLength", float(columns["perimeter_m"][i])),
        "Height": ("IfcQuantityLength", height_m),
    })  # fmt: skip
    return space


def _place(coordinates):
    """Return the words that an identifier follows from: coordinates to a millimetre."""
    return (np.round(np.asarray(coordinates, float).ravel(), 3) + 0.0).tolist()


def _known(value):
    return float(value) if np.isfinite(value) else None
