"""The report of a dataset: one page of HTML that needs nothing beside it."""

import base64
import hashlib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from scanplan.exports.sheet.symbols import list_blocks
from scanplan.plan import floorplan
from scanplan.project.stage_settings import SAME_FACE_DEG
from scanplan.report import (
    chart,
    page_tables,
    result_links,
    solid_view,
    templates,
    walk,
    wording,
)
from scanplan.report.facts import Pictures, RunFacts, SurveyFacts
from scanplan.report.plan_view import growth, next_visit, plan_svg
from scanplan.store import registered_scans
from scanplan.types import FloatArray, Settings
from scanplan.validation import doubts, verdict

_FOUND, _RIGHT = "visible_completeness_010m", "correctness_010m"
_DIGITS = 12  # of a digest: no two plans of a survey have the same
_CAPTIONS = {
    "scans": "Points of the registered scans from above, where each was taken, and the selected"
    " scans by rank.",
    "registration": "The sensor's way, kept and dropped scans by reason, links between scans by"
    " what is left of their disagreement, and the thickness of walls by the recorded poses and"
    " the registered ones.",
    "area": "Covered area against the number of scans for every ordering, and the most any choice"
    " could cover.",
    "walls": "Wall faces of the plan over the points of the selected scans.",
    "validation": "Where rays of scans that did not make the plan ended, and whether the plan"
    " explains it.",
    "deviation": "Points of the selected scans, between floor and ceiling, by how far they lie from"
    " the faces that are drawn, and faces that no point shows.",
    "oracle_shares": "What the first scans of every ordering find, as a share of what the oracle's"
    " do.",
    "evaluation": "What the first scans of every ordering find of the true walls, and why walls"
    " are missed.",
}


@dataclass(frozen=True)
class PageFigure:
    """A figure of the page: an SVG file in base64, whose identifiers and styles stay its own."""

    name: str
    caption: str
    base64: str


def report_page(
    sources: Mapping[str, str],
    plan: floorplan.FloorPlan,
    survey: SurveyFacts,
    drawn: Pictures,
    run: RunFacts,
) -> str:
    """Return the page.

    Parameters
    ----------
    sources : dict of str to str
        File name to text of `page.html.j2` and of all that it asks for.

    Returns
    -------
    str
        The same for the same input.
    """
    of_plan = run.settings["plan"]
    objective, _ = wording.method_objective(of_plan["method"])
    curves = _curves(survey, of_plan, objective)
    n_scans = len(survey.selection["rank"])
    found = doubts.list_doubts(plan)
    start_m = _find_start_m(survey)
    plan_text = _plan_svg(plan, survey, drawn, of_plan["merge"])
    return templates.render_template(
        sources,
        "page.html.j2",
        name=plan.name,
        verdict=verdict.judge_plan(plan),
        summary=wording.plan_sentence(plan, survey),
        prediction=wording.prediction_sentence(survey.prediction),
        contradictions=[
            *plan.doubted.damage,
            *plan.doubted.rayless,
            *wording.list_contradictions(plan),
            *doubts.list_unrated(plan),
            *wording.list_notes(plan),
        ],
        facts=wording.head_figures(plan, survey),
        links=result_links.link_results(run.results),
        storeys=run.storeys,
        doubts=[
            walk.order_rooms(doubts.group_by_room(part), start_m)
            for part in (found[: doubts.MOST], found[doubts.MOST :])
        ],
        n_more=len(found[doubts.MOST :]),
        n_doubts=len(found),
        nearly=doubts.list_nearly(plan),
        confidence=wording.confidence_note(plan),
        plan=Markup(plan_text),
        opening_kinds=_list_opening_kinds(plan),
        visit=survey.visit.summary,
        visit_map=Markup(next_visit.draw_visit_map(plan, survey.visit)),
        standpoints=next_visit.standpoint_table(plan, survey.visit),
        hidden=next_visit.hidden_table(plan, survey.visit),
        chosen=survey.chosen,
        min_scans=of_plan["merge"]["min_scans"],
        chart=Markup(chart.chart_svg(curves, n_scans, survey.chosen)),
        curves=[(css, curve.name) for css, curve in curves.items()],
        certificate=wording.coverage_note(survey, of_plan["method"]),
        truth=_truth_table(survey),
        truth_note=wording.truth_note(survey),
        review=wording.review_note(plan),
        walls=page_tables.wall_table(plan, survey.evidence),
        faces=page_tables.face_table(plan),
        openings=page_tables.opening_table(plan),
        rooms=page_tables.room_table(plan),
        registration_note=wording.registration_note(survey),
        registration=page_tables.registration_table(survey.registration, _shift_m(survey)),
        figures=[_page_figure(name, svg) for name, svg in run.figures.items()],
        stages=page_tables.stage_table(run.costs),
        sizes=page_tables.size_table(run.sizes),
        settings=page_tables.settings_table(run.settings),
        version=run.version,
        in_space=drawn.in_space,
        sights=drawn.sights,
        top_m=math.ceil(drawn.in_space["height_m"] * 20) / 20,
        three=solid_view.pack_script(sources["three.js"]),
        data=_script_data(survey, run, objective, plan_text)
        | {"unmatched": list(plan.unmatched_corrections)},
    )


