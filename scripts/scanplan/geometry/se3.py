"""Rigid motions: quaternions (x, y, z, w), 4 x 4 matrices, interpolation between poses.

`a_from_b` maps coordinates in frame b to coordinates in frame a.
"""

import numpy as np
import numpy.typing as npt

from scanplan.geometry import rotations
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray


def pose_matrix(xyz_m: npt.ArrayLike, quat_xyzw: npt.ArrayLike) -> FloatArray:
    """Return the 4 x 4 matrices of poses.

    Parameters
    ----------
    xyz_m : (..., 3) float
    quat_xyzw : (..., 4) float
        Normalised here; NaN gives NaN.

    Returns
    -------
    (..., 4, 4) float64

    Examples
    --------
    >>> pose_matrix([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0])[:3, 3].tolist()
    [1.0, 2.0, 3.0]
    """
    xyz_m = np.asarray(xyz_m, float)
    quat_xyzw = np.asarray(quat_xyzw, float)
    pose = np.full((*xyz_m.shape[:-1], 4, 4), np.nan)
    pose[..., 3, :] = (0, 0, 0, 1)
    known = np.isfinite(quat_xyzw).all(axis=-1) & np.isfinite(xyz_m).all(axis=-1)
    if known.any():
        pose[known, :3, :3] = rotations.quaternions_to_matrices(quat_xyzw[known])
        pose[known, :3, 3] = xyz_m[known]
    return pose


def split_pose(pose: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return positions (..., 3) and quaternions (..., 4), w >= 0, of 4 x 4 matrices.

    NaN stays NaN.

    >>> xyz_m, quat_xyzw = split_pose(np.eye(4))
    >>> xyz_m.tolist(), quat_xyzw.tolist()
    ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0])
    """
    pose = np.asarray(pose, float)
    quat = np.full((*pose.shape[:-2], 4), np.nan)
    known = np.isfinite(pose).all(axis=(-2, -1))
    if known.any():
        quat[known] = rotations.matrices_to_quaternions(pose[known][:, :3, :3])
    return pose[..., :3, 3].copy(), quat


def transform_points(a_from_b: npt.ArrayLike, xyz_b_m: npt.ArrayLike) -> FloatArray:
    """Map points (n, 3) from frame b to frame a by one 4 x 4 matrix; float64.

    >>> pose = pose_matrix([1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0])  # half a turn
    >>> transform_points(pose, [[1.0, 0.0, 0.5]]).tolist()
    [[0.0, 0.0, 0.5]]
    """
    a_from_b = np.asarray(a_from_b, float)
    return np.asarray(xyz_b_m, float) @ a_from_b[:3, :3].T + a_from_b[:3, 3]


def invert_pose(a_from_b: npt.ArrayLike) -> FloatArray:
    """Return b_from_a of one or many 4 x 4 rigid motions.

    >>> invert_pose(pose_matrix([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]))[:3, 3].tolist()
    [-1.0, -2.0, -3.0]
    """
    a_from_b = np.asarray(a_from_b, float)
    back = a_from_b.copy()
    back[..., :3, :3] = np.swapaxes(a_from_b[..., :3, :3], -1, -2)
    back[..., :3, 3] = -(back[..., :3, :3] @ a_from_b[..., :3, 3, None])[..., 0]
    return back


def nearest_rigid(pose: npt.ArrayLike) -> FloatArray:
    """Return a 4 x 4 matrix with the nearest true rotation in it.

    `invert_pose` takes a rotation's transpose for its inverse, so in a chain of products and
    inverses a rounding error doubles with every link unless it is taken out.
    """
    cleaned = np.array(pose, float)
    turn = cleaned[:3, :3]
    error = turn.T @ turn - np.eye(3)
    if np.abs(error).max() < ROUNDING and np.linalg.det(turn) > 0:
        # the series of turn (1 + error)^-1/2: what is left out is of the error's square
        cleaned[:3, :3] = turn - turn @ error / 2
        return cleaned
    left, _, right = np.linalg.svd(turn)
    cleaned[:3, :3] = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    return cleaned


def turn_between_rad(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return by what angle (...,) poses (..., 4, 4) are turned from one another, 0 to pi.

    NaN of those that are not known.

    >>> float(turn_between_rad(np.eye(4), np.diag([-1.0, -1.0, 1.0, 1.0]))) == np.pi
    True
    """
    # |R - S| in the Frobenius norm is sqrt(8) sin(angle / 2)
    apart = one[..., :3, :3] - other[..., :3, :3]
    half_sine = np.linalg.norm(apart, axis=(-2, -1)) / np.sqrt(8)
    return 2 * np.arcsin(np.minimum(half_sine, 1.0))


