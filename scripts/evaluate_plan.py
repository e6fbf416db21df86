"""Measure the plan against the true one (thesis, section 5.1, and also openings and rooms)."""

from collections.abc import Mapping

import numpy as np

from scanplan.lab.evaluation import (
    plan_metrics,
    pose_errors,
    true_plan,
    truth_file,
    wall_findings,
    wall_metrics,
)
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath


def evaluate_plan(
    plan: Mapping[str, FilePath],
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    *,
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write how good the plan is, where it is in the map and after one rigid motion.

    Parameters
    ----------
    plan : dict of str to path-like
        plan/<name>.parquet by the names `faces`, `walls`, `openings`, `rooms`, `furniture` and
        `evidence`.
    registration, truth, true_poses, output : path-like
        registration.parquet, truth.geojson and truth_poses.tum; evaluation/plan.parquet, to write.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    scans = registered_scans.read_registered_scans(registration)
    poses = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(poses, scans.t_ns, true_poses)
    drawn = plan_metrics.read_plan_tables(plan)
    plan_scan_ids = plan_metrics.evidence_scan_ids(plan["evidence"])
    rows = registered_scans.rows_of_scans(plan_scan_ids, scans, plan["evidence"], registration)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth),
        placed[rows],
        truth_file.true_pose_matrices(poses),
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
        log.log_line(f"evaluate_plan: {frame}, {plan_metrics.summarise_plan_measures(row)}")
        measures.append(row)
    columns = plan_metrics.plan_evaluation_columns(measures)
    tables.write_table(output, schemas.PLAN_EVALUATION, columns)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        names = ("faces", "walls", "openings", "rooms", "furniture", "evidence")
        evaluate_plan(
            {name: snakemake.input[name] for name in names},
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
