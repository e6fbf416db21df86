"""Furniture of a building model, as far as it was seen."""

import numpy as np
import shapely
from ifcopenshell import entity_instance

from scanplan.exports.ifc_elements.storey_plan import EVIDENCE, StoreyPlan, known
from scanplan.exports.ifc_model import IfcModel

_CLASSES = {
    "toilet": ("IfcSanitaryTerminal", "TOILETPAN"),
    "basin": ("IfcSanitaryTerminal", "WASHHANDBASIN"),
    "bath": ("IfcSanitaryTerminal", "BATH"),
    "shower": ("IfcSanitaryTerminal", "SHOWER"),
    "sink": ("IfcSanitaryTerminal", "SINK"),
    "cooker": ("IfcElectricAppliance", "ELECTRICCOOKER"),
    "stairs": ("IfcStair", "NOTDEFINED"),
}
"""What pieces are that a person has named, with their predefined types."""
_LEAST_M = 0.05  # of a piece whose heights were not seen: a plane scan shows one of them


def add_furniture(model: IfcModel, storey: StoreyPlan) -> list[entity_instance]:
    """Add the furniture of a plan, as high as it was seen, in the order of its table."""
    rows = np.flatnonzero(np.asarray(storey.plan.furniture["kind"]) == "furniture")
    return [_add_piece(model, storey, row) for row in rows.tolist()]


def _add_piece(model: IfcModel, storey: StoreyPlan, row: int) -> entity_instance:
    columns = storey.plan.furniture
    floor_m, _ = storey.plan.storey_m
    outline = shapely.from_wkb(columns["geometry"][row])
    number = str(columns["furniture"][row])
    place = outline.centroid
    named = str(columns["named"][row])
    ifc_class, predefined = _CLASSES.get(named, ("IfcFurniture", "NOTDEFINED"))
    piece = model.root(
        ifc_class,
        (round(place.x, 2), round(place.y, 2)),
        Name=f"{model.origin.locale.title(named or 'furniture')} {number}",
        Tag=number,
        ObjectPlacement=model.placement((0, 0, 0), (1, 0), model.storey.ObjectPlacement),
        PredefinedType=predefined,
    )
    top_m = known(float(columns["z_max_m"][row]) - floor_m)
    high_m = max(_LEAST_M, 0.0 if top_m is None else top_m)
    bodies = [model.prism(part, 0.0, high_m) for part in shapely.get_parts(outline)]
    model.colour(bodies, "furniture")
    piece.Representation = model.shape(bodies, symbol=model.outline(outline))
    evidence = {
        "HeightMeasured": ("IfcBoolean", top_m is not None),
        "Points": ("IfcInteger", int(columns["n_points"][row])),
        "Scans": ("IfcInteger", int(columns["n_scans"][row])),
    }
    model.describe(piece, EVIDENCE, evidence)
    return piece
