"""Covered area of a scan: one convex hull per cluster of its points.

Thesis 3.3.2, algorithm 2.
"""

from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M, SMALLEST_M2
from scanplan.store import schemas
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

OUTLIERS = -1
"""The cluster of points that are in none, as scikit-learn numbers it."""
RADII = ("least_distance", "nearest_centre", "none")
"""How far a cluster reaches: to the least distance of any two centres, to that of its own centre
from the nearest other one, or without end."""

_MOST_CLUSTERS = np.iinfo(np.int16).max  # labels are sorted as 16-bit numbers
_MANY_POINTS = 50  # with fewer, dropping inner points takes longer than the hull of all


def make_cluster_hulls(
    scan_id: int, xyz_m: Array, *, n_clusters: int, sample_size: int, radius: str, seed: int
) -> dict[str, Array]:
    """Cluster one scan's points in plan view and draw one convex hull round each cluster.

    Thesis, algorithm 2 and 3.3.2. KMeans runs on a random sample of the points; then every point
    joins its nearest centre, if that is within the radius; the others are outliers. The sample
    depends on `seed` and `scan_id` alone. A cluster of fewer than three points, or of points on one
    line, stays as the Point or LineString it is, with area 0: the convex hull of all rows is
    exactly that of all points.

    Parameters
    ----------
    xyz_m : (n, 2) or (n, 3) float, n >= 1
        Map coordinates, z up; z is not looked at.
    n_clusters : int, 1 to 32,767
        Number of clusters. A sample with fewer distinct points makes one cluster of each.
    sample_size : int, >= 1
        Number of points that KMeans sees; all of them if the scan has fewer.
    radius : str
        One of `RADII`. The thesis: "points around each cluster are selected, based on the minimum
        distance between all the cluster centers".
    seed : int, >= 0

    Returns
    -------
    dict of str to (m,) numpy.ndarray, 1 <= m <= `n_clusters` + 1
        The scan's rows of `schemas.HULLS`; that of its outliers, if any, is of cluster `OUTLIERS`.

    Raises
    ------
    ValueError
        If there are no points, a coordinate is not finite, the radius is not known, or a number of
        clusters or points is out of its range.
    """
    xy_m = _plan_view(xyz_m)
    if not 1 <= n_clusters <= _MOST_CLUSTERS or sample_size < 1:
        raise ValueError(
            f"n_clusters {n_clusters} must be 1 to {_MOST_CLUSTERS}, sample_size {sample_size} at"
            " least 1"
        )
    rng = np.random.default_rng([seed, scan_id])
    n_sampled = min(sample_size, len(xy_m))
    sample = xy_m[rng.choice(len(xy_m), n_sampled, replace=False, shuffle=False)]
    # relative to the mean, squared distances keep their digits far from the map's origin
    middle_m = sample.mean(axis=0)
    centres = _find_centres(sample - middle_m, n_clusters, int(rng.integers(2**31)))
    label = _assign_clusters(xy_m - middle_m, centres, _reach_m(centres, radius))
    cluster, hulls = _convex_hulls(xy_m, label)
    return {
        "scan_id": np.full(len(hulls), scan_id, np.int32),
        "cluster": cluster,
        "n_points": np.bincount(label - OUTLIERS)[cluster - OUTLIERS].astype(np.int32),
        "area_m2": shapely.area(hulls),
        "geometry": shapely.to_wkb(hulls, byte_order=1),
    }


def concatenate_hulls(parts: Sequence[Columns]) -> dict[str, Array]:
    """Join the rows of several scans, in their order, to the columns of one table of hulls."""
    return {name: np.concatenate([part[name] for part in parts]) for name in schemas.HULLS.columns}


def scan_polygons(columns: Columns) -> tuple[IntArray, Array]:
    """Return each scan's polygon: the union of the hulls of its clusters, without its outliers.

    Parameters
    ----------
    columns : dict of str to (n,) numpy.ndarray
        `scan_id` (sorted), `cluster` and `geometry` (WKB) of a table of hulls.

    Returns
    -------
    scan_ids : (m,) int, increasing
    polygons : (m,) numpy.ndarray of shapely Polygon or MultiPolygon
        Empty for a scan of degenerate clusters only.
    """
    scan_ids, groups = _split_by_scan(columns, columns["cluster"] != OUTLIERS)
    unions = [overlays.unite_areas(hulls[shapely.get_dimensions(hulls) == 2]) for hulls in groups]
    with_area = [union if union.area > 0 else shapely.Polygon() for union in unions]
    return scan_ids, np.array(with_area, object)


def scan_full_hulls(columns: Columns) -> tuple[IntArray, Array]:
    """Return each scan's one convex hull of all its points, the thesis's baseline.

    See `scan_polygons`.
    """
    scan_ids, groups = _split_by_scan(columns, np.ones(len(columns["cluster"]), bool))
    hulls = shapely.convex_hull(
        np.array([shapely.geometrycollections(hulls) for hulls in groups], object)
    )
    hulls[shapely.get_dimensions(hulls) != 2] = shapely.Polygon()
    return scan_ids, hulls


def _plan_view(xyz_m: Array) -> FloatArray:
    xyz_m = np.asarray(xyz_m)
    if xyz_m.ndim != 2 or xyz_m.shape[0] < 1 or xyz_m.shape[1] not in (2, 3):
        raise ValueError(f"a scan must be (n, 2) or (n, 3) with n >= 1, not {xyz_m.shape}")
    xy_m = np.ascontiguousarray(xyz_m[:, :2], float)
    if not np.isfinite(xy_m).all():
        raise ValueError("a scan's x and y must be finite")
    return xy_m


