"""Measure the merged plan against the true walls (thesis, section 5.1)."""

import numpy as np

from scanplan import evaluation, findings, lengthmetrics, poseerrors, registered, schemas, stagelog, tables, truthfile
from scanplan.visibility import thinned

_SURVEY_STEP_M = 0.25


def evaluate_plan(faces, registration, truth, true_poses, output, *, max_range_m, bitmap_cell_m):
    """Write how well the faces of the plan show the true walls, where they are and after one rigid motion.

    Parameters
    ----------
    faces, registration, truth, true_poses : path-like
        plan/faces.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        evaluation/plan.parquet, to write.
    max_range_m : float
        How far a scan can see.
    bitmap_cell_m : float
    """
    scans, poses = registered.read(registration), truthfile.read_poses(true_poses)
    placed = truthfile.poses_at(poses, scans.t_ns, true_poses)
    survey_m = poses.xyz_m[thinned(poses.xyz_m[:, :2], _SURVEY_STEP_M), :2]
    floor = findings.look(truthfile.read_faces(truth), placed[:1, :2, 3], survey_m, max_range_m=max_range_m)
    plan = tables.read(faces, schemas.FACES)
    lines_m = np.column_stack([plan[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(-1, 2, 2)
    motion = poseerrors.alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    rows = []
    for frame, moved_m in (("aligned", lines_m @ motion[:2, :2].T + motion[:2, 3]), ("registered", lines_m)):
        row = {"frame": frame, "length_m": float(lengthmetrics.lengths_m(moved_m).sum())}
        rows.append(row | evaluation.of_plan(moved_m, floor, bitmap_cell_m))
        stagelog.say(f"evaluate_plan: {frame}, {_told(rows[-1])}")
    tables.write(output, schemas.PLAN_EVALUATION, {name: np.array([row[name] for row in rows]) for name in rows[0]})


def _told(row):
    completeness, correctness = row["visible_completeness_010m"], row["correctness_010m"]
    return f"{row['n_walls']} faces show {completeness:.2f} of the visible walls, {correctness:.2f} of them is true"


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        evaluate_plan(
            *(snakemake.input[name] for name in ("faces", "registration", "truth", "true_poses")),
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
