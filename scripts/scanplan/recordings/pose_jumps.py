"""Poses that jump: a localiser that corrects itself by metres did not drive there."""

import numpy as np

from scanplan.geometry import se3
from scanplan.types import BoolArray, FloatArray, IntArray

LEAST_M = 0.5  # above what localisers correct as a matter of course, below what displaces a wall


def find_jumps(t_ns: IntArray, xyz_m: FloatArray, *, max_speed_m_s: float) -> BoolArray:
    """Return which steps between poses are jumps: more than half a metre, and faster than a limit.

    Parameters
    ----------
    t_ns : (n,) int64, strictly increasing
    xyz_m : (n, 3) float

    Returns
    -------
    (n - 1,) bool
    """
    step_m = np.linalg.norm(np.diff(xyz_m, axis=0), axis=1)
    return (step_m > LEAST_M) & (step_m > max_speed_m_s * np.diff(t_ns) / 1e9)


def join_jumps(pose: FloatArray, jumping: BoolArray) -> FloatArray:
    """Return poses without their jumps: after each the way goes on from where it was.

    Of odometry that was reset this is what it would have said; of wheels that slipped the motion in
    between is lost.

    Parameters
    ----------
    pose : (n, 4, 4) float64
    jumping : (n - 1,) bool
        As `find_jumps` gives it.

    Returns
    -------
    (n, 4, 4) float64
    """
    joined = np.array(pose, float)
    for row in np.flatnonzero(jumping).tolist():
        # of many jumps each would double the rounding of the one before
        moved = se3.nearest_rigid(joined[row] @ se3.invert_pose(joined[row + 1]))
        joined[row + 1 :] = moved @ joined[row + 1 :]
    return joined


def is_inside_jump(t_ns: IntArray, jumping: BoolArray, query_ns: IntArray) -> BoolArray:
    """Return which times lie within steps that are jumps, and not on a stamp.

    Parameters
    ----------
    t_ns : (n,) int64, strictly increasing
    jumping : (n - 1,) bool
        As `find_jumps` gives it.
    query_ns : (m,) int64

    Returns
    -------
    (m,) bool
    """
    if not np.any(jumping):
        return np.zeros(len(query_ns), bool)
    after = np.searchsorted(t_ns, query_ns)
    on_stamp = t_ns[np.minimum(after, len(t_ns) - 1)] == query_ns
    return jumping[np.clip(after, 1, len(t_ns) - 1) - 1] & ~on_stamp
