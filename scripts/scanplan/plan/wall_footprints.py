"""Wall footprints: polygons that are mitred at corners and butt at junctions, as draughtsmen do."""

from collections.abc import Iterator
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
    direction : (2n, 2) float64
        Unit vectors into the wall.
    left_m, right_m : (2n,) float64
        How far the surfaces lie from the line, on both sides of the way.
    """

    place_m: FloatArray
    direction: FloatArray
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
    crossings : list of (end, end)
        Ends that run on beyond where their walls cross.
    stops : list of (end, wall)
        Ends that butt at the side of a wall.
    """

    corners: list[list[int]]
    crossings: list[tuple[int, int]]
    stops: list[tuple[int, int]]


def draw_footprints(lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray) -> Array:
    """Return the footprint of each wall.

    Walls whose ends meet are mitred: their surfaces are drawn on to where they cross those of the
    next wall around the corner. A wall that ends at the side of another stops at its surface. Walls
    that cross near their ends are mitred there, others that cross overlap.

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
    corners = find_corners(lines_m, left_m, right_m)
    n_walls = len(corners) // 2
    rings = [_ring(corners[2 * wall], corners[2 * wall + 1]) for wall in range(n_walls)]
    return np.array([shapely.orient_polygons(ring) for ring in rings], object)


def cut_sides(
    lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the left and the right side (n, 2, 2) of each wall, first end first.

    They end where the wall does, or before it in the corners of its footprint: what runs on beyond
    a wall that it meets is left out. `draw_footprints` has the parameters.
    """
    corners = find_corners(lines_m, left_m, right_m)
    ends = _ends(*_as_walls(lines_m, left_m, right_m))
    sides: list[list[FloatArray]] = [[], []]
    for e in range(len(corners)):
        square = _square(ends, e, ends.place_m[e])
        # seen from its end, the sides of a wall are the other way round at the second one
        for side, at in zip(sides, (-1, 0) if e % 2 == 0 else (0, -1), strict=True):
            inward_m = max((corners[e][at] - square[at]) @ ends.direction[e], 0.0)
            side.append(square[at] + inward_m * ends.direction[e])
    left, right = (np.array(side).reshape(-1, 2, 2) for side in sides)
    return left, right


