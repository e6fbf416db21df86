"""Pairs of neighbouring scans, and which share of their points meet: of the right reading most."""

import numpy as np

from scanplan.geometry import se3
from scanplan.types import FloatArray, IntArray

_PAIRS = 12  # enough for a mean; a pair takes a few milliseconds a reading
LEAST_PAIRS = 3
"""Of fewer a jump of the map between two scans is most."""
_POINTS = 600  # of a scan: shares of fewer scatter
_NEAR_M = 0.1  # of another point, by ranges and by how far apart points are
ARM_M = 3.0  # what a turn moves a wall by: walls of rooms are so far away
_MOTION_M = (0.4, 4.0)  # of a pair: less tells readings not apart, beyond it scans share little
LEAST_MET = 0.5
"""The right reading has 0.6 to 0.95, others 0.25 at most."""
MORE_MET = 0.2
"""Than as the scans were read."""


def choose_pairs(world_from_sensor: FloatArray) -> IntArray:
    """Return rows of poses (n, 4, 4) that the sensor moved and turned after, up to the next one."""
    moved = se3.invert_pose(world_from_sensor[:-1]) @ world_from_sensor[1:]
    turn_rad = se3.turn_between_rad(np.eye(4), moved)
    motion_m = np.linalg.norm(moved[:, :3, 3], axis=1) + ARM_M * turn_rad
    rows = np.flatnonzero((motion_m > _MOTION_M[0]) & (motion_m < _MOTION_M[1]))
    # by turns most readings differ: half of the pairs have them
    by_turn = rows[np.argsort(-turn_rad[rows], kind="stable")][: _PAIRS // 2]
    others = np.setdiff1d(rows, by_turn)
    spread = np.linspace(0, len(others) - 1, _PAIRS - len(by_turn)).astype(int)
    return np.union1d(by_turn, others[spread] if len(others) else others)


def thin_points(xyz_m: FloatArray) -> FloatArray:
    """Return some points (m, 3) of a scan (n, 3), enough to ask whether they meet others."""
    return xyz_m[:: max(1, len(xyz_m) // _POINTS)]


def measure_met(
    target_m: FloatArray,
    source_m: FloatArray,
    target_from_source: FloatArray,
    *,
    planar: bool,
    scale: float = 1.0,
) -> float:
    """Return which share of a scan's points (m, 3) lies on those (n, 3) of the one before.

    Parameters
    ----------
    target_m, source_m : (n, 3), (m, 3) float
    target_from_source : (4, 4) float64
    scale : float
        How many of their unit a metre is.
    """
    from scipy.spatial import KDTree  # 0.3 s, before it is known that any pair is asked

    if len(target_m) == 0 or len(source_m) == 0:
        return 0.0
    size = 2 if planar else 3
    moved_m = se3.transform_points(target_from_source, source_m)
    # in a smaller unit points are nearer, but for their noise
    near_m = _NEAR_M * np.sqrt(scale)
    apart_m, _ = KDTree(target_m[:, :size]).query(moved_m[:, :size], distance_upper_bound=near_m)
    return float(np.isfinite(apart_m).mean())
