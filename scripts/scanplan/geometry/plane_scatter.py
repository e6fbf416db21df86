"""Map thickness (plane scatter): what is left of registration errors without any truth.

A surface that several scans saw should be one surface. In neighbourhoods of the map that hold
points of several scans the spread across the surface is the root of the least eigenvalue of the
points' covariance: the range noise, where the scans lie on each other, and more, where they do not.
The median over places all over the map is the crispness. Corners and clutter have large spreads
whatever the poses, which the median bears as long as surfaces are the larger part.

Droeschel and Behnke, "Efficient continuous-time SLAM for 3D lidar-based online mapping", ICRA 2018,
call the mean of it mean plane variance; Razlaw et al., "Evaluation of registration methods for
sparse 3D laser scans", ECMR 2015.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue]  # compiled

from scanplan.types import FloatArray, IntArray

_RADIUS_M = 0.2  # well above what poses err, below what lies between surfaces
_MOST_PLACES = 2000  # evenly over the map: a bound on time
_FEWEST_POINTS = 10  # a covariance of fewer says little
_FEWEST_SCANS = 3  # two may be off together
_LEAST_SPREAD = 0.25  # of the radius; points all over a disc have half of it, a single ring's none


@dataclass(frozen=True)
class SurfaceScatter:
    """Neighbourhoods of a map.

    Attributes
    ----------
    xyz_m : (n, 3) float64
        A point of the map in the middle of each.
    sigma_m : (n,) float64
        Standard deviation of its points across the surface; NaN where fewer than 10 points, or
        points of fewer than 3 scans, are there, or they lie along a line in space, at a spot in
        the plane: far away a sensor's rings are wider apart than a neighbourhood, and how thin
        one ring is says nothing of the surface.
    """

    xyz_m: FloatArray
    sigma_m: FloatArray

    @property
    def median_m(self) -> float:
        """The thickness of the map, NaN if there is no place to measure it at."""
        known = self.sigma_m[np.isfinite(self.sigma_m)]
        return float(np.median(known)) if len(known) else np.nan


def thin_randomly(
    scans: Iterable[tuple[int, FloatArray]], *, most_points: int, n_scans: int, seed: int
) -> tuple[FloatArray, IntArray]:
    """Take a random share of every scan.

    Parameters
    ----------
    scans : iterable of (int, (n, 3) float)
        scan_id and points in the map frame; read one at a time.
    most_points : int
        Of all scans together.
    n_scans : int, >= 1
        How many there are.

    Returns
    -------
    xyz_m : (m, 3) float64
    scan_ids : (m,) int64
        Which scan each point is of.
    """
    share = max(1, most_points // n_scans)
    points, owners = [], []
    for scan_id, xyz_m in scans:
        chosen = np.arange(len(xyz_m))
        if len(xyz_m) > share:
            rng = np.random.default_rng([seed, scan_id])
            chosen = np.sort(rng.choice(len(xyz_m), share, replace=False))
        points.append(np.asarray(xyz_m[chosen], float))
        owners.append(np.full(len(chosen), scan_id))
    return np.concatenate(points), np.concatenate(owners)


def choose_places(
    xyz_m: FloatArray, *, planar: bool, radius_m: float, most_places: int, seed: int
) -> IntArray:
    """Choose places evenly over a map: a point of every occupied cube (square, in the plane).

    Parameters
    ----------
    xyz_m : (n, 3) float64, n >= 1
    radius_m : float
        Edge of a cube.
    most_places : int
        A random choice of as many is made where there are more.

    Returns
    -------
    (m,) int64
        Rows of these points.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(xyz_m))
    cell = np.floor(xyz_m[order, : 2 if planar else 3] / radius_m).astype(np.int64)
    cell -= cell.min(axis=0)
    # one number a cell sorts ten times as fast as three
    key = np.ravel_multi_index(tuple(cell.T), tuple(cell.max(axis=0) + 1))
    _, first = np.unique(key, return_index=True)
    if len(first) > most_places:
        first = rng.choice(first, most_places, replace=False)
    return order[np.sort(first)]


