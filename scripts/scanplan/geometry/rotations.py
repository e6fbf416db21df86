"""Rotations as matrices, unit quaternions (x, y, z, w) and rotation vectors (axis times radians).

Written out, as half of what a stage takes to start was the import of scipy's.
"""

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import FloatArray


def quaternions_to_matrices(quat_xyzw: FloatArray) -> FloatArray:
    """Return the matrices (n, 3, 3) of quaternions (n, 4), which are normalised here.

    Raises
    ------
    ValueError
        If one is of length 0.

    Examples
    --------
    >>> quaternions_to_matrices(np.array([[0.0, 0.0, 2.0, 0.0]]))[0].diagonal().tolist()
    [-1.0, -1.0, 1.0]
    """
    length = np.linalg.norm(quat_xyzw, axis=1, keepdims=True)
    if not length.all():
        raise ValueError("a quaternion of length 0 is no rotation")
    x, y, z, w = (quat_xyzw / length).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def matrices_to_quaternions(turn: FloatArray) -> FloatArray:
    """Return unit quaternions (n, 4), w >= 0, of rotation matrices (n, 3, 3).

    S. W. Shepperd: Quaternion from rotation matrix, Journal of Guidance and Control 1 (1978).

    >>> matrices_to_quaternions(np.eye(3)[None]).tolist()
    [[0.0, 0.0, 0.0, 1.0]]
    """
    # four times the products of a quaternion's parts: every row is it, times four of its own part
    diagonal = np.einsum("nii->ni", turn)
    trace = diagonal.sum(axis=1)
    products = np.empty((len(turn), 4, 4))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        products[:, i, i] = 1 + 2 * diagonal[:, i] - trace
        products[:, i, j] = products[:, j, i] = turn[:, i, j] + turn[:, j, i]
        products[:, i, 3] = products[:, 3, i] = turn[:, k, j] - turn[:, j, k]
    products[:, 3, 3] = 1 + trace
    # the row of the largest part loses no digits
    largest = np.argmax(np.einsum("nii->ni", products), axis=1)
    quat = products[np.arange(len(turn)), largest]
    quat /= np.linalg.norm(quat, axis=1, keepdims=True)
    return np.where(quat[:, 3:] < 0, -quat, quat)


def vectors_to_matrices(vector_rad: FloatArray) -> FloatArray:
    """Return the matrices (n, 3, 3) of rotation vectors (n, 3), by Rodrigues' formula.

    >>> vectors_to_matrices(np.array([[0.0, 0.0, np.pi]]))[0].diagonal().round(6).tolist()
    [-1.0, -1.0, 1.0]
    """
    angle = np.linalg.norm(vector_rad, axis=1)[:, None, None]
    cross = cross_matrix(vector_rad)
    # sin(a) / a and (1 - cos(a)) / a^2, which are 1 and 1/2 where there is no turn
    sine = np.sinc(angle / np.pi)
    versine = np.sinc(angle / (2 * np.pi)) ** 2 / 2
    return np.eye(3) + sine * cross + versine * (cross @ cross)


def matrices_to_vectors(turn: FloatArray) -> FloatArray:
    """Return rotation vectors (n, 3), at most half a turn long, of matrices (n, 3, 3).

    >>> matrices_to_vectors(np.eye(3)[None]).tolist()
    [[0.0, 0.0, 0.0]]
    """
    quat = matrices_to_quaternions(turn)
    sine = np.linalg.norm(quat[:, :3], axis=1, keepdims=True)
    angle = 2 * np.arctan2(sine, quat[:, 3:])
    # a small angle is its own sine, which is that of half of it
    return quat[:, :3] * np.where(sine > ROUNDING, angle / np.maximum(sine, ROUNDING), 2.0)


def cross_matrix(vector: FloatArray) -> FloatArray:
    """Return [v]x with [v]x w = v x w, (..., 3) to (..., 3, 3).

    >>> (cross_matrix(np.array([0.0, 0.0, 1.0])) @ [1.0, 0.0, 0.0]).tolist()
    [0.0, 1.0, 0.0]
    """
    x, y, z = np.moveaxis(np.asarray(vector, float), -1, 0)
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
