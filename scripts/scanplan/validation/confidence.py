"""How likely each wall, face, opening and room of a plan exists as it is drawn, and why not.

A logistic model of what is known of an element without any truth, see `element_features.py`. Its
coefficients stand in `confidence_coefficients.py`, which `make bench ARGS="confidence ..."` writes,
from simulated surveys.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.plan.floorplan import NUMBERS, FloorPlan
from scanplan.plan.tolerances import END_M
from scanplan.types import Array, BoolArray, Columns, FloatArray
from scanplan.validation.confidence_coefficients import COEFFICIENTS
from scanplan.validation.element_features import (
    FIXED,
    OF_WALL,
    REASONS,
    describe_elements,
)

NOT_CLOSED = "its outline is not closed: the area is a guess"
"""Why a room is to be verified that is likely enough."""
OF_DOUBTFUL_WALLS = "most of the walls around it are to be verified"
"""Likewise of one that is closed."""


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
        As `confidence_coefficients` has them: `level`, below which an element is to be verified,
        and a model by table. They hold where heights above the floor are seen, and rays that were
        left out are others; of a planar survey's plan, or one without rays, probabilities are not
        known (NaN).
    """
    described = describe_elements(plan, validation)
    level = coefficients["level"]
    is_ratable = np.isfinite(plan.floor_z_m) & (not plan.doubted.rayless)
    held = _find_held(plan)
    parts: dict[str, Columns] = {}
    # walls come before the rooms that are judged by them
    for table, number in NUMBERS.items():
        columns, features, model = getattr(plan, table), described[table], coefficients[table]
        p_true, shares = weigh_features(features, model)
        if not is_ratable:
            p_true = np.full(len(p_true), np.nan)
        verify = p_true < level
        p_seen, _ = weigh_features(_raise_evidence(features, model, held), model)
        needs_person = verify & (p_seen < level)
        doubt = _explain(shares, model["features"], verify)
        if table == "walls":
            is_weak = columns["verify"] & ~verify
            doubt[is_weak] = "place or end uncertain, or hardly seen"
            verify = verify | is_weak
        if table == "openings":
            is_unknown = columns["type"] == "gap"
            p_true[is_unknown & is_ratable] = 0.0
            # in one plane beams that never came back say as much of a way out as of a pane, and
            # where none were recorded nothing
            is_unknown |= (columns["type"] == "glass") & ~is_ratable
            verify[is_unknown] = True
            needs_person[is_unknown] = False
            doubt[is_unknown] = "not known what it is"
        if table == "rooms":
            is_open = ~columns["closed"] & ~verify
            doubt[is_open] = NOT_CLOSED
            verify = verify | is_open
            is_weak = _have_doubtful_walls(plan, parts["walls"]["verify"]) & ~verify
            doubt[is_weak] = OF_DOUBTFUL_WALLS
            verify = verify | is_weak
        if "corrected" in columns:
            # a person has looked at it: nothing is left to verify, and rays do not rate it
            is_by_hand = columns["corrected"] != ""
            p_true[is_by_hand], verify[is_by_hand], doubt[is_by_hand] = np.nan, False, ""
            needs_person[is_by_hand] = False
        parts[table] = {
            "table": np.full(len(p_true), table, object),
            "number": columns[number].astype(np.int32),
            "p_true": p_true,
            "verify": verify,
            "doubt": doubt,
            "needs_person": needs_person,
        }
    ordered = [parts[table] for table in sorted(parts)]
    return {name: np.concatenate([part[name] for part in ordered]) for name in ordered[0]}


def _have_doubtful_walls(plan: FloorPlan, verify: BoolArray) -> BoolArray:
    """Return around which rooms (r,) most length of walls is of those (n,) to be verified."""
    outlines = shapely.boundary(plan.areas)
    doubtful, walls = (
        overlays.buffer_shapes(overlays.unite_areas(bodies), END_M)
        for bodies in (plan.bodies[verify], plan.bodies)
    )
    along_doubtful_m, along_m = (
        shapely.length(overlays.intersect_lines(outlines, ground)) for ground in (doubtful, walls)
    )
    return 2 * along_doubtful_m > along_m


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
    logit = model["intercept"] + shares.sum(axis=1)
    return (1 + np.tanh(logit / 2)) / 2, shares


def _find_held(plan: FloorPlan) -> dict[str, BoolArray]:
    """Return, by feature, of which elements no scan betters it."""
    held: dict[str, BoolArray] = dict.fromkeys(FIXED, np.ones(1, bool))
    return held | dict.fromkeys(OF_WALL, plan.hosts < 0)


def _raise_evidence(
    features: Mapping[str, FloatArray], model: Mapping[str, Any], held: Mapping[str, BoolArray]
) -> dict[str, FloatArray]:
    """Return features that are as good as usual, but for those that no scan betters."""
    raised: dict[str, FloatArray] = {}
    for name, values in features.items():
        usual = np.maximum(values, model["features"][name]["mean"])
        raised[name] = np.where(held[name], values, usual) if name in held else usual
    return raised


def _explain(shares: FloatArray, features: Mapping[str, Any], verify: BoolArray) -> Array:
    """Return in words (n,) what most speaks against each element to verify; else nothing."""
    names = np.array(list(features), object)
    words = np.full(len(verify), "", object)
    for row in np.flatnonzero(verify):
        # two reasons: more are not read
        worst = [i for i in np.argsort(shares[row])[:2] if shares[row, i] < 0]
        words[row] = ", ".join(REASONS[name] for name in names[worst]) or "little is known of it"
    return words
