"""The report of a dataset: one page of HTML that needs nothing beside it."""

import base64
import json
import re
from dataclasses import dataclass
from html import escape
from string import Template

import numpy as np

from scanplan.plan import floorplan
from scanplan.report import chart, figures, growth, html_tables, plan_svg, wording

_STAGES = (
    "simulate", "interpolate", "register", "measure", "build", "observe", "order", "extract", "assemble", "export",
    "evaluate", "draw",
)  # fmt: skip
_FOUND, _RIGHT = "visible_completeness_010m", "correctness_010m"
_CAPTIONS = {
    "scans": "Points of the registered scans from above, where each was taken, and the selected scans by rank.",
    "registration": "The sensor's way, kept and dropped scans by reason, links between scans by what is left of their"
    " disagreement, and the thickness of walls by the localiser's poses and the registered ones.",
    "area": "Covered area against the number of scans for every ordering, and the most any choice could cover.",
    "walls": "Wall faces of the plan over the points of the selected scans.",
    "oracle_shares": "What the first scans of every ordering find, as a share of what the oracle's do.",
    "evaluation": "What the first scans of every ordering find of the true walls, and why walls are missed.",
}


@dataclass(frozen=True)
class SurveyFacts:
    """What a plan was made of.

    Attributes
    ----------
    selection, registration, poses, segments, evidence : dict of str to (n,) array
        The columns of `schemas.SELECTION` (the plan's method), `REGISTRATION`, `POSES`, `WALLS` (the plan's extractor)
        and `EVIDENCE`.
    chosen : int
        How many scans of the selection make the plan.
    evaluation : tuple of dict of str to (n,) array
        The columns of `schemas.EVALUATION` and of `schemas.PLAN_EVALUATION`, where the truth is known.
    """

    selection: dict
    registration: dict
    poses: dict
    segments: dict
    evidence: dict
    chosen: int
    evaluation: tuple


@dataclass(frozen=True)
class RunFacts:
    """How it was made.

    Attributes
    ----------
    settings : dict
        All settings of the dataset.
    figures : dict of str to str
        Name to the text of an SVG file.
    benchmarks : dict of str to str
        Stage to the text of Snakemake's benchmark file; what is missing or damaged is left out.
    sizes : list of (str, str, int)
        What, file name, bytes.
    version : str
    """

    settings: dict
    figures: dict
    benchmarks: dict
    sizes: list
    version: str


def report_page(template, style, script, plan, survey, run):
    """Return the page.

    Parameters
    ----------
    template : str
        HTML with the places that `string.Template` fills.
    style, script : str
        CSS and JavaScript to put in.
    plan : floorplan.FloorPlan
    survey : Survey
    run : Run

    Returns
    -------
    str
        The same for the same input.
    """
    ranked = survey.selection["scan_id"][: survey.chosen]
    curves = _curves(survey, run.settings["plan"])
    return Template(template).substitute(
        name=escape(plan.name),
        style=style,
        script=script,
        summary=wording.plan_sentence(plan, survey),
        facts=wording.head_figures(plan, survey),
        plan=_plan(plan, survey, ranked, run.settings["plan"]["merge"]),
        chosen=survey.chosen,
        min_scans=run.settings["plan"]["merge"]["min_scans"],
        chart=chart.chart_svg(curves, len(survey.selection["rank"]), survey.chosen),
        legend=_legend(curves),
        certificate=wording.coverage_note(survey, run.settings["plan"]["method"]),
        against_truth=html_tables.truth_table(survey.evaluation[1]) if survey.evaluation else "",
        verify_note=wording.review_note(plan),
        walls=html_tables.wall_table(plan, survey.evidence),
        openings=html_tables.opening_table(plan),
        rooms=html_tables.room_table(plan),
        registration_note=wording.registration_note(survey),
        registration=html_tables.registration_table(survey.registration, _shift_m(survey)),
        figures="\n".join(_figure(name, text) for name, text in run.figures.items()),
        stages=html_tables.stage_table(_stage_times(run.benchmarks)),
        sizes=html_tables.size_table(run.sizes),
        settings=html_tables.settings_table(run.settings),
        version=escape(run.version),
        data=_data(survey, wording.method_objective(run.settings["plan"]["method"])[0]),
    )


