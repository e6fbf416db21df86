"""Surface normals of one scan, from neighbourhoods that grow with the distance to the sensor.

A spinning sensor's points are dense along a ring and sparse between rings: at 5 m and 2 degrees between beams, 0.02 m
against 0.17 m. The k nearest neighbours of a point then lie on its own ring and their plane is arbitrary. Spacing grows
with range in both directions, so a neighbourhood of constant angle, as seen from the sensor, spans the same few rings
at any range.
"""

import numpy as np
from scipy.spatial import cKDTree

_ROUGH = 0.2  # smallest over middle variance of a neighbourhood above which it is no surface; a 90 degree edge has 0.25
_MIN_NEIGHBOURS_3D = 6
_MIN_NEIGHBOURS_2D = 4
_MIN_RADIUS_2D_M = 0.08
_NEAREST_2D = 5
_NEAREST_REACH_2D = 3.0


def surface_normals(xyz_m, *, reach_deg):
    """Return the unit normals of a 3-D scan's surfaces, towards the sensor.

    The points are binned in (azimuth, z / r, ln r), r the horizontal range: cells of equal angle, about cubic in space.
    A cell's normal is the direction of least variance of the points in it and its 26 neighbours.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Points relative to the sensor, axes of the map (z up).
    reach_deg : float
        Half-width of a neighbourhood, as an angle seen from the sensor; at least one and a half times the angle
        between beams.

    Returns
    -------
    (n, 3) float64
        NaN where the surroundings are no surface: too few points, one ring alone, an edge, clutter.
    """
    xyz_m = np.asarray(xyz_m, float)
    if len(xyz_m) == 0:
        return np.empty((0, 3))
    cells, cell_of_point, turn = _cells(xyz_m, np.deg2rad(reach_deg) / 1.5)
    sums = _neighbourhood_sums(cells, _moments(xyz_m, cell_of_point, len(cells)), turn)
    normals = _least_variance(sums)[cell_of_point]
    return normals * -np.where((normals * xyz_m).sum(axis=1) > 0, 1, -1)[:, None]


def line_normals(xy_m, *, reach_deg):
    """Return the unit normals of a planar scan's outlines, towards the sensor.

    A point's neighbours are those within `reach_deg` (at least 8 cm), or its five nearest where these are not more than
    three times as far: where the outline is seen at a grazing angle, beams lie far apart.

    Parameters
    ----------
    xy_m : (n, 2) float
        Points relative to the sensor.
    reach_deg : float

    Returns
    -------
    (n, 2) float64, NaN where the surroundings are no line
    """
    xy_m = np.asarray(xy_m, float)
    if len(xy_m) < _MIN_NEIGHBOURS_2D:
        return np.full((len(xy_m), 2), np.nan)
    tree = cKDTree(xy_m)
    radius = np.maximum(_MIN_RADIUS_2D_M, np.deg2rad(reach_deg) * np.linalg.norm(xy_m, axis=1))
    nearest = tree.query(xy_m, k=[min(_NEAREST_2D + 1, len(xy_m))])[0][:, 0]
    radius = np.maximum(radius, np.minimum(nearest * (1 + 1e-9), _NEAREST_REACH_2D * radius))
    near = tree.query_ball_point(xy_m, radius, return_sorted=True)
    owner = np.repeat(np.arange(len(xy_m)), [len(n) for n in near])
    normals = _least_variance(_moments(xy_m[np.concatenate(near).astype(int)], owner, len(xy_m)))
    return normals * -np.where((normals * xy_m).sum(axis=1) > 0, 1, -1)[:, None]


def _cells(xyz_m, step):
    """Return the occupied cells (m, 3) int, each point's cell, and the number of cells of a full turn."""
    horizontal = np.maximum(np.hypot(xyz_m[:, 0], xyz_m[:, 1]), 1e-3)
    turn = max(3, round(2 * np.pi / step))
    azimuth = np.floor(np.arctan2(xyz_m[:, 1], xyz_m[:, 0]) / (2 * np.pi) * turn).astype(np.int64) % turn
    # the limits only concern points right above or below the sensor, which no wall has
    height = np.clip(np.floor(xyz_m[:, 2] / horizontal / step), -10_000, 10_000).astype(np.int64)
    distance = np.floor(np.log(horizontal) / step).astype(np.int64)
    lowest = np.array([0, height.min() - 1, distance.min() - 1])
    spans = height.max() - lowest[1] + 2, distance.max() - lowest[2] + 2
    key = (azimuth * spans[0] + height - lowest[1]) * spans[1] + distance - lowest[2]
    unique, cell_of_point = np.unique(key, return_inverse=True)
    rest, d = np.divmod(unique, spans[1])
    a, h = np.divmod(rest, spans[0])
    return np.column_stack([a, h, d]), cell_of_point, turn


def _moments(points, group, n_groups):
    """Return per group the count, the sums and the sums of products of coordinates, (n_groups, 1 + d + d * d)."""
    d = points.shape[1]
    products = (points[:, :, None] * points[:, None, :]).reshape(len(points), d * d)
    columns = [None, *points.T, *products.T]
    return np.column_stack([np.bincount(group, c, n_groups) for c in columns]).astype(float)


def _neighbourhood_sums(cells, moments, turn):
    """Add to each cell's moments those of its occupied neighbours; azimuth closes after a turn."""
    spans = cells.max(axis=0) + 2
    key = (cells[:, 0] * spans[1] + cells[:, 1]) * spans[2] + cells[:, 2]
    total = np.zeros_like(moments)
    for step in np.ndindex(3, 3, 3):
        a, h, d = (cells + step - 1).T
        wanted = (a % turn * spans[1] + h) * spans[2] + d
        at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
        found = key[at] == wanted
        total[found] += moments[at[found]]
    return total


def _least_variance(moments):
    """Return the direction of least variance of each group of points, NaN where it is not clearly the least."""
    d = 2 if moments.shape[1] == 7 else 3
    count, sums = moments[:, :1], moments[:, 1 : 1 + d]
    mean = sums / np.maximum(count, 1)
    covariance = moments[:, 1 + d :].reshape(-1, d, d) / np.maximum(count, 1)[:, :, None]
    covariance = covariance - mean[:, :, None] * mean[:, None, :]
    variances, axes = np.linalg.eigh(covariance)
    enough = count[:, 0] >= (_MIN_NEIGHBOURS_2D if d == 2 else _MIN_NEIGHBOURS_3D)
    clear = enough & (variances[:, 0] < _ROUGH * variances[:, 1])
    return np.where(clear[:, None], axes[:, :, 0], np.nan)
