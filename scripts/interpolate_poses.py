"""Give every candidate scan the pose its sensor had at that moment."""

import numpy as np

from scanplan import candidates, frames, motion, se3, stagelog, surveys, sweepcheck, tables
from scanplan.errors import StageError


def interpolate_poses(files, output, *, keep_every, max_step_m, max_turn_deg, max_gap_s, moved=None, **reading):
    """Write the candidates for registration with their interpolated poses, and how the sensor moved.

    Parameters
    ----------
    files : sequence of str
        All files of the dataset.
    output : path-like
        poses.parquet.
    keep_every, max_step_m, max_turn_deg
        See `candidates.choose`.
    max_gap_s : float
        Longest time between two poses to interpolate over.
    moved : path-like, optional
        motion.parquet, to write.
    **reading
        Keywords of `surveys.open_survey`.

    Raises
    ------
    StageError
        If the recordings cannot be used or no candidate has a pose.
    """
    with surveys.open_survey(files, **reading) as survey:
        t_ns, edges = survey.stamps(), survey.pose_edges()
        if moved is not None:
            way = motion.choose(survey.motion_chains(), t_ns, max_gap_s=max_gap_s)
            tables.write(moved, tables.MOTION, sweepcheck.checked(survey, way).columns())
    pose, gap_s, covered = frames.world_from_sensor(edges, t_ns, max_gap_s=max_gap_s)
    chosen = candidates.choose(pose, keep_every=keep_every, max_step_m=max_step_m, max_turn_deg=max_turn_deg)
    if not covered[chosen].any():
        raise StageError(
            f"{files[0]}: no scan has poses within {max_gap_s} s around it: clouds {_span(t_ns)}, poses"
            f" {', '.join(_span(e.t_ns) for e in edges if e.t_ns is not None)}; check the clocks or raise max_gap_s"
        )
    xyz_m, quat = se3.position_quaternion(pose[chosen])
    columns = {"scan_id": chosen, "t_ns": t_ns[chosen], "gap_s": gap_s[chosen], "covered": covered[chosen]}
    columns |= dict(zip(("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"), np.hstack([xyz_m, quat]).T, strict=True))
    tables.write(output, tables.POSES, columns)
    n_covered = int(covered[chosen].sum())
    stagelog.say(
        f"interpolate_poses: {len(t_ns):,} scans, {len(chosen):,} candidates,"
        f" {n_covered:,} with poses, {len(chosen) - n_covered:,} without"
    )


def _span(t_ns):
    return f"{np.min(t_ns) / 1e9:.3f} to {np.max(t_ns) / 1e9:.3f} s"


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        interpolate_poses(
            snakemake.input.recordings,
            snakemake.output.poses,
            moved=snakemake.output.motion,
            **snakemake.params.settings,
            **snakemake.params.reading,
        )
