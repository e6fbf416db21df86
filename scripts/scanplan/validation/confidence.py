"""How likely each wall, face, opening and room of a plan exists as it is drawn, and why not.

A logistic model of what is known of an element without any truth: the points, scans and rays that
show it, and how it predicts rays of scans that the plan was not made of. Its coefficients stand in
`confidence_coefficients.py`, which `make bench ARGS="confidence ..."` writes, from simulated
surveys.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy import special

from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import NUMBERS, FloorPlan, centrelines_m
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray
from scanplan.validation.confidence_coefficients import COEFFICIENTS
from scanplan.validation.drawn_surfaces import FACE, OPENING

REASONS = {
    "agreement": "rays of other scans contradict it",
    "worst_span": "rays of other scans contradict a part of it",
    "points": "few points",
    "scans": "few scans",
    "observed": "partly or wholly inferred",
    "length": "short",
    "smooth": "points scatter",
    "two_sided": "one side seen",
    "placed": "place uncertain",
    "kind": "kind uncertain",
    "rays": "few rays",
    "sill": "sill not seen",
    "lintel": "lintel not seen",
    "between_rooms": "leads out of the known rooms",
    "is_door": "a way through, by what rays show",
    "is_pane": "a pane, by what rays show",
    "closed": "not closed by walls",
    "walled": "outline partly not seen",
    "compact": "odd shape",
    "area": "small",
}
"""Features of elements, each the better the greater, and the doubt where one is low."""


def describe_elements(plan: FloorPlan, validation: Columns) -> dict[str, dict[str, FloatArray]]:
    """Return the features of the rows of each table of a plan, (n,) float64 by name.

    Parameters
    ----------
    plan : FloorPlan
    validation : dict of str to (n,) array
        The columns of `schemas.VALIDATION`.
    """
    faces = plan.faces
    length_m = line_lengths_m(centrelines_m(faces))
    agreement, worst = _agreements(validation, FACE, faces["face"])
    is_observed = (faces["state"] == "observed").astype(float)
    of_faces = {
        "agreement": agreement,
        "worst_span": worst,
        "points": np.log1p(faces["n_points"] / np.maximum(length_m, 0.1)),
        "scans": np.log1p(faces["n_scans"]),
        "observed": is_observed,
        "length": np.log(np.maximum(length_m, 0.1)),
        "smooth": -np.nan_to_num(faces["rmse_m"], nan=0.0) * 100,
    }
    return {
        "walls": _describe_walls(plan, length_m, agreement, worst, is_observed),
        "faces": of_faces,
        "openings": _describe_openings(plan, validation),
        "rooms": _describe_rooms(plan, validation),
    }


def _describe_walls(
    plan: FloorPlan,
    length_m: FloatArray,
    agreement: FloatArray,
    worst: FloatArray,
    is_observed: FloatArray,
) -> dict[str, FloatArray]:
    walls = plan.walls
    row_of = {wall: row for row, wall in enumerate(walls["wall"].tolist())}
    host = np.array([row_of.get(wall, -1) for wall in plan.faces["wall"].tolist()], np.int64)
    n = len(walls["wall"])
    has_host = host >= 0
    whole_m = np.bincount(host[has_host], length_m[has_host], n)

    def mean(values: FloatArray) -> FloatArray:
        """Return the mean (n,) of what the faces of each wall have, by their lengths."""
        sums = np.bincount(host[has_host], (values * length_m)[has_host], n)
        return np.divide(sums, whole_m, out=np.zeros(n), where=whole_m > 0)

    least = np.zeros(n)
    np.minimum.at(least, host[has_host], worst[has_host])
    wall_m = line_lengths_m(centrelines_m(walls))
    return {
        "agreement": mean(agreement),
        "worst_span": least,
        "points": np.log1p(walls["n_points"] / np.maximum(wall_m, 0.1)),
        "scans": np.log1p(walls["n_scans"]),
        "observed": mean(is_observed),
        "length": np.log(np.maximum(wall_m, 0.1)),
        "two_sided": plan.thick.astype(float),
        "placed": -np.log(np.maximum(walls["sigma_offset_m"], 1e-3)),
    }


def _describe_openings(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    openings = plan.openings
    agreement, _ = _agreements(validation, OPENING, openings["opening"])
    p_kind = np.nan_to_num(openings["p_kind"], nan=0.5).astype(float)
    is_door = np.isin(openings["type"].astype(str), ("door", "passage"))
    return {
        "agreement": agreement,
        "kind": special.logit(np.clip(p_kind, 0.01, 0.99)),
        "rays": np.log1p(openings["n_rays"]),
        "sill": np.isfinite(openings["sill_m"]).astype(float),
        "lintel": np.isfinite(openings["lintel_m"]).astype(float),
        "between_rooms": (np.minimum(openings["room_a"], openings["room_b"]) >= 0).astype(float),
        "is_door": is_door.astype(float),
        "length": np.log(np.maximum(openings["width_m"], 0.1)),
    }


def _describe_rooms(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    rooms = plan.rooms
    is_outline = validation["kind"] == "outline"
    bare_m = {
        room: line_lengths_m(
            centrelines_m(validation)[is_outline & (validation["number"] == room)]
        ).sum()
        for room in rooms["room"].tolist()
    }
    bare = np.array([bare_m[room] for room in rooms["room"].tolist()], float)
    perimeter_m = np.maximum(rooms["perimeter_m"], 0.1)
    return {
        "closed": rooms["closed"].astype(float),
        "walled": 1 - bare / perimeter_m,
        "scans": np.log1p(rooms["n_scans"]),
        "compact": np.log(4 * np.pi * rooms["area_m2"] / perimeter_m**2),
        "area": np.log(np.maximum(rooms["area_m2"], 0.1)),
    }


def _agreements(validation: Columns, kind: str, numbers: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return logarithms of odds (n,) that rays left out agree with elements, and with their worst.

    Spans that no ray tells of are as likely as not.
    """
    rows = np.flatnonzero(validation["kind"] == kind)
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


