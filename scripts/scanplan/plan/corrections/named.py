"""What a person says that scans do not: how doors open, and what pieces of furniture are."""

import numpy as np
import shapely

from scanplan.geometry.lines import left_normals
from scanplan.plan import plan_tables
from scanplan.plan.corrections import added
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.tolerances import HINGE_M, WIDEST_LEAF_M
from scanplan.project.corrections_file import Correction
from scanplan.store import schemas
from scanplan.types import FloatArray

_SLIDING_DOOR = "sliding door"
_SWEPT = 1.5  # widths of a door: where its leaf cannot stand, nobody means it


def hang_leaf(rows: PlanRows, opening: Row, correction: Correction) -> str | None:
    """Let a door slide or swing as a person says; what was seen of its leaves goes.

    Returns
    -------
    str or None
        Why it was not done.
    """
    is_sliding = opening["type"] == _SLIDING_DOOR
    if is_sliding:
        opening["type"] = "door"
    if not is_sliding and correction.swing_m is None:
        return None
    if opening["type"] != "door":
        return f"is a {opening['type']}, which does not swing; leave `swing` out"
    jambs_m = added.ends_of(opening)
    if correction.swing_m is None or is_sliding:
        _replace_leaves(rows, jambs_m, jambs_m, schemas.SLIDING)
        return None
    swing_m = np.array(correction.swing_m)
    apart_m = np.hypot(*(jambs_m - swing_m).T)
    width_m = float(np.hypot(*(jambs_m[1] - jambs_m[0])))
    if apart_m.min() > _SWEPT * width_m:
        return f"is {apart_m.min():.1f} m from `swing`; give a place beside the door"
    hinge_m = jambs_m[np.argmin(apart_m)]
    left = left_normals(jambs_m[None])[0]
    side = np.sign((swing_m - hinge_m) @ left) or 1.0
    leaf_m = width_m / (2 if width_m > WIDEST_LEAF_M else 1)
    _replace_leaves(rows, jambs_m, np.stack([hinge_m, hinge_m + side * leaf_m * left]))
    return None


def _replace_leaves(
    rows: PlanRows, jambs_m: FloatArray, leaf_m: FloatArray, said: str = ""
) -> None:
    """Put a leaf (2, 2) in place of those that hang at the jambs (2, 2) of a door."""
    jambs = shapely.MultiPoint(jambs_m)
    rows.furniture = [
        row
        for row in rows.furniture
        if row["kind"] != schemas.LEAF
        or shapely.distance(shapely.from_wkb(row["geometry"]), jambs) > HINGE_M
    ]
    number = rows.next_number("furniture")
    rows.furniture.append({"furniture": number, **plan_tables.leaf_columns(leaf_m, said)})
