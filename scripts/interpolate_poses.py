"""Give every candidate scan the pose its sensor had at that moment."""

import numpy as np

from scanplan import schemas, stagelog, tables
from scanplan.recordings import candidates, frames, motion, surveys, sweepcheck


def interpolate_poses(
    files, output, *, keep_every, max_step_m, max_turn_deg, max_gap_s, max_speed_m_s=np.inf, moved=None, **reading
):
    """Write the candidates for registration with their interpolated poses, and how the sensor moved.

    Parameters
    ----------
    files : sequence of str
        All files of the dataset.
    output : path-like
        poses.parquet.
    keep_every, max_step_m, max_turn_deg
        See `candidates.choose`.
    max_gap_s, max_speed_m_s : float
        Longest time between two poses to interpolate over, and fastest way.
    moved : path-like, optional
        motion.parquet, to write.
    **reading
        Keywords of `surveys.open_survey`.

    Raises
    ------
    StageError
        If the recordings cannot be used or no candidate has a pose.
    """
    limits = {"max_gap_s": max_gap_s, "max_speed_m_s": max_speed_m_s}
    with surveys.open_survey(files, **reading) as survey:
        t_ns, edges = survey.stamps(), survey.pose_edges()
        known = frames.world_from_sensor(edges, t_ns, **limits)
        chosen = candidates.choose(known[0], keep_every=keep_every, max_step_m=max_step_m, max_turn_deg=max_turn_deg)
        candidates.require_poses(chosen, t_ns, known[2], edges, files[0], **limits)
        if moved is not None:
            way = motion.choose(survey.motion_chains(), t_ns, **limits)
            tables.write(moved, schemas.MOTION, sweepcheck.checked(survey, way).columns())
    tables.write(output, schemas.POSES, candidates.columns(chosen, t_ns, *known))
    n_covered = int(known[2][chosen].sum())
    stagelog.say(
        f"interpolate_poses: {len(t_ns):,} scans, {len(chosen):,} candidates,"
        f" {n_covered:,} with poses, {len(chosen) - n_covered:,} without"
    )


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        interpolate_poses(
            snakemake.input.recordings,
            snakemake.output.poses,
            moved=snakemake.output.motion,
            **snakemake.params.settings,
            **snakemake.params.reading,
        )
