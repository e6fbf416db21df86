"""The thesis's algorithms 1 and 2, written as they are printed.

Slow, and easy to check against the page.
"""

import numpy as np
import shapely
from sklearn.cluster import KMeans

TIE_M2 = 1e-6


def cluster_and_hull(scans, n_clusters, radius="least_distance", seed=0):
    """Algorithm 2: the convex hulls of every scan's clusters; KMeans sees all points.

    The tests need the optimum and not a local one, hence the ten starts.
    """
    all_hulls = []
    for xy_m in scans:
        centres = KMeans(n_clusters, n_init=10, random_state=seed).fit(xy_m).cluster_centers_
        clusters = select_points(xy_m, centres, radius)
        all_hulls.append([shapely.MultiPoint(cluster).convex_hull for cluster in clusters])
    return all_hulls


def select_points(xy_m, centres, radius):
    """Section 3.3.2: the points around each centre, by the minimum distance between all centres."""
    apart = {
        (i, j): np.linalg.norm(a - b)
        for i, a in enumerate(centres)
        for j, b in enumerate(centres)
        if i != j
    }
    clusters = [[] for _ in centres]
    for p in xy_m:
        own = min(range(len(centres)), key=lambda i: np.linalg.norm(p - centres[i]))
        if radius == "least_distance":
            reach = min(apart.values())
        elif radius == "nearest_centre":
            reach = min(apart[own, j] for j in range(len(centres)) if j != own)
        else:
            reach = np.inf
        if np.linalg.norm(p - centres[own]) <= reach:
            clusters[own].append(p)
    return clusters


def hull_selection(polygons, k=None):
    """Algorithm 1: order polygons, each the one whose union with those before it is largest.

    All, or the first k.

    The page leaves ties to the order of its loop and to rounding. Here those whose union is within
    `TIE_M2` of the largest are equal, and the first of them is taken. The first polygon is no
    special case: the union is empty then.
    """
    order, covered_m2 = [], []
    union = shapely.Polygon()
    remaining = list(range(len(polygons)))
    for _ in range(len(polygons) if k is None else k):
        potential_area = {j: union.union(polygons[j]).area for j in remaining}
        largest = max(potential_area.values())
        index = next(j for j in remaining if potential_area[j] >= largest - TIE_M2)
        order.append(index)
        remaining.remove(index)
        union = union.union(polygons[index])
        covered_m2.append(union.area)
    return order, covered_m2
