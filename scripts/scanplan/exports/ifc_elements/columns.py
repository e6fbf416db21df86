"""Columns of a building model."""

import numpy as np
import shapely
from ifcopenshell import entity_instance

from scanplan.exports.ifc_elements.storey_plan import EVIDENCE, StoreyPlan
from scanplan.exports.ifc_model import Frame, IfcModel
from scanplan.store.schemas import COLUMN


def add_columns(model: IfcModel, storey: StoreyPlan) -> list[entity_instance]:
    """Add the columns of a plan, as high as the storey, in the order of its table."""
    rows = np.flatnonzero(np.asarray(storey.plan.furniture["kind"]) == COLUMN)
    return [_add_column(model, storey, row) for row in rows.tolist()]


def _add_column(model: IfcModel, storey: StoreyPlan, row: int) -> entity_instance:
    columns = storey.plan.furniture
    outline = shapely.from_wkb(columns["geometry"][row])
    _, height_m = storey.plan.storey_m
    frame = Frame(shapely.get_coordinates(outline)[:2])
    number = str(columns["furniture"][row])
    place = outline.centroid
    column = model.root(
        "IfcColumn",
        (round(place.x, 2), round(place.y, 2)),
        Name=f"{model.origin.locale.title('column')} {number}",
        Tag=number,
        ObjectPlacement=frame.placement(model),
        PredefinedType="COLUMN",
    )
    body = model.prism(frame.move_here(outline), 0.0, height_m)
    model.colour([body], "column")
    around = model.outline(frame.move_here(outline))
    column.Representation = model.shape([body], symbol=around)
    model.describe(
        column, "Pset_ColumnCommon", {"IsExternal": ("IfcBoolean", False)}, unknown=["LoadBearing"]
    )
    evidence = {
        "Points": ("IfcInteger", int(columns["n_points"][row])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
    }
    model.describe(column, EVIDENCE, evidence)
    model.measure(
        column,
        "Qto_ColumnBaseQuantities",
        {
            "Length": height_m,
            "CrossSectionArea": outline.area,
            "GrossVolume": outline.area * height_m,
        },
    )
    return column
