"""The report's sentences and head figures."""

import math
from collections.abc import Sequence

import numpy as np

from scanplan.plan import floorplan
from scanplan.plan.survey_scale import state_scale
from scanplan.recordings.clocks import state_date
from scanplan.report import page_tables
from scanplan.report.facts import PredictionFacts, SurveyFacts
from scanplan.stage.witnesses import rank_findings
from scanplan.validation import doubts
from scanplan.validation.confidence import is_planar
from scanplan.validation.confidence_coefficients import COEFFICIENTS
from scanplan.validation.verdict import is_note

_OBJECTIVES = {"wall_length": ("wall shown", "m"), "visibility": ("free space seen", "m²")}


def plan_sentence(plan: floorplan.FloorPlan, survey: SurveyFacts) -> str:
    """Return what the plan is and what it was made of, in one sentence."""
    n_kept, n_candidates = _count_candidates(survey)
    return (
        f"A plan of {floorplan.summarise_floorplan(plan)}, made of"
        f" {floorplan.say_count(survey.chosen, 'scan')} chosen"
        f" from {n_kept:,} registered ones; {n_candidates:,} were candidates."
    )


def prediction_sentence(prediction: PredictionFacts) -> str:
    """Return how well the plan predicts what other scans saw, or why that is not known."""
    if prediction.absent:
        return f"Not checked against unused scans: {prediction.absent}."
    low, high = prediction.bounds
    counts = (prediction.n_stopped, prediction.n_passed, prediction.n_beyond)
    stopped, passed, beyond = (n / prediction.n_rays for n in counts)
    n = prediction.n_scans
    share = prediction.length_share
    # of no element enough rays were asked
    agree = ""
    if math.isfinite(share):
        agree = f" Rays agree with {share:.1%} of the length of faces, openings and outlines."
    return (
        f"Check against {floorplan.say_count(n, 'unused scan')}: of {prediction.n_rays:,} rays"
        f" {prediction.share:.1%} ({low:.1%} to {high:.1%}) end where the plan says, {stopped:.1%}"
        f" before it (furniture, people, or something not drawn), {passed:.1%} pass through drawn"
        f" surfaces, {beyond:.1%} end where nothing is drawn.{agree}"
    )


def list_contradictions(plan: floorplan.FloorPlan) -> list[str]:
    """Return what speaks against all of a plan, and corrections not carried out, in sentences.

    The likeliest cause first.
    """
    findings = [found for found in plan.doubted.findings if not is_note(found)]
    return [
        *(found.sentence for found in rank_findings(findings)),
        *(f"a correction by hand has no effect: {why}" for why in plan.unmatched_corrections),
    ]


def state_lengths(plan: floorplan.FloorPlan) -> str:
    """Return what scale follows of all that was measured by hand, and how far lengths are off."""
    assert plan.scale is not None
    told = [state_scale(plan.scale)]
    factor = plan.scale.applied
    if factor != 1.0:
        told.append("sheets, models and tables have them, this page the map's")
    if plan.taped_m:
        off = ", ".join(f"{1000 * (factor * m - taped):+.0f}" for m, taped, _ in plan.taped_m)
        told.append(f"drawn less taped: {off} mm")
    return "; ".join(told)


def state_reference(reference: floorplan.GeoReference) -> str:
    """Return how far each control and each check point is off where a plan is laid onto Earth."""

    def listed(off_m: Sequence[tuple[str, float]]) -> str:
        return ", ".join(f"{name} {off:.3f}" for name, off in off_m)

    controls = floorplan.say_count(len(reference.control_off_m), "control point")
    parts = [
        f"in {reference.crs} by {controls}, off by {listed(reference.control_off_m)} m",
        f"their root mean square is {reference.residual_m:.3f} m",
    ]
    if reference.check_off_m:
        counted = floorplan.say_count(len(reference.check_off_m), "check point")
        parts.append(f"{counted}, off by {listed(reference.check_off_m)} m")
        parts.append(f"their root mean square is {reference.check_rms_m:.3f} m")
    parts += reference.faults
    if reference.fits_mirrored:
        parts.append("exchanged axes would not show: add a check point off the points' line")
    return "; ".join(parts)


def list_notes(plan: floorplan.FloorPlan) -> list[str]:
    """Return what else stages warned of, in sentences."""
    return [found.sentence for found in plan.doubted.findings if is_note(found)]


