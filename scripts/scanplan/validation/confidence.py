"""How likely each wall, face, opening and room of a plan exists as it is drawn, and why not.

A logistic model of what is known of an element without any truth, see `element_features.py`: one of
surveys in space, and one of surveys in one plane, which know less. Their coefficients stand in
`confidence_coefficients.py`, which `make bench ARGS="confidence ..."` writes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.plan.floorplan import NUMBERS, FloorPlan, centrelines_m
from scanplan.plan.tolerances import END_M
from scanplan.store import schemas
from scanplan.types import Array, BoolArray, Columns, FloatArray
from scanplan.validation import surroundings
from scanplan.validation.confidence_coefficients import COEFFICIENTS
from scanplan.validation.element_features import (
    FIXED,
    OF_KIND,
    OF_WALL,
    REASONS,
    describe_elements,
)

EXISTENCE, KIND, PLACE, OUTLINE, END, WIDTH = (
    *("existence", "kind", "place", "outline"),
    *("end", "width"),
)
"""What of an element is doubtful: all of it, what it is, where it is, where a room ends; of what is
not to be verified itself, where a wall ends and how wide an opening is."""
NOT_CLOSED = "its outline is not closed: the area is a guess"
"""Why a room is to be verified that is likely enough."""
OF_DOUBTFUL_WALLS = "most of the walls around it are to be verified"
"""Likewise of one that is closed."""
_SIGMAS = 2  # of an end: it lies within so many of them in 19 of 20 cases


def is_planar(plan: FloorPlan) -> bool:
    """Return whether a survey has seen one height alone."""
    return not np.isfinite(plan.least_height_m)


def rate_elements(
    plan: FloorPlan,
    validation: Columns,
    max_sigma_m: float,
    coefficients: Mapping[str, Any] = COEFFICIENTS,
) -> Columns:
    """Return the columns of `schemas.CONFIDENCE` for a plan.

    Parameters
    ----------
    validation : dict of str to (n,) array
        The columns of `schemas.VALIDATION`.
    max_sigma_m : float
        Ends of walls with a greater standard deviation are doubtful.
    coefficients : dict
        As `confidence_coefficients` has them, of `space` and of `plane`: `level`, below which an
        element is to be verified, `most`, which no probability is above, and a model by table.
    """
    described = describe_elements(plan, validation)
    models = coefficients["plane" if is_planar(plan) else "space"]
    held = _find_held(plan)
    rated = {table: _rate_table(described[table], models, table, held) for table in NUMBERS}
    if plan.doubted.rayless:
        # what was learned with rays says nothing without
        for of_table in rated.values():
            of_table.forget(np.ones(len(of_table.p_true), bool))
    _doubt_walls(rated["walls"], plan, max_sigma_m)
    _doubt_openings(rated["openings"], plan)
    for table, of_table in rated.items():
        of_table.leave_out(getattr(plan, table).get("corrected"))
    _doubt_rooms(rated["rooms"], plan, rated["walls"].verify)
    parts = [
        {
            "table": np.full(len(rated[table].p_true), table, object),
            "number": getattr(plan, table)[NUMBERS[table]].astype(np.int32),
            **vars(rated[table]),
        }
        for table in sorted(rated)
    ]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@dataclass(frozen=True, eq=False)
class _Rated:
    """The columns of `schemas.CONFIDENCE` of the elements (n,) of a table; they change in place."""

    p_true: FloatArray
    verify: BoolArray
    about: Array
    doubt: Array
    needs_person: BoolArray

    def add(
        self, where: BoolArray, about: str, words: str | Sequence[str], *, verify: bool = False
    ) -> None:
        """Doubt elements (n,), those that are not doubted so far."""
        chosen = where & (self.about == "")
        self.about[chosen], self.verify[chosen] = about, verify
        self.doubt[chosen] = np.broadcast_to(np.array(words, object), chosen.shape)[chosen]

    def leave_out(self, corrected: Array | None) -> None:
        """Rate none that a person has looked at: nothing is left to verify, and rays say less."""
        if corrected is not None:
            self.forget(corrected != "")

    def forget(self, chosen: BoolArray) -> None:
        """Know nothing of some elements (n,)."""
        self.p_true[chosen], self.verify[chosen] = np.nan, False
        self.about[chosen], self.doubt[chosen], self.needs_person[chosen] = "", "", False


def _rate_table(
    features: Mapping[str, FloatArray],
    models: Mapping[str, Any],
    table: str,
    held: Mapping[str, BoolArray],
) -> _Rated:
    """Rate the elements of a table by its model."""
    model, level = models[table], models["level"]
    p_true, shares = weigh_features(features, model)
    verify = p_true < level
    p_seen, _ = weigh_features(_raise_evidence(features, model, held), model)
    about, doubt = _explain(shares, list(model["features"]), verify)
    return _Rated(
        np.minimum(p_true, models["most"]), verify, about, doubt, verify & (p_seen < level)
    )


def _doubt_walls(rated: _Rated, plan: FloorPlan, max_sigma_m: float) -> None:
    walls = plan.walls
    rated.add(walls["verify"], PLACE, "place uncertain, or hardly seen", verify=True)
    sigma_m = np.fmax(walls["sigma_end0_m"], walls["sigma_end1_m"])
    within_m = np.ceil(10 * _SIGMAS * sigma_m) / 10
    words = [f"the wall is sure, its end within {m:.1f} m" for m in within_m.tolist()]
    rated.add(sigma_m > max_sigma_m, END, words)


def _doubt_openings(rated: _Rated, plan: FloorPlan) -> None:
    is_unknown = plan.openings["type"] == "gap"
    if plan.doubted.rayless:
        # where no rays were recorded a pane may as well be a way out
        is_unknown |= plan.openings["type"] == "glass"
    rated.p_true[is_unknown] = np.nan if plan.doubted.rayless else 0.0
    rated.verify[is_unknown] = True
    rated.about[is_unknown], rated.doubt[is_unknown] = KIND, "not known what it is"
    rated.needs_person[is_unknown] = False
    seen_m = centrelines_m(plan.faces)[plan.faces["state"] == "observed"]
    n_jambs = surroundings.count_joined_ends(centrelines_m(plan.openings), seen_m)
    rated.add(n_jambs < 2, WIDTH, "a jamb was not seen: its width is not sure")


def _doubt_rooms(rated: _Rated, plan: FloorPlan, doubtful_walls: BoolArray) -> None:
    said = np.asarray(plan.rooms.get("corrected", np.full(len(rated.p_true), "")), str)
    by_hand = said != ""
    # who names a room says nothing of its sides
    is_checked = np.array([of.startswith(schemas.CHECKED) for of in said.tolist()], bool)
    rated.add(~plan.rooms["closed"] & ~is_checked, OUTLINE, NOT_CLOSED, verify=True)
    is_weak = _have_doubtful_walls(plan, doubtful_walls) & ~by_hand
    rated.add(is_weak, OUTLINE, OF_DOUBTFUL_WALLS, verify=True)


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
        What is not known of one (NaN) adds nothing.
    model : dict
        `intercept`, and of each feature its `mean` and `weight`.
    """
    names = list(model["features"])
    means = np.array([model["features"][name]["mean"] for name in names])
    weights = np.array([model["features"][name]["weight"] for name in names])
    shares = (np.column_stack([features[name] for name in names]) - means) * weights
    shares = np.nan_to_num(shares, nan=0.0)
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
    for name, known in model["features"].items():
        usual = np.fmax(features[name], known["mean"])
        raised[name] = np.where(held[name], features[name], usual) if name in held else usual
    return raised


def _explain(shares: FloatArray, names: Sequence[str], verify: BoolArray) -> tuple[Array, Array]:
    """Return what of each element to verify is doubtful (n,), and in words (n,) why; else nothing.

    What most speaks against an element says which.
    """
    about, words = (np.full(len(verify), "", object) for _ in range(2))
    for row in np.flatnonzero(verify):
        # two reasons: more are not read
        order = np.argsort(shares[row])[:2]
        worst: list[str] = np.array(names, object)[order[shares[row, order] < 0]].tolist()
        words[row] = ", ".join(REASONS[name] for name in worst) or "little is known of it"
        about[row] = KIND if worst and worst[0] in OF_KIND else EXISTENCE
    return about, words
