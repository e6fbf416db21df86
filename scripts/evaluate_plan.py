"""Measure the plan against the true one: faces, walls, openings and rooms."""

import numpy as np

from scanplan import planevaluation, poseerrors, registered, schemas, stagelog, tables, trueplan, truthfile, visibility

_SURVEY_STEP_M = 0.25


def evaluate_plan(plan, registration, truth, true_poses, output, *, max_range_m):
    """Write how good a plan is.

    Parameters
    ----------
    plan : dict of str to path-like
        plan/<name>.parquet of faces, walls, openings, rooms and evidence.
    registration, truth, true_poses : path-like
        registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        evaluation/plan.parquet, to write.
    max_range_m : float
        How far a scan can see.
    """
    scans, poses = registered.read(registration), truthfile.read_poses(true_poses)
    placed = truthfile.poses_at(poses, scans.t_ns, true_poses)
    true, faces = trueplan.read(truth), truthfile.read_faces(truth)
    names = {"faces": schemas.FACES, "walls": schemas.PLAN_WALLS, "openings": schemas.OPENINGS, "rooms": schemas.ROOMS}
    drawn = {name: tables.read(plan[name], schema, allow_empty=True) for name, schema in names.items()}
    chosen = np.unique(tables.read(plan["evidence"], schemas.EVIDENCE, ["wall", "scan_id"])["scan_id"])
    used = registered.rows_of(chosen, scans, plan["evidence"], registration)
    cells = visibility.cut(faces.inner_m)
    seen = visibility.seen_by_each(cells, faces.outer_m, placed[used, :2, 3], max_range_m=max_range_m).any(axis=0)
    survey_m = poses.xyz_m[visibility.thinned(poses.xyz_m[:, :2], _SURVEY_STEP_M), :2]
    visible = seen | visibility.seen_by_each(cells, faces.outer_m, survey_m, max_range_m=max_range_m).any(axis=0)
    motion = poseerrors.alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    rows = []
    for frame, moved in (("aligned", motion), ("map", np.eye(4))):
        measured = planevaluation.measure(drawn, moved, true, cells, visible, seen)
        rows.append({"frame": frame, "n_scans": len(chosen), **measured})
        stagelog.say(f"evaluate_plan: {frame}, {planevaluation.summary(rows[-1])}")
    tables.write(output, schemas.PLAN_EVALUATION, planevaluation.table(rows))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        evaluate_plan(
            dict(snakemake.input.items()),
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.plan,
            max_range_m=snakemake.params.max_range_m,
        )
