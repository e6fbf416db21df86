"""Iterative closest point in the plane: point to line (Chen and Medioni 1992 in 2-D) with a robust (Cauchy) weight."""

import numpy as np

_NEIGHBOURS = 6
_PAIR_SIGMA_M = 0.045
_LEAST_SHARE = 1e-3
_PLANAR = np.array([0, 1, 5])


def align_planar(source, target, start, _method, distance_m, max_iterations, step_done):
    """Refine a motion in the plane; see `icp.align_clouds`.

    Returns
    -------
    motion : (4, 4) float64
    information : (6, 6) float64 or None
        Of x, y and the turn about z, zero elsewhere; None without pairs.
    """
    motion, information = np.array(start, float), None
    reach_m = np.sqrt(2 * np.mean(source.xyz_m[:, :2] ** 2))
    for _ in range(max_iterations):
        equations = _normal_equations(source.xyz_m[:, :2], target, motion, distance_m)
        if equations is None:
            return start, None
        information, gradient = equations
        step = _solve(information, gradient, reach_m)
        motion = motion @ _motion(step)
        if np.abs(step).max() < step_done:
            break
    return motion, _in_space(information)


def planar_normals(xy_m, tree, *, reach_m):
    """Return unit normals (n, 2) from the nearest neighbours; NaN where they are too few, too far or form no line.

    Parameters
    ----------
    xy_m : (n, 2) float
    tree : scipy.spatial.cKDTree
        Over them.
    reach_m : float
        A point whose neighbours lie farther away has no normal.
    """
    neighbours = min(_NEIGHBOURS, len(xy_m))
    if neighbours < 3:
        return np.full((len(xy_m), 2), np.nan)
    distance, index = tree.query(xy_m, k=neighbours)
    offset = xy_m[index] - xy_m[index].mean(axis=1, keepdims=True)
    value, vector = np.linalg.eigh(np.einsum("nki,nkj->nij", offset, offset))
    line = (distance[:, -1] < reach_m) & (value[:, 0] < 0.1 * value[:, 1])
    return np.where(line[:, None], vector[:, :, 0], np.nan)


def _normal_equations(source_xy, target, motion, distance_m):
    """Information and gradient of the point-to-line error for a step (dx, dy, turn) in the source's frame."""
    moved = source_xy @ motion[:2, :2].T + motion[:2, 3]
    distance, nearest = target.tree.query(moved, distance_upper_bound=distance_m)
    pairs = np.flatnonzero(np.isfinite(distance))
    pairs = pairs[np.isfinite(target.normal[nearest[pairs], 0])]
    if len(pairs) < 3:
        return None
    normal, point = target.normal[nearest[pairs]], source_xy[pairs]
    residual = np.einsum("ij,ij->i", normal, moved[pairs] - target.xyz_m[nearest[pairs], :2])
    seen = normal @ motion[:2, :2]
    jacobian = np.column_stack([seen, seen[:, 1] * point[:, 0] - seen[:, 0] * point[:, 1]])
    # a scale taken from the residuals alone would trust the wall that fits best and let all others slide
    scale = max(1.4826 * np.median(np.abs(residual)), distance_m / 10)
    weighted = jacobian.T / (1 + (residual / scale) ** 2)
    return weighted @ jacobian, weighted @ residual


def _solve(information, gradient, reach_m):
    """Solve for the step; directions that the pairs say next to nothing about stay as they are."""
    scale = np.array([1, 1, 1 / max(reach_m, 1e-3)])
    value, vector = np.linalg.eigh(information * np.outer(scale, scale))
    known = value > _LEAST_SHARE * value[-1]
    return -scale * (vector[:, known] @ ((vector[:, known].T @ (scale * gradient)) / value[known]))


def _motion(step):
    cos, sin = np.cos(step[2]), np.sin(step[2])
    motion = np.eye(4)
    motion[:2, :2] = [[cos, -sin], [sin, cos]]
    motion[:2, 3] = step[:2]
    return motion


def _in_space(information):
    result = np.zeros((6, 6))
    result[np.ix_(_PLANAR, _PLANAR)] = information / _PAIR_SIGMA_M**2
    return result
