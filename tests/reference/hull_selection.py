"""The thesis's algorithms 1 and 2, written as they are printed.

Slow, and easy to check against the page.
"""

import shapely
from sklearn.cluster import KMeans

TIE_M2 = 1e-6


def cluster_and_hull(scans, n_clusters, seed=0):
    """Algorithm 2: the convex hulls of every scan's clusters; KMeans sees all points.

    The tests need the optimum and not a local one, hence the ten starts.
    """
    all_hulls = []
    for xy_m in scans:
        label = KMeans(n_clusters, n_init=10, random_state=seed).fit_predict(xy_m)
        all_hulls.append(
            [shapely.MultiPoint(xy_m[label == c]).convex_hull for c in range(n_clusters)]
        )
    return all_hulls


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
