"""Plans of finished surveys against the truth: of chosen scans, of all, and a line detector's."""

import functools
import importlib.util
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import ifcopenshell
import numpy as np
import shapely
import walls_bench
import watershed_rooms

from helpers import ifc_volumes
from scanplan.lab.evaluation import (
    plan_metrics,
    true_plan,
    truth_file,
    visible_faces,
    wall_findings,
    wall_metrics,
)
from scanplan.plan import planning
from scanplan.plan.model import fronts
from scanplan.project import stage_settings
from scanplan.rays import free_space, ray_set
from scanplan.selection import stopping
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import Array, Columns, FloatArray, IntArray, Settings

_FIGURES = {
    "correctness_010m": "right",
    "visible_completeness_010m": "of visible",
    "redundancy": "redundancy",
    "plan_walls_per_true_wall": "walls/true",
    "thickness_error_m": "thickness m",
    "door_recall": "door recall",
    "door_precision": "precision",
    "door_width_error_m": "width m",
    "window_recall": "window recall",
    "window_precision": "precision",
    "n_rooms_found": "rooms",
    "n_rooms_false": "false",
    "room_iou": "IoU",
    "seen_room_iou": "of what was seen",
    "missed_not_seen": "not seen",
    "missed_misplaced": "misplaced",
    "missed_misextracted": "not extracted",
}
"""Measure to what it is printed as."""

_CELL_M = 0.05  # that of the evaluation's bitmap


class Results(NamedTuple):
    """What the workflow made of a survey."""

    folder: Path
    walls: Columns
    ordering: Columns
    registered: registered_scans.RegisteredScans
    store: tables.ScanStore


class Plan(NamedTuple):
    """A plan, and the floor's height in the map."""

    plan: Any
    floor_z_m: float


def bench(results: Path, surveys: Sequence[Path], settings: Settings) -> None:
    """Print a table for every finished survey that has a truth, there or in one of `surveys`.

    Parameters
    ----------
    results : Path
        With a folder for each dataset, as the workflow makes them.
    surveys : list of Path
        Folders of dataset folders.
    settings : dict
        The whole configuration.
    """
    folders = sorted(path.parent for path in results.glob("*/walls"))
    truths = {folder: find_truth(folder, surveys) for folder in folders}
    finished = {folder: truth for folder, truth in truths.items() if truth is not None}
    if not finished:
        print(
            f"plans: no survey with walls and a truth under {results}; `make compare` makes them",
            flush=True,
        )
    for folder, truth in finished.items():
        _bench_survey(_read_results(folder, settings), truth, settings)


def find_truth(folder: Path, surveys: Sequence[Path]) -> Path | None:
    """Return the folder of a survey's truth, there or in one of `surveys`."""
    places = [folder / "survey", *(survey / folder.name for survey in surveys)]
    names = ("truth.geojson", "truth_poses.tum")
    complete = (place for place in places if all((place / name).exists() for name in names))
    return next(complete, None)


def _read_results(folder: Path, settings: Settings) -> Results:
    method, extractor = settings["plan"]["method"], settings["plan"]["extractor"]
    return Results(
        folder,
        tables.read_table(folder / f"walls/{extractor}.parquet", schemas.WALLS, allow_empty=True),
        tables.read_table(folder / f"selection/{method}.parquet", schemas.SELECTION),
        registered_scans.read_registered_scans(folder / "registration.parquet"),
        tables.ScanStore(folder / "scans.parquet"),
    )


def _bench_survey(found: Results, truth: Path, settings: Settings) -> None:
    stop = settings["selection"]["stop"]
    count, _ = stopping.choose_n_scans(found.ordering, planar=found.store.planar, **stop)
    all_ids = np.sort(found.ordering["scan_id"])
    share = count / len(all_ids)
    print(
        f"plans, {found.folder.name}: {count} of {len(all_ids)} scans chosen ({share:.0%})",
        flush=True,
    )
    chosen_ids = np.sort(found.ordering["scan_id"][:count])
    _bench_plan("plan of chosen scans", found, chosen_ids, truth, settings)
    plan, floor = _bench_plan("plan of all scans", found, all_ids, truth, settings)
    _print_volumes(found.folder, truth)
    _bench_raster(found, all_ids, plan, floor)
    _bench_watershed(found, all_ids, truth, settings)


