"""Outlines of rooms that follow the walls they lie on."""

from itertools import pairwise

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.exports.drafting.moved_walls import ON_M, MovedWalls
from scanplan.geometry import overlays
from scanplan.plan.tolerances import END_M
from scanplan.types import BoolArray, FloatArray, IntArray

_ALONG_SINE = 0.05  # of 3 degrees: an edge that runs along a wall
_CORNER_SINE = 0.17  # of 10 degrees: edges that turn less go on, and do not cross
_STRAIGHT_M = 0.005
"""Off a straight line by less is noise of faces, and no more than a hair on paper."""
_LEAST_EDGE_M = 0.03  # a shorter one has no direction


def move_outline(outline: Polygon, moved: MovedWalls) -> Polygon:
    """Return a room's outline as its walls are now.

    Every edge that lay along a side of a wall does so again; a corner is where its two edges cross,
    or on the one of them that lies on a wall. What lies on no wall stays.
    """
    rings = [
        _move_ring(shapely.get_coordinates(ring), moved) for ring in shapely.get_rings(outline)
    ]
    shell, *holes = rings
    if len(shell) < 3:
        return outline
    shape = overlays.repair_areas(Polygon(shell, [hole for hole in holes if len(hole) >= 3]))
    parts = [part for part in shapely.get_parts(shape) if isinstance(part, Polygon)]
    return _straighten(max(parts, key=lambda part: part.area, default=outline))


def _straighten(outline: Polygon) -> Polygon:
    """Return an outline without corners at which it does not turn, the first of each ring too."""
    kept = overlays.simplify_shapes(outline, _STRAIGHT_M)
    turned = [_turn_ring(shapely.get_coordinates(ring)) for ring in shapely.get_rings(kept)]
    again = overlays.simplify_shapes(Polygon(turned[0], turned[1:]), _STRAIGHT_M)
    fewest = min(kept, again, key=shapely.get_num_coordinates)
    return fewest if isinstance(fewest, Polygon) and fewest.is_valid else outline


def _turn_ring(corners_m: FloatArray) -> FloatArray:
    """Return a ring that begins at another of its corners."""
    return np.concatenate([corners_m[1:], corners_m[1:2]])


def _move_ring(corners_m: FloatArray, moved: MovedWalls) -> list[FloatArray]:
    edges_m = np.array([*pairwise(corners_m)])
    hosts = np.array([_find_host(edge_m, moved) for edge_m in edges_m])
    is_kept = ~_find_between(hosts, np.hypot(*(edges_m[:, 1] - edges_m[:, 0]).T))
    edges_m, hosts = edges_m[is_kept], hosts[is_kept]
    lines_m = [
        moved.move_points(edge_m, host) if host >= 0 else edge_m
        for edge_m, host in zip(edges_m, hosts.tolist(), strict=True)
    ]
    points_m: list[FloatArray] = []
    for after in range(len(edges_m)):
        before = after - 1
        is_on = hosts[[before, after]] >= 0
        if is_on.all():
            points_m += _meet(lines_m[before], lines_m[after])
        else:
            points_m.append(lines_m[before][1] if is_on[0] else lines_m[after][0])
    return points_m


def _find_between(hosts: IntArray, lengths_m: FloatArray) -> BoolArray:
    """Return which edges (n,) lie on no wall, but between two that do, and are too short to show.

    All from the one to the other together: what is left of a corner, or of a joint of two walls.
    """
    is_between = np.zeros(len(hosts), bool)
    on = np.flatnonzero(hosts >= 0)
    for first, last in zip(on, np.roll(on, -1), strict=True):
        run = np.arange(first + 1, last + len(hosts) * (last <= first)) % len(hosts)
        is_between[run] = lengths_m[run].sum() <= END_M
    return is_between


def _find_host(edge_m: FloatArray, moved: MovedWalls) -> int:
    """Return the row of the wall that an edge runs along a side of, -1 of none."""
    walls = moved.before
    along_m = edge_m[1] - edge_m[0]
    length_m = np.hypot(*along_m)
    if length_m < _LEAST_EDGE_M:
        return -1
    direction = along_m / length_m
    sines = np.abs(walls.directions[:, 0] * direction[1] - walls.directions[:, 1] * direction[0])
    to_m = edge_m.mean(axis=0) - walls.lines_m[:, 0]
    across_m = to_m[:, 1] * walls.directions[:, 0] - to_m[:, 0] * walls.directions[:, 1]
    ahead_m = np.einsum("ij,ij->i", to_m, walls.directions)
    off_m = np.abs(np.abs(across_m) - walls.half_m)
    beyond_m = np.maximum(-ahead_m, ahead_m - walls.lengths_m)
    is_on = ~walls.is_bent & (sines <= _ALONG_SINE) & (off_m <= ON_M) & (beyond_m <= END_M)
    if not is_on.any():
        return -1
    # of collinear walls that which it is beside
    return int(np.argmin(np.where(is_on, np.round(off_m + np.maximum(beyond_m, 0), 6), np.inf)))


def _meet(before_m: FloatArray, after_m: FloatArray) -> list[FloatArray]:
    """Return the corner (2,) of two edges that lie on walls; two where they run on as one."""
    directions = [line_m[1] - line_m[0] for line_m in (before_m, after_m)]
    directions = [direction / np.hypot(*direction) for direction in directions]
    sine = directions[0][0] * directions[1][1] - directions[0][1] * directions[1][0]
    ends_m = [before_m[1], after_m[0]]
    if abs(sine) < _CORNER_SINE:
        is_one = np.hypot(*(ends_m[1] - ends_m[0])) < 1e-6
        return ends_m[:1] if is_one else ends_m
    to_m = after_m[0] - before_m[1]
    along_m = (to_m[0] * directions[1][1] - to_m[1] * directions[1][0]) / sine
    corner_m = before_m[1] + along_m * directions[0]
    # farther off it would be drawn where no wall is
    is_near = max(np.hypot(*(corner_m - end_m)) for end_m in ends_m) <= 2 * END_M
    return [corner_m] if is_near else ends_m
