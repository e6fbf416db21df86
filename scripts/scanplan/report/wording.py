"""The report's sentences and head figures."""

from datetime import UTC, datetime
from html import escape

import numpy as np

from scanplan.plan import floorplan

_OBJECTIVES = {"wall_length": ("wall shown", "m"), "visibility": ("free space seen", "m²")}


def plan_sentence(plan, survey):
    """Return what the plan is and what it was made of, in one sentence."""
    kept, n = int(survey.registration["kept"].sum()), len(survey.registration["scan_id"])
    return (
        f"A plan of {escape(floorplan.summarise_floorplan(plan))}, made of {survey.chosen} scans chosen from"
        f" {kept:,} registered ones; {n:,} were candidates."
    )


def head_figures(plan, survey):
    """Return the figures at the head of the page."""
    t_s = survey.poses["t_ns"] / 1e9
    recorded = datetime.fromtimestamp(t_s[0], UTC).strftime("%Y-%m-%d %H:%M UTC")
    known_m = plan.walls["thickness_m"][plan.thick]
    facts = {
        "recorded": recorded,
        "duration": f"{(t_s[-1] - t_s[0]) / 60:.1f} min",
        "scans of the plan": f"{survey.chosen} of {len(survey.selection['rank']):,}",
        "length of walls": f"{np.hypot(*np.diff(floorplan.centrelines_m(plan.walls), axis=1)[:, 0].T).sum():,.1f} m",
        "median thickness": f"{1000 * np.median(known_m):.0f} mm" if len(known_m) else "not known",
        "area of rooms": _areas(plan.rooms),
        "to verify on site": f"{plan.walls['verify'].sum():,} of {len(plan.walls['wall']):,} walls",
    }
    return "\n".join(f"<div><dt>{name}</dt><dd>{value}</dd></div>" for name, value in facts.items())


def method_objective(method):
    """Return what a method of selection looks for, in words, and its unit; of one that measures nothing, the area."""
    return _OBJECTIVES.get(method, ("area covered", "m²"))


def _areas(rooms):
    """Return the area of closed rooms, and of the others, whose outlines are partly a guess."""
    closed_m2, open_m2 = (
        rooms["area_m2"][rooms["closed"] == is_closed].sum() for is_closed in (True, False)
    )
    return f"{closed_m2:,.1f} m²" + (f" and about {open_m2:,.1f} m² not closed" if open_m2 else "")


def coverage_note(survey, method):
    """Return what the chosen scans cover, and how much better any other choice could be."""
    selection, k = survey.selection, survey.chosen
    covered, covered_m2 = selection["covered"], selection["covered_m2"]
    what, unit = method_objective(method)
    share = covered_m2[k - 1] / covered_m2[-1]
    area = f"{share:.1%} of the area that the hulls of all {len(covered):,} registered scans cover"
    if covered[-1] <= 0:
        return f"The {k} scans of the plan cover {area} ({covered_m2[-1]:,.1f} m²); no scan has any {what}."
    given, best = covered[k - 1], min(selection["bound"][k - 1], covered[-1])
    return (
        f"The {k} scans of the plan cover {area} ({covered_m2[-1]:,.1f} m²) and give {given / covered[-1]:.1%} of their"
        f" {what} ({given:,.1f} of {covered[-1]:,.1f} {unit}). Certificate: no {k} of these scans give more than"
        f" {best:,.1f} {unit}, so this choice is within {1 - given / best:.1%} of the best."
    )


def review_note(plan):
    """Return how many walls are weakly supported."""
    n = int(plan.walls["verify"].sum())
    return (
        f"Standard deviations of a wall's offset and of both its ends as the scans that show it tell. {n:,} of"
        f" {len(plan.walls['wall']):,} walls are weakly supported and marked to be verified on site. Choosing a row"
        " shows its wall in the plan."
    )


def registration_note(survey):
    """Return how many candidates were kept."""
    kept, n = int(survey.registration["kept"].sum()), len(survey.registration["scan_id"])
    return (
        f"{kept:,} of {n:,} candidate scans were kept. Medians by verdict; the shift is the way from where the"
        " localiser put a scan to where it was registered."
    )