def _bench_plan(
    name: str, found: Results, scan_ids: IntArray, truth: Path, settings: Settings
) -> tuple[Plan, wall_findings.VisibleTruth]:
    rows = registered_scans.rows_of_scans(scan_ids, found.registered, found.folder, found.folder)
    floor = visible_truth(truth, found.registered.t_ns, rows, settings)
    started = time.process_time()
    plan = _make_plan(found, rows, scan_ids, settings)
    took_s = time.process_time() - started
    true = true_plan.read_true_plan(truth / "truth.geojson")
    rooms = shapely.from_wkb(plan.plan.rooms["geometry"])
    measures = _measure_plan(plan, true, floor) | _measure_seen_rooms(rooms, true, truth, settings)
    _print_row(name, measures, took_s)
    return plan, floor


def _measure_seen_rooms(
    rooms: Array, true: true_plan.TruePlan, truth: Path, settings: Settings
) -> dict[str, float]:
    """Measure rooms on the ground that the survey could see.

    What stands in a room hides ground from level beams: no plan can know what is there.
    """
    seen = _find_visible_ground(truth, settings)
    drawn, entered = (
        shapely.intersection(shapely.make_valid(np.asarray(shapes, object)), seen)
        for shapes in (rooms, true.rooms)
    )
    measures = plan_metrics.measure_rooms(list(drawn), list(entered), true.visited)
    return {"seen_room_iou": measures["room_iou"]}


def _find_visible_ground(truth: Path, settings: Settings) -> shapely.Geometry:
    """Return the ground between the sensor's true places and what stops its level beams."""
    faces = truth_file.read_true_faces(truth / "truth.geojson")
    lines_m = np.concatenate([faces.inner_m, faces.outer_m])
    view = truth_file.read_sensor_view(
        truth / "truth.geojson", max_range_m=settings["input"]["max_range_m"]
    )
    poses = truth_file.true_pose_matrices(truth_file.read_true_poses(truth / "truth_poses.tum"))
    grounds = []
    for pose in poses:
        place_m = pose[:2, 3]
        corners_m = visible_faces.visible_polygon(lines_m, place_m, open_m=view.max_range_m)
        ahead_rad = np.arctan2(pose[1, 0], pose[0, 0])
        turn_rad = ahead_rad + np.linspace(-view.field_rad / 2, view.field_rad / 2, 60)
        rim_m = place_m + view.max_range_m * np.column_stack([np.cos(turn_rad), np.sin(turn_rad)])
        field, ground = (
            free_space.polygon_parts(shapely.make_valid(shapely.Polygon(outline)))
            for outline in ([place_m, *rim_m], corners_m)
        )
        grounds.append(free_space.polygon_parts(shapely.intersection(ground, field)))
    return free_space.union_on_grid(grounds)


def visible_truth(
    truth: Path, t_ns: IntArray, rows: IntArray, settings: Settings
) -> wall_findings.VisibleTruth:
    """Return what the survey, and the scans at these rows, could see of the true faces."""
    poses = truth_file.read_true_poses(truth / "truth_poses.tum")
    placed = truth_file.interpolate_true_poses(poses, t_ns, truth)
    survey = truth_file.true_pose_matrices(poses)
    faces = truth_file.read_true_faces(truth / "truth.geojson")
    view = truth_file.read_sensor_view(
        truth / "truth.geojson", max_range_m=settings["input"]["max_range_m"]
    )
    return wall_findings.observe_truth(faces, placed[rows], survey, sight=view)


