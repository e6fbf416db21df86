"""Straight lines through points in the plane. A line is its unit normal n and offset d: all p with n . p = d."""

import numpy as np

_REFITS = 3
_MAX_SCORED = 1000


def fit_line_tls(xy_m, weight=None):
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
    if not _distinct(xy_m):
        raise ValueError("a line needs two distinct points")
    weight = np.ones(len(xy_m)) if weight is None else np.asarray(weight, float)
    centre = weight @ xy_m / weight.sum()
    (xx, xy), (_, yy) = (weight[:, None] * (xy_m - centre)).T @ (xy_m - centre)
    # the direction of largest variance of a 2 x 2 covariance, in closed form
    direction_rad = 0.5 * np.arctan2(2 * xy, xx - yy)
    return _outward(np.array([-np.sin(direction_rad), np.cos(direction_rad)]), centre)


def fit_line_ransac(xy_m, *, inlier_m, trials, rng, weight=None):
    """Find the line most points lie on (thesis, algorithm 4), then fit it to these by least squares.

    All pairs are drawn beforehand, so that the result depends on the points and the generator's state alone; ties go to
    the pair drawn first. Clouds of more than 1,000 points are scored on 1,000 of them.

    Parameters
    ----------
    xy_m : (n, 2) float
    inlier_m : float
        Largest distance of an inlier from the line.
    trials : int
    rng : numpy.random.Generator
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
    pairs = _pairs(len(xy_m), trials, rng)
    weight = np.ones(len(xy_m)) if weight is None else np.asarray(weight, float)
    chosen = (
        slice(None)
        if len(xy_m) <= _MAX_SCORED
        else rng.choice(len(xy_m), _MAX_SCORED, replace=False)
    )
    start, step = xy_m[pairs[:, 0]], xy_m[pairs[:, 1]] - xy_m[pairs[:, 0]]
    length = np.linalg.norm(step, axis=1)
    start, step, length = start[length > 0], step[length > 0], length[length > 0]
    if len(length) == 0:
        return np.full(2, np.nan), np.nan, np.zeros(len(xy_m), bool)
    normals = np.column_stack([-step[:, 1], step[:, 0]]) / length[:, None]
    distance = np.abs(normals @ xy_m[chosen].T - (normals * start).sum(axis=1)[:, None])
    best = np.argmax((distance <= inlier_m) @ weight[chosen])
    return refit_line(xy_m, *_outward(normals[best], start[best]), inlier_m=inlier_m, weight=weight)


def _pairs(n, trials, rng):
    """Draw `trials` pairs of different indices below n; none if n < 2."""
    if n < 2:
        return np.empty((0, 2), np.int64)
    first = rng.integers(0, n, trials)
    return np.column_stack([first, (first + rng.integers(1, n, trials)) % n])


def refit_line(xy_m, normal, offset_m, *, inlier_m, weight=None):
    """Fit a line to the points near it, as long as that brings more points near.

    Parameters
    ----------
    xy_m : (n, 2) float
    normal, offset_m
        A line. While there are no two distinct points within `inlier_m` of it, it stays as it is.
    inlier_m : float
    weight : (n,) float, optional

    Returns
    -------
    normal, offset_m, inliers : as `fit_line_ransac` returns them
    """
    weight = np.ones(len(xy_m)) if weight is None else weight
    inliers = np.abs(xy_m @ normal - offset_m) <= inlier_m
    for _ in range(_REFITS):
        if not _distinct(xy_m[inliers]):
            break
        normal, offset_m = fit_line_tls(xy_m[inliers], weight[inliers])
        again = np.abs(xy_m @ normal - offset_m) <= inlier_m
        if weight[again].sum() <= weight[inliers].sum():
            break
        inliers = again
    return normal, offset_m, inliers


def _distinct(xy_m):
    """Whether points (n, 2) are not all the same."""
    return len(xy_m) > 1 and bool((xy_m != xy_m[0]).any())


def _outward(normal, point):
    offset_m = float(normal @ point)
    return (-normal, -offset_m) if offset_m < 0 else (normal, offset_m)
