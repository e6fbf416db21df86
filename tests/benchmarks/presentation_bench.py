"""Regular drawings of simulated drives against their truths, beside what was measured."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from scanplan.exports.drafting.regular_plan import MEASURED, draft_plan, make_draft_settings
from scanplan.geometry.lines import left_normals
from scanplan.lab.evaluation.scores import drawn_plan, plan_scores, score_files
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan
from scanplan.lab.evaluation.scores.scene import TrueOpenings
from scanplan.lab.evaluation.scores.score_files import Placed
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_shapes
from scanplan.project import catalogue_file
from scanplan.types import BoolArray, Columns, FloatArray, IntArray, Settings

_SHOWN = (
    *("room_iou", "wall_correctness_010", "wall_completeness_010", "solid_right", "solid_complete"),
    "thickness_error_m",
    *("angle_deg", "true_thickness", "true_door", "door_off_m", "true_window", "window_off_m"),
)
_LONG_M = 1.0  # a shorter wall has hardly a direction
_NEAR_M = 0.1  # as far as a wall counts as drawn right
_BESIDE_DEG = 5.0  # of the true wall that a drawn one is held against
_TRUE_KINDS = {"door": ("door", "passage"), "window": ("window",)}
_JAMB_M = 0.3  # from the middle of a true opening to that of a drawn one
_WIDTH_M = 0.01  # of a width that is the true one: half of what sizes of a catalogue are apart
_ALIKE_M = 0.0015  # of a thickness that is the true one: what tables are rounded to, and a little
_TABLES = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")


def bench(results: Path, truths: Path, names: Sequence[str], settings: Settings) -> None:
    """Print measures of each drive's plan, as measured and made regular, and their means.

    Parameters
    ----------
    results : Path
        Folder of the drives' results, with registrations and plans.
    truths : Path
        Folder of folders with truth.geojson and truth_poses.tum.
    names : sequence of str
        Drives; all that have both where none is named.
    settings : dict
        Default settings.
    """
    export = settings["plan"]["export"]
    sizes = catalogue_file.read_catalogue(export["catalogue"])
    drafting = make_draft_settings(export["max_change_m"], sizes)
    found = names or sorted(p.parent.name for p in truths.glob("*/truth.geojson"))
    rows: list[list[dict[str, float]]] = []
    for name in found:
        if not (results / name / "plan/free.parquet").is_file():
            continue
        truth = truths / name
        placed = score_files.place_results(
            results / name, truth / "truth.geojson", truth / "truth_poses.tum"
        )
        files = {table: results / name / f"plan/{table}.parquet" for table in _TABLES}
        plan = floorplan_files.read_floorplan(files, name)
        regular, drafted = draft_plan(plan, drafting)
        measured = score_files.read_plan(results / name)
        clear = _narrow_by_frames(placed.scene.openings, truth / "truth.geojson")
        both = (measured, _replace(measured, regular))
        solid = (measured, _leave_outlines(both[1], regular))
        rows.append(
            [
                _measure(tables, placed, clear) | _measure_solid(walls, placed)
                for tables, walls in zip(both, solid, strict=True)
            ]
        )
        print(f"{name}: {_format(rows[-1])}, moved by {1000 * drafted.moved_m:.0f} mm", flush=True)
    means = [
        {key: float(np.nanmean([row[number][key] for row in rows])) for key in _SHOWN}
        for number in (0, 1)
    ]
    print(f"mean of {len(rows)}: {_format(means)}")


def _format(pair: Sequence[Mapping[str, float]]) -> str:
    measured, regular = pair
    return ", ".join(f"{key} {measured[key]:.4f} -> {regular[key]:.4f}" for key in _SHOWN)


def _replace(tables: Mapping[str, Columns], regular: FloorPlan) -> dict[str, Columns]:
    """Return a plan's tables as those of its regular one, assumed thickness left out.

    What was measured of reveals is there where walls that are drawn end as they do.
    """
    walls = regular.walls
    known_m = np.where(walls["thickness_from"] == MEASURED, walls["thickness_m"], np.nan)
    changed = {"walls": {**walls, "thickness_m": known_m}, "openings": regular.openings}
    measured = tables["faces"]
    is_jamb = ~np.isin(measured["face"], regular.faces["face"]) & _find_jambs(measured, regular)
    faces = {
        name: np.concatenate([values, measured[name][is_jamb]])
        for name, values in regular.faces.items()
    }
    return {**tables, "faces": faces, "rooms": regular.rooms, **changed}


def _leave_outlines(tables: Mapping[str, Columns], regular: FloorPlan) -> dict[str, Columns]:
    """Return a plan's tables without faces of walls that are outlines: perhaps they are none."""
    faces = tables["faces"]
    is_solid = ~np.isin(faces["wall"], regular.walls["wall"][regular.walls["perhaps"]])
    return {**tables, "faces": {name: values[is_solid] for name, values in faces.items()}}


def _measure_solid(tables: Mapping[str, Columns], placed: Placed) -> dict[str, float]:
    scored = plan_scores.score_plan(tables, placed.motion, placed.scene, placed.known_sight)
    return {
        "solid_right": scored.measures["wall_correctness_010"],
        "solid_complete": scored.measures["wall_completeness_010"],
    }