def rate_elements(
    plan: FloorPlan, validation: Columns, coefficients: Mapping[str, Any] = COEFFICIENTS
) -> Columns:
    """Return the columns of `schemas.CONFIDENCE` for a plan.

    Parameters
    ----------
    plan : FloorPlan
    validation : dict of str to (n,) array
        The columns of `schemas.VALIDATION`.
    coefficients : dict
        As `confidence_coefficients` has them. They hold where heights above the floor are seen;
        of a plan without them, such as a planar survey's, probabilities are not known (NaN).
    """
    described = describe_elements(plan, validation)
    has_heights = np.isfinite(plan.floor_z_m)
    parts = []
    for table, number in sorted(NUMBERS.items()):
        columns, features = getattr(plan, table), described[table]
        p_true, shares = weigh_features(features, coefficients[table])
        if not has_heights:
            p_true = np.full(len(p_true), np.nan)
        verify = p_true < coefficients[table]["level"]
        doubt = _explain(shares, features, verify)
        if table == "walls":
            is_weak = columns["verify"] & ~verify
            doubt[is_weak] = "place uncertain, or hardly seen"
            verify = verify | is_weak
        if table == "openings":
            is_unknown = columns["type"] == "gap"
            p_true[is_unknown], verify[is_unknown] = 0.0, True
            doubt[is_unknown] = "not known what it is"
        parts.append(
            {
                "table": np.full(len(p_true), table, object),
                "number": columns[number].astype(np.int32),
                "p_true": p_true,
                "verify": verify,
                "doubt": doubt,
            }
        )
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def weigh_features(
    features: Mapping[str, FloatArray], model: Mapping[str, Any]
) -> tuple[FloatArray, FloatArray]:
    """Return probabilities (n,), and what each feature adds to their logits, (n, f).

    Parameters
    ----------
    features : dict of str to (n,) float64
    model : dict
        `intercept`, and of each feature its `mean` and `weight`.
    """
    names = list(model["features"])
    means = np.array([model["features"][name]["mean"] for name in names])
    weights = np.array([model["features"][name]["weight"] for name in names])
    shares = (np.column_stack([features[name] for name in names]) - means) * weights
    return special.expit(model["intercept"] + shares.sum(axis=1)), shares


def _explain(shares: FloatArray, features: Mapping[str, Any], verify: BoolArray) -> Array:
    """Return in words (n,) what most speaks against each element to verify; else nothing."""
    names = np.array(list(features), object)
    words = np.full(len(verify), "", object)
    for row in np.flatnonzero(verify):
        # two reasons: more are not read
        worst = [i for i in np.argsort(shares[row])[:2] if shares[row, i] < 0]
        words[row] = ", ".join(REASONS[name] for name in names[worst]) or "little is known of it"
    return words