def _as_walls(
    lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    left_m, right_m = (np.asarray(side_m, float).reshape(-1) for side_m in (left_m, right_m))
    return np.asarray(lines_m, float).reshape(-1, 2, 2), left_m, right_m


def find_corners(lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray) -> Corners:
    """Return the corners of all ends; square ones where others turn a wall inside out."""
    lines_m, left_m, right_m = _as_walls(lines_m, left_m, right_m)
    ends = _ends(lines_m, left_m, right_m)
    corners: Corners = {e: _square(ends, e, ends.place_m[e]) for e in range(len(ends.place_m))}
    joints = _find_joints(lines_m, np.maximum(left_m, right_m))
    for end, wall in joints.stops:
        corners[end] = _butt(ends, end, 2 * wall, corners[end])
    for meeting in joints.corners:
        corners.update(_mitre(ends, meeting, ends.place_m[meeting].mean(axis=0)))
    for e, other in joints.crossings:
        places_m, directions = ends.place_m[[e, other]], ends.direction[[e, other]]
        corners.update(
            _mitre(
                ends, [e, other], _crossing(places_m[0], directions[0], places_m[1], directions[1])
            )
        )
    for first in range(0, len(corners), 2):
        ring = _ring(corners[first], corners[first + 1])
        if not ring.is_valid or ring.area == 0:
            corners.update({e: _square(ends, e, ends.place_m[e]) for e in (first, first + 1)})
    return corners


def _ends(lines_m: FloatArray, left_m: FloatArray, right_m: FloatArray) -> _Ends:
    along_m = lines_m[:, 1] - lines_m[:, 0]
    length_m = np.hypot(*along_m.T)
    if not (length_m > 0).all() or not (left_m + right_m > 0).all():
        raise ValueError("a wall has no length or no thickness")
    direction = along_m / length_m[:, None]
    return _Ends(
        place_m=lines_m.reshape(-1, 2),
        direction=np.stack([direction, -direction], axis=1).reshape(-1, 2),
        left_m=np.stack([left_m, right_m], axis=1).ravel(),
        right_m=np.stack([right_m, left_m], axis=1).ravel(),
    )


def _left_of(direction: FloatArray) -> FloatArray:
    return np.array([-direction[1], direction[0]])


def _square(ends: _Ends, e: int, place_m: FloatArray) -> list[FloatArray]:
    """Return the right and the left corner of an end that is cut off square at a place."""
    left = _left_of(ends.direction[e])
    return [place_m - ends.right_m[e] * left, place_m + ends.left_m[e] * left]


def _find_joints(lines_m: FloatArray, half_m: FloatArray) -> _Joints:
    ends_m = lines_m.reshape(-1, 2)
    end, wall = _near_walls(lines_m, half_m)
    reach_m = half_m[end // 2] + half_m[wall] + END_M
    to_ends_m = np.hypot(*np.moveaxis(lines_m[wall] - ends_m[end][:, None], 2, 0))
    nearest = to_ends_m.argmin(axis=1)
    apart_m = to_ends_m[np.arange(len(end)), nearest]
    # of a wall that is shorter than walls reach, one end is at the corner
    met_m = lines_m[wall, nearest]
    is_nearer = apart_m <= np.hypot(*(ends_m[end ^ 1] - met_m).T)
    is_corner = (apart_m <= reach_m) & is_nearer
    first = end[is_corner]
    second = 2 * wall[is_corner] + nearest[is_corner]
    at_corner = np.unique(np.concatenate([first, second]))
    # a wall that is near to another with both its ends lies along or across it
    is_both = np.isin((end ^ 1) + len(ends_m) * wall, end + len(ends_m) * wall)
    is_stop = ~is_corner & ~np.isin(end, at_corner) & ~is_both
    stops = list(zip(end[is_stop].tolist(), wall[is_stop].tolist(), strict=True))
    crossed = list(_cross_at_ends(lines_m, stops))
    in_crossing = {end for pair in crossed for end in pair}
    stops = [(end, wall) for end, wall in stops if end not in in_crossing]
    return _Joints(_group_ends(first, second, at_corner, len(ends_m)), crossed, stops)


def _cross_at_ends(lines_m: FloatArray, stops: list[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of ends that would stop at each other's wall though the walls cross.

    Walls that turn too little for a corner run on beside each other.
    """
    direction = lines_m[:, 1] - lines_m[:, 0]
    direction /= np.hypot(*direction.T)[:, None]
    stopping = set(stops)
    taken: set[int] = set()
    for end, wall in stops:
        others = [e for e in (2 * wall, 2 * wall + 1) if (e, end // 2) in stopping]
        is_free = taken.isdisjoint({end, *others})
        line, crossed = (shapely.LineString(lines_m[row]) for row in (end // 2, wall))
        is_turned = abs(_cross(direction[end // 2], direction[wall])) >= _MIN_SINE
        if others and is_free and is_turned and line.intersects(crossed):
            taken |= {end, others[0]}
            yield end, others[0]


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

    They stay as they were if it runs along that wall, or would have to be drawn on so far that it
    ends in a tip.
    """
    direction = ends.direction[other]
    if abs(_cross(ends.direction[e], direction)) < _MIN_SINE:
        return square
    is_from_left = _cross(direction, ends.direction[e]) > 0
    side_m = ends.left_m[other] if is_from_left else -ends.right_m[other]
    surface_m = ends.place_m[other] + _left_of(direction) * side_m
    met_m = [_crossing(corner_m, ends.direction[e], surface_m, direction) for corner_m in square]
    beyond_m = np.max((np.array(square) - met_m) @ ends.direction[e])
    return met_m if beyond_m <= _MITRE_LIMIT * ends.width_m[e] + END_M else square


def _mitre(ends: _Ends, meeting: list[int], centre_m: FloatArray) -> Corners:
    """Return the corners of ends that meet at a place.

    Every wall's left surface goes to where it crosses the right one of the next wall around.
    """
    is_junction = len(meeting) > 2
    if is_junction:
        centre_m = np.mean([_foot(ends, e, centre_m) for e in meeting], axis=0)
    around = sorted(meeting, key=lambda e: (np.arctan2(*ends.direction[e][::-1]), e))
    corners = {e: _square(ends, e, _foot(ends, e, centre_m)) for e in around}
    for e, following in zip(around, around[1:] + around[:1], strict=True):
        if abs(_cross(ends.direction[e], ends.direction[following])) < _MIN_SINE:
            continue
        met_m = _crossing(
            corners[e][-1], ends.direction[e], corners[following][0], ends.direction[following]
        )
        widest_m = max(ends.width_m[e], ends.width_m[following])
        if np.hypot(*(met_m - centre_m)) <= _MITRE_LIMIT * widest_m + END_M:
            corners[e][-1] = met_m
            corners[following][0] = met_m
    if is_junction:
        return {e: [right_m, centre_m, left_m] for e, (right_m, left_m) in corners.items()}
    return corners


def _foot(ends: _Ends, e: int, place_m: FloatArray) -> FloatArray:
    """Return the point of an end's line that is nearest to a place."""
    return ends.place_m[e] + ends.direction[e] * ((place_m - ends.place_m[e]) @ ends.direction[e])


def _cross(a: FloatArray, b: FloatArray) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _crossing(a_m: FloatArray, way_a: FloatArray, b_m: FloatArray, way_b: FloatArray) -> FloatArray:
    """Return where two lines cross, each through a point along a way; they are not parallel."""
    return a_m + way_a * (_cross(b_m - a_m, way_b) / _cross(way_a, way_b))


def _ring(first: list[FloatArray], second: list[FloatArray]) -> Polygon:
    return Polygon([*first, *second][::-1])
