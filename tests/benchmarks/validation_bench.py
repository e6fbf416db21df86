"""What the score of left-out scans is worth: against the truth, over plans that were damaged."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely
from plans_bench import find_truth, visible_truth
from scipy import stats

from scanplan.lab.evaluation import wall_findings, wall_metrics
from scanplan.plan import floorplan, floorplan_files
from scanplan.project import stage_settings
from scanplan.rays import ray_set
from scanplan.selection import stopping
from scanplan.store import registered_scans, tables
from scanplan.types import Columns, FloatArray, IntArray, Settings
from scanplan.validation import left_out_scans, prediction

_N_DAMAGED = 48  # plans of a survey: a dozen of each kind of damage
_N_PLACES = 40  # where a metre is removed, and where one is invented
_SHIFTS_M = (0.05, 0.3)
_PIECE_M = 1.0
_SIDE_M = 0.6  # farther is no side of the same wall
_CELL_M = 0.05  # of the evaluation's bitmap
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_LEAST_F1 = 0.5  # poses of drives without a localiser are in a frame of their own
_WITHIN = ("005m", "010m", "015m")


class Survey(NamedTuple):
    """A plan, the rays that test it, its settings, and what was visible of the truth."""

    plan: floorplan.FloorPlan
    rays: ray_set.RaySet
    limits: prediction.ValidationSettings
    floor: wall_findings.VisibleTruth


def bench(results: Path, surveys: Sequence[Path], settings: Settings) -> None:
    """Print a line for every finished survey that has a truth, there or in one of `surveys`."""
    for folder in sorted(path.parent for path in results.glob("*/plan")):
        truth = find_truth(folder, surveys)
        if truth is None:
            print(f"validation, {folder.name}: its truth is not known", flush=True)
            continue
        survey = _read_survey(folder, truth, settings)
        if _measure_quality(survey.plan, survey.floor) < _LEAST_F1:
            print(f"validation, {folder.name}: F1 below {_LEAST_F1}, left out", flush=True)
            continue
        _bench_damage(folder.name, survey)
        _bench_pieces(folder.name, survey)


def _read_survey(folder: Path, truth: Path, settings: Settings) -> Survey:
    limits = prediction.ValidationSettings(**stage_settings.select_validation(settings))
    parts = ("faces", "walls", "openings", "rooms", "free")
    plan = floorplan_files.read_floorplan({name: folder / f"plan/{name}.parquet" for name in parts})
    method = settings["plan"]["method"]
    stop = settings["selection"]["stop"]
    chosen_ids, _ = stopping.read_chosen_scans(folder / f"selection/{method}.parquet", **stop)
    chosen_ids = np.sort(chosen_ids)
    known = registered_scans.read_registered_scans(folder / "registration.parquet")
    store = tables.ScanStore(folder / "scans.parquet")
    rays = left_out_scans.draw_left_out_rays(store, known, chosen_ids, plan, limits)
    rows = np.searchsorted(known.scan_ids, chosen_ids)
    return Survey(plan, rays, limits, visible_truth(truth, known.t_ns, rows, settings))


def _bench_damage(name: str, survey: Survey) -> None:
    """Print how the score ranks damaged plans, beside the truth."""
    random = np.random.default_rng(1)
    started = time.process_time()
    rows = []
    for number in range(_N_DAMAGED):
        kind, damaged = _damage(survey.plan, number, random)
        rows.append((kind, *_score(survey, damaged), _measure_quality(damaged, survey.floor)))
    took_s = time.process_time() - started
    kinds, of_rays, of_length, quality = (np.array(column) for column in zip(*rows, strict=True))
    whole, right = _validate(survey, survey.plan), _measure_quality(survey.plan, survey.floor)
    print(f"validation, {name}: true F1 {right:.3f}, of {_N_DAMAGED} damaged plans", end=" ")
    print(f"{quality.min():.3f} to {quality.max():.3f}, {took_s:.0f} s", flush=True)
    for row, of_what, scores in ((-1, "rays", of_rays), (-2, "length", of_length)):
        share, low, high = (whole[column][row] for column in ("share", "share_low", "share_high"))
        rank = _rank_correlation(scores, quality)
        each = {kind: kinds == kind for kind in dict.fromkeys(kinds.tolist())}
        ranks = [
            f"{kind} {_rank_correlation(scores[those], quality[those]):.2f}"
            for kind, those in each.items()
        ]
        print(
            f"  of {of_what}: {share:.4f} ({low:.4f} to {high:.4f}), damaged {scores.min():.3f} to"
            f" {scores.max():.3f}, rank correlation {rank:.3f} ({', '.join(ranks)})",
            flush=True,
        )


def _rank_correlation(scores: FloatArray, qualities: FloatArray) -> float:
    """Return Spearman's coefficient."""
    ranks = stats.rankdata(scores), stats.rankdata(qualities)
    return float(np.corrcoef(*ranks)[0, 1])