def pose_yaw_rad(pose: npt.ArrayLike) -> FloatArray:
    """Return the heading of 4 x 4 matrices: the angle of the x axis about z, radians.

    >>> float(pose_yaw_rad(np.diag([-1.0, -1.0, 1.0, 1.0]))) == np.pi
    True
    """
    pose = np.asarray(pose, float)
    return np.arctan2(pose[..., 1, 0], pose[..., 0, 0])


def level_frame(pose: npt.ArrayLike) -> FloatArray:
    """Return poses (..., 4, 4) with the places and headings of others, not tilted."""
    yaw_rad = pose_yaw_rad(pose)
    level = np.zeros(np.shape(pose))
    level[..., 0, 0] = level[..., 1, 1] = np.cos(yaw_rad)
    level[..., 1, 0] = np.sin(yaw_rad)
    level[..., 0, 1] = -level[..., 1, 0]
    level[..., 2, 2] = level[..., 3, 3] = 1
    level[..., :3, 3] = np.asarray(pose)[..., :3, 3]
    return level


def interpolate_poses(
    t_ns: npt.ArrayLike,
    xyz_m: npt.ArrayLike,
    quat_xyzw: npt.ArrayLike,
    query_ns: npt.ArrayLike,
    *,
    max_gap_s: float,
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Interpolate poses: linear in position, spherical in rotation (thesis, algorithm 3, step 1).

    Never extrapolates; a query that falls into a gap longer than `max_gap_s` is not covered. A
    query that equals a stamp is covered whatever the gaps beside it.

    Parameters
    ----------
    t_ns : (n,) int64, strictly increasing, n >= 1
        Pose stamps, nanoseconds.
    xyz_m : (n, 3) float
    quat_xyzw : (n, 4) float
        Unit quaternions; the sign of each is free.
    query_ns : (m,) int64

    Returns
    -------
    xyz_m : (m, 3) float64, NaN where not covered
    quat_xyzw : (m, 4) float64, NaN where not covered
    gap_s : (m,) float64
        Time between the two poses around the query; 0 on a stamp, infinite before the first and
        after the last.
    covered : (m,) bool

    Raises
    ------
    ValueError
        If `t_ns` is empty or not strictly increasing.
    """
    t_ns = np.asarray(t_ns, np.int64)
    query_ns = np.asarray(query_ns, np.int64)
    xyz_m = np.asarray(xyz_m, float)
    quat_xyzw = np.asarray(quat_xyzw, float)
    if len(t_ns) == 0 or (np.diff(t_ns) <= 0).any():
        raise ValueError("pose stamps must be one or more and strictly increasing")
    after = np.clip(np.searchsorted(t_ns, query_ns), 0, len(t_ns) - 1)
    before = np.where(t_ns[after] == query_ns, after, np.maximum(after - 1, 0))
    inside = (t_ns[before] <= query_ns) & (query_ns <= t_ns[after])
    gap_s = np.where(inside, (t_ns[after] - t_ns[before]) / 1e9, np.inf)
    covered = gap_s <= max_gap_s
    xyz = np.full((len(query_ns), 3), np.nan)
    quat = np.full((len(query_ns), 4), np.nan)
    if covered.any():
        b, a = before[covered], after[covered]
        # ASSUME spans below 2**53 ns (104 days) from the first stamp: exact in float64
        share = (query_ns[covered] - t_ns[b]) / np.maximum(t_ns[a] - t_ns[b], 1)
        xyz[covered] = xyz_m[b] * (1 - share)[:, None] + xyz_m[a] * share[:, None]
        quat[covered] = _slerp(quat_xyzw, b, a, share)
    return xyz, quat, gap_s, covered


def _slerp(
    quat_xyzw: FloatArray, before: IntArray, after: IntArray, share: FloatArray
) -> FloatArray:
    length = np.linalg.norm(quat_xyzw, axis=1, keepdims=True)
    if not length.all():
        raise ValueError("a quaternion of length 0 is no rotation")
    unit = quat_xyzw / length
    start, end = unit[before], unit[after]
    # q and -q are one turn: the shorter way
    end = np.where((start * end).sum(axis=1, keepdims=True) < 0, -end, end)
    apart = np.linalg.norm(end - start, axis=1), np.linalg.norm(end + start, axis=1)
    angle = 2 * np.arctan2(*apart)
    whole = np.sin(angle)
    is_turned = whole > ROUNDING
    weights = [
        np.divide(np.sin(part * angle), whole, out=part.copy(), where=is_turned)[:, None]
        for part in (1 - share, share)
    ]
    quat = weights[0] * start + weights[1] * end
    quat /= np.linalg.norm(quat, axis=1, keepdims=True)
    return np.where(quat[:, 3:] < 0, -quat, quat)
