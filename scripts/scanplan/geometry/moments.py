"""How groups of points spread: moments, and the direction in which each group spreads least."""

from collections.abc import Mapping

import numpy as np

from scanplan.geometry.lines import least_scatter_normal
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import FloatArray, IntArray

FEWEST = {2: 4, 3: 6}
"""Fewest points, by dimension, of a group whose least direction is taken for a normal."""

# smallest over middle variance above which a group is no surface; a 90 degree edge has 0.25
_ROUGH = 0.2

_Covariances = Mapping[tuple[int, int], FloatArray]
_Spread = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


def group_moments(points: FloatArray, group: IntArray, n_groups: int) -> FloatArray:
    """Return per group the count, the sums and the sums of products of coordinates.

    Parameters
    ----------
    points : (n, d) float
    group : (n,) int
        Of each point, below `n_groups`.

    Returns
    -------
    (1 + d + d (d + 1) / 2, n_groups) float64

    Examples
    --------
    >>> group_moments(np.array([[1.0], [3.0], [5.0]]), np.array([0, 0, 1]), 2).tolist()
    [[2.0, 1.0], [4.0, 5.0], [10.0, 25.0]]
    """
    axes = list(points.T)
    products = [axes[i] * axes[j] for i in range(len(axes)) for j in range(i, len(axes))]
    columns = [None, *axes, *products]
    return np.stack([np.bincount(group, c, n_groups) for c in columns]).astype(float)


def means_and_covariances(
    sums: FloatArray,
) -> tuple[FloatArray, dict[tuple[int, int], FloatArray]]:
    """Return the means (d, m) of groups, and the covariances (m,) of axes i and j, i <= j."""
    d = 2 if len(sums) == 6 else 3
    count = np.maximum(sums[0], 1)
    mean = sums[1 : 1 + d] / count
    pairs = [(i, j) for i in range(d) for j in range(i, d)]
    return mean, {
        (i, j): products / count - mean[i] * mean[j]
        for (i, j), products in zip(pairs, sums[1 + d :], strict=True)
    }


def least_variance_direction(sums: FloatArray) -> FloatArray:
    """Return the direction (d, m) of least variance of each group, NaN where it is not clear."""
    d = 2 if len(sums) == 6 else 3
    _, covariance = means_and_covariances(sums)
    least, middle, largest, axis = (_spread_2d if d == 2 else _spread_3d)(covariance)
    enough = sums[0] >= FEWEST[d]
    # a group whose points are on a line has no normal
    clear = enough & (least < _ROUGH * middle) & (middle > ROUNDING * largest)
    return np.where(clear, axis, np.nan)


def _spread_2d(c: _Covariances) -> _Spread:
    """Return the eigenvalues of 2 x 2 matrices (the largest twice) and the axis of the least."""
    half = (c[0, 0] + c[1, 1]) / 2
    away = np.hypot((c[0, 0] - c[1, 1]) / 2, c[0, 1])
    axis = least_scatter_normal(c[0, 0], c[0, 1], c[1, 1])
    return half - away, half + away, half + away, axis


def _spread_3d(c: _Covariances) -> _Spread:
    """Return the eigenvalues of symmetric 3 x 3 matrices, rising, and the axis of the least.

    In closed form, an eighth of the time of `numpy.linalg.eigh`. O. K. Smith: Eigenvalues of a
    symmetric 3 x 3 matrix, Communications of the ACM 4 (1961).
    """
    xy, xz, yz = c[0, 1], c[0, 2], c[1, 2]
    centre = (c[0, 0] + c[1, 1] + c[2, 2]) / 3
    xx, yy, zz = c[0, 0] - centre, c[1, 1] - centre, c[2, 2] - centre
    scale = np.sqrt((xx**2 + yy**2 + zz**2 + 2 * (xy**2 + xz**2 + yz**2)) / 6)
    # points at one place have no scale
    scale = np.maximum(scale, np.finfo(float).eps)
    determinant = xx * (yy * zz - yz**2) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    angle = np.arccos(np.clip(determinant / scale**3 / 2, -1, 1)) / 3
    largest, least = 2 * scale * np.cos(angle), 2 * scale * np.cos(angle + 2 * np.pi / 3)
    # the axis is perpendicular to every row of the matrix less its eigenvalue; the longest product
    # is the safest
    rows = [(xx - least, xy, xz), (xy, yy - least, yz), (xz, yz, zz - least)]
    crosses = np.stack(
        [_cross(rows[0], rows[1]), _cross(rows[0], rows[2]), _cross(rows[1], rows[2])]
    )
    length = np.sqrt((crosses**2).sum(axis=1))
    best = np.argmax(length, axis=0)
    each = np.arange(len(best))
    axis = crosses[best, :, each].T / np.maximum(length[best, each], np.finfo(float).tiny)
    return centre + least, centre - least - largest, centre + largest, axis


_Row = tuple[FloatArray, FloatArray, FloatArray]


def _cross(a: _Row, b: _Row) -> FloatArray:
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
