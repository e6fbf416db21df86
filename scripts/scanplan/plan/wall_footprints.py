"""Wall footprints: polygons that are mitred at corners and butt at junctions, as draughtsmen do."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.plan.tolerances import END_M
from scanplan.types import Array, FloatArray

_MIN_SINE = 0.17  # walls that turn by less than 10 degrees run on, they make no corner
_MITRE_LIMIT = 3.0  # of a corner's distance in widths: sharper ones (below 20 degrees) are cut off

Corners = dict[int, list[FloatArray]]
"""Points (2,) at each end of a wall by its number, from its right to its left side."""


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

    place_m: FloatArray
    way: FloatArray
    left_m: FloatArray
    right_m: FloatArray

    @property
    def width_m(self) -> FloatArray:
        """Thickness of the wall at each end, (2n,)."""
        return self.left_m + self.right_m


@dataclass(frozen=True)
class _Joints:
    """Where walls meet.

    Attributes
    ----------
    corners : list of list of int
        Numbers of ends that meet each other.
    stops : list of (end, wall)
        Ends that butt at the side of a wall.
    """

    corners: list[list[int]]
    stops: list[tuple[int, int]]


def draw_footprints(lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray) -> Array:
    """Return the footprint of each wall.

    Walls whose ends meet are mitred: their surfaces are drawn on to where they cross those of the
    next wall around the corner. A wall that ends at the side of another stops at its surface. Walls
    that cross overlap.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
        First and second end of each wall's line; no two are the same point.
    left_m, right_m : (n,) float, >= 0
        How far its surfaces lie from the line on the left and on the right of the way from the
        first end to the second; not both 0.

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
    left_m = np.asarray(left_m, float).reshape(-1)
    right_m = np.asarray(right_m, float).reshape(-1)
    ends = _ends(lines_m, left_m, right_m)
    corners: Corners = {e: _square(ends, e, ends.place_m[e]) for e in range(len(ends.place_m))}
    joints = _find_joints(lines_m, np.maximum(left_m, right_m))
    for end, wall in joints.stops:
        corners[end] = _butt(ends, end, 2 * wall, corners[end])
    for meeting in joints.corners:
        corners.update(_mitre(ends, meeting))
    return np.array([_polygon(corners, ends, wall) for wall in range(len(lines_m))], object)


def _ends(lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray) -> _Ends:
    along_m = lines_m[:, 1] - lines_m[:, 0]
    length_m = np.hypot(*along_m.T)
    if not (length_m > 0).all() or not (left_m + right_m > 0).all():
        raise ValueError("a wall has no length or no thickness")
    way = along_m / length_m[:, None]
    return _Ends(
        place_m=lines_m.reshape(-1, 2),
        way=np.stack([way, -way], axis=1).reshape(-1, 2),
        left_m=np.stack([left_m, right_m], axis=1).ravel(),
        right_m=np.stack([right_m, left_m], axis=1).ravel(),
    )


def _left_of(way: FloatArray) -> FloatArray:
    return np.array([-way[1], way[0]])


def _square(ends: _Ends, e: int, place_m: FloatArray) -> list[FloatArray]:
    """Return the right and the left corner of an end that is cut off square at a place."""
    left = _left_of(ends.way[e])
    return [place_m - ends.right_m[e] * left, place_m + ends.left_m[e] * left]