def head_figures(plan: floorplan.FloorPlan, survey: SurveyFacts) -> list[tuple[str, str]]:
    """Return the figures at the head of the page: what each is called, and its value."""
    t_s = survey.poses["t_ns"] / 1e9
    recorded = state_date(int(survey.poses["t_ns"][0]), "%Y-%m-%d %H:%M UTC")
    thickness_m = plan.walls["thickness_m"][plan.thick]
    thickness = f"{1000 * np.median(thickness_m):.0f} mm" if len(thickness_m) else "not known"
    by_kind = doubts.group_by_kind(plan)
    counted = ", ".join(floorplan.say_count(len(of), kind) for kind, of in by_kind.items())
    reference = plan.georeference
    placed = [] if reference is None else [("on Earth", state_reference(reference))]
    placed += [] if plan.scale is None else [("lengths", state_lengths(plan))]
    return [
        ("recorded", recorded),
        ("duration", f"{(t_s[-1] - t_s[0]) / 60:.1f} min"),
        ("scans of the plan", f"{survey.chosen} of {len(survey.selection['rank']):,}"),
        ("length of walls", f"{page_tables.wall_lengths_m(plan).sum():,.1f} m"),
        ("median thickness", thickness),
        ("area of rooms", _area_of_rooms(plan)),
        *placed,
        ("to verify on site", counted or "nothing that is marked"),
    ]


def method_objective(method: str) -> tuple[str, str]:
    """Return what a method of selection looks for, and its unit; of any other the area."""
    return _OBJECTIVES.get(method, ("area covered", "m²"))


def coverage_note(survey: SurveyFacts, method: str) -> str:
    """Return what the chosen scans cover, and how much better any other choice could be."""
    selection, k = survey.selection, survey.chosen
    covered = selection["covered"]
    objective, unit = method_objective(method)
    chosen = f"The plan is made of {k} of {len(covered):,} registered scans"
    if covered[-1] <= 0:
        return f"{chosen}; no scan has any {objective}."
    given = covered[k - 1]
    best = min(selection["bound"][k - 1], covered[-1])
    return (
        f"{chosen}, which give {given / covered[-1]:.1%} of the {objective} of all ({given:,.1f} of"
        f" {covered[-1]:,.1f} {unit}). Guarantee: the best possible {k} scans would give"
        f" at most {best:,.1f} {unit}: this choice is within {1 - given / best:.1%} of it."
    )


def review_note(plan: floorplan.FloorPlan) -> str:
    """Return how many walls are weakly supported."""
    n_to_verify = int(plan.walls["verify"].sum())
    return (
        "Standard deviations of each wall's offset and ends against the rest of the plan, from"
        " pose uncertainty and the spread of points."
        f" {n_to_verify:,} of {len(plan.walls['wall']):,} walls are weakly supported: verify them"
        " on site. A row chosen here is shown in the plan."
    )


def confidence_note(plan: floorplan.FloorPlan) -> str:
    """Return where probabilities come from, and by how much they were off elsewhere."""
    off = COEFFICIENTS["plane" if is_planar(plan) else "space"]["off"]

    def listed(half: str) -> str:
        return ", ".join(f"{table} by {error:.2f}" for table, error in off[half].items())

    known = f"on real floors with a truth drawn by hand {listed('real')}" if "real" in off else ""
    unknown = [table for table in floorplan.NUMBERS if table not in off.get("real", {})]
    rest = f"of {', '.join(unknown)} nobody has measured it on real floors" if unknown else ""
    return (
        "How likely elements are was learned from simulated surveys. In other simulated buildings"
        f" probabilities were off in the mean: {listed('reporting')}; "
        + "; ".join(filter(None, [known, rest]))
        + ". Read a probability as so much more or less."
    )


def registration_note(survey: SurveyFacts) -> str:
    """Return how many candidates were kept."""
    n_kept, n_candidates = _count_candidates(survey)
    source = "odometry" if survey.is_drifting else "the localiser"
    return (
        f"{n_kept:,} of {n_candidates:,} candidate scans were kept. Medians by verdict; shift:"
        f" from the pose by {source} to the registered one."
    )


def truth_note(survey: SurveyFacts) -> str:
    """Return in which frames the plan is measured, and which of the two says how good it is."""
    if survey.is_drifting:
        return (
            "Use the aligned figures, after the one rigid motion that fits the registered scans to"
            " the true poses. The registered ones mean nothing for odometry: the plan lies in the"
            " frame of its first scan."
        )
    return (
        "Measured where the plan is in the map (registered), and after the one rigid motion that"
        " fits the registered scans to the true poses (aligned)."
    )


def _count_candidates(survey: SurveyFacts) -> tuple[int, int]:
    """Return how many scans registration kept, and how many it was given."""
    kept = survey.registration["kept"]
    return int(kept.sum()), len(kept)


def _area_of_rooms(plan: floorplan.FloorPlan) -> str:
    """Return the area of closed rooms, and of the others, whose outlines are partly a guess."""
    is_closed = plan.rooms["closed"]
    closed_m2, open_m2 = (plan.net_areas_m2[of].sum() for of in (is_closed, ~is_closed))
    guessed = f" and about {open_m2:,.1f} m² not closed" if open_m2 else ""
    return f"{closed_m2:,.1f} m²{guessed}"