def measure_scatter(
    xyz_m: FloatArray,
    scan_ids: IntArray,
    centres_m: FloatArray,
    *,
    planar: bool,
    radius_m: float,
) -> SurfaceScatter:
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

    Returns
    -------
    SurfaceScatter
    """
    axes = slice(2) if planar else slice(3)
    centres_m = np.asarray(centres_m, float)
    # of so few neighbourhoods a tree that is made fast serves better than one that is searched fast
    tree = cKDTree(xyz_m[:, axes], balanced_tree=False, compact_nodes=False)
    near = tree.query_ball_point(centres_m[:, axes], radius_m)
    count = np.array([len(points) for points in near], np.int64)
    place = np.repeat(np.arange(len(near)), count)
    points = np.concatenate([np.empty(0, np.int64), *map(np.asarray, near)]).astype(np.int64)
    offset_m = xyz_m[points, axes] - centres_m[place, axes]
    across_m2, along_m2 = _variances(offset_m, place, count)
    is_known = (count >= _FEWEST_POINTS) & (along_m2 >= (_LEAST_SPREAD * radius_m) ** 2)
    is_known &= _count_owners(scan_ids[points], place, len(near)) >= _FEWEST_SCANS
    sigma_m = np.where(is_known, np.sqrt(np.maximum(across_m2, 0.0)), np.nan)
    return SurfaceScatter(centres_m, sigma_m)


def measure_map_scatter(
    xyz_m: FloatArray,
    scan_ids: IntArray,
    *,
    planar: bool,
    seed: int,
    radius_m: float = _RADIUS_M,
    most_places: int = _MOST_PLACES,
) -> SurfaceScatter:
    """Measure the spread (`measure_scatter`) around places of a map (`choose_places`)."""
    rows = choose_places(
        xyz_m, planar=planar, radius_m=radius_m, most_places=most_places, seed=seed
    )
    return measure_scatter(xyz_m, scan_ids, xyz_m[rows], planar=planar, radius_m=radius_m)


def scatter_columns(measured: Mapping[str, SurfaceScatter]) -> dict[str, Any]:
    """Return the columns of `schemas.CRISPNESS` of scatters by the name of the map's poses."""
    names = sorted(measured)
    all_sigma_m = [measured[name].sigma_m for name in names]
    finite_m = [sigma_m[np.isfinite(sigma_m)] for sigma_m in all_sigma_m]
    quarter, median, three_quarters = np.transpose([_quartiles(sigma_m) for sigma_m in finite_m])
    return {
        "poses": names,
        "sigma_m": median,
        "quarter_below_m": quarter,
        "quarter_above_m": three_quarters,
        "n_places": [len(sigma_m) for sigma_m in finite_m],
    }


def _quartiles(values: FloatArray) -> FloatArray:
    return np.percentile(values, (25, 50, 75)) if len(values) else np.full(3, np.nan)


def _variances(
    offset_m: FloatArray, place: IntArray, count: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return the least and the next variance of the points (n, d) of each place, (m,)."""
    centred_m = offset_m.copy()
    for axis in range(offset_m.shape[1]):
        sums = np.bincount(place, offset_m[:, axis], len(count))
        centred_m[:, axis] -= (sums / np.maximum(count, 1))[place]
    d = offset_m.shape[1]
    products = [
        np.bincount(place, centred_m[:, i] * centred_m[:, j], len(count))
        for i in range(d)
        for j in range(d)
    ]
    covariance = np.array(products).T.reshape(-1, d, d) / np.maximum(count - 1, 1)[:, None, None]
    variances = np.linalg.eigvalsh(covariance)
    return variances[:, 0], variances[:, 1]


def _count_owners(scan_ids: IntArray, place: IntArray, n_places: int) -> IntArray:
    """Return of how many scans the points of each place are."""
    _, owner = np.unique(scan_ids, return_inverse=True)
    n_owners = int(owner.max(initial=0)) + 1
    return np.bincount(np.unique(place * n_owners + owner) // n_owners, minlength=n_places)
