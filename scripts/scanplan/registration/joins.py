"""Where a map jumps: scans that no alignment ties to those before them, and lie elsewhere.

Where the sensor went from one scan to the next odometry knows, or what the scans on both sides
show: their submaps are searched for on one another, wherever the map has them. Where neither does,
it went no farther than a walk leads.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from scanplan.geometry import se3
from scanplan.registration.drift import submaps
from scanplan.registration.multiway import OptimisedMap
from scanplan.registration.pose_graph import INLIER_WEIGHT
from scanplan.registration.prepared_clouds import PreparedCloud
from scanplan.types import BoolArray, FloatArray, IntArray

_MOST_SEARCHED = 20  # joins: of more lies than these a few tell enough, and each takes 0.2 s
_SIDE = 5  # scans on either side that are merged: their walls together are like no other place's
LONGEST_S = 10.0
"""Between two scans, seconds: later a robot may be anywhere."""
_SPEED_M_S = 1.5  # ASSUME of rovers and of people who carry a sensor, indoors
_LEAST_FITNESS = 0.5  # of what an alignment shares: a scan 2 m aside was aligned with 0.31
_LEAST_SUPPORT = 0.8  # of what both sides see, where they are right: one of 0.9 has moved chairs
_NEAR_M = 0.5  # that a map may be off between two scans, however little later
ODOMETRY = "odometry"
"""What knows of a jump where odometry was recorded."""
_SCANS, _PACE = "the scans on both sides", "the pace of a walk"
_NOTHING = ""


class MapJump(NamedTuple):
    """Jump of a map against the known motion between two scans.

    Attributes
    ----------
    row : int
        Of the second one.
    shift_m, turn_deg : float
        By how much.
    by : str
        What knows.
    step : (4, 4) float64
        The known motion: the pose of its cloud in the one before; NaN of a mere pace.
    """

    row: int
    shift_m: float
    turn_deg: float
    by: str
    step: FloatArray


def find_tied(scan_ids: IntArray, optimised: OptimisedMap, begins: Sequence[int] = ()) -> BoolArray:
    """Return which scans (n,) an alignment ties to one before them, in every direction.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    begins : sequence of int, increasing
        Rows at which another map begins: what ties a scan to one before tells nothing there.
    """
    ends = [
        (edge.source, edge.target)
        for edge, weight in zip(optimised.edges, optimised.weight, strict=True)
        if edge.kind == "sequence"
        and edge.fit.n_unobservable == 0
        and edge.fitness >= _LEAST_FITNESS
        and weight >= INLIER_WEIGHT
    ]
    source, target = np.searchsorted(scan_ids, np.array(ends, np.int64).reshape(-1, 2)).T
    part = np.searchsorted(np.asarray(begins, np.int64), np.arange(len(scan_ids)), side="right")
    return np.isin(np.arange(len(scan_ids)), source[part[source] == part[target]])


def find_map_jumps(
    t_ns: IntArray,
    world_from_cloud: FloatArray,
    is_tied: BoolArray,
    steps: FloatArray | None,
    read_clouds: Callable[[IntArray], list[PreparedCloud]],
) -> list[MapJump]:
    """Return the jump of the map at each scan without a link to the one before.

    Parameters
    ----------
    t_ns : (n,) int64
        Stamps of the scans.
    world_from_cloud : (n, 4, 4) float64
    is_tied : (n,) bool
        See `find_tied`.
    steps : (n - 1, 4, 4) float64, optional
        Of each cloud the pose of the next one by odometry; NaN where it does not know.
    read_clouds : callable
        Returns the clouds of some rows.
    """
    loose = np.flatnonzero(~is_tied[1:]) + 1
    motion = se3.invert_pose(world_from_cloud[loose - 1]) @ world_from_cloud[loose]
    known = np.full_like(motion, np.nan) if steps is None else steps[loose - 1]
    is_known = np.atleast_1d(np.isfinite(known).all(axis=(1, 2))).tolist()
    by = [ODOMETRY if is_so else _NOTHING for is_so in is_known]
    apart_s = (t_ns[loose] - t_ns[loose - 1]) / 1e9
    asked = [i for i, one in enumerate(by) if one == _NOTHING and apart_s[i] <= LONGEST_S]
    for i in asked[:: -(-len(asked) // _MOST_SEARCHED) or 1]:
        found = _match_sides(loose[i], apart_s[i], loose, world_from_cloud, read_clouds)
        if found is not None:
            known[i], by[i] = found, _SCANS
    for i in _find_too_fast(t_ns, world_from_cloud)[loose - 1].nonzero()[0]:
        if by[i] == _NOTHING:
            known[i], by[i] = motion[i], _PACE
            known[i, :2, 3] *= _reach_m(apart_s[i]) / np.hypot(*motion[i, :2, 3])
    off_m = np.linalg.norm((motion - known)[:, :2, 3], axis=1)
    turn_deg = np.degrees(se3.turn_between_rad(known, motion))
    return [
        MapJump(
            int(loose[i]),
            float(off_m[i]),
            float(turn_deg[i]),
            one,
            known[i] if one != _PACE else np.full((4, 4), np.nan),
        )
        for i, one in enumerate(by)
        if one != _NOTHING
    ]


def _find_too_fast(t_ns: IntArray, world_from_cloud: FloatArray) -> BoolArray:
    """Return which steps (n - 1,) are longer than a walk; none where stamps do not say so."""
    apart_s = np.diff(t_ns) / 1e9
    step_m = np.hypot(*np.diff(world_from_cloud[:, :2, 3], axis=0).T)
    is_long = step_m > _reach_m(apart_s)
    # a log's stamps may be of when it was written
    return is_long & (apart_s <= LONGEST_S) & (2 * is_long.sum() <= len(is_long))


def _reach_m(apart_s: Any) -> Any:
    """Return the greatest distance of two scans, given the seconds between them."""
    return _NEAR_M + _SPEED_M_S * apart_s


def _match_sides(
    row: int,
    apart_s: float,
    loose: IntArray,
    world_from_cloud: FloatArray,
    read_clouds: Callable[[IntArray], list[PreparedCloud]],
) -> FloatArray | None:
    """Return the motion to a scan from the one before as their surroundings tell it.

    None where they tell nothing, or are as they should be as the map has them: the two directions
    of a corridor are alike.
    """
    from scanplan.registration.drift import recognition  # scipy's 0.3 s, and few maps jump

    begin = max(int(loose[loose < row].max(initial=0)), row - _SIDE)
    later = loose[loose > row]
    end = min(int(later.min(initial=len(world_from_cloud))), row + _SIDE)
    sides = []
    for rows, of in ((np.arange(begin, row), row - 1), (np.arange(row, end), row)):
        merged = submaps.merge_scans(rows, read_clouds(rows), world_from_cloud[rows])
        if merged is None:
            return None
        level_from_world = se3.invert_pose(se3.level_frame(world_from_cloud[merged.row]))
        sides.append((merged, level_from_world @ world_from_cloud[of]))
    (before, before_from_cloud), (after, after_from_cloud) = sides
    motion = se3.invert_pose(world_from_cloud[row - 1]) @ world_from_cloud[row]
    mapped = before_from_cloud @ motion @ se3.invert_pose(after_from_cloud)
    if recognition.compare_submaps(after, before, mapped).support >= _LEAST_SUPPORT:
        return None
    found = recognition.find_submap(
        after,
        before,
        # as if it had stood still
        before_from_cloud @ se3.invert_pose(after_from_cloud),
        reach_m=_reach_m(apart_s),
        turn_rad=np.pi,
    )
    if found is None:
        return None
    return se3.invert_pose(before_from_cloud) @ found.fit.target_from_source @ after_from_cloud
