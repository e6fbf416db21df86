"""Point-to-line ICP in the plane (Chen and Medioni 1992 in 2-D) with a robust (Cauchy) weight."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.tolerances import FACING, SHORTEST_M
from scanplan.geometry.twists import PLANAR_DIMENSIONS
from scanplan.registration.prepared_clouds import PreparedCloud
from scanplan.types import FloatArray

# GICP weighs a pair as if it were off by this much along the normal: 1e-3 from each side in its
# covariances; the information of other methods, the planar one's too, is stated alike
PAIR_SIGMA_M = 0.045
LEAST_SHARE = 0.005
"""Of the largest eigenvalue: a direction with less is not observable."""
_LEAST_STEPPED = 1e-3  # likewise, of a step: where it arrives, more may be
_THING_M = 0.4  # around its middle: somebody who walks, or pushes a trolley
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
    start : (4, 4) float64
        target_from_source.
    distance_m : float
        Points farther apart are no pair.
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
    for _ in range(max_iterations):
        pairs = _pair_points(source, target, motion, distance_m)
        if pairs is None:
            return None
        information = pairs.information
        step = _solve(information, pairs.gradient, source.reach_m)
        motion = motion @ _motion(step)
        if np.abs(step).max() < step_done:
            break
    return motion, _in_space(information)


def leave_out_a_thing(
    source: PreparedCloud, target: PreparedCloud, motion: FloatArray, distance_m: float
) -> FloatArray:
    """Return the information (6, 6) of an alignment, without a thing that it hangs on alone.

    In a corridor nothing but somebody who walks there may face along it: scans would be moved with
    them. Where the rest determines the motion as well, all pairs count.

    Parameters
    ----------
    source, target, motion, distance_m
        As `align_planar` takes and returns them.
    """
    pairs = _pair_points(source, target, motion, distance_m)
    if pairs is None:
        return np.zeros((6, 6))
    scale = _turn_scale(source.reach_m)
    value, vector = np.linalg.eigh(pairs.information * np.outer(scale, scale))
    if value[0] <= LEAST_SHARE * value[-1]:
        return _in_space(pairs.information)
    # of the direction that is determined least
    share = pairs.weight * (pairs.jacobian @ (scale * vector[:, 0])) ** 2
    middle_m = pairs.point_m[share >= share.max() / 10]
    is_near = np.hypot(*(middle_m[:, None] - pairs.point_m).transpose(2, 0, 1)) <= _THING_M
    is_thing = is_near[np.argmax(is_near @ share)]
    rest = (pairs.weight * ~is_thing * pairs.jacobian.T) @ pairs.jacobian
    value = np.linalg.eigvalsh(rest * np.outer(scale, scale))
    return _in_space(pairs.information if value[0] > LEAST_SHARE * value[-1] else rest)


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Points of a source (n, 2) on lines of a target.

    How their distances to these change with a step (dx, dy, turn) in the source's frame, (n, 3),
    and their robust weights (n,); the information (3, 3) of such a step, and the gradient (3,) of
    half the squared distances by it.
    """

    point_m: FloatArray
    jacobian: FloatArray
    weight: FloatArray
    information: FloatArray
    gradient: FloatArray


def _pair_points(
    source: PreparedCloud, target: PreparedCloud, motion: FloatArray, distance_m: float
) -> _Pairs | None:
    """Return the pairs of points no farther apart than a distance; None of too few."""
    source_xy_m = source.xyz_m[:, :2]
    moved_m = source_xy_m @ motion[:2, :2].T + motion[:2, 3]
    apart_m, nearest = target.tree.query(moved_m, distance_upper_bound=distance_m)
    (pairs,) = np.isfinite(apart_m).nonzero()
    nearest = nearest.take(pairs)
    normal = target.normal.take(nearest, axis=0)
    moved_normal = source.normal.take(pairs, axis=0) @ motion[:2, :2].T
    cosine = np.einsum("ij,ij->i", moved_normal, normal)
    # the two sides of a wall, seen from either room, are not one; a corner faces no side
    (kept,) = (np.isfinite(normal[:, 0]) & ~(cosine < -FACING)).nonzero()
    if len(kept) < len(PLANAR_DIMENSIONS):
        return None
    pairs, nearest, normal = pairs.take(kept), nearest.take(kept), normal.take(kept, axis=0)
    point_m = source_xy_m[pairs]
    residual_m = np.einsum("ij,ij->i", normal, moved_m[pairs] - target.xyz_m[nearest, :2])
    source_normal = normal @ motion[:2, :2]
    by_turn = source_normal[:, 1] * point_m[:, 0] - source_normal[:, 0] * point_m[:, 1]
    jacobian = np.column_stack([source_normal, by_turn])
    # a scale from the residuals alone would trust the wall that fits best and let others slide
    # of a normal distribution by its median absolute deviation
    sigma_m = 1.4826 * _median(np.abs(residual_m))
    scale_m = max(sigma_m, distance_m / _LEAST_SCALE_PART)
    weight = 1 / (1 + (residual_m / scale_m) ** 2)
    weighted = weight * jacobian.T
    return _Pairs(point_m, jacobian, weight, weighted @ jacobian, weighted @ residual_m)


def _median(values: FloatArray) -> float:
    """Return the median of numbers (n,), n >= 1; numpy's takes four times as long of a few."""
    middle = len(values) // 2
    if len(values) % 2:
        return float(np.partition(values, middle)[middle])
    below, above = np.partition(values, (middle - 1, middle))[middle - 1 : middle + 1].tolist()
    return (below + above) / 2


def _solve(information: FloatArray, gradient: FloatArray, reach_m: float) -> FloatArray:
    """Return the step (3,): zero in directions that the pairs hardly determine."""
    scale = _turn_scale(reach_m)
    value, vector = np.linalg.eigh(information * np.outer(scale, scale))
    is_observable = value > _LEAST_STEPPED * value[-1]
    directions = vector[:, is_observable]
    return -scale * (directions @ ((directions.T @ (scale * gradient)) / value[is_observable]))


def _turn_scale(reach_m: float) -> FloatArray:
    """Return the lever arm (3,) that converts rotations to displacements."""
    return np.array([1, 1, 1 / max(reach_m, SHORTEST_M)])


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
