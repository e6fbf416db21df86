"""Which scans go on to registration."""

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import pose_jumps
from scanplan.stage import log
from scanplan.store import schemas


def choose_candidates(world_from_sensor, *, keep_every, max_step_m, max_turn_deg):
    """Retain every `keep_every`-th scan (thesis, algorithm 3, step 2), and more where the sensor moves fast.

    A scan between two of them is retained too once the sensor has moved more than `max_step_m` or turned more than
    `max_turn_deg` since the last retained scan with a pose, so that neighbours keep overlapping however slow the
    recorder was. Motion is known only where there are poses; the scans without go by their number alone.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float
        NaN where not known.
    keep_every : int
    max_step_m, max_turn_deg : float

    Returns
    -------
    (m,) int64
        Indices, increasing.
    """
    if keep_every < 1:
        raise ValueError(f"keep_every is {keep_every}")
    pose = np.asarray(world_from_sensor, float)
    known = np.isfinite(pose).all(axis=(1, 2))
    # |R - S| in the Frobenius norm is sqrt(8) sin(angle / 2)
    max_difference = np.sqrt(8) * np.sin(np.radians(min(max_turn_deg, 180)) / 2)
    chosen, last = [], None
    for i in range(len(pose)):
        moved = (
            known[i]
            and last is not None
            and _moved(pose[last], pose[i], max_step_m, max_difference)
        )
        if i % keep_every == 0 or moved:
            chosen.append(i)
            last = i if known[i] else last
    return np.array(chosen, np.int64)


def _moved(before, now, max_step_m, max_difference):
    step_m = np.linalg.norm(now[:3, 3] - before[:3, 3])
    return step_m > max_step_m or np.linalg.norm(now[:3, :3] - before[:3, :3]) > max_difference


def pose_columns(chosen, t_ns, world_from_sensor, gap_s, covered):
    """Return the columns of `schemas.POSES` of the scans `chosen`, from what is known of all."""
    xyz_m, quat = se3.split_pose(world_from_sensor[chosen])
    pose = dict(zip((*schemas.XYZ, *schemas.QUAT), np.hstack([xyz_m, quat]).T, strict=True))
    return {
        "scan_id": chosen,
        "t_ns": t_ns[chosen],
        "gap_s": gap_s[chosen],
        "covered": covered[chosen],
        **pose,
    }


def require_poses(chosen, t_ns, covered, edges, where, *, max_gap_s, max_speed_m_s):
    """Say how often the poses jump, and refuse scans of which none that is chosen has a pose.

    Parameters
    ----------
    chosen : (m,) int64
    t_ns : (n,) int64
        Stamps of all scans.
    covered : (n,) bool
        Whether each has a pose.
    edges : list of tf_tree.FrameEdge
        The poses.
    where : str
        The dataset, for the error.
    max_gap_s, max_speed_m_s : float
        Limits of the interpolation.

    Raises
    ------
    StageError
        If none has one.
    """
    moving = [edge for edge in edges if edge.t_ns is not None]
    n_jumps = sum(
        int(pose_jumps.find_jumps(e.t_ns, e.xyz_m, max_speed_m_s=max_speed_m_s).sum())
        for e in moving
    )
    if n_jumps:
        log.log_line(
            f"{where}: the poses jump {n_jumps} times by more than {pose_jumps.LEAST_M} m: no pose in between"
        )
    if not covered[chosen].any():
        raise StageError(
            f"{where}: no scan has poses within {max_gap_s} s around it: clouds {_span(t_ns)}, poses"
            f" {', '.join(_span(edge.t_ns) for edge in moving)}; check the clocks or raise max_gap_s"
        )


def _span(t_ns):
    return f"{np.min(t_ns) / 1e9:.3f} to {np.max(t_ns) / 1e9:.3f} s"
