"""Measure the plan against the true one (thesis, section 5.1, and also openings and rooms)."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.lab.evaluation import (
    plan_metrics,
    pose_errors,
    true_plan,
    truth_file,
    wall_findings,
    wall_metrics,
)
from scanplan.recordings.motion import pose_kind
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath

_FRAMES = {
    "aligned": "moved onto the truth by one rigid motion",
    "registered": "where it is in the map",
}


def evaluate_plan(
    inputs: Mapping[str, FilePath],
    output: FilePath,
    *,
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write how good the plan is, where it is in the map and after one rigid motion.

    Parameters
    ----------
    inputs : dict of str to path-like
        plan/<name>.parquet by the names `faces`, `walls`, `openings`, `rooms`, `furniture`, `free`
        and `evidence`; `poses`, `registration`, `truth` and `true_poses`: poses.parquet,
        registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        evaluation/plan.parquet, to write.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    registration, truth = inputs["registration"], inputs["truth"]
    evidence, true_poses = inputs["evidence"], inputs["true_poses"]
    scans = registered_scans.read_registered_scans(registration)
    track = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(track, scans.t_ns, true_poses)
    drawn = plan_metrics.leave_unseen_sides(plan_metrics.read_plan_tables(inputs))
    plan_scan_ids = plan_metrics.evidence_scan_ids(evidence)
    rows = registered_scans.rows_of_scans(plan_scan_ids, scans, evidence, registration)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth),
        placed[rows],
        truth_file.true_pose_matrices(track),
        sight=truth_file.read_sensor_view(truth, max_range_m=max_range_m),
    )
    true = true_plan.read_true_plan(truth)
    motion = pose_errors.fit_alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    measures = []
    for frame, moved in (("aligned", motion), ("registered", np.eye(4))):
        faces_m = plan_metrics.moved_faces_m(drawn, moved)
        row = {
            "frame": frame,
            "n_scans": len(plan_scan_ids),
            **wall_metrics.measure_plan_lines(faces_m, floor, bitmap_cell_m),
            **plan_metrics.measure_plan(drawn, moved, true, floor),
        }
        measures.append(row)
    _log_measures({row["frame"]: row for row in measures}, inputs["free"], inputs["poses"])
    columns = plan_metrics.plan_evaluation_columns(measures)
    tables.write_table(output, schemas.PLAN_EVALUATION, columns)


def _log_measures(measures: Mapping[str, Any], free: FilePath, poses: FilePath) -> None:
    """Tell the measures by frame, those first that mean something for the kind of poses."""
    has_heights = tables.read_note(free, schemas.FREE, "floor_z_m") not in ("", "nan")
    frames = ["registered", "aligned"]
    if pose_kind.is_drifting(tables.read_note(poses, schemas.POSES, pose_kind.NOTE)):
        frames = ["aligned"]
        log.log_line(
            "evaluate_plan: the poses are odometry: the aligned figures say how good the plan is,"
            " as it lies in the first scan's frame"
        )
    for frame in frames:
        words = plan_metrics.summarise_plan_measures(measures[frame], has_heights=has_heights)
        log.log_line(f"evaluate_plan: {frame}, {words} ({_FRAMES[frame]})")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_plan(
            dict(snakemake.input.items()),
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