def _stage_times(benchmarks):
    """Return stage, seconds, processor seconds and peak memory in MB of each benchmark, in the workflow's order."""
    rows = []
    for stage, text in sorted(benchmarks.items(), key=lambda item: (_place(item[0]), item[0])):
        head, *lines = [line.split("\t") for line in text.splitlines()] or [[]]
        if not lines or not {"s", "cpu_time", "max_rss"} <= set(head):
            continue
        measured = [dict(zip(head, line, strict=False)) for line in lines]
        values = [[_float(row.get(c)) for row in measured] for c in ("s", "cpu_time", "max_rss")]
        rows.append((stage, *(float(np.mean(v)) for v in values)))
    return rows


def _place(stage):
    return next((i for i, name in enumerate(_STAGES) if stage.startswith(name)), len(_STAGES))


def _float(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return np.nan


def _plan(plan, survey, ranked, merging):
    """Draw the plan, its growth, and what each chosen scan shows."""
    rank_of = {scan: rank for rank, scan in enumerate(ranked.tolist(), 1)}
    rank = np.array(
        [rank_of.get(scan, 0) for scan in survey.segments["scan_id"].tolist()], np.int64
    )
    used = {name: values[rank > 0] for name, values in survey.segments.items()}
    rank = rank[rank > 0]
    grown = growth.cut_by_rank(
        plan.faces, used, rank, max_angle_deg=merging["max_angle_deg"], distance_m=merging["merge_distance_m"],
        min_scans=merging["min_scans"],
    )  # fmt: skip
    lines_m = floorplan.centrelines_m(used)
    shown_m = [lines_m[rank == k] for k in range(1, survey.chosen + 1)]
    return plan_svg.growing_plan_svg(
        plan, grown, figures.sensor_positions(survey.registration, ranked), shown_m
    )


def _curves(survey, of_plan):
    """Return the curves of the chart: the certificate and, where the truth is known, what is found of it."""
    k, covered = survey.selection["rank"], survey.selection["covered"]
    what, _ = wording.method_objective(of_plan["method"])
    share, bound = (
        _of_all(survey.selection[column], covered[-1]) for column in ("covered", "bound")
    )
    curves = {
        "covered": (f"{what}, of what all scans give", k, share),
        "bound": ("most that any choice of as many scans can give", k, bound),
    }
    if survey.evaluation:
        measured = survey.evaluation[0]
        own = np.all([measured[part] == of_plan[part] for part in ("method", "extractor")], axis=0)
        at, found, right = (measured[column][own] for column in ("k", _FOUND, _RIGHT))
        curves["found"] = ("visible true walls found, within 0.10 m", at, found)
        curves["right"] = ("wall segments that are right, within 0.10 m", at, right)
    return curves


def _legend(curves):
    keys = (
        f'<li><svg class="mark {css}" viewBox="0 0 30 8" aria-hidden="true"><path d="M0 4H30"/></svg>{name}</li>'
        for css, (name, _, _) in curves.items()
    )
    return f'<ul class="curves">{"".join(keys)}</ul>'


def _shift_m(survey):
    """Return how far each scan of the registration lies from its interpolated pose, NaN where it has none."""
    row = {scan: i for i, scan in enumerate(survey.poses["scan_id"].tolist())}
    at = np.array([row.get(scan, -1) for scan in survey.registration["scan_id"].tolist()], np.int64)
    apart = [survey.registration[c] - survey.poses[c][at] for c in ("x_m", "y_m")]
    return np.where(at >= 0, np.hypot(*apart), np.nan)


def _figure(name, svg):
    caption = _CAPTIONS.get(name, name.replace("_", " ").capitalize() + ".")
    # as an image of its own: its identifiers and styles stay its own
    text = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)
    source = base64.b64encode(text.encode()).decode()
    return (
        f'<figure id="figure-{escape(name)}"><img src="data:image/svg+xml;base64,{source}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _data(survey, what):
    selection = survey.selection
    values = {
        "chosen": survey.chosen,
        "scan_ids": selection["scan_id"][: survey.chosen].tolist(),
        "covered": _of_all(selection["covered"], selection["covered"][-1]).round(5).tolist(),
        "objective": what,
    }
    return json.dumps(values, allow_nan=False)


def _of_all(values, whole):
    """Return values as shares of what all scans give; of nothing everything is there."""
    return np.minimum(values / whole, 1) if whole > 0 else np.ones(len(values))
