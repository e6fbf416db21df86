"""How the sensor moved between and during its scans, from the smoothest source that was recorded.

A localiser corrects its poses in jumps of centimetres; odometry drifts but does not jump (REP 105). Where points have
to be moved by what happened within a tenth of a second the second is the better witness.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import pose_jumps, tf_tree
from scanplan.stage import log
from scanplan.store import schemas

_ENOUGH = 0.95
_STEP_M = 0.5
_FEWEST_STEPS = 3
_AGREEMENT = 1.25


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
        How the times of points are to be read: seconds after the stamp are `time_scale` times those stated plus
        `time_shift_s`; not at all if the scale is 0. See `time_check`.
    """

    t_ns: np.ndarray
    xyz_m: np.ndarray
    quat_xyzw: np.ndarray
    piece: np.ndarray
    time_scale: float = 1.0
    time_shift_s: float = 0.0

    def columns(self):
        """Return the columns of `schemas.MOTION`."""
        values = np.hstack([self.xyz_m, self.quat_xyzw]).T
        return {
            "t_ns": self.t_ns,
            "piece": self.piece,
            **dict(zip((*schemas.XYZ, *schemas.QUAT), values, strict=True)),
            "time_scale": np.full(len(self.t_ns), self.time_scale),
            "time_shift_s": np.full(len(self.t_ns), self.time_shift_s),
        }

    def at(self, query_ns):
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
        first, last = query_ns.min(), query_ns.max()
        start = int(np.searchsorted(self.t_ns, first, side="right")) - 1
        end = int(np.searchsorted(self.t_ns, last))
        if start < 0 or end >= len(self.t_ns) or self.piece[start] != self.piece[end]:
            return None
        near = slice(start, end + 1)
        xyz_m, quat, _, _ = se3.interpolate_poses(
            self.t_ns[near], self.xyz_m[near], self.quat_xyzw[near], query_ns, max_gap_s=np.inf
        )
        return se3.pose_matrix(xyz_m, quat)

    def covered(self, query_ns):
        """Tell for each time (m,) whether the pose at it is known."""
        before = np.searchsorted(self.t_ns, query_ns, side="right") - 1
        after = np.searchsorted(self.t_ns, query_ns)
        inside = (before >= 0) & (after < len(self.t_ns))
        return inside & (self.piece[before] == self.piece[np.minimum(after, len(self.t_ns) - 1)])


def motion_from_columns(columns):
    """Return the Motion whose `columns` these are."""
    xyz_m, quat = (
        np.column_stack([columns[c] for c in names]) for names in (schemas.XYZ, schemas.QUAT)
    )
    reading = float(columns["time_scale"][0]), float(columns["time_shift_s"][0])
    return SensorMotion(columns["t_ns"], xyz_m, quat, columns["piece"], *reading)


def motion_along(edges, t_ns, *, max_gap_s, max_speed_m_s=np.inf):
    """Return the motion along a chain of transforms.

    Parameters
    ----------
    edges : sequence of tf_tree.FrameEdge
        From a fixed frame to the sensor.
    t_ns : (m,) int64, m >= 1
        Stamps of the scans: a chain without time holds over all of them.
    max_gap_s : float
        Longest time between two samples to interpolate over.
    max_speed_m_s : float
        Nor is it known within a jump (`pose_jumps.find_jumps`).

    Returns
    -------
    Motion or None
        None if parts of the chain were never known at the same time.
    """
    stamps = [edge.t_ns for edge in edges if edge.t_ns is not None]
    if not stamps:
        pose, _, _ = tf_tree.chain_poses(edges, [0], max_gap_s=max_gap_s)
        both_ns = np.array([np.min(t_ns) - 10**9, np.max(t_ns) + 10**9])
        return SensorMotion(
            both_ns, *se3.split_pose(np.repeat(pose, 2, axis=0)), np.zeros(2, np.int32)
        )
    known_ns = np.unique(np.concatenate(stamps))
    pose, _, covered = tf_tree.chain_poses(edges, known_ns, max_gap_s=max_gap_s)
    if not covered.any():
        return None
    known_ns, pose = known_ns[covered], pose[covered]
    breaks = (np.diff(known_ns) > max_gap_s * 1e9) | _jumping(edges, known_ns, max_speed_m_s)
    piece = np.concatenate([[0], np.cumsum(breaks)]).astype(np.int32)
    return SensorMotion(known_ns, *se3.split_pose(pose), piece)


def _jumping(edges, known_ns, max_speed_m_s):
    """Tell for each step between times (n,) whether a jump of one of the edges lies in it or reaches into it."""
    found = np.zeros(len(known_ns) - 1, bool)
    for edge in edges:
        if edge.t_ns is None:
            continue
        jumping = pose_jumps.find_jumps(edge.t_ns, edge.xyz_m, max_speed_m_s=max_speed_m_s)
        for start_ns, end_ns in zip(edge.t_ns[:-1][jumping], edge.t_ns[1:][jumping], strict=True):
            found |= (known_ns[:-1] < end_ns) & (known_ns[1:] > start_ns)
    return found


def choose_motion(chains, t_ns, **limits):
    """Choose by which of several chains the sensor's motion is told.

    The first one that knows it at nearly as many scans as any does. One that tells of quite another way than the last,
    the poses themselves, is left out: wheels that were not connected, or a clock of its own.

    Parameters
    ----------
    chains : list of (str, list of tf_tree.FrameEdge)
        Names and transforms; the smoothest first, the poses themselves last.
    t_ns : (m,) int64
        Stamps of the scans.
    **limits
        Of `motion_along`.

    Returns
    -------
    Motion

    Raises
    ------
    StageError
        If not even the poses are ever known.
    """
    found = [(name, motion_along(edges, t_ns, **limits)) for name, edges in chains]
    found = [(name, motion) for name, motion in found if motion is not None]
    if not found:
        raise StageError(
            f"{chains[-1][0]}: parts of the chain to the sensor are never known together; check its stamps"
        )
    poses = found[-1][1]
    shares = [float(motion.covered(t_ns).mean()) for _, motion in found]
    for (name, motion), share in zip(found, shares, strict=True):
        ratio = 1.0 if motion is poses else _way_ratio(motion, poses)
        if share < _ENOUGH * max(shares):
            log.log_line(
                f"{name} tells the motion at {share:.0%} of the scans only: not used within sweeps"
            )
        elif not 1 / _AGREEMENT <= ratio <= _AGREEMENT:
            log.log_line(
                f"{name} tells of {ratio:.2f} times the way that the poses tell of: not used within sweeps"
            )
        else:
            break
    log.log_line(f"motion within sweeps from {name}: {len(motion.t_ns):,} poses")
    return motion


def _way_ratio(motion, poses):
    """How much longer steps of the poses' half metre are in a motion: the median; 1 where there are too few to tell."""
    ends = [0]
    for i in range(1, len(poses.t_ns)):
        if np.linalg.norm(poses.xyz_m[i] - poses.xyz_m[ends[-1]]) >= _STEP_M:
            ends.append(i)
    ends = np.array([i for i in ends if motion.covered(poses.t_ns[i : i + 1])[0]], int)
    if len(ends) <= _FEWEST_STEPS:
        return 1.0
    there, _, _, _ = se3.interpolate_poses(
        motion.t_ns, motion.xyz_m, motion.quat_xyzw, poses.t_ns[ends], max_gap_s=np.inf
    )
    step_m = np.linalg.norm(np.diff(poses.xyz_m[ends], axis=0), axis=1)
    return float(np.median(np.linalg.norm(np.diff(there, axis=0), axis=1) / step_m))