def _find_centres(sample: FloatArray, n_clusters: int, seed: int) -> FloatArray:
    """Return the centres of KMeans of the sample (k, 2); its distinct points if these suffice."""
    rounded = SAME_M * np.round(sample / SAME_M)
    # to compare points by x is quick, and nearly always enough
    if len(np.unique(rounded[:, 0])) <= n_clusters:
        distinct = np.unique(rounded, axis=0)
        if len(distinct) <= n_clusters:
            return distinct
    make_kmeans, threads = _load_kmeans()
    # sums that threads share out differ in their last digits
    with threads.limit(limits=1):
        found = make_kmeans(n_clusters, n_init=1, random_state=seed).fit(sample)
    return SAME_M * np.round(found.cluster_centers_ / SAME_M)


@cache
def _load_kmeans() -> tuple[Any, Any]:
    """Return scikit-learn's KMeans, and what limits the threads of its libraries."""
    # takes a second: only processes that cluster pay for it
    from sklearn.cluster import KMeans
    from threadpoolctl import ThreadpoolController

    # looks all loaded libraries up, which takes longer than a scan's clusters
    return KMeans, ThreadpoolController()


def _reach_m(centres: FloatArray, radius: str) -> FloatArray:
    """Return how far the cluster of each centre (k,) reaches; without end if there is no other."""
    if radius not in RADII:
        raise ValueError(f"radius {radius} must be one of {', '.join(RADII)}")
    if radius == "none" or len(centres) < 2:
        return np.full(len(centres), np.inf)
    from scipy.spatial import distance  # 0.3 s, and only processes that cluster need it

    apart_m = distance.squareform(distance.pdist(centres))
    np.fill_diagonal(apart_m, np.inf)
    nearest_m = apart_m.min(axis=0)
    return np.full(len(centres), nearest_m.min()) if radius == "least_distance" else nearest_m


def _assign_clusters(xy_m: FloatArray, centres: FloatArray, reach_m: FloatArray) -> IntArray:
    """Return each point's nearest centre, numbered without gaps, or `OUTLIERS`."""
    from scipy.cluster import vq  # 0.3 s, and only processes that cluster need it

    # neither a matrix product nor threads: the same labels for any core count
    nearest, distance_m = vq.vq(xy_m, centres, check_finite=False)
    is_in = distance_m <= reach_m[nearest]
    has_points = np.bincount(nearest[is_in], minlength=len(centres)) > 0
    return np.where(is_in, (np.cumsum(has_points) - 1)[nearest], OUTLIERS)


def _convex_hulls(xy_m: FloatArray, label: IntArray) -> tuple[IntArray, Array]:
    """Return the labels (m,) that occur, rising, and the convex hull of the points of each."""
    n_points = np.bincount(label - OUTLIERS)
    (occurring,) = np.nonzero(n_points)
    # sorting 16-bit numbers is linear; a line is much faster made than a MultiPoint
    by_label = np.argsort(label.astype(np.int16), kind="stable")
    start = np.concatenate([[0], np.cumsum(n_points[occurring])])
    clusters = [_outer(xy_m.take(by_label[a:b], axis=0)) for a, b in pairwise(start)]
    indices = np.repeat(np.arange(len(clusters)), [len(points) for points in clusters])
    lines = shapely.linestrings(np.concatenate(clusters), indices=indices)
    hulls = np.asarray(shapely.normalize(shapely.convex_hull(lines)))
    return (occurring + OUTLIERS).astype(np.int32), hulls


def _outer(xy_m: FloatArray) -> FloatArray:
    """Return the points (n, 2) that may be corners of their convex hull, at least 2.

    Those well inside the quadrilateral of the diagonal extremes are left out: none of these is a
    corner of the convex hull (Akl and Toussaint 1978, "A fast convex hull algorithm"); of walls
    seen from a room few others are left.
    """
    if len(xy_m) < _MANY_POINTS:
        # a line needs two points
        return np.concatenate([xy_m, xy_m[:1]])
    x_m, y_m = np.ascontiguousarray(xy_m.T)
    rising_m = x_m + y_m
    falling_m = y_m - x_m
    extremes = [rising_m.argmax(), falling_m.argmax(), rising_m.argmin(), falling_m.argmin()]
    corners = xy_m[extremes].tolist()
    inside_m2 = np.full(len(xy_m), np.inf)
    for (x0_m, y0_m), (x1_m, y1_m) in zip(corners, corners[1:] + corners[:1], strict=True):
        if (x0_m, y0_m) != (x1_m, y1_m):
            # twice the area of a point's triangle with this edge: above 0 on the inner side
            edge_m2 = (x1_m - x0_m) * (y_m - y0_m) - (y1_m - y0_m) * (x_m - x0_m)
            np.minimum(inside_m2, edge_m2, out=inside_m2)
    outer = inside_m2 <= SMALLEST_M2
    outer[0] = True
    return np.concatenate([xy_m[outer], xy_m[:1]])


def _split_by_scan(columns: Columns, is_taken: BoolArray) -> tuple[IntArray, list[Array]]:
    """Return the scans (m,), and of each the geometries of the rows (n,) that are taken."""
    scan_ids, start = np.unique(columns["scan_id"], return_index=True)
    shapes = shapely.from_wkb(columns["geometry"][is_taken])
    return scan_ids, np.split(shapes, np.concatenate([[0], np.cumsum(is_taken)])[start])[1:]
