"""Lines through points in the plane, also among outliers.

A line is its unit normal n and offset d: all p with n . p = d.
"""

import numpy as np

from scanplan.geometry.lines import least_scatter_normal
from scanplan.types import BoolArray, FloatArray, IntArray

_REFITS = 3  # each brings fewer new points near than the last
_MAX_SCORED = 1000  # points that rank the drawn lines nearly as all would, in a bounded time


def fit_line_tls(xy_m: FloatArray, weight: FloatArray | None = None) -> tuple[FloatArray, float]:
    """Fit a line by total least squares: the least squared distances perpendicular to it.

    Parameters
    ----------
    xy_m : (n, 2) float, n >= 2, not all the same
    weight : (n,) float, optional
        As how many points each counts.

    Returns
    -------
    normal : (2,) float64
        Unit vector; offset is not negative.
    offset_m : float

    Raises
    ------
    ValueError
        If fewer than two distinct points are given.
    """
    xy_m = np.asarray(xy_m, float)
    if not _has_distinct(xy_m):
        raise ValueError("a line needs two distinct points")
    weight = np.ones(len(xy_m)) if weight is None else np.asarray(weight, float)
    centre_m = weight @ xy_m / weight.sum()
    (xx, xy), (_, yy) = (weight[:, None] * (xy_m - centre_m)).T @ (xy_m - centre_m)
    return _face_outward(least_scatter_normal(xx, xy, yy), centre_m)


def fit_line_ransac(
    xy_m: FloatArray,
    *,
    inlier_m: float,
    trials: int,
    rng: np.random.Generator,
    weight: FloatArray | None = None,
) -> tuple[FloatArray, float, BoolArray]:
    """Find the line most points lie on, then fit it to these by least squares.

    Thesis, algorithm 4. All pairs are drawn beforehand, so that the result depends on the points
    and the generator's state alone; ties go to the pair drawn first. Clouds of more than 1,000
    points are scored on 1,000 of them.

    Parameters
    ----------
    xy_m : (n, 2) float
    inlier_m : float
        Largest distance of an inlier from the line.
    weight : (n,) float, optional
        As how many points each counts.

    Returns
    -------
    normal : (2,) float64
    offset_m : float
    inliers : (n,) bool
        None of them where there are no two distinct points; `normal` and `offset_m` are then NaN.
    """
    xy_m = np.asarray(xy_m, float).reshape(-1, 2)
    pairs = _draw_pairs(len(xy_m), trials, rng)
    weight = np.ones(len(xy_m)) if weight is None else np.asarray(weight, float)
    scored = _draw_scored(len(xy_m), rng)
    start_m = xy_m[pairs[:, 0]]
    step_m = xy_m[pairs[:, 1]] - start_m
    length_m = np.linalg.norm(step_m, axis=1)
    apart = length_m > 0
    if not apart.any():
        return np.full(2, np.nan), np.nan, np.zeros(len(xy_m), bool)
    start_m, step_m, length_m = start_m[apart], step_m[apart], length_m[apart]
    normals = np.column_stack([-step_m[:, 1], step_m[:, 0]]) / length_m[:, None]
    distance_m = np.abs(normals @ xy_m[scored].T - (normals * start_m).sum(axis=1)[:, None])
    best = np.argmax((distance_m <= inlier_m) @ weight[scored])
    line = _face_outward(normals[best], start_m[best])
    return refit_line(xy_m, *line, inlier_m=inlier_m, weight=weight)


def _draw_pairs(n: int, trials: int, rng: np.random.Generator) -> IntArray:
    """Draw `trials` pairs of different indices below n; none if n < 2."""
    if n < 2:
        return np.empty((0, 2), np.int64)
    first = rng.integers(0, n, trials)
    return np.column_stack([first, (first + rng.integers(1, n, trials)) % n])


def _draw_scored(n: int, rng: np.random.Generator) -> IntArray | slice:
    """Draw the points that lines are scored on: all, or a thousand where there are more."""
    return slice(None) if n <= _MAX_SCORED else rng.choice(n, _MAX_SCORED, replace=False)


def refit_line(
    xy_m: FloatArray,
    normal: FloatArray,
    offset_m: float,
    *,
    inlier_m: float,
    weight: FloatArray | None = None,
) -> tuple[FloatArray, float, BoolArray]:
    """Fit a line to the points near it, as long as that brings more points near.

    Parameters
    ----------
    xy_m : (n, 2) float
    normal, offset_m
        A line. While there are no two distinct points within `inlier_m` of it, it stays as it is.
    weight : (n,) float, optional

    Returns
    -------
    normal, offset_m, inliers : as `fit_line_ransac` returns them
    """
    weight = np.ones(len(xy_m)) if weight is None else weight
    inliers = np.abs(xy_m @ normal - offset_m) <= inlier_m
    for _ in range(_REFITS):
        if not _has_distinct(xy_m[inliers]):
            break
        normal, offset_m = fit_line_tls(xy_m[inliers], weight[inliers])
        again = np.abs(xy_m @ normal - offset_m) <= inlier_m
        if weight[again].sum() <= weight[inliers].sum():
            break
        inliers = again
    return normal, offset_m, inliers


def _has_distinct(xy_m: FloatArray) -> bool:
    """Return whether points (n, 2) are not all the same."""
    return len(xy_m) > 1 and bool((xy_m != xy_m[0]).any())


def _face_outward(normal: FloatArray, point_m: FloatArray) -> tuple[FloatArray, float]:
    """Return the normal and the offset of a line through a point, the offset not negative."""
    offset_m = float(normal @ point_m)
    return (-normal, -offset_m) if offset_m < 0 else (normal, offset_m)
