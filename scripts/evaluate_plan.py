"""Measure the plan against the true one (thesis, section 5.1, and what it does not measure: openings and rooms)."""

import numpy as np

from scanplan import schemas, stagelog, tables
from scanplan.evaluation import (
    findings,
    planevaluation,
    poseerrors,
    registered,
    trueplan,
    truthfile,
    wallevaluation,
)


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
    scans, poses = registered.read(registration), truthfile.read_poses(true_poses)
    placed = truthfile.poses_at(poses, scans.t_ns, true_poses)
    drawn, chosen = planevaluation.read(plan), planevaluation.scans_of(plan["evidence"])
    used = registered.rows_of(chosen, scans, plan["evidence"], registration)
    sight = truthfile.read_sight(truth, max_range_m=max_range_m)
    floor = findings.look(truthfile.read_faces(truth), placed[used], truthfile.matrices(poses), sight=sight)
    true = trueplan.read(truth)
    rows = []
    motion = poseerrors.alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    for frame, moved in (("aligned", motion), ("registered", np.eye(4))):
        measured = planevaluation.measure(drawn, moved, true, floor)
        bitmaps = wallevaluation.of_plan(planevaluation.faces_m(drawn, moved), floor, bitmap_cell_m)
        rows.append({"frame": frame, "n_scans": len(chosen), **bitmaps, **measured})
        stagelog.say(f"evaluate_plan: {frame}, {planevaluation.summary(rows[-1])}")
    tables.write(output, schemas.PLAN_EVALUATION, planevaluation.table(rows))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        evaluate_plan(
            {name: snakemake.input[name] for name in ("faces", "walls", "openings", "rooms", "evidence")},
            *(snakemake.input[name] for name in ("registration", "truth", "true_poses")),
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
