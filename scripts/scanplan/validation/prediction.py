"""How well a plan predicts rays: over all, and element by element."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.rays.ray_set import RaySet
from scanplan.types import Array, Columns, FloatArray, IntArray
from scanplan.validation.clustered_shares import (
    SIGMAS,
    Shares,
    average_shares,
    estimate_shares,
    number_places,
)
from scanplan.validation.drawn_surfaces import list_surfaces
from scanplan.validation.ray_outcomes import (
    BEYOND,
    EXPLAINED,
    OUTCOMES,
    OUTSIDE,
    PASSED,
    STOPPED,
    RayOutcomes,
    cast_rays,
)

LENGTH, RAYS = "plan_length", "plan_rays"
"""Kinds of the rows that stand for all of the plan, the last two: by drawn length, and by rays."""
_COUNTS = {EXPLAINED: "n_explained", STOPPED: "n_stopped", PASSED: "n_passed", BEYOND: "n_beyond"}


@dataclass(frozen=True, kw_only=True)
class ValidationSettings:
    """What a plan is validated with.

    Attributes
    ----------
    max_scans, max_rays : int, >= 1
        So many of the scans left out, and of their rays, are drawn.
    span_m : float, > 0
        Faces and outlines are judged in spans of at most this length.
    place_m : float, > 0
        Scans taken in one square of this edge count as one, see `clustered_shares`.
    registration_sigma_m : float, > 0
        Standard deviation of a scan's place.
    max_sigma_m : float, > 0
        Ends of walls that have a greater one are doubtful.
    seed : int
    """

    max_scans: int
    registration_sigma_m: float
    max_sigma_m: float
    seed: int
    max_rays: int = 80_000  # of a share they would leave 0.2 %, if each were independent
    span_m: float = 1.0  # about a door's width
    place_m: float = 1.0  # scans of one square see the same


@dataclass(frozen=True, eq=False)
class Validation:
    """What rays say of a plan.

    Attributes
    ----------
    elements, rays : dict of str to (n,) array
        The columns of `schemas.VALIDATION` and `VALIDATION_RAYS`.
    tolerance_m : float
    """

    elements: Columns
    rays: Columns
    tolerance_m: float


def validate_by_rays(plan: FloorPlan, rays: RaySet, settings: ValidationSettings) -> Validation:
    """Compare what rays measured with what a plan predicts of them.

    Parameters
    ----------
    rays : RaySet
        Of scans that the plan was not made of; none at all are an answer, too.
    """
    surfaces = list_surfaces(plan, settings.span_m, planar=rays.planar)
    tolerance_m = find_tolerance(plan.faces, settings.registration_sigma_m)
    found = cast_rays(rays, surfaces, tolerance_m)
    place = number_places(rays.sensors_m[:, :2], settings.place_m)[rays.scan]
    no_element = {
        "number": np.zeros(1, np.int32),
        "span": np.zeros(1, np.int32),
        **dict.fromkeys(("x0_m", "y0_m", "x1_m", "y1_m"), np.full(1, np.nan)),
    }
    told = np.flatnonzero(found.outcome != OUTSIDE)
    lines_m = centrelines_m(surfaces.elements)
    length_m = line_lengths_m(lines_m)
    spoken = (found.element, place[found.row], found.verdict == EXPLAINED)
    parts = [
        dict(surfaces.elements)
        | _count_groups(found.element, found.verdict, len(length_m))
        | _share_columns(estimate_shares(*spoken, len(length_m))),
        {"kind": np.array([LENGTH], object)}
        | no_element
        | _count_groups(np.zeros_like(found.element), found.verdict, 1)
        | _share_columns(average_shares(*spoken, length_m)),
        {"kind": np.array([RAYS], object)}
        | no_element
        | _count_groups(np.zeros_like(told), found.outcome[told], 1)
        | _share_columns(
            estimate_shares(np.zeros_like(told), place[told], found.outcome[told] == EXPLAINED, 1)
        ),
    ]
    elements = {name: np.concatenate([part[name] for part in parts]) for name in parts[-1]}
    return Validation(elements, _ray_columns(rays, found), tolerance_m)


def find_tolerance(faces: Columns, registration_sigma_m: float) -> float:
    """Return how far returns at a surface lie from it in 95 of 100 cases, metres.

    The scans' places err by what registration may be wrong by, ranges by how far the points of the
    plan's faces scatter: the median of their length.

    Parameters
    ----------
    faces : dict of str to (n,) array
        Columns of `schemas.FACES`.
    """
    observed = np.isfinite(faces["rmse_m"])
    noise_m = 0.0
    if observed.any():
        lines_m = centrelines_m(faces)[observed]
        length_m = line_lengths_m(lines_m)
        order = np.argsort(faces["rmse_m"][observed])
        half = np.searchsorted(np.cumsum(length_m[order]), length_m.sum() / 2)
        noise_m = float(faces["rmse_m"][observed][order][half])
    return SIGMAS * float(np.hypot(registration_sigma_m, noise_m))


def explain_absence(found: Validation, n_registered: int, n_left_out: int) -> str:
    """Return why the share of the whole plan is not known; nothing if it is."""
    if np.isfinite(found.elements["share"][-1]):
        return ""
    if n_left_out == 0:
        what = "the only registered scan makes" if n_registered == 1 else "all scans make"
        return f"{what} the plan, none is left to test it"
    if found.elements["n_rays"][-1] == 0:
        return "no ray of the scans left out ends between floor and ceiling"
    return "all scans left out were taken at one place"


def summarise_counts(found: Validation) -> str:
    """Return the share of rays that are explained, and what became of the others."""
    whole = {name: values[-1] for name, values in found.elements.items()}
    shares = [f"{whole[name] / whole['n_rays']:.1%} {name[2:]}" for name in _COUNTS.values()]
    bounds = f"{whole['share_low']:.1%} to {whole['share_high']:.1%}"
    length = f"{found.elements['share'][-2]:.1%} of the drawn length"
    counted = f"{', '.join(shares)} of {whole['n_rays']:,} rays; explained {bounds}"
    return f"{counted}; they agree with {length}, within {found.tolerance_m:.3f} m"


def _count_groups(group: IntArray, outcome: IntArray, n_groups: int) -> dict[str, Array]:
    """Return how many rays of each group came to which end, by column."""
    columns: dict[str, Array] = {"n_rays": np.bincount(group, minlength=n_groups)}
    for code, name in _COUNTS.items():
        columns[name] = np.bincount(group[outcome == code], minlength=n_groups)
    return columns


def _share_columns(shares: Shares) -> dict[str, Array]:
    return {
        "n_places": shares.n_places,
        "share": shares.share,
        "share_low": shares.low,
        "share_high": shares.high,
    }


def _ray_columns(rays: RaySet, found: RayOutcomes) -> dict[str, Array]:
    ends_m: FloatArray = rays.xyz_m
    return {
        "scan_id": rays.scan_ids[rays.scan],
        "ray": np.arange(len(ends_m)) - rays.first[rays.scan],
        **dict(zip(("x_m", "y_m", "z_m"), ends_m.T.copy(), strict=True)),
        "outcome": np.array(OUTCOMES, object)[found.outcome],
    }