def _score(survey: Survey, plan: floorplan.FloorPlan) -> tuple[float, float]:
    """Return the shares of rays and of the drawn length."""
    share = _validate(survey, plan)["share"]
    return share[-1], share[-2]


def _bench_pieces(name: str, survey: Survey) -> None:
    """Print in how many cases most rays contradict a metre that was removed or invented.

    First by the share itself, then by its interval: of a few places that is wide.
    """
    random = np.random.default_rng(2)
    seen = {"removed": [], "invented": []}
    for _ in range(_N_PLACES):
        for kind, make in (("removed", _remove_piece), ("invented", _invent)):
            damaged, at_m = make(survey.plan, random)
            seen[kind].append(_is_contradicted(_validate(survey, damaged), kind, at_m))
    shares = {kind: np.mean(values, axis=0) for kind, values in seen.items()}
    found = ", ".join(f"{kind} {shown:.3f} ({sure:.3f})" for kind, (shown, sure) in shares.items())
    print(f"  contradicted by most rays, of {_N_PLACES} pieces of 1 m each: {found}", flush=True)


def _is_contradicted(elements: Columns, kind: str, at_m: FloatArray) -> tuple[bool, bool]:
    """Return whether the share of an element of a piece (2, 2) is below half, and its interval."""
    of_kind = elements["kind"] == ("outline" if kind == "removed" else "face")
    with np.errstate(invalid="ignore"):
        middle_m = floorplan.centrelines_m(elements).mean(axis=1)
        along = (at_m[1] - at_m[0]) / _PIECE_M
        places_m = middle_m - at_m[0]
        beside_m = np.abs(places_m @ (-along[1], along[0]))
        own = of_kind & (beside_m < 0.2) & (np.abs(places_m @ along - _PIECE_M / 2) < 0.5)
        shares = (elements[name][own] for name in ("share", "share_high"))
        shown, sure = (bool((share < 0.5).any()) for share in shares)
        return shown, sure


def _validate(survey: Survey, plan: floorplan.FloorPlan) -> Columns:
    return prediction.validate_by_rays(plan, survey.rays, survey.limits).elements


def _measure_quality(plan: floorplan.FloorPlan, floor: wall_findings.VisibleTruth) -> float:
    """Return the mean of the true F1 of the faces within 5, 10 and 15 cm."""
    lines_m = floorplan.centrelines_m(plan.faces)
    measures = wall_metrics.measure_plan_lines(lines_m, floor, _CELL_M)
    return float(np.mean([measures[f"visible_f1_{within}"] for within in _WITHIN]))


def _damage(
    plan: floorplan.FloorPlan, number: int, random: np.random.Generator
) -> tuple[str, floorplan.FloorPlan]:
    """Return a plan with one kind of damage, more of it the higher the number."""
    kinds = ("removed", "shifted", "invented", "closed")
    kind = kinds[number % len(kinds)]
    step = number // len(kinds) + 1
    doors = np.flatnonzero(plan.openings["type"] != "window")
    for _ in range(step * 2):
        if kind == "removed":
            plan, _ = _remove_piece(plan, random)
        elif kind == "shifted":
            plan = _shift_wall(plan, random)
        elif kind == "invented":
            plan, _ = _invent(plan, random)
    if kind == "closed" and len(doors):
        plan = _close(plan, random.choice(doors, min(step, len(doors)), replace=False))
    return kind, plan


def _with_faces(plan: floorplan.FloorPlan, faces: Columns) -> floorplan.FloorPlan:
    numbered = dict(faces) | {"face": np.arange(len(faces["face"]), dtype=np.int32)}
    return replace(plan, faces=numbered)


def _added(plan: floorplan.FloorPlan, lines_m: FloatArray) -> floorplan.FloorPlan:
    """Return a plan with more faces, (n, 2, 2), of no wall."""
    rows = np.zeros(len(lines_m), int)
    faces = {name: np.append(values, values[rows]) for name, values in plan.faces.items()}
    for name, values in zip(
        ("x0_m", "y0_m", "x1_m", "y1_m"), lines_m.reshape(-1, 4).T, strict=True
    ):
        faces[name][-len(lines_m) :] = values
    faces["wall"][-len(lines_m) :] = -1
    return _with_faces(plan, faces)