def _make_plan(found: Results, rows: IntArray, scan_ids: IntArray, settings: Settings) -> Plan:
    poses = found.registered.map_from_sensor
    sensors_m = dict(zip(found.registered.scan_ids.tolist(), poses[:, :3, 3], strict=True))
    rays = ray_set.gather_rays(found.store.scans(scan_ids), sensors_m, planar=found.store.planar)
    used = np.isin(found.walls["scan_id"], scan_ids)
    find_floor = None
    if found.store.planar:
        retained = found.store.scans(found.registered.scan_ids)
        find_floor = functools.partial(free_space.find_seen_floor, retained, sensors_m)
    dense = fronts.DenseScans(found.store.scans, found.registered, found.store.planar)
    others = planning.OtherScans(find_floor, dense)
    segments = {column: values[used] for column, values in found.walls.items()}
    plan = planning.make_plan(
        planning.ChosenScans.of_registered(segments, rays, found.registered, rows),
        poses[:, :2, 3],
        planning.make_plan_settings(stage_settings.select_plan(settings)),
        others=others,
    )
    return Plan(plan, rays.floor_z_m)


def _measure_plan(
    made: Plan, true: true_plan.TruePlan, floor: wall_findings.VisibleTruth
) -> dict[str, float]:
    drawn = {
        table: {name: np.asarray(values) for name, values in getattr(made.plan, table).items()}
        for table in ("faces", "walls", "openings", "rooms", "furniture")
    }
    lines_m = plan_metrics.moved_faces_m(drawn, np.eye(4))
    return _measure_lines(lines_m, floor) | plan_metrics.measure_plan(drawn, np.eye(4), true, floor)


def _measure_lines(lines_m: FloatArray, floor: wall_findings.VisibleTruth) -> dict[str, float]:
    observed = np.ones(len(lines_m), bool)
    faces = plan_metrics.measure_faces(
        lines_m, observed, floor.cells, floor.visible, np.asarray(floor.seen.any(axis=0))
    )
    return wall_metrics.measure_plan_lines(lines_m, floor, _CELL_M) | faces


def _print_volumes(folder: Path, truth: Path) -> None:
    file = folder / "plan/plan.ifc"
    if file.exists():
        text = (truth / "truth.geojson").read_text()
        count, found_m3, true_m3 = ifc_volumes.compared(ifcopenshell.open(file), text)
        print(
            f"  plan.ifc: {count} walls measured, {found_m3:.2f} m3 of {true_m3:.2f}"
            f" ({found_m3 / true_m3 - 1:+.1%})"
        )


def _bench_raster(
    found: Results, scan_ids: IntArray, plan: Plan, floor: wall_findings.VisibleTruth
) -> None:
    if not importlib.util.find_spec("cv2"):
        print("  raster and LSD: no OpenCV (cv2) here, so without its line detector", flush=True)
        return
    up_m = np.array([0, 0, np.nan_to_num(plan.floor_z_m)])
    scans = [(i, np.asarray(xyz_m, float) - up_m) for i, xyz_m in found.store.scans(scan_ids)]
    started = time.process_time()
    lines_m = walls_bench.raster_lines(scans, planar=found.store.planar)
    took_s = time.process_time() - started
    _print_row("raster and LSD, all scans", _measure_lines(lines_m, floor), took_s)


def _bench_watershed(found: Results, scan_ids: IntArray, truth: Path, settings: Settings) -> None:
    rows = registered_scans.rows_of_scans(scan_ids, found.registered, found.folder, found.folder)
    sensors_m = found.registered.map_from_sensor[rows, :3, 3]
    positions = dict(zip(scan_ids.tolist(), sensors_m, strict=True))
    started = time.process_time()
    rays = ray_set.gather_rays(found.store.scans(scan_ids), positions, planar=found.store.planar)
    rooms = watershed_rooms.find_watershed_rooms(rays)
    took_s = time.process_time() - started
    true = true_plan.read_true_plan(truth / "truth.geojson")
    row = plan_metrics.measure_rooms(rooms, true.rooms, true.visited)
    row |= _measure_seen_rooms(np.array(rooms, object), true, truth, settings)
    _print_row("watershed of distances, all scans", row, took_s)


def _print_row(name: str, row: Mapping[str, float], took_s: float) -> None:
    figures = [f"{label} {row[key]:.3g}" for key, label in _FIGURES.items() if key in row]
    print(f"  {name}: {', '.join(figures)}; {took_s:.1f} s of one core", flush=True)
