"""What a scan covers on the floor plan: one convex hull per cluster of its points.

Thesis 3.3.2, algorithm 2.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from scipy.cluster import vq

from scanplan.geometry.tolerances import SAME_M, SMALLEST_M2
from scanplan.store import schemas
from scanplan.types import Array, Columns, FloatArray, IntArray

_LLOYD_ITERATIONS = 20  # centres move by less than the sample's noise after that
_MOST_CLUSTERS = np.iinfo(np.int16).max  # labels are sorted as 16-bit numbers
_MANY_POINTS = 50  # with fewer, dropping inner points takes longer than the hull of all


def make_cluster_hulls(
    scan_id: int, xyz_m: Array, *, n_clusters: int, sample_size: int, seed: int
) -> dict[str, Array]:
    """Cluster one scan's points in plan view and draw one convex hull round each cluster.

    Thesis, algorithm 2. KMeans runs on a random sample of the points; then every point joins its
    nearest centre. The sample depends on `seed` and `scan_id` alone. A cluster of fewer than three
    points, or of points on one line, stays as the Point or LineString it is, with area 0: the
    convex hull of all rows is exactly that of all points.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 2) or (n, 3) float, n >= 1
        Map coordinates, z up; z is not looked at.
    n_clusters : int, 1 to 32,767
        Number of clusters. A sample with fewer distinct points makes one cluster of each.
    sample_size : int, >= 1
        Number of points that KMeans sees; all of them if the scan has fewer.
    seed : int, >= 0

    Returns
    -------
    dict of str to (m,) numpy.ndarray, 1 <= m <= `n_clusters`
        The scan's rows of `schemas.HULLS`.

    Raises
    ------
    ValueError
        If there are no points, a coordinate is not finite, or a number of clusters or points is out
        of its range.
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
    centres = _find_centres(sample - middle_m, n_clusters, rng)
    label, n_points = _assign_clusters(xy_m - middle_m, centres)
    hulls = _convex_hulls(xy_m, label, len(n_points))
    return {
        "scan_id": np.full(len(hulls), scan_id, np.int32),
        "cluster": np.arange(len(hulls), dtype=np.int32),
        "n_points": n_points.astype(np.int32),
        "area_m2": shapely.area(hulls),
        "geometry": shapely.to_wkb(hulls, byte_order=1),
    }


def concatenate_hulls(parts: Sequence[Columns]) -> dict[str, Array]:
    """Join the rows of several scans, in their order, to the columns of one table of hulls."""
    return {name: np.concatenate([part[name] for part in parts]) for name in schemas.HULLS.columns}


def scan_polygons(columns: Columns) -> tuple[IntArray, Array]:
    """Return each scan's polygon: the union of the hulls of its clusters.

    Parameters
    ----------
    columns : dict of str to (n,) numpy.ndarray
        `scan_id` (sorted) and `geometry` (WKB) of a table of hulls.

    Returns
    -------
    scan_ids : (m,) int, increasing
    polygons : (m,) numpy.ndarray of shapely Polygon or MultiPolygon
        Empty for a scan of degenerate clusters only.
    """
    scan_ids, groups = _split_by_scan(columns)
    unions = [shapely.union_all(hulls[shapely.get_dimensions(hulls) == 2]) for hulls in groups]
    with_area = [union if union.area > 0 else shapely.Polygon() for union in unions]
    return scan_ids, np.array(with_area, object)


def scan_full_hulls(columns: Columns) -> tuple[IntArray, Array]:
    """Return each scan's one convex hull, the thesis's baseline; see `scan_polygons`."""
    scan_ids, groups = _split_by_scan(columns)
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


def _find_centres(sample: FloatArray, n_clusters: int, rng: np.random.Generator) -> FloatArray:
    """Return the centres of KMeans of the sample (k, 2); its distinct points if these suffice."""
    rounded = SAME_M * np.round(sample / SAME_M)
    # to compare points by x is quick, and nearly always enough
    if len(np.unique(rounded[:, 0])) <= n_clusters:
        distinct = np.unique(rounded, axis=0)
        if len(distinct) <= n_clusters:
            return distinct
    return _move_to_means(sample, _spread_centres(sample, n_clusters, rng))


