"""Point-to-line ICP in the plane (Chen and Medioni 1992 in 2-D) with a robust (Cauchy) weight."""

import numpy as np

from scanplan.geometry.tolerances import FACING, SHORTEST_M
from scanplan.geometry.twists import PLANAR_DIMENSIONS
from scanplan.registration.prepared_clouds import PreparedCloud
from scanplan.types import FloatArray

# GICP weighs a pair as if it were off by this much along the normal: 1e-3 from each side in its
# covariances; the information of other methods, the planar one's too, is stated alike
PAIR_SIGMA_M = 0.045
_LEAST_SHARE = 1e-3  # of the largest eigenvalue: a direction with less is not observable
_LEAST_SCALE_PART = 10  # the robust scale is at least this part of the pairs' largest distance


def align_planar(
    source: PreparedCloud,
    target: PreparedCloud,
    start: FloatArray,
    distance_m: float,
    max_iterations: int,
    step_done: float,
) -> tuple[FloatArray, FloatArray] | None:
    """Refine a motion in the plane; see `icp.align_clouds`.

    Parameters
    ----------
    source, target : PreparedCloud
    start : (4, 4) float64
        target_from_source.
    distance_m : float
        Points farther apart are no pair.
    max_iterations : int
    step_done : float
        A smaller step, metres and radians, is the last.

    Returns
    -------
    motion : (4, 4) float64
    information : (6, 6) float64
        Of x, y and the turn about z, zero elsewhere.
    None instead of both without pairs.
    """
    motion = np.array(start, float)
    information = np.zeros((3, 3))
    reach_m = float(np.sqrt(2 * np.mean(source.xyz_m[:, :2] ** 2)))
    for _ in range(max_iterations):
        equations = _normal_equations(source, target, motion, distance_m)
        if equations is None:
            return None
        information, gradient = equations
        step = _solve(information, gradient, reach_m)
        motion = motion @ _motion(step)
        if np.abs(step).max() < step_done:
            break
    return motion, _in_space(information)


def _normal_equations(
    source: PreparedCloud, target: PreparedCloud, motion: FloatArray, distance_m: float
) -> tuple[FloatArray, FloatArray] | None:
    """Return information (3, 3) and gradient (3,) of the point-to-line error; None without pairs.

    They are those of a step (dx, dy, turn) in the source's frame.
    """
    source_xy_m = source.xyz_m[:, :2]
    moved_m = source_xy_m @ motion[:2, :2].T + motion[:2, 3]
    apart_m, nearest = target.tree.query(moved_m, distance_upper_bound=distance_m)
    pairs = np.flatnonzero(np.isfinite(apart_m))
    pairs = pairs[np.isfinite(target.normal[nearest[pairs], 0])]
    moved_normal = source.normal[pairs] @ motion[:2, :2].T
    cosine = np.einsum("ij,ij->i", moved_normal, target.normal[nearest[pairs]])
    # the two sides of a wall, seen from either room, are not one; a corner faces no side
    pairs = pairs[~(cosine < -FACING)]
    if len(pairs) < len(PLANAR_DIMENSIONS):
        return None
    normal = target.normal[nearest[pairs]]
    point_m = source_xy_m[pairs]
    residual_m = np.einsum("ij,ij->i", normal, moved_m[pairs] - target.xyz_m[nearest[pairs], :2])
    source_normal = normal @ motion[:2, :2]
    by_turn = source_normal[:, 1] * point_m[:, 0] - source_normal[:, 0] * point_m[:, 1]
    jacobian = np.column_stack([source_normal, by_turn])
    # a scale from the residuals alone would trust the wall that fits best and let others slide
    # of a normal distribution by its median absolute deviation
    sigma_m = 1.4826 * np.median(np.abs(residual_m))
    scale_m = max(sigma_m, distance_m / _LEAST_SCALE_PART)
    weighted = jacobian.T / (1 + (residual_m / scale_m) ** 2)
    return weighted @ jacobian, weighted @ residual_m


def _solve(information: FloatArray, gradient: FloatArray, reach_m: float) -> FloatArray:
    """Return the step (3,): zero in directions that the pairs hardly determine."""
    scale = np.array([1, 1, 1 / max(reach_m, SHORTEST_M)])
    value, vector = np.linalg.eigh(information * np.outer(scale, scale))
    is_observable = value > _LEAST_SHARE * value[-1]
    directions = vector[:, is_observable]
    return -scale * (directions @ ((directions.T @ (scale * gradient)) / value[is_observable]))


def _motion(step: FloatArray) -> FloatArray:
    x_m, y_m, turn_rad = step
    cos = np.cos(turn_rad)
    sin = np.sin(turn_rad)
    motion = np.eye(4)
    motion[:2, :2] = [[cos, -sin], [sin, cos]]
    motion[:2, 3] = x_m, y_m
    return motion


def _in_space(information: FloatArray) -> FloatArray:
    result = np.zeros((6, 6))
    rows = np.ix_(PLANAR_DIMENSIONS, PLANAR_DIMENSIONS)
    result[rows] = information / PAIR_SIGMA_M**2
    return result
