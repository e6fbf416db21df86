"""Transforms between two frames, constant or changing with time, and chains of them.

An edge is a transform `parent_from_child`. The product of a chain of edges from the map to the
sensor is the pose `chain_poses` (REP 105).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import se3
from scanplan.geometry.tolerances import SAME_M
from scanplan.recordings import clocks, pose_jumps
from scanplan.types import BoolArray, FloatArray, IntArray

_FARTHEST_M = 1e8  # from the origin of any map, that of the Earth among them
AMBIGUOUS = "in a time that went by twice (dropped)"
_NORM_TOLERANCE = 1e-3  # single precision and a few digits of text stay within it


@dataclass(frozen=True, eq=False)
class FrameEdge:
    """A transform parent_from_child.

    Attributes
    ----------
    parent, child : str
    xyz_m : (n, 3) float64
    quat_xyzw : (n, 4) float64
    t_ns : (n,) int64, strictly increasing, or None
        None if it never changes; then n = 1.
    is_contradicted : bool
        Whether it is said never to change, and was recorded with other values, too.
    """

    parent: str
    child: str
    xyz_m: FloatArray
    quat_xyzw: FloatArray
    t_ns: IntArray | None = None
    is_contradicted: bool = False

    def without_jumps(self, *, max_speed_m_s: float) -> "tuple[FrameEdge, int]":
        """Return the edge with its jumps taken out, and how many there were."""
        if self.t_ns is None:
            return self, 0
        jumping = pose_jumps.find_jumps(self.t_ns, self.xyz_m, max_speed_m_s=max_speed_m_s)
        if not jumping.any():
            return self, 0
        pose = pose_jumps.join_jumps(se3.pose_matrix(self.xyz_m, self.quat_xyzw), jumping)
        xyz_m, quat = se3.split_pose(pose)
        return replace(self, xyz_m=xyz_m, quat_xyzw=quat), int(jumping.sum())

    def inverse(self) -> "FrameEdge":
        """Return child_from_parent, sample by sample."""
        xyz_m, quat = se3.split_pose(se3.invert_pose(se3.pose_matrix(self.xyz_m, self.quat_xyzw)))
        return replace(self, parent=self.child, child=self.parent, xyz_m=xyz_m, quat_xyzw=quat)

    def frozen(self) -> "FrameEdge":
        """Return the edge without time, as its last sample has it."""
        return replace(self, xyz_m=self.xyz_m[-1:], quat_xyzw=self.quat_xyzw[-1:], t_ns=None)

    def is_still(self, tolerance: float = SAME_M) -> bool:
        """Return whether all samples are the same, to a tolerance in metres and about in radians.

        By default to a micrometre.
        """
        same_turn = np.abs(self.quat_xyzw @ self.quat_xyzw[0]) >= 1 - tolerance**2
        same_place = np.abs(self.xyz_m - self.xyz_m[0]) <= tolerance
        return bool(same_turn.all() and same_place.all())


def make_static_edge(parent: str, child: str, pose: FloatArray) -> FrameEdge:
    """Return a constant edge from one 4 x 4 matrix."""
    xyz_m, quat = se3.split_pose(np.asarray(pose, float)[None])
    return FrameEdge(parent, child, xyz_m, quat)


def make_track_edge(
    parent: str,
    child: str,
    t_ns: IntArray,
    receive_ns: IntArray,
    rows: FloatArray | Sequence[Sequence[float]],
) -> tuple[FrameEdge | None, dict[str, int]]:
    """Make a changing edge from recorded poses, leaving out what cannot be a pose.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64
        Header stamps and receive times, in the order of recording. If all stamps are 0 the receive
        times count.
    rows : (n, 7) float
        x, y, z, qx, qy, qz, qw.

    Returns
    -------
    edge : FrameEdge or None
        None if nothing is left. Of poses with the same stamp the one recorded last is kept.
    faults : dict of str to int
        How many were not finite or nowhere on Earth, had no unit quaternion, came backwards in
        time, lay in a time that went by twice (none of them is kept: nobody knows which of the
        two a scan belongs to), repeated a stamp, had no stamp.
    """
    t_ns = np.asarray(t_ns, np.int64)
    rows = np.asarray(rows, float).reshape(-1, 7)
    unstamped = len(t_ns) > 0 and not t_ns.any()
    if unstamped:
        t_ns = np.asarray(receive_ns, np.int64)
    finite = np.isfinite(rows).all(axis=1) & (np.abs(rows[:, :3]) <= _FARTHEST_M).all(axis=1)
    unit = _have_unit_quaternions(rows)
    good = finite & unit
    twice = np.zeros(len(t_ns), bool)
    twice[good] = clocks.find_repeated_times(t_ns[good])
    good &= ~twice
    t_good = t_ns[good]
    # the first of the reversed order is the one recorded last
    t_kept, last = np.unique(t_good[::-1], return_index=True)
    kept = rows[good][::-1][last]
    faults = {
        "not finite": int((~finite).sum()),
        "without unit quaternion": int((finite & ~unit).sum()),
        "backwards in time": int((t_good[1:] < np.maximum.accumulate(t_good)[:-1]).sum()),
        AMBIGUOUS: int(twice.sum()),
        "of a repeated stamp": len(t_good) - len(t_kept),
        "without stamp (receive time taken)": len(t_ns) if unstamped else 0,
    }
    if len(t_kept) == 0:
        return None, faults
    quat = kept[:, 3:] / np.linalg.norm(kept[:, 3:], axis=1, keepdims=True)
    return FrameEdge(parent, child, kept[:, :3], quat, t_kept), faults


def _have_unit_quaternions(rows: FloatArray) -> BoolArray:
    with np.errstate(invalid="ignore", over="ignore"):
        return np.abs(np.linalg.norm(rows[:, 3:], axis=1) - 1) <= _NORM_TOLERANCE


def chain_poses(
    edges: Iterable[FrameEdge],
    query_ns: IntArray | Sequence[int],
    *,
    max_gap_s: float,
    max_speed_m_s: float = np.inf,
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Multiply a chain of edges at given times (thesis, algorithm 3, step 1, for each moving one).

    Parameters
    ----------
    edges : sequence of FrameEdge
        From the world to the sensor.
    query_ns : (m,) int64
    max_gap_s : float
        Longest time between two samples to interpolate over.
    max_speed_m_s : float
        Nothing is interpolated within a jump (`pose_jumps.find_jumps`).

    Returns
    -------
    pose : (m, 4, 4) float64, NaN where not covered
    gap_s : (m,) float64
        The longest gap of all edges; infinite outside the time of one of them.
    covered : (m,) bool
    """
    query_ns = np.asarray(query_ns, np.int64)
    pose = np.tile(np.eye(4), (len(query_ns), 1, 1))
    gap_s = np.zeros(len(query_ns))
    covered = np.ones(len(query_ns), bool)
    for edge in edges:
        if edge.t_ns is None:
            pose = pose @ se3.pose_matrix(edge.xyz_m[0], edge.quat_xyzw[0])
            continue
        xyz_m, quat, apart_s, inside = se3.interpolate_poses(
            edge.t_ns, edge.xyz_m, edge.quat_xyzw, query_ns, max_gap_s=max_gap_s
        )
        pose = pose @ se3.pose_matrix(xyz_m, quat)
        jumping = pose_jumps.find_jumps(edge.t_ns, edge.xyz_m, max_speed_m_s=max_speed_m_s)
        inside &= ~pose_jumps.is_inside_jump(edge.t_ns, jumping, query_ns)
        gap_s = np.maximum(gap_s, apart_s)
        covered &= inside
    pose[~covered] = np.nan
    return pose, gap_s, covered
