"""How far the poses of a pose graph may be off: what its measurements leave open."""

import numpy as np
from scipy.sparse.linalg import SuperLU, spsolve_triangular

from scanplan.geometry.twists import PLANAR_DIMENSIONS
from scanplan.types import FloatArray

_N_DRAWS = 100  # standard deviations within 7 %: the inverse itself grows with the scans' square


def estimate_covariance(factors: SuperLU, world_from_scan: FloatArray) -> FloatArray:
    """Return the covariance of each pose, as far as poses err against each other.

    The inverse of the Hessian is the covariance of all poses (Kaess and Dellaert 2009). Poses are
    drawn of it by the Hessian's factors, and each draw is moved onto the map by one rigid motion:
    how the whole map lies in the world is no error of it.

    Parameters
    ----------
    factors : scipy.sparse.linalg.SuperLU
        Of the Hessian (n * d, n * d), symmetric and positive definite, of steps in the scans'
        frames: x, y and turn about z, d = 3, or shift and turn, d = 6.
    world_from_scan : (n, 4, 4) float64

    Returns
    -------
    (n, 3, 3) float64
        Of x, y and heading in the world: metres and radians.
    """
    n_scans = len(world_from_scan)
    white = np.random.default_rng(0).standard_normal((factors.shape[0], _N_DRAWS))
    # H = P L D L' P', so that P inv(L') D^-1/2 is a root of its inverse; the factors hold D L'
    upper = factors.U
    root = np.sqrt(upper.diagonal())[:, None]
    step = spsolve_triangular(upper, root * white, lower=False)[factors.perm_c]
    step = step.reshape(n_scans, -1, _N_DRAWS)
    if step.shape[1] == len(PLANAR_DIMENSIONS):
        shift = world_from_scan[:, :2, :2] @ step[:, :2]
        turn = step[:, 2]
    else:
        shift = world_from_scan[:, :2, :3] @ step[:, :3]
        turn = (world_from_scan[:, 2:3, :3] @ step[:, 3:])[:, 0]
    from_middle_m = world_from_scan[:, :2, 3] - world_from_scan[:, :2, 3].mean(axis=0)
    of_map = np.zeros((n_scans, 2, 3))
    of_map[:, 0, 0] = of_map[:, 1, 1] = 1
    of_map[:, :, 2] = from_middle_m[:, ::-1] * [-1, 1]
    of_map = of_map.reshape(-1, 3)
    motion = np.linalg.lstsq(of_map, shift.reshape(-1, _N_DRAWS))[0]
    shift = shift - (of_map @ motion).reshape(shift.shape)
    error = np.concatenate([shift, (turn - motion[2])[:, None]], axis=1)
    return np.asarray(error @ error.transpose(0, 2, 1) / _N_DRAWS)