def _find_jambs(faces: Columns, regular: FloorPlan) -> BoolArray:
    """Return which faces (f,) are sides of openings of a regular plan: reveals, drawn by wall."""
    left_m, right_m = regular.sides_m
    rows = np.flatnonzero(regular.hosts >= 0)
    hosts = regular.hosts[rows]
    across = left_normals(centrelines_m(regular.walls))[hosts]
    sides_m = np.stack([left_m[hosts], -right_m[hosts]], axis=1)
    ends_m = centrelines_m(regular.openings)[rows]
    jambs_m = ends_m[:, :, None] + sides_m[:, None, :, None] * across[:, None, None]
    drawn = shapely.union_all(shapely.buffer(line_shapes(jambs_m.reshape(-1, 2, 2)), _NEAR_M))
    lines = line_shapes(centrelines_m(faces))
    return shapely.length(shapely.intersection(lines, drawn)) > 0.5 * shapely.length(lines)


def _narrow_by_frames(true: TrueOpenings, file: Path) -> TrueOpenings:
    """Return openings between their frames, as scans see them and a catalogue has them."""
    drawn = [
        (np.array(feature["geometry"]["coordinates"]), feature["properties"].get("frame_m", 0.0))
        for feature in json.loads(file.read_text())["features"]
        if feature["properties"]["kind"] == "opening"
    ]
    middles_m = np.array([line_m.mean(axis=0) for line_m, _ in drawn]).reshape(-1, 2)
    lines_m = true.lines_m.copy()
    for line_m in lines_m:
        apart_m = np.hypot(*(middles_m - line_m.mean(axis=0)).T)
        frame_m = drawn[int(np.argmin(apart_m))][1] if len(drawn) else 0.0
        way_m = line_m[1] - line_m[0]
        in_m = frame_m * way_m / np.hypot(*way_m)
        line_m += np.stack([in_m, -in_m])
    return replace(true, lines_m=lines_m)


def _measure(
    tables: Mapping[str, Columns], placed: Placed, clear: TrueOpenings
) -> dict[str, float]:
    scored = plan_scores.score_plan(tables, placed.motion, placed.scene, placed.known_sight)
    plan, scene = drawn_plan.place_plan(tables, placed.motion), placed.scene
    true_faces_m = np.concatenate([scene.inner_m, scene.outer_m])
    off_deg, lengths_m, _, _ = _pair(plan.faces_m, true_faces_m)
    known = np.isfinite(plan.thickness_m)
    _, walls_m, rows, of = _pair(plan.walls_m[known], scene.walls_m)
    thick_m, true_m = plan.thickness_m[known][rows], scene.thickness_m[of]
    is_true = (thick_m >= true_m.min(axis=1) - _ALIKE_M) & (
        thick_m <= true_m.max(axis=1) + _ALIKE_M
    )
    return {
        **scored.measures,
        "angle_deg": _mean(off_deg, lengths_m),
        "true_thickness": _mean(is_true, walls_m),
        **_measure_widths(plan, clear),
    }


def _measure_widths(plan: DrawnPlan, true: TrueOpenings) -> dict[str, float]:
    """Return the share of doors and windows as wide as the true one there, and the median error."""
    found: dict[str, float] = {}
    for kind, true_kinds in _TRUE_KINDS.items():
        drawn_m = plan.openings_m[np.asarray(plan.type == kind, bool)]
        true_m = true.lines_m[np.isin(true.type, true_kinds)]
        widths_m, true_widths_m = (np.hypot(*(m[:, 1] - m[:, 0]).T) for m in (drawn_m, true_m))
        off = drawn_m.mean(axis=1)[:, None] - true_m.mean(axis=1)
        apart_m = np.hypot(off[..., 0], off[..., 1])
        rows = np.flatnonzero((apart_m < _JAMB_M).any(axis=1))
        by_m = widths_m[rows] - true_widths_m[apart_m[rows].argmin(axis=1)] if len(rows) else rows
        found[f"true_{kind}"] = _mean((np.abs(by_m) <= _WIDTH_M).astype(float), np.ones(len(rows)))
        found[f"{kind}_off_m"] = float(np.median(by_m)) if len(rows) else np.nan
    return found


def _pair(
    lines_m: FloatArray, true_m: FloatArray
) -> tuple[FloatArray, FloatArray, IntArray, IntArray]:
    """Return of lines with a true one at their middle: turned by, length, row, the other's row."""
    ways, true_ways = (line[:, 1] - line[:, 0] for line in (lines_m, true_m))
    lengths_m, true_lengths_m = (np.hypot(*way.T) for way in (ways, true_ways))
    angles, true_angles = (np.degrees(np.arctan2(*way.T[::-1])) for way in (ways, true_ways))
    off_deg = np.abs((angles[:, None] - true_angles + 90) % 180 - 90)
    middles = np.asarray(shapely.points(lines_m.mean(axis=1)), object)
    apart_m = shapely.distance(middles[:, None], np.asarray(shapely.linestrings(true_m), object))
    is_near = (apart_m < _NEAR_M) & (off_deg < _BESIDE_DEG) & (true_lengths_m > _LONG_M)
    rows = np.flatnonzero(is_near.any(axis=1) & (lengths_m > _LONG_M))
    of = np.where(is_near, apart_m, np.inf)[rows].argmin(axis=1)
    return off_deg[rows, of], lengths_m[rows], rows, of


def _mean(values: FloatArray, weights: FloatArray) -> float:
    return float(np.average(values, weights=weights)) if len(values) else np.nan
