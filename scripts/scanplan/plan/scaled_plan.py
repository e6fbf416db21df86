"""A plan in metres of a tape: of a survey whose scale is known to be off."""

from dataclasses import replace

import numpy as np
import shapely

from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.survey_scale import find_factor
from scanplan.types import Array, Columns

_TABLES = ("faces", "walls", "openings", "unseen", "rooms", "free", "furniture")
_POWERS = {"_m": 1, "_m2": 2}
"""Of the scale in columns, by how their names end: lengths, places and heights, and areas."""


def scale_floorplan(plan: FloorPlan) -> FloorPlan:
    """Return a plan whose lengths, places and heights are multiplied by the scale of its survey.

    The map's origin stays where it is; the plan itself where no scale is applied.
    """
    factor = find_factor(plan.scale)
    if factor == 1.0:
        return plan
    tables = {name: scale_columns(getattr(plan, name), factor) for name in _TABLES}
    nearly = [replace(of, ends_m=np.asarray(of.ends_m) * factor) for of in plan.nearly]
    levels_m = {name: factor * getattr(plan, name) for name in ("floor_z_m", "ceiling_z_m")}
    return replace(plan, **tables, **levels_m, nearly=nearly)


def scale_shapes(shapes: Array, factor: float) -> Array:
    """Return shapes (n,) with their coordinates multiplied."""
    return np.asarray(shapely.transform(shapes, lambda xy_m: xy_m * factor), object)


def scale_columns(columns: Columns, factor: float) -> dict[str, Array]:
    """Return the columns of a table likewise, its geometry (WKB) with them."""
    scaled: dict[str, Array] = {}
    for name, values in columns.items():
        power = next((of for end, of in _POWERS.items() if name.endswith(end)), 0)
        if name == "geometry":
            moved = scale_shapes(shapely.from_wkb(np.asarray(values, object)), factor)
            scaled[name] = np.asarray(shapely.to_wkb(moved), object)
        else:
            scaled[name] = values * factor**power if power else values
    return scaled
