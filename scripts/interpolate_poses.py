"""Give every candidate scan the pose its sensor had at that moment."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from scanplan.project import provenance
from scanplan.recordings import candidates, frame_edges
from scanplan.recordings.motion import (
    lidar_odometry,
    pose_delay,
    pose_kind,
    time_check,
    trajectory,
    turn_smear,
)
from scanplan.recordings.survey import Reading, is_as_recorded, open_survey
from scanplan.recordings.survey_protocol import Survey
from scanplan.stage import log, witnesses
from scanplan.store import doubts, schemas, tables
from scanplan.types import BoolArray, FilePath, FloatArray, IntArray


def interpolate_poses(
    files: Sequence[str],
    output: FilePath,
    *,
    keep_every: int,
    max_step_m: float,
    max_turn_deg: float,
    max_gap_s: float,
    max_speed_m_s: float = np.inf,
    moved: FilePath | None = None,
    made_of: str = "",
    **reading: Any,
) -> None:
    """Write the candidates for registration with interpolated poses, and the sensor's motion.

    Parameters
    ----------
    files : sequence of str
        All files of the dataset.
    output : path-like
        poses.parquet.
    keep_every, max_step_m, max_turn_deg
        See `candidates.choose_candidates`; of stations each is one.
    max_gap_s, max_speed_m_s : float
        Longest time between two poses to interpolate over, and fastest way.
    moved : path-like, optional
        motion.parquet, to write. By it scans are candidates whose points are moved well.
    made_of : str
        Digest of the files, which all tables of the dataset are to state.
    **reading
        Keywords of `survey.open_survey`, but for how many clouds may be damaged: few are read
        here, so that `register_scans` counts them.

    Raises
    ------
    StageError
        If the recordings cannot be used or no candidate has a pose.
    """
    limits = {"max_gap_s": max_gap_s, "max_speed_m_s": max_speed_m_s}
    with open_survey(files, Reading(**reading, max_damaged_share=1.0)) as survey:
        t_ns = survey.stamps()
        # what of it is lost, and not which of the clouds that are read here are damaged
        found = doubts.Doubts().add(survey.describe_damage(), rayless=survey.describe_rays())
        gaps = survey.describe_gaps()
        measured = [witnesses.state_witness("days apart", len(gaps), said="; ".join(gaps))]
        edges = survey.pose_edges()
        if pose_kind.is_drifting(survey.pose_kind):
            edges, resets = _join_resets(edges, max_speed_m_s)
            measured.append(resets)
        delay_s = _find_delay_s(survey, edges, limits, "poses")
        side = "later" if delay_s > 0 else "earlier"
        measured.append(witnesses.state_witness("late poses", abs(delay_s), side=side))
        at_ns = t_ns + round(delay_s * 1e9)
        pose, gap_s, covered = frame_edges.chain_poses(edges, at_ns, **limits)
        if survey.pose_kind == pose_kind.STATIONS:
            keep_every = 1
        keep_every = candidates.thin_less_standing(pose, covered, keep_every)
        spacing = {"keep_every": keep_every, "max_step_m": max_step_m, "max_turn_deg": max_turn_deg}
        measured.append(candidates.measure_standing(pose, covered))
        is_steady = np.ones(len(t_ns), bool)
        if moved is not None:
            motion = trajectory.choose_motion(survey.motion_chains(), t_ns, **limits)
            motion = _shift_motion(survey, motion, delay_s, limits)
            motion = time_check.check_point_times(survey, motion)
            notes = {
                schemas.OF_POSES: json.dumps(motion.of_poses),
                schemas.SMEAR_MM: str(turn_smear.measure_smear_mm(survey, motion)),
            }
            tables.write_table(
                moved, schemas.MOTION, motion.columns(), notes=notes, made_of=made_of
            )
            is_moved = survey.sweep_times is not None and motion.time_scale > 0
            if survey.pose_kind == pose_kind.ESTIMATED and is_moved:
                is_steady = lidar_odometry.find_steady(survey.pose_edges()[0], motion, t_ns)
        chosen = candidates.choose_candidates(pose, is_steady=is_steady, **spacing)
        candidates.log_jumps(edges, files[0], max_speed_m_s=max_speed_m_s)
        candidates.require_poses(covered[chosen], t_ns, edges, files[0], max_gap_s=max_gap_s)
        _log_unsteady(is_steady, chosen)
        as_recorded = is_as_recorded(survey)
    n_covered = int(covered[chosen].sum())
    n_without = len(chosen) - n_covered
    share = n_without / len(chosen)
    measured.append(
        witnesses.state_witness("no pose", share, n_without=n_without, n_asked=len(chosen))
    )
    for sentence in (*found.damage, *found.rayless):
        log.log_warning(f"interpolate_poses: {sentence}")
    found = found.add(findings=witnesses.tell("interpolate_poses", measured))
    columns = candidates.pose_columns(chosen, t_ns, pose, gap_s, covered)
    notes = found.as_notes() | {
        pose_kind.NOTE: survey.pose_kind,
        schemas.N_RECORDED: str(len(t_ns)),
        schemas.AS_RECORDED: json.dumps(as_recorded),
    }
    tables.write_table(output, schemas.POSES, columns, notes=notes, made_of=made_of)
    log.log_line(
        f"interpolate_poses: {len(t_ns):,} scans, {len(chosen):,} candidates,"
        f" {n_covered:,} with poses, {n_without:,} without"
    )
    _log_pose_kind(
        survey.pose_kind, is_set=reading.get("pose_kind", pose_kind.FOUND) != pose_kind.FOUND
    )


def _find_delay_s(
    survey: Survey, edges: Sequence[frame_edges.FrameEdge], limits: dict[str, float], what: str
) -> float:
    """Return how much later than the clouds recorded poses are stamped."""
    if survey.pose_kind not in (pose_kind.LOCALISER, pose_kind.ODOMETRY):
        return 0.0

    def poses_at(at_ns: IntArray) -> FloatArray:
        return frame_edges.chain_poses(edges, at_ns, **limits)[0]

    return pose_delay.find_delay_s(survey, poses_at, what)


def _shift_motion(
    survey: Survey, motion: trajectory.SensorMotion, delay_s: float, limits: dict[str, float]
) -> trajectory.SensorMotion:
    """Return the motion by the clock of the clouds: that of the poses, or odometry of its own."""
    if not motion.of_poses:
        edge = frame_edges.FrameEdge("", "", motion.xyz_m, motion.quat_xyzw, motion.t_ns)
        delay_s = _find_delay_s(survey, [edge], limits, "motion within sweeps")
    return replace(motion, t_ns=motion.t_ns - round(delay_s * 1e9))


def _join_resets(
    edges: Sequence[frame_edges.FrameEdge], max_speed_m_s: float
) -> tuple[list[frame_edges.FrameEdge], witnesses.Measured]:
    """Return odometry that goes on where it was reset, and how often it was."""
    joined = [edge.without_jumps(max_speed_m_s=max_speed_m_s) for edge in edges]
    n_jumps = sum(n for _, n in joined)
    resets = witnesses.state_witness("odometry resets", n_jumps)
    return ([edge for edge, _ in joined] if n_jumps else list(edges)), resets


def _log_unsteady(is_steady: BoolArray, chosen: IntArray) -> None:
    n_left = int((~is_steady).sum())
    if n_left:
        log.log_line(
            f"interpolate_poses: during {n_left:,} of {len(is_steady):,} scans a turn begins or"
            " ends, and clouds do not say when: others are candidates, but for"
            f" {int((~is_steady[chosen]).sum()):,} that no other overlaps enough"
        )


def _log_pose_kind(kind: str, *, is_set: bool) -> None:
    found = {
        pose_kind.ESTIMATED: "as none are recorded",
        pose_kind.STATIONS: "by the kind of file",
    }.get(kind, "found by topic and frame")
    by = "set by advanced.input.pose_kind" if is_set else found
    of = {
        pose_kind.LOCALISER: "a localiser's, in its map",
        pose_kind.ODOMETRY: "odometry, which drifts",
        pose_kind.ESTIMATED: "estimated from the clouds, and drift",
        pose_kind.STATIONS: "stations', surveyed: each is a candidate and stays within millimetres",
    }
    means = ": they count as motions between scans, and loops are looked for"
    meaning = of[kind] + (means if pose_kind.is_drifting(kind) else "")
    log.log_line(f"interpolate_poses: the poses are {meaning} ({by})")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        interpolate_poses(
            snakemake.input.recordings,
            snakemake.output.poses,
            moved=snakemake.output.motion,
            made_of=provenance.digest_recordings(tuple(snakemake.input.recordings)),
            **snakemake.params.settings,
            **snakemake.params.reading,
        )
