"""Small rigid motions as six numbers: a shift, metres, then a rotation vector, radians.

They are taken in the frame of what moves: `pose @ motion(twist)`. Shift and turn stay apart (no
screw motion), which makes the six numbers those that errors are stated in.
"""

import numpy as np
import numpy.typing as npt

from scanplan.geometry import rotations
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import FloatArray

PLANAR_DIMENSIONS = (0, 1, 5)
"""Of the six numbers: x, y and the turn about z."""


def twist_to_motion(twist: npt.ArrayLike) -> FloatArray:
    """Return the 4 x 4 matrices of six numbers each, (..., 6) to (..., 4, 4).

    >>> twist_to_motion([1.0, 2.0, 3.0, 0.0, 0.0, 0.0])[:3, 3].tolist()
    [1.0, 2.0, 3.0]
    """
    twist = np.asarray(twist, float)
    result = np.zeros((*twist.shape[:-1], 4, 4))
    turns = rotations.vectors_to_matrices(twist[..., 3:].reshape(-1, 3))
    result[..., :3, :3] = turns.reshape(*twist.shape[:-1], 3, 3)
    result[..., :3, 3] = twist[..., :3]
    result[..., 3, 3] = 1
    return result


def motion_to_twist(a_from_b: npt.ArrayLike) -> FloatArray:
    """Return the six numbers of rigid motions, (..., 4, 4) to (..., 6).

    The inverse of `twist_to_motion`.

    >>> motion_to_twist(np.eye(4)).tolist()
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    a_from_b = np.asarray(a_from_b, float)
    turn = a_from_b[..., :3, :3]
    # sin and cos of the angle, times the axis: a tenth of the time of the way through
    # quaternions; entry by entry, as most calls are of one motion
    x, y, z = ((turn[..., i, j] - turn[..., j, i]) / 2 for i, j in ((2, 1), (0, 2), (1, 0)))
    sine = np.sqrt(x * x + y * y + z * z)
    cosine = (turn[..., 0, 0] + turn[..., 1, 1] + turn[..., 2, 2] - 1) / 2
    # a small angle is its own sine
    scale = np.where(sine > ROUNDING, np.arctan2(sine, cosine) / np.maximum(sine, ROUNDING), 1.0)
    twist = np.empty((*a_from_b.shape[:-2], 6))
    twist[..., :3] = a_from_b[..., :3, 3]
    vector = twist[..., 3:]
    for part, along in enumerate((x, y, z)):
        vector[..., part] = along * scale
    # near half a turn rounding leaves nothing of the axis
    reversed_turn = (cosine < 0) & np.isfinite(cosine)
    if np.any(reversed_turn):
        vector[reversed_turn] = rotations.matrices_to_vectors(turn[reversed_turn])
    return twist


def twist_adjoint(a_from_b: npt.ArrayLike) -> FloatArray:
    """Return (..., 6, 6): a small twist in frame b to the same motion's twist in frame a."""
    a_from_b = np.asarray(a_from_b, float)
    turn = a_from_b[..., :3, :3]
    result = np.zeros((*a_from_b.shape[:-2], 6, 6))
    result[..., :3, :3] = result[..., 3:, 3:] = turn
    result[..., :3, 3:] = rotations.cross_matrix(a_from_b[..., :3, 3]) @ turn
    return result


def pose_information(sigma: npt.ArrayLike, world_from_scan: npt.ArrayLike) -> FloatArray:
    """Return the inverse covariances (..., 6, 6) of poses, as twists in their own frames.

    Parameters
    ----------
    sigma : (6,) float
        Standard deviations along and about the world's axes, metres and radians.
    world_from_scan : (..., 4, 4) float
    """
    turn = np.zeros((*np.shape(world_from_scan)[:-2], 6, 6))
    turn[..., :3, :3] = turn[..., 3:, 3:] = np.asarray(world_from_scan)[..., :3, :3]
    return np.swapaxes(turn, -1, -2) @ (np.asarray(sigma, float)[:, None] ** -2.0 * turn)
