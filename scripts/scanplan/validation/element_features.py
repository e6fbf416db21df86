"""What is known of the elements of a plan without any truth: the model's own posterior, and rays.

`plan/model/` says how likely a surface is a wall and no leaf, furniture or what is outside, how
likely its line is solid, and how likely an opening is of its kind. Rays of scans that the plan was
not made of say the rest. What is not known of an element (NaN) speaks neither for it nor against.
"""

import numpy as np

from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m
from scanplan.plan.model.priors import log_odds
from scanplan.types import Columns, FloatArray, IntArray
from scanplan.validation import surroundings
from scanplan.validation.drawn_surfaces import FACE

REASONS = {
    "thing": "may be a leaf, furniture or what is outside",
    "line": "may be open in part",
    "agreement": "rays of other scans contradict it",
    "worst_span": "rays of other scans contradict a part of it",
    "bounding": "bounds no room",
    "kind": "may be of another kind",
    "host": "its wall may be none",
    "wall": "rays of other scans contradict its wall",
    "rays": "few rays went through",
    "wide": "narrow for what it is",
    "leads": "leads to no known room, or is a window inside",
    "walled": "outline partly not seen",
    "faced": "outline partly without walls",
    "broad": "small or narrow",
    "whole": "may be several rooms",
    "apart": "may be one with a room beside it",
}
"""Features of elements, each the better the greater, and the doubt where one is low."""
OF_KIND = ("thing", "line", "kind")
"""Features that say what an element is, where others say whether it is there."""
FIXED = ("wide", "broad")
"""Features that are the same however often an element is seen."""
OF_WALL = ("host", "wall")
"""Features that an opening in no wall never has."""
_USUAL_M = {"window": 1.0, "glass": 1.0}
_LEAF_M = 0.75
# narrower ones are between things: the least usual leaf (DIN 18101), and windows of the tuning half


def describe_elements(plan: FloorPlan, validation: Columns) -> dict[str, dict[str, FloatArray]]:
    """Return the features of the rows of each table of a plan, (n,) float64 by name.

    Parameters
    ----------
    validation : dict of str to (n,) array
        The columns of `schemas.VALIDATION`.
    """
    faces = _describe_faces(plan, validation)
    walls = _describe_walls(plan, faces["agreement"])
    return {
        "walls": walls,
        "faces": {name: faces[name] for name in ("thing", "line", "worst_span", "bounding")},
        "openings": _describe_openings(plan, walls),
        "rooms": _describe_rooms(plan, validation),
    }


def _describe_faces(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    agreement, worst = _agreements(validation, plan.faces["face"])
    return {
        **{
            name: np.append(odds, np.nan)[plan.face_hosts]
            for name, odds in _odds_of_walls(plan).items()
        },
        "agreement": agreement,
        "worst_span": worst,
        # rooms end at sides that were seen, not at reveals nor at what lies behind
        "bounding": np.where(
            plan.reveals | (plan.faces["state"] == "inferred"),
            np.nan,
            surroundings.share_along(centrelines_m(plan.faces), plan.areas),
        ),
    }


def _odds_of_walls(plan: FloorPlan) -> dict[str, FloatArray]:
    return {"thing": log_odds(plan.walls["p_wall"]), "line": log_odds(plan.walls["p_solid"])}


def _describe_walls(plan: FloorPlan, of_faces: FloatArray) -> dict[str, FloatArray]:
    """Return the features of walls (n,): agreement is that of their faces (m,), by length."""
    host = plan.face_hosts
    has_host = host >= 0
    length_m = np.maximum(line_lengths_m(centrelines_m(plan.faces)), 0.1)[has_host]
    whole_m, sums = (
        np.bincount(host[has_host], values, len(plan.walls["wall"]))
        for values in (length_m, length_m * of_faces[has_host])
    )
    agreement = np.divide(sums, whole_m, out=np.zeros(len(whole_m)), where=whole_m > 0)
    return {**_odds_of_walls(plan), "agreement": agreement}


def _describe_openings(plan: FloorPlan, walls: dict[str, FloatArray]) -> dict[str, FloatArray]:
    openings, is_hosted = plan.openings, plan.hosts >= 0
    kinds = openings["type"].astype(str)
    is_way = np.isin(kinds, WAYS)
    is_inner = np.minimum(openings["room_a"], openings["room_b"]) >= 0
    is_between = is_inner & (openings["room_a"] != openings["room_b"])
    usual_m = np.array([_USUAL_M.get(kind, _LEAF_M) for kind in kinds])
    wide = np.log(np.clip(openings["width_m"], 0.05, usual_m) / usual_m)
    # a passage in no wall is narrow floor: neither wall nor rays are asked of it
    no_wall = np.where(kinds == "passage", np.nan, 0.0)
    return {
        "kind": log_odds(openings["p_kind"]),
        "host": np.where(is_hosted, np.append(walls["thing"], 0.0)[plan.hosts], no_wall),
        "wall": np.where(is_hosted, np.append(walls["agreement"], 0.0)[plan.hosts], no_wall),
        "rays": np.where(is_hosted, np.log1p(openings["n_rays"]), no_wall),
        "wide": wide,
        "leads": np.where(is_way, is_between, ~is_inner).astype(float),
    }


def _describe_rooms(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    rooms = plan.rooms
    is_bare = validation["kind"] == "outline"
    bare_m = _sum_by_room(
        rooms["room"],
        validation["number"][is_bare],
        line_lengths_m(centrelines_m(validation)[is_bare]),
    )
    perimeter_m = np.maximum(rooms["perimeter_m"], 0.1)
    return {
        "walled": 1 - bare_m / perimeter_m,
        "faced": surroundings.share_faced(plan.areas, centrelines_m(plan.faces)),
        "broad": np.log(np.maximum(surroundings.measure_breadth(plan.areas), 0.1)),
        "whole": log_odds(rooms["p_whole"]),
        "apart": log_odds(rooms["p_apart"]),
    }


def _sum_by_room(rooms: IntArray, numbers: IntArray, lengths_m: FloatArray) -> FloatArray:
    """Return the sum (r,) of the lengths that have each room's number."""
    return np.array([lengths_m[numbers == room].sum() for room in rooms.tolist()], np.float64)


def _agreements(validation: Columns, numbers: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return logarithms of odds (n,) that rays left out agree with faces, and with their worst.

    Spans that no ray tells of are as likely as not.
    """
    rows = np.flatnonzero(validation["kind"] == FACE)
    row_of = {number: row for row, number in enumerate(numbers.tolist())}
    element = np.array([row_of.get(number, -1) for number in validation["number"][rows]], np.int64)
    rows, element = rows[element >= 0], element[element >= 0]
    good, all_rays = validation["n_explained"][rows], validation["n_rays"][rows]
    n = len(numbers)
    of_spans = np.log((good + 1) / (all_rays - good + 1))
    worst = np.full(n, np.inf)
    np.minimum.at(worst, element, of_spans)
    sums = (np.bincount(element, values, n) for values in (good, all_rays - good))
    n_good, n_bad = sums
    return np.log((n_good + 1) / (n_bad + 1)), np.where(np.isfinite(worst), worst, 0.0)
