"""How thick the walls of a merged map are: what is left of registration errors where nobody knows the truth.

A surface that several scans saw should be one surface. In neighbourhoods of the map that hold
points of several scans the spread across the surface is the root of the least eigenvalue of the
points' covariance: the range noise, where the scans lie on each other, and more, where they do not.
The median over places all over the map is the crispness. Corners and clutter have large spreads
whatever the poses, which the median bears as long as surfaces are the larger part.

Droeschel and Behnke, "Efficient continuous-time SLAM for 3D lidar-based online mapping", ICRA 2018,
call the mean of it mean plane variance; Razlaw et al., "Evaluation of registration methods for
sparse 3D laser scans", ECMR 2015.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

_FEWEST_POINTS = 10
_FEWEST_SCANS = 3


@dataclass(frozen=True)
class SurfaceScatter:
    """Neighbourhoods of a map.

    Attributes
    ----------
    xyz_m : (n, 3) float64
        A point of the map in the middle of each.
    sigma_m : (n,) float64
        Standard deviation of its points across the surface; NaN where fewer than 10 points, or
        points of fewer than 3 scans, are there.
    """

    xyz_m: np.ndarray
    sigma_m: np.ndarray

    @property
    def median_m(self):
        """The crispness of the map, NaN if there is no place to tell it by."""
        known = self.sigma_m[np.isfinite(self.sigma_m)]
        return float(np.median(known)) if len(known) else np.nan


def thin_randomly(scans, *, most_points, n_scans, seed):
    """Take a random share of every scan.

    Parameters
    ----------
    scans : iterable of (int, (n, 3) float)
        scan_id and points in the map frame; read one at a time.
    most_points : int
        Of all scans together.
    n_scans : int, >= 1
        How many there are.
    seed : int

    Returns
    -------
    xyz_m : (m, 3) float64
    scan_ids : (m,) int64
        Which scan each point is of.
    """
    share, points, owners = max(1, most_points // n_scans), [], []
    for scan_id, xyz_m in scans:
        chosen = np.arange(len(xyz_m))
        if len(xyz_m) > share:
            chosen = np.sort(
                np.random.default_rng([seed, scan_id]).choice(len(xyz_m), share, replace=False)
            )
        points.append(np.asarray(xyz_m, float)[chosen])
        owners.append(np.full(len(chosen), scan_id))
    return np.concatenate(points), np.concatenate(owners)


def choose_places(xyz_m, *, planar, radius_m, most_places, seed):
    """Choose places evenly over a map: a point of every occupied cube (square, in the plane) of edge `radius_m`.

    Parameters
    ----------
    xyz_m : (n, 3) float64, n >= 1
    planar : bool
    radius_m : float
    most_places : int
        A random choice of as many is made where there are more.
    seed : int

    Returns
    -------
    (m, 3) float64
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(xyz_m))
    cell = np.floor(xyz_m[order, : 2 if planar else 3] / radius_m).astype(np.int64)
    _, first = np.unique(cell, axis=0, return_index=True)
    if len(first) > most_places:
        first = rng.choice(first, most_places, replace=False)
    return xyz_m[order[np.sort(first)]]


def measure_scatter(xyz_m, scan_ids, centres_m, *, planar, radius_m):
    """Measure the spread across the surface around some places.

    Parameters
    ----------
    xyz_m : (n, 3) float64
        The map.
    scan_ids : (n,) int
        Which scan each point is of.
    centres_m : (m, 3) float64
    planar : bool
        Whether surfaces are lines in x, y.
    radius_m : float

    Returns
    -------
    Places
    """
    axes = slice(2) if planar else slice(3)
    near = cKDTree(xyz_m[:, axes]).query_ball_point(centres_m[:, axes], radius_m)
    sigma_m = [_sigma(xyz_m[found, axes], scan_ids[found]) for found in near]
    return SurfaceScatter(np.asarray(centres_m, float), np.array(sigma_m, float))


def measure_map_scatter(xyz_m, scan_ids, *, planar, radius_m, most_places, seed):
    """Choose places (`choose_places`) in a map and measure the spread around them (`measure_scatter`)."""
    centres_m = choose_places(
        xyz_m, planar=planar, radius_m=radius_m, most_places=most_places, seed=seed
    )
    return measure_scatter(xyz_m, scan_ids, centres_m, planar=planar, radius_m=radius_m)


def scatter_columns(measured):
    """Return the columns of `schemas.CRISPNESS` from Places by the name of the poses that made the map."""
    names = sorted(measured)
    known = [measured[name].sigma_m[np.isfinite(measured[name].sigma_m)] for name in names]
    shares = [
        np.percentile(sigma_m, (25, 50, 75)) if len(sigma_m) else [np.nan] * 3 for sigma_m in known
    ]
    quarter, median, three_quarters = np.transpose(shares)
    return {
        "poses": names,
        "sigma_m": median,
        "quarter_below_m": quarter,
        "quarter_above_m": three_quarters,
        "n_places": [len(sigma_m) for sigma_m in known],
    }


def _sigma(points_m, scan_ids):
    if len(points_m) < _FEWEST_POINTS or len(np.unique(scan_ids)) < _FEWEST_SCANS:
        return np.nan
    centred = points_m - points_m.mean(axis=0)
    least = np.linalg.eigvalsh(centred.T @ centred / (len(points_m) - 1))[0]
    return float(np.sqrt(max(least, 0.0)))
