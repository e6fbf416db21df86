"""Frames and the motions between them: edges, the tf tree, poses at given times.

An edge is a transform `parent_from_child`, constant or changing with time. The product of a chain of edges from the
map to the sensor is the pose `chain_poses` (REP 105).
"""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import clocks, pose_jumps

WORLD_FRAMES = ("map", "odom", "world", "earth")
_NORM_TOLERANCE = 1e-3
_STILL = 1e-6


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
    """

    parent: str
    child: str
    xyz_m: np.ndarray
    quat_xyzw: np.ndarray
    t_ns: np.ndarray | None = None

    def inverse(self):
        """Return child_from_parent, sample by sample."""
        xyz_m, quat = se3.split_pose(se3.invert_pose(se3.pose_matrix(self.xyz_m, self.quat_xyzw)))
        return FrameEdge(self.child, self.parent, xyz_m, quat, self.t_ns)

    def frozen(self):
        """Return the edge without time, as its last sample has it."""
        return FrameEdge(self.parent, self.child, self.xyz_m[-1:], self.quat_xyzw[-1:])

    def is_still(self):
        """Tell whether all samples are the same."""
        alike = np.abs(self.quat_xyzw @ self.quat_xyzw[0]) >= 1 - _STILL**2
        return bool(alike.all() and (np.abs(self.xyz_m - self.xyz_m[0]) <= _STILL).all())


def make_static_edge(parent, child, pose):
    """Return a constant edge from one 4 x 4 matrix."""
    xyz_m, quat = se3.split_pose(np.asarray(pose, float)[None])
    return FrameEdge(parent, child, xyz_m, quat)


def make_track_edge(parent, child, t_ns, receive_ns, rows):
    """Make a changing edge from recorded poses, leaving out what cannot be a pose.

    Parameters
    ----------
    parent, child : str
    t_ns, receive_ns : (n,) int64
        Header stamps and receive times, in the order of recording. If all stamps are 0 the receive times count.
    rows : (n, 7) float
        x, y, z, qx, qy, qz, qw.

    Returns
    -------
    edge : Edge or None
        None if nothing is left. Of poses with the same stamp the one recorded last is kept.
    found : dict of str to int
        How many were not finite, had no unit quaternion, came backwards in time, lay in a time that went by twice
        (none of them is kept: nobody knows which of the two a scan belongs to), repeated a stamp, had no stamp.
    """
    t_ns, rows = np.asarray(t_ns, np.int64), np.asarray(rows, float).reshape(-1, 7)
    unstamped = len(t_ns) > 0 and not t_ns.any()
    t_ns = np.asarray(receive_ns, np.int64) if unstamped else t_ns
    finite = np.isfinite(rows).all(axis=1)
    with np.errstate(invalid="ignore", over="ignore"):
        unit = np.abs(np.linalg.norm(rows[:, 3:], axis=1) - 1) <= _NORM_TOLERANCE
    good = finite & unit
    twice = np.zeros(len(t_ns), bool)
    twice[good] = clocks.find_repeated_times(t_ns[good])
    good &= ~twice
    t_good, rows_good = t_ns[good], rows[good]
    backwards = int((t_good[1:] < np.maximum.accumulate(t_good)[:-1]).sum())
    # the first of the reversed order is the one recorded last
    t_kept, last = np.unique(t_good[::-1], return_index=True)
    kept = rows_good[::-1][last]
    found = {
        "not finite": int((~finite).sum()),
        "without unit quaternion": int((finite & ~unit).sum()),
        "backwards in time": backwards,
        "in a time that the clock told twice (dropped)": int(twice.sum()),
        "of a repeated stamp": len(t_good) - len(t_kept),
        "without stamp (receive time taken)": len(t_ns) if unstamped else 0,
    }
    quat = kept[:, 3:] / np.linalg.norm(kept[:, 3:], axis=1, keepdims=True)
    return (FrameEdge(parent, child, kept[:, :3], quat, t_kept) if len(t_kept) else None), found


class _TwoParentsError(StageError):
    """A frame hangs on two others; `edges_below` lead up to it."""

    def __init__(self, frame, parents, edges_below):
        names = " and ".join(sorted(parents))
        super().__init__(
            f"tf: frame {frame} hangs on {names}; set input.base_frame or input.base_from_sensor"
        )
        self.edges_below = edges_below


class FrameTree:
    """The frames of /tf and /tf_static.

    Parameters
    ----------
    edges : iterable of Edge
        One for each pair of frames. Edges that never move count as constant, unless they hang on a frame of the world:
        a robot that stands still is not bolted down.
    """

    def __init__(self, edges):
        self._edges = {}
        for edge in edges:
            mounted = edge.t_ns is not None and edge.parent not in WORLD_FRAMES and edge.is_still()
            self._edges.setdefault(edge.child, {})[edge.parent] = edge.frozen() if mounted else edge

    @property
    def frames(self):
        """All frame names, sorted."""
        return sorted({*self._edges, *(p for parents in self._edges.values() for p in parents)})

    def up(self, frame, follows=lambda edge: True):
        """Iterate over the edges from a frame to the root, nearest first; only over those that `follows` accepts.

        Raises
        ------
        StageError
            If a frame hangs on itself or on two others.
        """
        seen, below = [frame], []
        while parents := {p: e for p, e in self._edges.get(seen[-1], {}).items() if follows(e)}:
            if len(parents) > 1:
                raise _TwoParentsError(seen[-1], parents, below)
            edge = next(iter(parents.values()))
            if edge.parent in seen:
                raise StageError(
                    f"tf: frames {' -> '.join([*seen, edge.parent])} are a cycle; mend the robot's tf"
                )
            seen.append(edge.parent), below.append(edge)
            yield edge

    def path(self, start, end):
        """Return the edges whose product is start_from_end, or None if the frames are not connected.

        Raises
        ------
        StageError
            If there is a cycle above one of them, or only a frame that hangs on two others could connect them.
        """
        rising, falling, doubt = [], [], None
        for frame, chain in [(start, rising), (end, falling)]:
            try:
                chain.extend(self.up(frame))
            except _TwoParentsError as error:
                chain[:] = error.edges_below
                doubt = error
        above_end = [end, *(edge.parent for edge in falling)]
        for i, frame in enumerate([start, *(edge.parent for edge in rising)]):
            if frame in above_end:
                return [edge.inverse() for edge in rising[:i]] + falling[: above_end.index(frame)][
                    ::-1
                ]
        if doubt:
            raise doubt
        return None

    def mount_root(self, frame, world):
        """Return the frame at the top of what is rigidly connected to `frame`, below the frames of the world.

        Parameters
        ----------
        frame : str
        world : str
            The frame that the poses are given in; the climb stops below it too.
        """
        rigid = self.up(
            frame, lambda edge: edge.t_ns is None and edge.parent not in (world, *WORLD_FRAMES)
        )
        return [frame, *(edge.parent for edge in rigid)][-1]

    def world_root(self, frame):
        """Return the frame that poses are to be given in: map above `frame`, else odom, else the topmost."""
        above = [frame]
        for edge in self.up(frame):
            above.append(edge.parent)
            if edge.parent == "map":
                break
        return next((name for name in ("map", "odom") if name in above), above[-1])


def chain_poses(edges, query_ns, *, max_gap_s, max_speed_m_s=np.inf):
    """Multiply a chain of edges at given times (thesis, algorithm 3, step 1, for each edge that changes).

    Parameters
    ----------
    edges : sequence of Edge
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
    gap_s, covered = np.zeros(len(query_ns)), np.ones(len(query_ns), bool)
    for edge in edges:
        if edge.t_ns is None:
            pose = pose @ se3.pose_matrix(edge.xyz_m[0], edge.quat_xyzw[0])
            continue
        xyz_m, quat, gap, inside = se3.interpolate_poses(
            edge.t_ns, edge.xyz_m, edge.quat_xyzw, query_ns, max_gap_s=max_gap_s
        )
        pose = pose @ se3.pose_matrix(xyz_m, quat)
        jumping = pose_jumps.find_jumps(edge.t_ns, edge.xyz_m, max_speed_m_s=max_speed_m_s)
        inside &= ~pose_jumps.is_inside_jump(edge.t_ns, jumping, query_ns)
        gap_s, covered = np.maximum(gap_s, gap), covered & inside
    pose[~covered] = np.nan
    return pose, gap_s, covered
