"""Candidates: which scans go on to registration."""

from collections.abc import Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import pose_jumps
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.stage import log
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.store import pose_columns as poses_in_tables
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_STILL = 1e-3  # metres, and of a turn radians: less than any localiser's noise
_FEWEST_TO_STAND = 10  # a second of most sensors
_STOOD_M = 0.05  # what poses of a sensor that stands scatter by, and 0.05 rad of a turn
_MOST_OF_A_SPOT = 100  # scans: ten seconds of most sensors; more differ by noise alone


def choose_candidates(
    world_from_sensor: FloatArray,
    *,
    keep_every: int,
    max_step_m: float,
    max_turn_deg: float,
    is_steady: BoolArray | None = None,
) -> IntArray:
    """Take every `keep_every`-th scan (thesis, algorithm 3, step 2), more if the rover is fast.

    A scan between two of them is retained too once the sensor has moved more than `max_step_m` or
    turned more than `max_turn_deg` since the last retained scan with a pose, so that neighbours
    keep overlapping however slow the recorder was. Motion is known only where there are poses; the
    scans without go by their number alone.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float
        NaN where not known.
    is_steady : (n,) bool, optional
        During which scans it is known how the sensor moved, by default all. Instead of another the
        next of these is taken, unless the sensor moves on twice as far or turns twice as much.
        Scans without a pose are taken all the same.

    Returns
    -------
    (m,) int64
        Indices, increasing.
    """
    if keep_every < 1:
        raise ValueError(f"keep_every is {keep_every}")
    pose = np.asarray(world_from_sensor, float)
    has_pose = [bool(np.isfinite(matrix).all()) for matrix in pose]
    is_usable = np.ones(len(pose), bool) if is_steady is None else is_steady | ~np.array(has_pose)
    chosen: list[int] = []
    last: int | None = None
    is_due = False
    for i in range(len(pose)):
        is_due |= i % keep_every == 0
        if is_due and not is_usable[i] and last is None:
            last = i
        most = 1 if is_usable[i] else 2
        has_moved = (
            has_pose[i]
            and last is not None
            and _has_moved(pose[last], pose[i], most * max_step_m, most * max_turn_deg)
        )
        if (is_due and is_usable[i]) or has_moved:
            chosen.append(i)
            is_due = False
            last = i if has_pose[i] else last
    return np.array(chosen, np.int64)


def thin_less_standing(world_from_sensor: FloatArray, has_pose: BoolArray, keep_every: int) -> int:
    """Return every how many-th scan is a candidate: of a sensor that never moved each, up to 100.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float
    has_pose : (n,) bool
    keep_every : int
        Of a sensor that moves.
    """
    poses = np.asarray(world_from_sensor, float)[has_pose]
    if len(poses) == 0 or np.ptp(poses, axis=0).max() > _STOOD_M:
        return keep_every
    fewer = min(keep_every, int(np.ceil(len(poses) / _MOST_OF_A_SPOT)))
    if fewer < keep_every:
        taken = "each" if fewer == 1 else f"one in {fewer}"
        log.log_line(f"the sensor stood still: {taken} of its {len(poses):,} turns is a candidate")
    return fewer


def measure_standing(world_from_sensor: FloatArray, has_pose: BoolArray) -> Measured:
    """Return how many scans there are if all of their poses are one and the same.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float
    has_pose : (n,) bool
    """
    poses = np.asarray(world_from_sensor, float)[has_pose]
    if len(poses) < _FEWEST_TO_STAND or np.ptp(poses, axis=0).max() > _STILL:
        return state_witness("one place", 0)
    return state_witness("one place", len(poses))


def _has_moved(before: FloatArray, now: FloatArray, max_step_m: float, max_turn_deg: float) -> bool:
    step_m = np.linalg.norm(now[:3, 3] - before[:3, 3])
    turn_deg = np.degrees(se3.turn_between_rad(before, now))
    return bool(step_m > max_step_m or turn_deg > max_turn_deg)


def pose_columns(
    chosen: IntArray,
    t_ns: IntArray,
    world_from_sensor: FloatArray,
    gap_s: FloatArray,
    covered: BoolArray,
) -> dict[str, Array]:
    """Return the columns of `schemas.POSES` of the scans `chosen`, from what is known of all."""
    return {
        "scan_id": chosen,
        "t_ns": t_ns[chosen],
        "gap_s": gap_s[chosen],
        "covered": covered[chosen],
        **poses_in_tables.pose_columns(*se3.split_pose(world_from_sensor[chosen])),
    }


def log_jumps(edges: Sequence[FrameEdge], where: str, *, max_speed_m_s: float) -> None:
    """Log how often poses jump.

    Parameters
    ----------
    edges : list of frame_edges.FrameEdge
        The poses.
    where : str
        The dataset.
    max_speed_m_s : float
        Of the interpolation.
    """
    n_jumps = sum(
        int(pose_jumps.find_jumps(edge.t_ns, edge.xyz_m, max_speed_m_s=max_speed_m_s).sum())
        for edge in edges
        if edge.t_ns is not None
    )
    if n_jumps:
        log.log_line(
            f"{where}: the poses jump {n_jumps} times by more than {pose_jumps.LEAST_M} m:"
            " no pose in between"
        )


def require_poses(
    is_covered: BoolArray,
    t_ns: IntArray,
    edges: Sequence[FrameEdge],
    where: str,
    *,
    max_gap_s: float,
) -> None:
    """Refuse scans of which no chosen one has a pose.

    Parameters
    ----------
    is_covered : (m,) bool
        Whether each chosen scan has one.
    t_ns : (n,) int64
        Stamps of all scans.
    edges, where
        As of `log_jumps`.
    max_gap_s : float
        Of the interpolation.

    Raises
    ------
    StageError
        If none has one.
    """
    if not is_covered.any():
        spans = [_format_span(edge.t_ns) for edge in edges if edge.t_ns is not None]
        raise StageError(
            f"{where}: no scan has poses within {max_gap_s} s around it: clouds"
            f" {_format_span(t_ns)}, poses {', '.join(spans)}; {_advise(t_ns, edges)}"
        )


def _advise(t_ns: IntArray, edges: Sequence[FrameEdge]) -> str:
    """Return what helps where no scan has a pose: beyond the poses no gap is bridged."""
    tracks_ns = [edge.t_ns for edge in edges if edge.t_ns is not None]
    if any((t_ns.max() < track[0]) or (t_ns.min() > track[-1]) for track in tracks_ns):
        return (
            "they are of different times, or of clocks that differ by what no time of receipt"
            " tells: stamp both by one clock (of Ouster's driver: timestamp_mode"
            " TIME_FROM_ROS_TIME)"
        )
    return "raise poses.max_gap_s"


def _format_span(t_ns: IntArray) -> str:
    return f"{np.min(t_ns) / 1e9:.3f} to {np.max(t_ns) / 1e9:.3f} s"
