"""Coefficients of the confidence in a plan's elements, and how well they hold on other floors.

Plans that `realistic` has finished are held against their truths, in the bench's own terms: which
of their elements are right. What is fitted on the tuning half is told apart by kinds of buildings
that were left out, by the reporting half and by real floors.
"""

import pprint
import sys
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import ablation
import ablation_scores
import matplotlib.pyplot as plt
import numpy as np
from realistic import scoring
from realistic.floors import HALVES, Floor
from scipy import optimize, special

from scanplan.lab.evaluation.scores import flag_scores, score, score_files
from scanplan.plan import floorplan, floorplan_files
from scanplan.store import schemas, tables
from scanplan.types import BoolArray, Columns, FloatArray, IntArray
from scanplan.validation import confidence
from scanplan.validation.element_features import describe_elements

_TABLES = ("faces", "walls", "openings", "rooms", "free")
_RIGHT_FLAGGED = 0.09  # of right elements lie below the level: on other floors it may be a tenth
_SUREST_SHARE = 0.1  # of elements of kinds left out: as often as these are right, nothing is surer
_TEMPERS = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5)
_LEAST_WEIGHT = 0.05  # of a deviation of a feature: it changes no probability by more than .0125
Features = Mapping[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Rated:
    """The elements of a floor's plan: by table, their features, and which (n,) are right.

    `right` is 1, 0, or NaN of what the truth does not tell.
    """

    floor: Floor
    is_planar: bool
    features: Mapping[str, Features]
    right: Mapping[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Judged:
    """How likely elements (n,) are said to be right, whether they are, and whether flagged."""

    p_true: FloatArray
    right: BoolArray
    flagged: BoolArray


def bench(folder: Path, *, coefficients: Path, figure: Path) -> None:
    """Fit on the tuning half below a folder of `realistic`; write coefficients and a figure."""
    found = [
        rate_floor(path, floor)
        for path in sorted((folder / "code/results").glob("*"))
        if (path / "plan/validation.parquet").exists()
        for floor in [ablation.find_floor(path)]
        if floor.half and ablation_scores.find_truth(path) is not None
    ]
    fitted: dict[str, Any] = {}
    charts: dict[tuple[str, str], dict[str, Judged]] = {}
    for name, is_planar in (("space", False), ("plane", True)):
        of_sensor = [rated for rated in found if rated.is_planar == is_planar]
        halves = {half: [r for r in of_sensor if r.floor.half == half] for half in HALVES}
        if not halves["tuning"]:
            sys.exit(f"confidence: no tuning floor of {name} is finished in {folder}")
        plain = fit_tables(halves["tuning"])
        tempers = choose_tempers(halves["real"], plain)
        left_out = _leave_out(halves["tuning"], tempers)
        fitted[name] = soften_models(plain, tempers) | choose_limits(
            left_out.values(), len(halves["tuning"])
        )
        limits = (fitted[name]["most"], fitted[name]["level"])
        charts[name, "tuning"] = {table: _limit(j, *limits) for table, j in left_out.items()}
        for half in ("reporting", "real"):
            if halves[half]:
                charts[name, half] = _judge(halves[half], fitted[name])
        fitted[name]["off"] = {
            half: _find_errors(charts[name, half]) for half in HALVES if (name, half) in charts
        }
    kinds = dict.fromkeys(rated.floor.kind for rated in found if rated.floor.half == "tuning")
    coefficients.write_text(
        '"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.\n\n'
        + textwrap.fill(
            f"Fitted on drives through buildings of these kinds: {', '.join(kinds)}.", 100
        )
        + '\n"""\n\nfrom typing import Any\n\n'
        + f"COEFFICIENTS: dict[str, Any] = {pprint.pformat(fitted, sort_dicts=False, width=90)}\n"
    )
    _draw(charts, figure)


def rate_floor(results: Path, floor: Floor) -> Rated:
    """Return the elements of a finished plan, and which are right.

    Raises
    ------
    StageError
        If a table is missing, or of another version than this code's.
    """
    plan = floorplan_files.read_floorplan({t: results / f"plan/{t}.parquet" for t in _TABLES})
    validation = tables.read_table(results / "plan/validation.parquet", schemas.VALIDATION)
    recorded = ablation_scores.find_truth(results)
    assert recorded is not None
    placed = scoring.place_floor(results, recorded, with_points=False)
    elements = score_files.score_results(placed).elements
    print(f"confidence, {results.name}", flush=True)
    right = {
        table: _find_right(elements, number, getattr(plan, table)[number])
        for table, number in floorplan.NUMBERS.items()
    }
    right["faces"][_find_further_chords(plan)] = np.nan
    return Rated(floor, confidence.is_planar(plan), describe_elements(plan, validation), right)


def _find_further_chords(plan: floorplan.FloorPlan) -> BoolArray:
    """Return which faces (n,) are chords of a side of a curved wall that another stands for."""
    host = plan.face_hosts
    centre_m = np.column_stack(
        [np.append(plan.walls[name].astype(float), np.nan)[host] for name in ("arc_x_m", "arc_y_m")]
    )
    off_m = floorplan.centrelines_m(plan.faces).mean(axis=1) - centre_m
    is_outer = off_m[:, 0] * plan.faces["nx"] + off_m[:, 1] * plan.faces["ny"] > 0
    _, first = np.unique(2 * host + is_outer, return_index=True)
    return np.isfinite(off_m[:, 0]) & ~np.isin(np.arange(len(host)), first)


def _find_right(elements: Columns, kind: str, numbers: IntArray) -> FloatArray:
    """Return which elements (n,) of a plan are right; NaN of those that are not judged."""
    chosen = (elements["table"] == kind) & (elements["number"] >= 0)
    chosen &= ~np.isin(elements["verdict"], [score.MISSED, *score.UNCOUNTED])
    verdict_of = dict(
        zip(elements["number"][chosen].tolist(), elements["verdict"][chosen], strict=True)
    )
    right = [
        np.nan if n not in verdict_of else verdict_of[n] == score.RIGHT for n in numbers.tolist()
    ]
    return np.array(right, np.float64)


def join_rows(found: Iterable[Rated], table: str) -> tuple[Features, FloatArray]:
    """Return the features of all elements of a table that are judged, and which (n,) are right."""
    parts = list(found)
    right = np.concatenate([rated.right[table] for rated in parts])
    known = np.isfinite(right)
    names = list(parts[0].features[table])
    return {
        name: np.concatenate([rated.features[table][name] for rated in parts])[known]
        for name in names
    }, right[known]


def fit_tables(found: Sequence[Rated]) -> dict[str, Any]:
    """Return a model of each table."""
    return {table: fit(*join_rows(found, table)) for table in floorplan.NUMBERS}


def fit(features: Features, right: FloatArray) -> dict[str, Any]:
    """Fit a logistic model whose features speak for an element only.

    What few floors seem to teach against reason (the more rays agree, the less likely) holds on no
    other. A feature that says nothing is left out.
    """
    values = np.column_stack(list(features.values()))
    is_known = np.isfinite(values)
    mean = np.nan_to_num(
        np.where(is_known, values, 0).sum(axis=0) / np.maximum(is_known.sum(axis=0), 1)
    )
    off = np.where(is_known, values - mean, 0.0)
    scale = np.maximum(off.std(axis=0), 1e-6)
    # the first column has the intercept, which is not held small
    standard = np.column_stack([np.ones(len(right)), off / scale])
    sign = 2 * right - 1

    def lose(weights: FloatArray) -> tuple[float, FloatArray]:
        margin = sign * (standard @ weights)
        held = np.append(0.0, weights[1:])
        slope = -(sign * special.expit(-margin)) @ standard + held
        return float(np.logaddexp(0, -margin).sum() + held @ held / 2), slope

    bounds = [(None, None), *[(0.0, None)] * len(features)]
    start = np.zeros(len(bounds))
    weights = optimize.minimize(lose, start, jac=True, bounds=bounds, method="L-BFGS-B").x
    return {
        "intercept": round(float(weights[0]), 2),
        "features": {
            name: {"mean": round(float(m), 2), "weight": round(float(w / s), 2)}
            for name, m, w, s in zip(features, mean, weights[1:], scale, strict=True)
            if w > _LEAST_WEIGHT
        },
    }


def choose_tempers(real: Sequence[Rated], models: Mapping[str, Any]) -> dict[str, float]:
    """Return by table how much of the log odds of a fit holds on real floors: what is likeliest.

    All of them where no truth of a real floor judges a table.
    """

    def surprise(table: str, temper: float) -> float:
        softened = soften_models(models, dict.fromkeys(models, temper))
        judged = _judge(real, softened)[table]
        p = np.clip(judged.p_true, 1e-6, 1 - 1e-6)
        return -float(np.log(np.where(judged.right, p, 1 - p)).sum())

    return {table: min(_TEMPERS, key=partial(surprise, table)) if real else 1.0 for table in models}


def soften_models(models: Mapping[str, Any], tempers: Mapping[str, float]) -> dict[str, Any]:
    """Return models whose log odds are so many times as great."""
    return {
        table: {
            "intercept": round(tempers[table] * model["intercept"], 2),
            "features": {
                name: known | {"weight": round(tempers[table] * known["weight"], 2)}
                for name, known in model["features"].items()
            },
        }
        for table, model in models.items()
    }


def _leave_out(tuning: Sequence[Rated], tempers: Mapping[str, float]) -> dict[str, Judged]:
    """Return by table how likely elements are said to be by fits without their kind of building."""
    parts: list[dict[str, Judged]] = []
    for kind in sorted({rated.floor.kind for rated in tuning}):
        models = fit_tables([rated for rated in tuning if rated.floor.kind != kind])
        own = [rated for rated in tuning if rated.floor.kind == kind]
        parts.append(_judge(own, soften_models(models, tempers)))
    return {table: _join([part[table] for part in parts]) for table in floorplan.NUMBERS}


def choose_limits(left_out: Iterable[Judged], n_drives: int) -> dict[str, float]:
    """Return the level below which elements are flagged, and what no probability is above.

    Probabilities of walls and of rooms mean the same: one level misses the fewest wrong elements.
    The surest of what was left out are right so often, and what a fit says beyond is not known.
    Elements of one drive err together, so that n drives without an error show no more than that
    (n + 1) of n + 2 have none (Laplace's rule of succession).
    """
    judged = _join(list(left_out))
    level = float(np.quantile(judged.p_true[judged.right], _RIGHT_FLAGGED))
    is_surest = judged.p_true >= np.quantile(judged.p_true, 1 - _SUREST_SHARE)
    most = min(float(judged.right[is_surest].mean()), (n_drives + 1) / (n_drives + 2))
    return {"level": round(level, 3), "most": round(most, 3)}


def _judge(found: Sequence[Rated], models: Mapping[str, Any]) -> dict[str, Judged]:
    judged: dict[str, Judged] = {}
    for table in floorplan.NUMBERS:
        features, right = join_rows(found, table)
        p_true, _ = confidence.weigh_features(features, models[table])
        raw = Judged(p_true, right == 1, np.zeros(len(right), bool))
        judged[table] = _limit(raw, models.get("most", 1.0), models.get("level", 0.0))
    return judged


def _limit(judged: Judged, most: float, level: float) -> Judged:
    p_true = np.minimum(judged.p_true, most)
    return Judged(p_true, judged.right, p_true < level)


def _join(parts: Sequence[Judged]) -> Judged:
    return Judged(
        np.concatenate([part.p_true for part in parts]),
        np.concatenate([part.right for part in parts]),
        np.concatenate([part.flagged for part in parts]),
    )


def _find_errors(of_tables: Mapping[str, Judged]) -> dict[str, float]:
    """Return by how much probabilities are off, in the mean of the elements of each table."""
    errors = {
        table: flag_scores.measure_flags("x", judged.right, judged.flagged, judged.p_true)
        for table, judged in of_tables.items()
    }
    return {
        table: round(found["x_calibration_error"], 2)
        for table, found in errors.items()
        if found["x_n"]
    }


def _draw(charts: Mapping[tuple[str, str], Mapping[str, Judged]], figure: Path) -> None:
    """Draw reliability diagrams, and print a line for each table."""
    sheet, axes = plt.subplots(2, 3, figsize=(12, 8), sharex=True, sharey=True)
    print("| floors | table | n | wrong | ECE | wrong flagged | right flagged | p >= .99: right |")
    for (name, half), of_tables in charts.items():
        row, column = ("space", "plane").index(name), HALVES.index(half)
        chart = axes[row, column]
        chart.plot([0, 1], [0, 1], color="0.7")
        for table, judged in {**of_tables, "all": _join(list(of_tables.values()))}.items():
            if not len(judged.right):
                continue
            said = flag_scores.measure_flags("x", judged.right, judged.flagged, judged.p_true)
            print(
                f"| {name}, {half} | {table} | {said['x_n']} | {said['x_n_wrong']} |"
                f" {said['x_calibration_error']:.3f} | {said['x_wrong_flagged']:.2f} |"
                f" {said['x_right_flagged']:.3f} |"
                f" {said['x_sure_n']}: {said['x_sure_right']:.3f} |",
                flush=True,
            )
            bins = [i for i in range(flag_scores.BINS) if said[f"x_bin_{i}_n"]]
            chart.plot(
                [said[f"x_bin_{i}_p"] for i in bins],
                [said[f"x_bin_{i}_right"] for i in bins],
                "o-",
                label=table,
            )
        chart.set(
            title=f"{name}, {half}", xlabel="stated probability", ylabel="share that is right"
        )
        chart.legend(fontsize=7)
    sheet.savefig(figure, dpi=110, bbox_inches="tight")
