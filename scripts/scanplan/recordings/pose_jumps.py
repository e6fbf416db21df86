"""Poses that jump: a localiser that finds itself elsewhere did not drive there."""

import numpy as np

LEAST_M = 0.5


def find_jumps(t_ns, xyz_m, *, max_speed_m_s):
    """Tell which steps from one pose to the next are jumps: more than half a metre, and faster than a limit.

    Parameters
    ----------
    t_ns : (n,) int64, strictly increasing
    xyz_m : (n, 3) float
    max_speed_m_s : float

    Returns
    -------
    (n - 1,) bool
    """
    way_m = np.linalg.norm(np.diff(xyz_m, axis=0), axis=1)
    return (way_m > LEAST_M) & (way_m > max_speed_m_s * np.diff(t_ns) / 1e9)


def is_inside_jump(t_ns, jumping, query_ns):
    """Tell which times lie within steps that are jumps, and not on a stamp.

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
