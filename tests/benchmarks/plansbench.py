"""Plans of finished surveys against the truth: of chosen scans, of all, and a line detector on all points."""

import importlib.util
import time
from types import SimpleNamespace

import ifcopenshell
import numpy as np
import wallbench

from helpers import ifc_volumes
from scanplan.lab.evaluation import plan_metrics, true_plan, truth_file, wall_findings, wall_metrics
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.rays import ray_set
from scanplan.selection import stopping
from scanplan.store import registered_scans, schemas, tables

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
    "missed_not_seen": "not seen",
    "missed_misplaced": "misplaced",
    "missed_misextracted": "not extracted",
}


def bench(results, surveys, settings):
    """Print a table for every survey under `results` that has walls, an ordering and, there or in `survey`, a truth.

    Parameters
    ----------
    results : Path
        With a folder for each dataset, as the workflow makes them.
    surveys : list of Path
        Folders of dataset folders.
    settings : dict
        The whole configuration.
    """
    found = [(f, _truth(f, surveys)) for f in sorted(p.parent for p in results.glob("*/walls"))]
    found = [(folder, truth) for folder, truth in found if truth]
    if not found:
        print(
            f"plans: no survey with walls and a truth under {results}; run the workflow on one first",
            flush=True,
        )
    for folder, truth in found:
        _bench(folder, truth, settings)


def _truth(folder, surveys):
    places = [folder / "survey", *(s / folder.name for s in surveys)]
    return next(
        (p for p in places if (p / "truth.geojson").exists() and (p / "truth_poses.tum").exists()),
        None,
    )


def _bench(folder, truth, settings):
    kept, store = (
        registered_scans.read_registered_scans(folder / "registration.parquet"),
        tables.ScanStore(folder / "scans.parquet"),
    )
    ordering = tables.read_table(
        folder / f"selection/{settings['plan']['method']}.parquet", schemas.SELECTION
    )
    seen = tables.read_table(
        folder / f"walls/{settings['plan']['extractor']}.parquet", schemas.WALLS, allow_empty=True
    )
    count, _ = stopping.choose_n_scans(ordering, **settings["selection"]["stop"])
    everything = np.sort(ordering["scan_id"])
    true, poses = (
        true_plan.read_true_plan(truth / "truth.geojson"),
        truth_file.read_true_poses(truth / "truth_poses.tum"),
    )
    placed, survey = (
        truth_file.interpolate_true_poses(poses, kept.t_ns, truth),
        truth_file.true_pose_matrices(poses),
    )
    faces = truth_file.read_true_faces(truth / "truth.geojson")
    sight = truth_file.read_sensor_view(
        truth / "truth.geojson", max_range_m=settings["input"]["max_range_m"]
    )
    print(
        f"plans, {folder.name}: {count} of {len(everything)} scans chosen ({count / len(everything):.0%})",
        flush=True,
    )
    for name, chosen in (
        ("chosen scans", np.sort(ordering["scan_id"][:count])),
        ("all scans", everything),
    ):
        rows = registered_scans.rows_of_scans(chosen, kept, folder, folder)
        floor = wall_findings.observe_truth(faces, placed[rows], survey, sight=sight)
        started = time.process_time()
        plan = _plan(seen, store, kept, rows, chosen, settings)
        _tell(f"plan of {name}", _of_plan(plan, true, floor), time.process_time() - started)
    if (folder / "plan/plan.ifc").exists():
        model, text = (
            ifcopenshell.open(folder / "plan/plan.ifc"),
            (truth / "truth.geojson").read_text(),
        )
        count, found_m3, true_m3 = ifc_volumes.compared(model, text)
        print(
            f"  plan.ifc: {count} walls measured, {found_m3:.2f} m3 of {true_m3:.2f} ({found_m3 / true_m3 - 1:+.1%})"
        )
    if not importlib.util.find_spec("cv2"):
        print("  raster and LSD: no OpenCV (cv2) here, so without its line detector", flush=True)
        return
    survey = SimpleNamespace(
        scans=[(i, _above_floor(xyz_m, plan)) for i, xyz_m in store.scans(everything)]
    )
    started = time.process_time()
    lines_m = wallbench.raster_lines(survey)
    _tell("raster and LSD, all scans", _of_lines(lines_m, floor), time.process_time() - started)


def _plan(seen, store, kept, rows, chosen, settings):
    positions = dict(zip(chosen.tolist(), kept.map_from_sensor[rows, :3, 3], strict=True))
    looked = ray_set.gather_rays(store.scans(chosen), positions, planar=store.planar)
    used = np.isin(seen["scan_id"], chosen)
    segments = {column: values[used] for column, values in seen.items()}
    track_m, up = kept.map_from_sensor[:, :2, 3], kept.map_from_sensor[rows, :3, 2]
    plan = planning.make_plan(
        segments,
        looked,
        track_m,
        kept.t_ns[rows],
        planning.make_plan_settings(**stage_settings.select_plan(settings)),
        up,
    )
    return SimpleNamespace(plan=plan, floor_z_m=looked.floor_z_m)


def _of_plan(made, true, floor):
    tables_ = ("faces", "walls", "openings", "rooms")
    drawn = {t: {name: np.asarray(v) for name, v in getattr(made.plan, t).items()} for t in tables_}
    return _of_lines(
        plan_metrics.moved_faces_m(drawn, np.eye(4)), floor
    ) | plan_metrics.measure_plan(drawn, np.eye(4), true, floor)


def _of_lines(lines_m, floor):
    return wall_metrics.measure_plan_lines(lines_m, floor, 0.05) | plan_metrics.measure_faces(
        *(lines_m, np.ones(len(lines_m), bool), floor.cells, floor.visible, floor.seen.any(axis=0))
    )


def _above_floor(xyz_m, made):
    return np.asarray(xyz_m, float) - (0, 0, np.nan_to_num(made.floor_z_m))


def _tell(name, row, took_s):
    figures = [f"{told} {row[key]:.3g}" for key, told in _FIGURES.items() if key in row]
    print(f"  {name}: {', '.join(figures)}; {took_s:.1f} s of one core", flush=True)