def _move_to_means(sample: FloatArray, centres: FloatArray) -> FloatArray:
    """Iterate after Lloyd until nothing changes; a centre that loses all its points stays."""
    nearest = None
    for _ in range(_LLOYD_ITERATIONS):
        before = nearest
        nearest, _ = vq.vq(sample, centres, check_finite=False)
        if before is not None and np.array_equal(nearest, before):
            break
        n_points = np.bincount(nearest, minlength=len(centres))
        sums = np.column_stack(
            [np.bincount(nearest, axis, minlength=len(centres)) for axis in sample.T]
        )
        centres = np.where(n_points[:, None] > 0, sums / np.maximum(n_points, 1)[:, None], centres)
    return centres


def _spread_centres(sample: FloatArray, n_clusters: int, rng: np.random.Generator) -> FloatArray:
    """Draw first centres far from each other: k-means++ with several candidates a step.

    Each centre is drawn with probability proportional to the squared distance to those already
    drawn; of a few such candidates the one that leaves the least distance is taken (Arthur and
    Vassilvitskii 2007, sections 2.2 and 7).
    """
    n_candidates = 2 + int(np.log(n_clusters))
    chosen = [int(rng.integers(len(sample)))]
    left = _squared_distance(sample, sample[chosen])[0]
    while len(chosen) < n_clusters:
        cumulative = np.cumsum(left)
        drawn = np.searchsorted(cumulative, rng.random(n_candidates) * cumulative[-1], side="right")
        drawn = np.minimum(drawn, len(sample) - 1)
        left_by = np.minimum(left, _squared_distance(sample, sample[drawn]))
        best = int(left_by.sum(axis=1).argmin())
        chosen.append(int(drawn[best]))
        left = left_by[best]
    return sample[chosen]


def _squared_distance(xy_m: FloatArray, to_m: FloatArray) -> FloatArray:
    """Return squared distances (m, n) of points (n, 2) to points (m, 2)."""
    return (xy_m[:, 0] - to_m[:, :1]) ** 2 + (xy_m[:, 1] - to_m[:, 1:]) ** 2


def _assign_clusters(xy_m: FloatArray, centres: FloatArray) -> tuple[IntArray, IntArray]:
    """Return each point's nearest centre, numbered without gaps, and how many points each has."""
    # neither a matrix product nor threads: the same labels for any core count
    nearest, _ = vq.vq(xy_m, centres, check_finite=False)
    n_points = np.bincount(nearest, minlength=len(centres))
    return (np.cumsum(n_points > 0) - 1)[nearest], n_points[n_points > 0]


def _convex_hulls(xy_m: FloatArray, label: IntArray, n_clusters: int) -> Array:
    """Return one convex hull per label, of the line through its outer points."""
    # sorting 16-bit numbers is linear; a line is much faster made than a MultiPoint
    by_label = np.argsort(label.astype(np.int16), kind="stable")
    start = np.cumsum(np.bincount(label + 1, minlength=n_clusters + 1))
    clusters = [_outer(xy_m.take(by_label[a:b], axis=0)) for a, b in pairwise(start)]
    indices = np.repeat(np.arange(n_clusters), [len(points) for points in clusters])
    lines = shapely.linestrings(np.concatenate(clusters), indices=indices)
    return np.asarray(shapely.normalize(shapely.convex_hull(lines)))


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


def _split_by_scan(columns: Columns) -> tuple[IntArray, list[Array]]:
    """Return the scans (m,) and the geometries of each."""
    scan_ids, start = np.unique(columns["scan_id"], return_index=True)
    return scan_ids, np.split(shapely.from_wkb(columns["geometry"]), start)[1:]