def _truth_table(survey: SurveyFacts) -> page_tables.PageTable | None:
    """Return the table of the plan against the truth where that is known."""
    if not survey.plan_measures:
        return None
    leads = "aligned" if survey.is_drifting else "registered"
    return page_tables.truth_table(survey.plan_measures, leads=leads)


def _list_opening_kinds(plan: floorplan.FloorPlan) -> list[tuple[str, str]]:
    """Return the kinds of openings that a plan has, and what its key calls them."""
    drawn = set(plan.openings["type"].tolist())
    return [(kind, words) for kind, words in floorplan.OPENINGS.items() if kind in drawn]


def _plan_svg(
    plan: floorplan.FloorPlan, survey: SurveyFacts, drawn: Pictures, merging: Settings
) -> str:
    """Draw the plan, its growth, and what each chosen scan shows."""
    selected_ids = survey.selection["scan_id"][: survey.chosen]
    rank_of = {scan: rank for rank, scan in enumerate(selected_ids.tolist(), 1)}
    scan_ids = survey.segments["scan_id"].tolist()
    rank = np.array([rank_of.get(scan, 0) for scan in scan_ids], np.int64)
    segments = {name: values[rank > 0] for name, values in survey.segments.items()}
    rank = rank[rank > 0]
    stretches = growth.cut_by_rank(
        plan.faces,
        segments,
        rank,
        max_angle_deg=SAME_FACE_DEG,
        distance_m=merging["merge_distance_m"],
        min_scans=merging["min_scans"],
    )
    lines_m = floorplan.centrelines_m(segments)
    shown_m = [lines_m[rank == k] for k in range(1, survey.chosen + 1)]
    positions_m = registered_scans.sensor_places(survey.registration, selected_ids)
    return plan_svg.growing_plan_svg(
        plan, stretches, positions_m, shown_m, drawn.points, drawn.way_m
    )


def _curves(survey: SurveyFacts, of_plan: Settings, objective: str) -> dict[str, chart.Curve]:
    """Return the curves of the chart by CSS class.

    They are the certificate and, where the truth is known, what is found of it.
    """
    rank, covered = survey.selection["rank"], survey.selection["covered"]
    share = _of_all(covered, covered[-1])
    bound = _of_all(survey.selection["bound"], covered[-1])
    curves = {
        "covered": chart.Curve(f"{objective}, of what all scans give", rank, share),
        "bound": chart.Curve("most that any choice of as many scans can give", rank, bound),
    }
    if survey.wall_measures:
        measures = survey.wall_measures
        rows = (measures["method"] == of_plan["method"]) & (
            measures["extractor"] == of_plan["extractor"]
        )
        n_scans, found, right = (measures[column][rows] for column in ("k", _FOUND, _RIGHT))
        curves["found"] = chart.Curve("visible true walls found, within 0.10 m", n_scans, found)
        curves["right"] = chart.Curve("wall segments that are right, within 0.10 m", n_scans, right)
    return curves


def _shift_m(survey: SurveyFacts) -> FloatArray:
    """Return how far each scan of the registration lies from its interpolated pose; NaN without."""
    row_of = {scan: i for i, scan in enumerate(survey.poses["scan_id"].tolist())}
    scan_ids = survey.registration["scan_id"].tolist()
    rows = np.array([row_of.get(scan, -1) for scan in scan_ids], np.int64)
    apart_m = [survey.registration[c] - survey.poses[c][rows] for c in ("x_m", "y_m")]
    return np.where(rows >= 0, np.hypot(*apart_m), np.nan)


def _page_figure(name: str, svg: str) -> PageFigure:
    caption = _CAPTIONS.get(name, name.replace("_", " ").capitalize() + ".")
    text = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)
    return PageFigure(name, caption, base64.b64encode(text.encode()).decode())


def _find_start_m(survey: SurveyFacts) -> FloatArray:
    """Return where (2,) the first scan was taken that has a place, map frame."""
    places_m = np.column_stack([survey.registration[c] for c in ("x_m", "y_m")])
    known = np.flatnonzero(np.isfinite(places_m).all(axis=1))
    return places_m[known[np.argmin(survey.registration["t_ns"][known])]]


def _script_data(
    survey: SurveyFacts, run: RunFacts, objective: str, drawn: str
) -> dict[str, object]:
    """Return what the page's script needs to know; `made` tells pages of other plans apart."""
    selection = survey.selection
    covered = _of_all(selection["covered"], selection["covered"][-1])
    return {
        "chosen": survey.chosen,
        "scan_ids": selection["scan_id"][: survey.chosen].tolist(),
        "covered": covered.round(5).tolist(),
        "objective": objective,
        "corrections": run.corrections,
        "survey": run.survey,
        "symbols": list_blocks(),
        "made": hashlib.sha256(f"{drawn}{run.corrections}".encode()).hexdigest()[:_DIGITS],
    }


def _of_all(values: FloatArray, whole: float) -> FloatArray:
    """Return values as shares of what all scans give; of nothing everything is there."""
    return np.minimum(values / whole, 1) if whole > 0 else np.ones(len(values))
