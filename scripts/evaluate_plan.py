"""Measure the plan against the true one (thesis, section 5.1, and what it does not measure: openings and rooms)."""

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


def evaluate_plan(plan, registration, truth, true_poses, output, *, max_range_m, bitmap_cell_m):
    """Write how good the plan is, where it is in the map and after one rigid motion.

    Parameters
    ----------
    plan : dict of str to path-like
        plan/<name>.parquet by the names `faces`, `walls`, `openings`, `rooms` and `evidence`.
    registration, truth, true_poses, output : path-like
        registration.parquet, truth.geojson and truth_poses.tum; evaluation/plan.parquet, to write.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    scans, poses = (
        registered_scans.read_registered_scans(registration),
        truth_file.read_true_poses(true_poses),
    )
    placed = truth_file.interpolate_true_poses(poses, scans.t_ns, true_poses)
    drawn, chosen = (
        plan_metrics.read_plan_tables(plan),
        plan_metrics.evidence_scan_ids(plan["evidence"]),
    )
    used = registered_scans.rows_of_scans(chosen, scans, plan["evidence"], registration)
    sight = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth),
        placed[used],
        truth_file.true_pose_matrices(poses),
        sight=sight,
    )
    true = true_plan.read_true_plan(truth)
    rows = []
    motion = pose_errors.fit_alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    for frame, moved in (("aligned", motion), ("registered", np.eye(4))):
        measured = plan_metrics.measure_plan(drawn, moved, true, floor)
        bitmaps = wall_metrics.measure_plan_lines(
            plan_metrics.moved_faces_m(drawn, moved), floor, bitmap_cell_m
        )
        rows.append({"frame": frame, "n_scans": len(chosen), **bitmaps, **measured})
        log.log_line(f"evaluate_plan: {frame}, {plan_metrics.summarise_plan_measures(rows[-1])}")
    tables.write_table(output, schemas.PLAN_EVALUATION, plan_metrics.plan_evaluation_columns(rows))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_plan(
            {
                name: snakemake.input[name]
                for name in ("faces", "walls", "openings", "rooms", "evidence")
            },
            *(snakemake.input[name] for name in ("registration", "truth", "true_poses")),
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
