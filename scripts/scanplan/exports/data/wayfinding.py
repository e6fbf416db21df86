"""Rooms and ways in the words of IMDF (Apple, OGC 20-094), as layers of a GeoPackage."""

import uuid
from collections.abc import Mapping

import numpy as np
import shapely

from scanplan.exports.data.element_tables import Rows
from scanplan.exports.data.geopackage import Layer
from scanplan.exports.data.room_graph import WHEELCHAIR_M
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan

_NAMESPACE = uuid.UUID("0a1de2c4-7f39-4c55-8a0e-6d2b9c7e1f38")  # any, and always the same
_DOORS = {"door": "unspecified", "passage": "open"}
"""IMDF's types of doors: how a leaf moves is in the building model."""


def imdf_layers(plan: FloorPlan, rows: Mapping[str, Rows]) -> dict[str, Layer]:
    """Return one level, its units and its openings, with IMDF's names of properties.

    Rooms are units of category `room`, doors and passages openings of category `pedestrian`, those
    at least 0.9 m wide with accessibility `wheelchair`. The level is what rooms and walls cover.
    Ids follow from GlobalIds, which stand beside them.

    Parameters
    ----------
    rows : dict
        See `element_tables.tabulate_elements`.
    """
    covered = shapely.get_parts(overlays.unite_areas([*plan.areas, *plan.bodies]))
    level_id = _identify(plan.name, "level")
    rooms, openings = rows["rooms"], rows["openings"]
    ways = np.flatnonzero(np.isin(plan.openings["type"], list(_DOORS))).tolist()
    widths_m = [openings["width_m"][way] for way in ways]
    units: Rows = {
        "id": [_identify(global_id) for global_id in rooms["global_id"]],
        "feature_type": ["unit"] * len(plan.areas),
        "category": ["room"] * len(plan.areas),
        "level_id": [level_id] * len(plan.areas),
        "name": rooms["name"],
        "global_id": rooms["global_id"],
    }
    doors: Rows = {
        "id": [_identify(openings["global_id"][way]) for way in ways],
        "feature_type": ["opening"] * len(ways),
        "category": ["pedestrian"] * len(ways),
        "level_id": [level_id] * len(ways),
        "door_type": [_DOORS[openings["type"][way]] for way in ways],
        "accessibility": ["wheelchair" if w >= WHEELCHAIR_M else None for w in widths_m],
        "width_m": widths_m,
        "global_id": [openings["global_id"][way] for way in ways],
    }
    levels: Rows = {
        "id": [level_id] * len(covered),
        "feature_type": ["level"] * len(covered),
        "category": ["unspecified"] * len(covered),
        "name": [plan.name] * len(covered),
        "ordinal": [0] * len(covered),
    }
    lines = floorplan.line_shapes(floorplan.centrelines_m(plan.openings)[ways])
    return {
        "imdf_level": Layer("POLYGON", np.asarray(covered, object), levels),
        "imdf_unit": Layer("POLYGON", plan.areas, units),
        "imdf_opening": Layer("LINESTRING", lines, doors),
    }


def _identify(*words: str) -> str:
    return str(uuid.uuid5(_NAMESPACE, "/".join(words)))