def _find_joints(lines_m: FloatArray, half_m: FloatArray) -> _Joints:
    ends_m = lines_m.reshape(-1, 2)
    end, wall = _near_walls(lines_m, half_m)
    reach_m = half_m[end // 2] + half_m[wall] + END_M
    to_ends_m = np.hypot(*np.moveaxis(lines_m[wall] - ends_m[end][:, None], 2, 0))
    nearest = to_ends_m.argmin(axis=1)
    is_corner = to_ends_m[np.arange(len(end)), nearest] <= reach_m
    first = end[is_corner]
    second = 2 * wall[is_corner] + nearest[is_corner]
    at_corner = np.unique(np.concatenate([first, second]))
    is_stop = ~is_corner & ~np.isin(end, at_corner)
    stops = list(zip(end[is_stop].tolist(), wall[is_stop].tolist(), strict=True))
    return _Joints(_group_ends(first, second, at_corner, len(ends_m)), stops)


def _near_walls(lines_m: FloatArray, half_m: FloatArray) -> tuple[Array, Array]:
    """Return pairs (k,), (k,) of the number of an end and of another wall that it is near to."""
    points = np.asarray(shapely.points(lines_m.reshape(-1, 2)), object)
    lines = np.asarray(shapely.linestrings(lines_m), object)
    farthest_m = half_m.repeat(2) + half_m.max(initial=0) + END_M
    end, wall = shapely.STRtree(lines).query(points, predicate="dwithin", distance=farthest_m)
    apart_m = shapely.distance(points[end], lines[wall])
    is_near = apart_m <= half_m[end // 2] + half_m[wall] + END_M
    keep = is_near & (end // 2 != wall)
    return end[keep], wall[keep]


def _group_ends(first: Array, second: Array, at_corner: Array, n_ends: int) -> list[list[int]]:
    """Return the groups of ends that meet, directly or through one another, in order."""
    # ends are few: scipy's connected components would take longer to import
    label = np.arange(n_ends)
    for one, other in zip(first, second, strict=True):
        low, high = sorted((label[one], label[other]))
        label[label == high] = low
    group_of = label[at_corner]
    return [at_corner[group_of == group].tolist() for group in np.unique(group_of)]


def _butt(ends: _Ends, e: int, other: int, square: list[FloatArray]) -> list[FloatArray]:
    """Return the corners of an end that stops at the surface of another wall.

    They stay as they were if it runs along that wall.
    """
    way = ends.way[other]
    if abs(_cross(ends.way[e], way)) < _MIN_SINE:
        return square
    is_from_left = _cross(way, ends.way[e]) > 0
    side_m = ends.left_m[other] if is_from_left else -ends.right_m[other]
    surface_m = ends.place_m[other] + _left_of(way) * side_m
    return [_crossing(corner_m, ends.way[e], surface_m, way) for corner_m in square]


def _mitre(ends: _Ends, meeting: list[int]) -> Corners:
    """Return the corners of ends that meet.

    Every wall's left surface goes to where it crosses the right one of the next wall around.
    """
    is_junction = len(meeting) > 2
    centre_m = ends.place_m[meeting].mean(axis=0)
    if is_junction:
        centre_m = np.mean([_foot(ends, e, centre_m) for e in meeting], axis=0)
    around = sorted(meeting, key=lambda e: (np.arctan2(*ends.way[e][::-1]), e))
    corners = {e: _square(ends, e, _foot(ends, e, centre_m)) for e in around}
    for e, following in zip(around, around[1:] + around[:1], strict=True):
        if abs(_cross(ends.way[e], ends.way[following])) < _MIN_SINE:
            continue
        met_m = _crossing(corners[e][-1], ends.way[e], corners[following][0], ends.way[following])
        widest_m = max(ends.width_m[e], ends.width_m[following])
        if np.hypot(*(met_m - centre_m)) <= _MITRE_LIMIT * widest_m + END_M:
            corners[e][-1] = met_m
            corners[following][0] = met_m
    if is_junction:
        return {e: [right_m, centre_m, left_m] for e, (right_m, left_m) in corners.items()}
    return corners


def _foot(ends: _Ends, e: int, place_m: FloatArray) -> FloatArray:
    """Return the point of an end's line that is nearest to a place."""
    return ends.place_m[e] + ends.way[e] * ((place_m - ends.place_m[e]) @ ends.way[e])


def _cross(a: FloatArray, b: FloatArray) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _crossing(a_m: FloatArray, way_a: FloatArray, b_m: FloatArray, way_b: FloatArray) -> FloatArray:
    """Return where two lines cross, each through a point along a way; they are not parallel."""
    return a_m + way_a * (_cross(b_m - a_m, way_b) / _cross(way_a, way_b))


def _polygon(corners: Corners, ends: _Ends, wall: int) -> Polygon:
    """Return a wall's polygon; cut off square where its corners have turned it inside out."""
    first = 2 * wall
    second = first + 1
    ring = _ring(corners[first], corners[second])
    if not ring.is_valid or ring.area == 0:
        ring = _ring(*(_square(ends, e, ends.place_m[e]) for e in (first, second)))
    return shapely.orient_polygons(ring)


def _ring(first: list[FloatArray], second: list[FloatArray]) -> Polygon:
    return Polygon([*first, *second][::-1])
