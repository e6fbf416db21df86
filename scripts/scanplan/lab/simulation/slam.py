"""Poses of a SLAM system while it runs: they drift until a loop is found, and then jump."""

import numpy as np

from scanplan.geometry import se3
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import rover
from scanplan.types import FloatArray

# ASSUME a place is recognised from within a metre of it, which is less than a room, and no sooner
# than after 10 m of way, as what was just passed is matched all the time
_LOOP_M = 1.0
_LOOP_WAY_M = 10.0
_LATE_M = 5.0  # ASSUME a loop is closed some seconds after it was driven


def track_poses(
    world_from_base: FloatArray,
    *,
    walk_m: float,
    walk_deg: float,
    loop_late_m: float = _LATE_M,
    seed: int,
) -> FloatArray:
    """Return map_from_base (m, 4, 4) as SLAM states them at the time.

    Each motion adds errors to all that follows. Where the way comes back to where it was, the loop
    is found only so much way later; the map then is bent so that what was measured there lies where
    it did the first time, and the pose jumps with it. Poses stated before stay as they were stated.

    Parameters
    ----------
    world_from_base : (m, 4, 4) float64
        True planar poses at its updates.
    walk_m, walk_deg : float
        Standard deviation, after a metre of way, of the position on each axis and of the heading.
    loop_late_m : float
        Way from a place that was seen before to the correction.
    """
    xy_m = world_from_base[:, :2, 3]
    step_m = np.hypot(*np.diff(xy_m, axis=0).T)
    way_m = np.concatenate([[0], np.cumsum(step_m)])
    noise = _draw_steps(step_m, walk_m, walk_deg, seed)
    tracked = world_from_base.copy()
    bent = world_from_base.copy()
    pending: tuple[int, int] | None = None
    for i in range(1, len(tracked)):
        motion = se3.invert_pose(world_from_base[i - 1]) @ world_from_base[i]
        tracked[i] = bent[i] = se3.nearest_rigid(tracked[i - 1] @ motion @ noise[i - 1])
        if pending is None:
            old = find_loop(xy_m, way_m, i)
            pending = None if old is None else (old, i)
        if pending is not None and way_m[i] >= way_m[pending[1]] + loop_late_m:
            _bend_map(bent[: i + 1], world_from_base, way_m[: i + 1], *pending)
            tracked[i] = bent[i]
            pending = None
    return tracked


def find_loop(xy_m: FloatArray, way_m: FloatArray, now: int) -> int | None:
    """Return the update before `now` at the nearest place that was left long ago; None if none is.

    Parameters
    ----------
    xy_m : (m, 2) float
        True positions at the updates.
    way_m : (m,) float
        Way up to each.
    """
    n_old = int(np.searchsorted(way_m, way_m[now] - _LOOP_WAY_M, side="right"))
    if n_old <= 0:
        return None
    apart_m = np.hypot(*(xy_m[:n_old] - xy_m[now]).T)
    nearest = int(apart_m.argmin())
    return nearest if apart_m[nearest] <= _LOOP_M else None


def _bend_map(
    bent: FloatArray, world_from_base: FloatArray, way_m: FloatArray, old: int, found: int
) -> None:
    """Lay what was seen at `found` where `old` saw it, and what lies between so far as it is on.

    `bent` (i, 4, 4) are the poses up to now as the map has them, which are changed in place.
    """
    old_error = bent[old] @ se3.invert_pose(world_from_base[old])
    new_error = bent[found] @ se3.invert_pose(world_from_base[found])
    whole = old_error @ se3.invert_pose(new_error)
    share = np.clip((way_m - way_m[old]) / (way_m[found] - way_m[old]), 0, 1)
    # errors are of few degrees: parts of the shift and of the turn are parts of the motion
    part = rover.planar_poses(np.outer(share, whole[:2, 3]), share * se3.pose_yaw_rad(whole))
    bent[:] = part @ bent


def _draw_steps(step_m: FloatArray, walk_m: float, walk_deg: float, seed: int) -> FloatArray:
    """Return the error (m - 1, 4, 4) of each step, by its length, in the base's frame."""
    generator = open_stream(seed, RandomStream.SLAM)
    scale = np.array([walk_m, walk_m, np.radians(walk_deg)])
    draw = generator.standard_normal((len(step_m), 3)) * np.sqrt(step_m)[:, None] * scale
    return rover.planar_poses(draw[:, :2], draw[:, 2])
