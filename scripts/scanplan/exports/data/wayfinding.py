"""Rooms and ways in the words of IMDF (Apple, OGC 20-094): layers of a GeoPackage, GeoJSON."""

import uuid
from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports import geojson
from scanplan.exports.data.element_tables import Rows
from scanplan.exports.data.geopackage import Layer
from scanplan.exports.data.room_graph import is_wide
from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan

_NAMESPACE = uuid.UUID("0a1de2c4-7f39-4c55-8a0e-6d2b9c7e1f38")  # any, and always the same
_DOORS = {"door": "unspecified", "passage": "open"}
"""IMDF's types of doors: how a leaf moves is in the building model."""
_HAIR_M = 0.02
_CATEGORIES = frozenset(
    (
        *("auditorium", "classroom", "conferenceroom", "elevator", "escalator", "foodservice"),
        *("kitchen", "laboratory", "library", "lobby", "lounge", "nonpublic", "office", "parking"),
        *("phoneroom", "prayerroom", "ramp", "recreation", "restroom", "room", "shower"),
        *("smokingarea", "stairs", "steps", "storage", "terrace", "theater", "unspecified"),
        *("waitingroom", "walkway"),
    )
)
"""Those of IMDF's categories of units that are rooms of most buildings."""


def imdf_layers(plan: FloorPlan, rows: Mapping[str, Rows], storey: str = "") -> dict[str, Layer]:
    """Return one level, its units and its openings, with IMDF's names of properties.

    Rooms are units, of the category that a person gave as their use, else `room`; doors and
    passages openings of category `pedestrian`, those that are wide enough (`room_graph.is_wide`)
    with accessibility `wheelchair`. The level is what rooms and walls cover. Ids follow from
    GlobalIds, which stand beside them.

    Parameters
    ----------
    rows : dict
        See `element_tables.tabulate_elements`.
    storey : str
        Name of the level, by default that of the plan.
    """
    # rooms end within millimetres of walls: what is left between them is no hole
    built = overlays.unite_areas([*plan.areas, *plan.bodies])
    grown = overlays.buffer_shapes(built, _HAIR_M, join_style="mitre")
    covered = shapely.get_parts(overlays.buffer_shapes(grown, -_HAIR_M, join_style="mitre"))
    level_id = _identify(plan.name, "level")
    rooms, openings = rows["rooms"], rows["openings"]
    ways = np.flatnonzero(np.isin(plan.openings["type"], list(_DOORS))).tolist()
    widths_m = [openings["width_m"][way] for way in ways]
    nominal_m = [openings["nominal_width_m"][way] for way in ways]
    are_wide = map(is_wide, widths_m, nominal_m)
    units: Rows = {
        "id": [_identify(global_id) for global_id in rooms["global_id"]],
        "feature_type": ["unit"] * len(plan.areas),
        "category": [_categorise(use) for use in plan.rooms["use"]],
        "level_id": [level_id] * len(plan.areas),
        "name": rooms["name"],
        "alt_name": [str(number) or None for number in plan.rooms["number"]],
        "global_id": rooms["global_id"],
    }
    doors: Rows = {
        "id": [_identify(openings["global_id"][way]) for way in ways],
        "feature_type": ["opening"] * len(ways),
        "category": ["pedestrian"] * len(ways),
        "level_id": [level_id] * len(ways),
        "door_type": [_DOORS[openings["type"][way]] for way in ways],
        "accessibility": ["wheelchair" if wide else None for wide in are_wide],
        "width_m": widths_m,
        "nominal_width_m": nominal_m,
        "global_id": [openings["global_id"][way] for way in ways],
    }
    levels: Rows = {
        "id": [level_id] * len(covered),
        "feature_type": ["level"] * len(covered),
        "category": ["unspecified"] * len(covered),
        "name": [storey or plan.name] * len(covered),
        "ordinal": [0] * len(covered),
    }
    lines = floorplan.line_shapes(floorplan.centrelines_m(plan.openings)[ways])
    return {
        "imdf_level": Layer("POLYGON", np.asarray(covered, object), levels),
        "imdf_unit": Layer("POLYGON", plan.areas, units),
        "imdf_opening": Layer("LINESTRING", lines, doors),
    }


def format_imdf(
    plan: FloorPlan,
    rows: Mapping[str, Rows],
    site: Site = NOWHERE,
    storey: str = "",
    language: str = "en",
) -> str:
    """Return the same features as the text of a FeatureCollection, placed as `plan.geojson` is.

    Parameters
    ----------
    rows, storey
        As of `imdf_layers`.
    language : str
        Of names, as BCP 47 has it; `und` if not known.
    """
    features = [
        _make_feature(shape, {name: values[row] for name, values in layer.rows.items()}, language)
        for layer in imdf_layers(plan, rows, storey).values()
        for row, shape in enumerate(site.place_shapes(layer.shapes))
    ]
    return geojson.format_collection(plan.name, features, **geojson.state_system(site))


def _make_feature(shape: BaseGeometry, values: dict[str, Any], language: str) -> geojson.Feature:
    """Return a feature as IMDF has it: its type beside its properties, names by language."""
    own = {"id": values.pop("id"), "feature_type": values.pop("feature_type")}
    values |= {key: {language: values[key]} for key in ("name", "alt_name") if values.get(key)}
    if "door_type" in values:
        values["door"] = {"type": values.pop("door_type"), "automatic": False, "material": None}
        values["accessibility"] = [values["accessibility"]] if values["accessibility"] else None
    made = geojson.make_feature(own["id"], shape, values)
    return {**made, **own}


def _categorise(use: str) -> str:
    """Return IMDF's category of a unit for what a person calls its use; `room` of others."""
    return use if use in _CATEGORIES else "room"


def _identify(*words: str) -> str:
    return str(uuid.uuid5(_NAMESPACE, "/".join(words)))
