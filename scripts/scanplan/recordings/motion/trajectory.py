"""How the sensor moved between and during its scans, from the smoothest source that was recorded.

A localiser corrects its poses in jumps of centimetres; odometry drifts but does not jump (REP 105).
Where points have to be moved by what happened within a tenth of a second odometry is the better
witness.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.geometry.tolerances import SAME_M
from scanplan.recordings import frame_edges, pose_jumps, topics
from scanplan.recordings.motion import pose_kind
from scanplan.recordings.survey_protocol import NamedChain
from scanplan.stage import log
from scanplan.store.pose_columns import pose_columns, split_pose_columns
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

_ENOUGH = 0.95  # of the most covered scans: a smoother source may lack a few at the ends
_FEWEST_STEPS = 3  # of fewer the median ratio says nothing
_AT_ONCE = 20_000  # poses, whose matrices take 3 MB
_AGREEMENT = 1.25  # wheels slip by less; a disconnected or misscaled source differs by more


@dataclass(frozen=True, eq=False)
class SensorMotion:
    """Poses of the sensor in some fixed frame, of which only the differences count.

    Attributes
    ----------
    t_ns : (n,) int64, strictly increasing
    xyz_m : (n, 3) float64
    quat_xyzw : (n, 4) float64
    piece : (n,) int32, not decreasing
        Between poses of two pieces too much time passed to say what happened.
    time_scale, time_shift_s : float
        How the times of points are to be read: seconds after the stamp are `time_scale` times those
        stated plus `time_shift_s`; not at all if the scale is 0. See `time_check`.
    of_poses : bool
        Whether it is the motion of the poses themselves, or of others in a map, which jump where a
        localiser corrects them; not of odometry that was measured beside them.
    """

    t_ns: IntArray
    xyz_m: FloatArray
    quat_xyzw: FloatArray
    piece: IntArray
    time_scale: float = 1.0
    time_shift_s: float = 0.0
    of_poses: bool = True

    def columns(self) -> dict[str, Array]:
        """Return the columns of `schemas.MOTION`."""
        return {
            "t_ns": self.t_ns,
            "piece": self.piece,
            **pose_columns(self.xyz_m, self.quat_xyzw),
            "time_scale": np.full(len(self.t_ns), self.time_scale),
            "time_shift_s": np.full(len(self.t_ns), self.time_shift_s),
        }

    def at(self, query_ns: IntArray | Sequence[int]) -> FloatArray | None:
        """Return the poses at some times.

        Parameters
        ----------
        query_ns : (m,) int64
            Within one piece.

        Returns
        -------
        (m, 4, 4) float64 or None
            None if they are not all within one piece.
        """
        query_ns = np.asarray(query_ns, np.int64)
        start = int(np.searchsorted(self.t_ns, query_ns.min(), side="right")) - 1
        end = int(np.searchsorted(self.t_ns, query_ns.max()))
        if start < 0 or end >= len(self.t_ns) or self.piece[start] != self.piece[end]:
            return None
        near = slice(start, end + 1)
        xyz_m, quat, _, _ = se3.interpolate_poses(
            self.t_ns[near], self.xyz_m[near], self.quat_xyzw[near], query_ns, max_gap_s=np.inf
        )
        return se3.pose_matrix(xyz_m, quat)

    def steps(self, query_ns: IntArray) -> FloatArray:
        """Return how the sensor moved from each of some times to the next.

        Parameters
        ----------
        query_ns : (m,) int64, increasing, m >= 1

        Returns
        -------
        (m - 1, 4, 4) float64
            Of its earlier frame the pose of the later one; NaN where they are not of one piece.
        """
        covered = self.covered(query_ns)
        # of what is not covered any pose will do
        known_ns = np.clip(query_ns, self.t_ns[0], self.t_ns[-1])
        xyz_m, quat, _, _ = se3.interpolate_poses(
            self.t_ns, self.xyz_m, self.quat_xyzw, known_ns, max_gap_s=np.inf
        )
        pose = se3.pose_matrix(xyz_m, quat)
        piece = self.piece[np.searchsorted(self.t_ns, known_ns)]
        is_known = covered[:-1] & covered[1:] & (piece[:-1] == piece[1:])
        step = se3.invert_pose(pose[:-1]) @ pose[1:]
        return np.where(is_known[:, None, None], step, np.nan)

    def covered(self, query_ns: IntArray) -> BoolArray:
        """Return for each time (m,) whether the pose at it is known."""
        before = np.searchsorted(self.t_ns, query_ns, side="right") - 1
        after = np.searchsorted(self.t_ns, query_ns)
        inside = (before >= 0) & (after < len(self.t_ns))
        return inside & (self.piece[before] == self.piece[np.minimum(after, len(self.t_ns) - 1)])


def motion_from_columns(columns: Columns, *, of_poses: bool = True) -> SensorMotion:
    """Return the motion whose `columns` these are; `of_poses` is not among them."""
    xyz_m, quat_xyzw = split_pose_columns(columns)
    return SensorMotion(
        columns["t_ns"],
        xyz_m,
        quat_xyzw,
        columns["piece"],
        time_scale=float(columns["time_scale"][0]),
        time_shift_s=float(columns["time_shift_s"][0]),
        of_poses=of_poses,
    )


def motion_along(
    edges: Sequence[frame_edges.FrameEdge],
    t_ns: IntArray,
    *,
    max_gap_s: float,
    max_speed_m_s: float = np.inf,
) -> SensorMotion | None:
    """Return the motion along a chain of transforms.

    Parameters
    ----------
    edges : sequence of frame_edges.FrameEdge
        From a fixed frame to the sensor.
    t_ns : (m,) int64, m >= 1
        Stamps of the scans: a chain without time holds over all of them.
    max_gap_s : float
        Longest time between two samples to interpolate over.
    max_speed_m_s : float
        Nor is it known within a jump (`pose_jumps.find_jumps`).

    Returns
    -------
    SensorMotion or None
        None if parts of the chain were never known at the same time.
    """
    stamps = [edge.t_ns for edge in edges if edge.t_ns is not None]
    if not stamps:
        pose, _, _ = frame_edges.chain_poses(edges, [0], max_gap_s=max_gap_s)
        ends_ns = np.array([np.min(t_ns) - 10**9, np.max(t_ns) + 10**9])
        xyz_m, quat = se3.split_pose(np.repeat(pose, 2, axis=0))
        return SensorMotion(ends_ns, xyz_m, quat, np.zeros(2, np.int32))
    known_ns = np.unique(np.concatenate(stamps))
    parts: list[tuple[FloatArray, FloatArray, IntArray]] = []
    # a matrix of each of all of them would take more than all else that is known of a long drive
    for some_ns in np.array_split(known_ns, len(known_ns) // _AT_ONCE + 1):
        pose, _, covered = frame_edges.chain_poses(edges, some_ns, max_gap_s=max_gap_s)
        parts.append((*se3.split_pose(pose[covered]), some_ns[covered]))
    xyz_m, quat, known_ns = (np.concatenate(of) for of in zip(*parts, strict=True))
    if len(known_ns) == 0:
        return None
    is_gap = np.diff(known_ns) > max_gap_s * 1e9
    breaks = is_gap | _are_jumped(edges, known_ns, max_speed_m_s)
    piece = np.concatenate([[0], np.cumsum(breaks)]).astype(np.int32)
    return SensorMotion(known_ns, xyz_m, quat, piece)


def _are_jumped(
    edges: Sequence[frame_edges.FrameEdge], known_ns: IntArray, max_speed_m_s: float
) -> BoolArray:
    """Return for each step between times (n,) whether an edge jumps in it or reaches into it."""
    jumped = np.zeros(len(known_ns) - 1, bool)
    for edge in edges:
        if edge.t_ns is None:
            continue
        jumping = pose_jumps.find_jumps(edge.t_ns, edge.xyz_m, max_speed_m_s=max_speed_m_s)
        for start_ns, end_ns in zip(edge.t_ns[:-1][jumping], edge.t_ns[1:][jumping], strict=True):
            jumped |= (known_ns[:-1] < end_ns) & (known_ns[1:] > start_ns)
    return jumped


def choose_motion(
    chains: Sequence[NamedChain],
    t_ns: IntArray,
    *,
    max_gap_s: float,
    max_speed_m_s: float = np.inf,
) -> SensorMotion:
    """Choose the chain that the sensor's motion is taken from.

    The first one that knows it at nearly as many scans as any does. One whose way differs much from
    that of the last, the poses themselves, is left out: wheels that were not connected, or a clock
    of its own.

    Parameters
    ----------
    chains : list of (str, list of frame_edges.FrameEdge)
        Names and transforms; the smoothest first, the poses themselves last.
    t_ns : (m,) int64
        Stamps of the scans.
    max_gap_s, max_speed_m_s : float
        See `motion_along`.

    Returns
    -------
    SensorMotion

    Raises
    ------
    StageError
        If not even the poses are ever known.
    """
    motions: list[tuple[str, SensorMotion]] = []
    for name, edges in chains:
        motion = motion_along(edges, t_ns, max_gap_s=max_gap_s, max_speed_m_s=max_speed_m_s)
        if motion is not None:
            motions.append((name, motion))
    if not motions:
        raise StageError(
            f"{chains[-1][0]}: parts of the chain to the sensor are never known together;"
            " check its stamps"
        )
    name, motion = _first_that_agrees(motions, t_ns)
    log.log_line(f"motion within sweeps from {name}: {len(motion.t_ns):,} poses")
    frame = dict(chains)[name][0].parent
    is_global = pose_kind.find_pose_kind(topics.ODOMETRY, frame) == pose_kind.LOCALISER
    return replace(motion, of_poses=is_global or _is_same(motion, motions[-1][1]))


def _first_that_agrees(
    motions: Sequence[tuple[str, SensorMotion]], t_ns: IntArray
) -> tuple[str, SensorMotion]:
    """Return the first that covers enough scans and agrees with the last; else the last."""
    _, poses = motions[-1]
    shares = [float(motion.covered(t_ns).mean()) for _, motion in motions]
    for (name, motion), share in zip(motions, shares, strict=True):
        ratio = 1.0 if motion is poses else _way_ratio(motion, poses)
        if share < _ENOUGH * max(shares):
            log.log_line(f"{name} covers {share:.0%} of the scans only: not used within sweeps")
        elif not 1 / _AGREEMENT <= ratio <= _AGREEMENT:
            log.log_line(
                f"{name} moves {ratio:.2f} times the way of the poses: not used within sweeps"
            )
        else:
            return name, motion
    return motions[-1]


def _is_same(motion: SensorMotion, poses: SensorMotion) -> bool:
    """Return whether a motion says nothing but what the poses say, be it by another name."""
    known_ns = poses.t_ns[motion.covered(poses.t_ns)]
    if len(known_ns) < 2:
        return True
    steps = (known.steps(known_ns) for known in (motion, poses))
    return bool(np.allclose(*steps, rtol=0, atol=SAME_M, equal_nan=True))


def _way_ratio(motion: SensorMotion, poses: SensorMotion) -> float:
    """Return the median ratio of a motion's steps to the poses' of half a metre; 1 of too few."""
    ends = [0]
    for i in range(1, len(poses.t_ns)):
        if np.linalg.norm(poses.xyz_m[i] - poses.xyz_m[ends[-1]]) >= pose_jumps.LEAST_M:
            ends.append(i)
    ends = np.array(ends, int)
    ends = ends[motion.covered(poses.t_ns[ends])]
    if len(ends) <= _FEWEST_STEPS:
        return 1.0
    xyz_m, _, _, _ = se3.interpolate_poses(
        motion.t_ns, motion.xyz_m, motion.quat_xyzw, poses.t_ns[ends], max_gap_s=np.inf
    )
    step_m = np.linalg.norm(np.diff(xyz_m, axis=0), axis=1)
    pose_step_m = np.linalg.norm(np.diff(poses.xyz_m[ends], axis=0), axis=1)
    return float(np.median(step_m / pose_step_m))
