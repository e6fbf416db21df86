"""The ground that walls stand on: polygons that meet at corners and junctions as a draughtsman draws them."""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

_REACH_M = 0.12
_MIN_SINE = 0.17  # walls that turn less than 10 degrees from each other run on, they make no corner
_MITRE_LIMIT = 3.0


@dataclass(frozen=True)
class _Ends:
    """The 2n ends of walls: number e of wall w is 2 w + e; seen from the end, into its wall.

    Attributes
    ----------
    place_m : (2n, 2) float64
    way : (2n, 2) float64
        Unit vectors into the wall.
    left_m, right_m : (2n,) float64
        How far the surfaces lie from the line, on both sides of the way.
    """

    place_m: np.ndarray
    way: np.ndarray
    left_m: np.ndarray
    right_m: np.ndarray


def draw_footprints(lines_m, left_m, right_m):
    """Return the ground that each wall stands on.

    Walls whose ends meet are mitred: their surfaces are drawn on to where they cross those of the next wall around the
    corner. A wall that ends at the side of another stops at its surface. Walls that cross overlap.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
        First and second end of each wall's line; no two are the same point.
    left_m, right_m : (n,) float, >= 0
        How far its surfaces lie from the line on the left and on the right of the way from the first end to the
        second; not both 0.

    Returns
    -------
    (n,) object
        shapely Polygons, counter-clockwise.

    Raises
    ------
    ValueError
        If a wall has no length or no thickness.
    """
    lines_m = np.asarray(lines_m, float).reshape(-1, 2, 2)
    left_m, right_m = (np.asarray(side_m, float).reshape(-1) for side_m in (left_m, right_m))
    ends = _ends(lines_m, left_m, right_m)
    corners_m = _flat(ends)
    beside = _beside(lines_m, np.maximum(left_m, right_m))
    for end, wall in beside["stops"]:
        corners_m[end] = _stopped(ends, end, 2 * wall, corners_m[end])
    for meeting in beside["corners"]:
        corners_m.update(_mitred(ends, meeting))
    return np.array([_polygon(corners_m, ends, wall) for wall in range(len(lines_m))], object)


def _ends(lines_m, left_m, right_m):
    length_m = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)
    if not (length_m > 0).all() or not (left_m + right_m > 0).all():
        raise ValueError("a wall has no length or no thickness")
    way = (lines_m[:, 1] - lines_m[:, 0]) / length_m[:, None]
    return _Ends(
        place_m=lines_m.reshape(-1, 2),
        way=np.stack([way, -way], axis=1).reshape(-1, 2),
        left_m=np.stack([left_m, right_m], axis=1).ravel(),
        right_m=np.stack([right_m, left_m], axis=1).ravel(),
    )


def _left_of(way):
    return np.array([-way[1], way[0]])


def _flat(ends):
    """Return the right, no middle and the left corner of every end, cut off square."""
    return {e: _square(ends, e, ends.place_m[e]) for e in range(len(ends.place_m))}


def _square(ends, e, place_m):
    left = _left_of(ends.way[e])
    return [place_m - ends.right_m[e] * left, place_m + ends.left_m[e] * left]


def _beside(lines_m, half_m):
    """Return which ends meet in corners (lists of ends), and which end stops at the side of which wall."""
    ends_m = shapely.points(lines_m.reshape(-1, 2))
    tree = shapely.STRtree(shapely.linestrings(lines_m))
    end, wall = tree.query(
        ends_m, predicate="dwithin", distance=half_m.repeat(2) + half_m.max(initial=0) + _REACH_M
    )
    near_m = shapely.distance(ends_m[end], tree.geometries[wall])
    keep = (end // 2 != wall) & (near_m <= half_m[end // 2] + half_m[wall] + _REACH_M)
    end, wall = end[keep], wall[keep]
    to_ends_m = np.hypot(*np.moveaxis(lines_m[wall] - lines_m.reshape(-1, 2)[end][:, None], 2, 0))
    nearest = to_ends_m.argmin(axis=1)
    at_corner = (
        to_ends_m[np.arange(len(end)), nearest] <= half_m[end // 2] + half_m[wall] + _REACH_M
    )
    first, second = end[at_corner], 2 * wall[at_corner] + nearest[at_corner]
    links = coo_matrix((np.ones(len(first)), (first, second)), shape=(len(ends_m),) * 2)
    label = connected_components(links, directed=False)[1]
    met = np.unique(np.concatenate([first, second]))
    corners = [met[label[met] == group].tolist() for group in np.unique(label[met])]
    loose = ~at_corner & ~np.isin(end, met)
    return {
        "corners": corners,
        "stops": list(zip(end[loose].tolist(), wall[loose].tolist(), strict=True)),
    }


def _stopped(ends, e, other, flat):
    """Return the corners of an end that stops at the surface of another wall; as they were if it runs along it."""
    way = ends.way[other]
    if abs(_cross(ends.way[e], way)) < _MIN_SINE:
        return flat
    from_left = _cross(way, ends.way[e]) > 0
    surface_m = ends.place_m[other] + _left_of(way) * (
        ends.left_m[other] if from_left else -ends.right_m[other]
    )
    return [_crossing(corner_m, ends.way[e], surface_m, way) for corner_m in flat]


def _mitred(ends, meeting):
    """Return the corners of ends that meet: every wall's left surface goes to the right one of the next around."""
    centre_m = ends.place_m[meeting].mean(axis=0)
    centre_m = (
        np.mean([_foot(ends, e, centre_m) for e in meeting], axis=0)
        if len(meeting) > 2
        else centre_m
    )
    around = sorted(meeting, key=lambda e: (np.arctan2(*ends.way[e][::-1]), e))
    corners = {e: _square(ends, e, _foot(ends, e, centre_m)) for e in around}
    for e, following in zip(around, around[1:] + around[:1], strict=True):
        if abs(_cross(ends.way[e], ends.way[following])) < _MIN_SINE:
            continue
        met_m = _crossing(corners[e][-1], ends.way[e], corners[following][0], ends.way[following])
        widest_m = max(
            ends.left_m[e] + ends.right_m[e], ends.left_m[following] + ends.right_m[following]
        )
        if np.hypot(*(met_m - centre_m)) <= _MITRE_LIMIT * widest_m + _REACH_M:
            corners[e][-1] = corners[following][0] = met_m
    if len(meeting) > 2:
        corners = {e: [right_m, centre_m, left_m] for e, (right_m, left_m) in corners.items()}
    return corners


def _foot(ends, e, place_m):
    return ends.place_m[e] + ends.way[e] * ((place_m - ends.place_m[e]) @ ends.way[e])


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def _crossing(a_m, way_a, b_m, way_b):
    """Return where two lines cross, each through a point along a way; they must not be parallel."""
    return a_m + way_a * (_cross(b_m - a_m, way_b) / _cross(way_a, way_b))


def _polygon(corners_m, ends, wall):
    """Return a wall's polygon; where its corners have turned it inside out, it is cut off square."""
    ring = shapely.Polygon([*corners_m[2 * wall], *corners_m[2 * wall + 1]][::-1])
    if not ring.is_valid or ring.area == 0:
        flat = [_square(ends, e, ends.place_m[e]) for e in (2 * wall, 2 * wall + 1)]
        ring = shapely.Polygon([*flat[0], *flat[1]][::-1])
    return shapely.orient_polygons(ring)
