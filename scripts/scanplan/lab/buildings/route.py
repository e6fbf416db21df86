"""Planning the rover's way: through every room it can reach, or along the hallways."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, Point

from scanplan.errors import StageError
from scanplan.lab.buildings import roadmap, tour

KINDS = ("given", "rooms", "hallways")
_START_STREAM = 9
_ROOMY_M, _YIELD_M = 0.6, 0.1
# how far from a stop, by cost, the middle of what is visited may be
_SPACING_M = 6.0
_HALL_WIDTH_M, _HALL_ASPECT, _HALL_JOINT_M = 3.5, 4.0, 0.5


@dataclass(frozen=True)
class Route:
    """A way through a building.

    Attributes
    ----------
    waypoints_m : (n, 2) float64
        Its corners.
    reached, missed : tuple of str
        The rooms it was asked to visit and does, or cannot reach; by name, or by place where they have none.
    """

    waypoints_m: np.ndarray
    reached: tuple
    missed: tuple


def plan_route(floor_m, obstacles_m, rooms, source, *, kind, clearance_m, start_m=None, seed=0):
    """Plan a way.

    The stops (the widest place of every room, and in large ones others so that no place is far from one) are joined by
    cheapest ways on a grid that prefer the middle of passages, in the order of a short tour: nearest neighbour improved
    by 2-opt. `rooms` ends at its last room; `find_hallways` returns to its start.

    Parameters
    ----------
    floor_m, obstacles_m : shapely geometry
        Where there is floor, and what stands on it.
    rooms : list of (str, Polygon)
    source : path-like
        What errors name as their origin.
    kind : str
        `rooms` or `find_hallways`. ASSUME a hallway is a room like a rectangle at most 3.5 m wide and 4 times as long, by
        its area and perimeter; the hallways are the largest of the areas that such rooms make where they meet.
    clearance_m : float
        What the way keeps from any obstacle, the rover's radius or more.
    start_m : (2,) float, "random" or None
        Where it begins: at a place, anywhere on the free ground, or at the end of the shortest tour.
    seed : int
        Of a random start.

    Returns
    -------
    Route

    Raises
    ------
    StageError
        If the start is not free, or no room or hallway can be reached.
    """
    if kind not in KINDS[1:] or not clearance_m > 0:
        raise ValueError(
            f"kind {kind!r} is none of {KINDS[1:]}, or clearance {clearance_m} m is not positive"
        )
    wanted, area_m = _asked(floor_m, rooms, kind, source)
    free = free_ground(area_m, obstacles_m, clearance_m)
    part = _part_of(free, start_m, clearance_m, wanted, source)
    grid = roadmap.make_grid(part, clearance_m, source)
    grid = roadmap.connected_grid(
        grid, None if start_m is None or isinstance(start_m, str) else start_m
    )
    first = _first(grid, start_m, seed)
    stops, reached, ways = _stops(grid, wanted, first, _SPACING_M)
    if not any(reached):
        raise StageError(
            f"simulate.site.clearance_m: in {source}: none of {len(wanted)} rooms can be entered with {clearance_m:g} m"
            " to either side; lower it, widen a door, or give simulate.site.waypoints_m"
        )
    if len(stops) < 2:
        raise StageError(
            f"{source}: its free floor is too small to drive on; give simulate.site.waypoints_m"
        )
    legs = _joined(stops, ways, fixed_start=first is not None, closed=kind == "hallways")
    corners = [_straightened(grid, leg, part, obstacles_m) for leg in legs]
    names = [name or f"({room.centroid.x:.1f}, {room.centroid.y:.1f})" for name, room in wanted]
    return Route(
        waypoints_m=np.vstack([*corners, grid.xy_m[legs[-1][-1]]]),
        reached=tuple(name for name, ok in zip(names, reached, strict=True) if ok),
        missed=tuple(name for name, ok in zip(names, reached, strict=True) if not ok),
    )


def free_ground(floor_m, obstacles_m, clearance_m):
    """Return where the rover's middle can be: floor at least `clearance_m` from obstacles and from the floor's edge."""
    # a buffer's arc is a polygon inside the circle; a millimetre more covers the difference
    blocked = obstacles_m.buffer(clearance_m + 0.001, quad_segs=16)
    return shapely.difference(floor_m.buffer(-clearance_m), blocked)


def find_hallways(rooms):
    """Return the corridor-like rooms: those shaped as `plan_route` states, as (name, Polygon)."""
    return [(name, room) for name, room in rooms if _is_hallway(room)]


def _is_hallway(room):
    """By the rectangle of the same area and perimeter; of a ring the perimeter counts both sides."""
    half_m, area_m2 = room.length / 2, room.area
    width_m = (half_m - np.sqrt(max(half_m**2 - 4 * area_m2, 0.0))) / 2
    return 0 < width_m <= _HALL_WIDTH_M and half_m - width_m >= _HALL_ASPECT * width_m


def _asked(floor_m, rooms, kind, source):
    """The rooms to visit and the ground to do it on."""
    if kind == "rooms":
        wanted, area_m = rooms, floor_m
    else:
        halls = find_hallways(rooms)
        # what lies between two hallways is the passage that joins them
        joined = shapely.union_all([hall for _, hall in halls]).buffer(
            _HALL_JOINT_M, join_style="mitre"
        )
        area_m = max(
            shapely.get_parts(joined), key=lambda part: part.area, default=shapely.Polygon()
        )
        area_m = area_m.intersection(floor_m)
        wanted = [(name, hall) for name, hall in halls if area_m.intersects(hall)]
    if not wanted:
        what = (
            "no rooms"
            if kind == "rooms"
            else f"no hallway among its {len(rooms)} rooms; set simulate.site.route: rooms"
        )
        raise StageError(f"{source}: has {what}, or give simulate.site.waypoints_m")
    return wanted, area_m


def _first(grid, start_m, seed):
    """The cell that the way begins at; None where it may be any."""
    if start_m is None or len(grid.xy_m) == 0:
        return None
    if isinstance(start_m, str):
        return int(np.random.default_rng([seed, _START_STREAM]).integers(len(grid.xy_m)))
    return roadmap.nearest_cell(grid, start_m)


def _part_of(free, start_m, clearance_m, rooms, source):
    """The connected ground that holds the start, or else the most room."""
    parts = [
        part for part in shapely.get_parts(free) if part.geom_type == "Polygon" and part.area > 0
    ]
    if start_m is None or isinstance(start_m, str):
        floors = shapely.union_all([room for _, room in rooms])
        return max(
            parts, key=lambda part: part.intersection(floors).area, default=shapely.Polygon()
        )
    held = [part for part in parts if part.covers(Point(start_m))]
    if not held:
        raise StageError(
            f"simulate.site.start_m: in {source}: the start ({start_m[0]:g}, {start_m[1]:g}) lies within"
            f" {clearance_m:g} m of a wall or furniture or off the floor; move it to free floor, or lower"
            " simulate.site.clearance_m"
        )
    return held[0]


def _stops(grid, rooms, first, spacing_m):
    """Places in the rooms, the middle of a room everywhere near one; which rooms have any; ways to every stop.

    The ways are costs (stops, cells) and the cell before each (stops, cells).
    """
    cells = [roadmap.room_cells(grid, room) for _, room in rooms]
    stops = [c[0] for c in cells if len(c)]
    ways = [
        roadmap.cheapest_ways(grid, stop) for stop in ([] if first is None else [first]) + stops
    ]
    stops = ([] if first is None else [first]) + stops
    # ASSUME what is seen from the middle of a room is the room: cells along its walls need no visit
    middle = [c[grid.middle[c]] for c in cells]
    asked = np.concatenate([np.empty(0, int), *middle])
    far = np.min([cost[asked] for cost, _ in ways], axis=0) if ways else np.empty(0)
    # a drive needs two places; then always the one farthest from those chosen
    while len(asked) > 1 and (len(stops) < 2 or far.max() > spacing_m):
        stops.append(int(asked[far.argmax()]))
        ways.append(roadmap.cheapest_ways(grid, stops[-1]))
        far = np.minimum(far, ways[-1][0][asked])
    return stops, [len(c) > 0 for c in cells], ways


def _joined(stops, ways, *, fixed_start, closed):
    """The ways from stop to stop in the order of a short tour, as cells."""
    cost = np.stack([metres[stops] for metres, _ in ways])
    order = tour.shortest_tour((cost + cost.T) / 2, closed=closed, first=0 if fixed_start else None)
    legs = []
    for a, b in pairwise([*order, order[0]] if closed else order):
        leg = [stops[b]]
        while leg[-1] != stops[a]:
            leg.append(int(ways[a][1][leg[-1]]))
        legs.append(leg[::-1])
    return legs


def _straightened(grid, leg, part, obstacles_m):
    """Corners of a leg, its last left out, that keep the space about it that its cells have, up to a limit."""
    xy_m = grid.xy_m[leg]
    near_m = np.minimum(shapely.distance(shapely.points(xy_m), obstacles_m), _ROOMY_M)
    kept, waiting = [], [(0, len(xy_m) - 1)]
    while waiting:
        a, b = waiting.pop()
        chord = LineString([xy_m[a], xy_m[b]])
        off_m = shapely.distance(shapely.points(xy_m[a : b + 1]), chord)
        space_m = near_m[a : b + 1].min() - _YIELD_M
        if b - a <= 1 or (part.covers(chord) and chord.distance(obstacles_m) >= space_m):
            kept.append(xy_m[a])
            continue
        middle = (
            a + int(np.clip(off_m.argmax(), 1, b - a - 1)) if off_m.max() > 1e-9 else (a + b) // 2
        )
        waiting += [(middle, b), (a, middle)]
    return np.array(kept)
