"""Covariance of the poses of a pose graph."""

from itertools import islice

import numpy as np
from scipy.sparse.linalg import SuperLU

from scanplan.geometry.tolerances import ROUNDING
from scanplan.geometry.twists import PLANAR_DIMENSIONS
from scanplan.registration.graph_equations import GraphEquations, GraphState
from scanplan.types import FloatArray

_N_DRAWS = 100  # standard deviations within 7 %: the inverse itself grows with the scans' square


def estimate_covariance(
    equations: GraphEquations, state: GraphState, factors: SuperLU, world_from_scan: FloatArray
) -> FloatArray:
    """Return the covariance of each pose, as far as poses err against each other.

    The inverse of the Hessian is the covariance of all poses (Kaess and Dellaert 2009). Poses are
    drawn of it: each draw is the solution for noise of the measurements, and is moved onto the map
    by one rigid motion, as how the whole map lies in the world is no error of it.

    Parameters
    ----------
    state : GraphState
        Of these poses.
    factors : scipy.sparse.linalg.SuperLU
        Of the Hessian and `ROUNDING` on its diagonal: as good as nothing is known of what nothing
        measures.
    world_from_scan : (n, 4, 4) float64

    Returns
    -------
    (n, 3, 3) float64
        Of x, y and heading in the world: metres and radians.
    """
    rng = np.random.default_rng(0)
    at_once = _N_DRAWS // 10  # as many gradients are in memory
    draws = []
    for gradient in islice(equations.draw_gradients(state, rng, at_once), _N_DRAWS // at_once):
        unmeasured = ROUNDING**0.5 * rng.standard_normal(gradient.shape)
        draws.append(_to_world(factors.solve(gradient + unmeasured), world_from_scan))
    error = _without_common_motion(np.concatenate(draws, axis=2), world_from_scan[:, :2, 3])
    return np.asarray(error @ error.transpose(0, 2, 1) / error.shape[2])


def _to_world(step: FloatArray, world_from_scan: FloatArray) -> FloatArray:
    """Return x, y and heading (n, 3, k) of steps (n * d, k) in the scans' frames."""
    step = step.reshape(len(world_from_scan), -1, step.shape[1])
    if step.shape[1] == len(PLANAR_DIMENSIONS):
        return np.concatenate([world_from_scan[:, :2, :2] @ step[:, :2], step[:, 2:]], axis=1)
    shift = world_from_scan[:, :2, :3] @ step[:, :3]
    return np.concatenate([shift, world_from_scan[:, 2:3, :3] @ step[:, 3:]], axis=1)


def _without_common_motion(error: FloatArray, xy_m: FloatArray) -> FloatArray:
    """Return errors (n, 3, k) of poses at places (n, 2) without what one rigid motion explains.

    Poses that are worse than most count for less: one that hardly anything measures would turn all
    others.
    """
    from_middle_m = xy_m - xy_m.mean(axis=0)
    of_motion = np.tile(np.eye(3), (len(xy_m), 1, 1))
    of_motion[:, :2, 2] = from_middle_m[:, ::-1] * [-1, 1]
    left = error
    for _ in range(2):
        variance = (left**2).mean(axis=2)
        weight = 1 / (np.maximum(variance, np.median(variance, axis=0)) + ROUNDING**2)
        pulled = of_motion * weight[:, :, None]
        normal = np.einsum("nij,nik->jk", pulled, of_motion)
        motion = np.linalg.solve(normal, np.einsum("nij,nik->jk", pulled, error))
        left = error - of_motion @ motion
    return left