def _remove_piece(
    plan: floorplan.FloorPlan, random: np.random.Generator
) -> tuple[floorplan.FloorPlan, FloatArray]:
    """Return a plan without a metre of a wall, on both of its sides, and where that was."""
    lines_m = floorplan.centrelines_m(plan.faces)
    gaps = shapely.buffer(shapely.union_all(plan.gaps), _CELL_M)
    rests = shapely.difference(floorplan.line_shapes(lines_m), gaps)
    parts, rows = shapely.get_parts(rests, return_index=True)
    of_piece = (shapely.length(parts) > _PIECE_M) & (plan.faces["state"][rows] == "observed")
    if not of_piece.any():
        return plan, np.full((2, 2), np.nan)
    length_m = np.where(of_piece, shapely.length(parts), 0)
    chosen = random.choice(len(parts), p=length_m / length_m.sum())
    row, ends_m = rows[chosen], shapely.get_coordinates(parts[chosen])
    along = (ends_m[1] - ends_m[0]) / length_m[chosen]
    start_m = ends_m[0] + random.uniform(0, length_m[chosen] - _PIECE_M) * along
    piece_m = np.stack([start_m, start_m + _PIECE_M * along])
    wall = plan.faces["wall"][row]
    is_cut = (plan.faces["wall"] == wall) & (wall >= 0)
    is_cut[row] = True
    kept = {name: [] for name in plan.faces}
    for other, line_m in enumerate(lines_m):
        for rest_m in _outside(line_m, piece_m) if is_cut[other] else [line_m]:
            values = {name: column[other] for name, column in plan.faces.items()}
            values |= dict(zip(_ENDS, rest_m.ravel(), strict=True))
            for name, value in values.items():
                kept[name].append(value)
    faces = {name: np.array(values, plan.faces[name].dtype) for name, values in kept.items()}
    return _with_faces(plan, faces), piece_m


def _outside(ends_m: FloatArray, piece_m: FloatArray) -> list[FloatArray]:
    """Return what a line (2, 2) has beside a piece, the other side of its wall with it."""
    line, piece = floorplan.line_shapes(np.stack([ends_m, piece_m]))
    rest = shapely.difference(line, shapely.buffer(piece, _SIDE_M, cap_style="flat"))
    return [shapely.get_coordinates(part) for part in shapely.get_parts(rest) if part.length > 0]


def _shift_wall(plan: floorplan.FloorPlan, random: np.random.Generator) -> floorplan.FloorPlan:
    """Return a plan with both sides of a wall moved square to it."""
    wall = random.choice(np.unique(plan.faces["wall"]))
    moved = plan.faces["wall"] == wall
    row = np.flatnonzero(moved)[0]
    by_m = random.uniform(*_SHIFTS_M) * random.choice([-1, 1])
    faces = {name: values.copy() for name, values in plan.faces.items()}
    for axis in ("x", "y"):
        for end in (0, 1):
            faces[f"{axis}{end}_m"][moved] += by_m * plan.faces[f"n{axis}"][row]
    return _with_faces(plan, faces)


def _invent(
    plan: floorplan.FloorPlan, random: np.random.Generator
) -> tuple[floorplan.FloorPlan, FloatArray]:
    """Return a plan with a face of a metre in a room, and where that is."""
    area = shapely.union_all(plan.areas)
    low_m, high_m = np.reshape(area.bounds, (2, 2))
    while True:
        start_m = random.uniform(low_m, high_m)
        angle = random.uniform(0, 2 * np.pi)
        ends_m = np.stack([start_m, start_m + _PIECE_M * np.array([np.cos(angle), np.sin(angle)])])
        # no wall stands at it as it is
        if area.contains(shapely.buffer(shapely.linestrings(ends_m), _SIDE_M)):
            return _added(plan, ends_m[None]), ends_m


def _close(plan: floorplan.FloorPlan, rows: IntArray) -> floorplan.FloorPlan:
    """Return a plan with faces in place of openings, on both sides of their walls."""
    kept = np.ones(len(plan.openings["wall"]), bool)
    kept[rows] = False
    lines_m = floorplan.centrelines_m(plan.openings)[rows]
    along = (lines_m[:, 1] - lines_m[:, 0]) / plan.openings["width_m"][rows, None]
    side_m = np.nan_to_num(plan.openings["thickness_m"][rows] / 2)[:, None]
    aside_m = (side_m * np.column_stack([-along[:, 1], along[:, 0]]))[:, None]
    openings = {name: values[kept] for name, values in plan.openings.items()}
    both_m = np.concatenate([lines_m + aside_m, lines_m - aside_m])
    return _added(replace(plan, openings=openings), both_m)
