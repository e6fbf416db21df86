"""Planning the rover's way: through every room it can reach, or along the hallways."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays, roadmap, tour
from scanplan.geometry.roadmap import RoadmapGrid
from scanplan.lab.buildings import hallways
from scanplan.lab.buildings.hallways import Rooms
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.types import FilePath, FloatArray, IntArray

KINDS = ("given", "rooms", "hallways")
_CELLS_M = (0.05, 0.1)  # doors hardly wider than the rover are met, and those of large floors
_LARGE_M2 = 300.0  # of floor, 120,000 fine cells: seconds for every stop's ways
_MAX_CELLS = 20e6  # rasters of 160 MB each
_YIELD_M = 0.1  # less space than its cells have that a straightened way may keep: corners for space
_SPACING_M = 6.0  # by cost, from a stop to the middle of what is visited: hallways get several

Searches = list[tuple[FloatArray, IntArray]]
"""For every stop the costs of going there from every cell, and the cell before each."""


@dataclass(frozen=True)
class Route:
    """A way through a building.

    Attributes
    ----------
    waypoints_m : (n, 2) float64
        Its corners.
    reached, missed : tuple of str
        The rooms that it was asked to visit and does, or cannot reach; by name, or by place where
        they have none.
    """

    waypoints_m: FloatArray
    reached: tuple[str, ...]
    missed: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Ground:
    """Where a rover may drive.

    Attributes
    ----------
    floor_m, obstacles_m : shapely geometry
        Where there is floor, and what stands on it.
    rooms : list of (str, Polygon)
    """

    floor_m: BaseGeometry
    obstacles_m: BaseGeometry
    rooms: Rooms


def plan_route(
    ground: Ground,
    source: FilePath,
    *,
    kind: str,
    clearance_m: float,
    start_m: Sequence[float] | str | None = None,
    seed: int = 0,
) -> Route:
    """Plan a way.

    The stops (the widest place of every room, and in large ones others so that no place is far from
    one) are joined by cheapest ways on a grid that prefer the middle of passages, in the order of a
    short tour: nearest neighbour improved by 2-opt. `rooms` ends at its last room; `hallways`
    returns to its start.

    Parameters
    ----------
    source : path-like
        What errors name as their origin.
    kind : str
        `rooms` or `hallways`. ASSUME a hallway is a room like a rectangle at most 3.5 m wide and 4
        times as long, by its area and perimeter; the hallways are the largest of the areas that
        such rooms make where they meet.
    clearance_m : float
        What the way keeps from any obstacle, the rover's radius or more.
    start_m : (2,) float, "random" or None
        Where it begins: at a place, anywhere on the free ground, or at the shortest tour's end.
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
    asked, area_m = _asked_rooms(ground.floor_m, ground.rooms, kind, source)
    free = free_ground(area_m, ground.obstacles_m, clearance_m)
    start_xy_m = None if isinstance(start_m, str) else start_m
    part = _part_of(free, start_xy_m, clearance_m, asked, source)
    grid = roadmap.connected_grid(_grid_over(part, clearance_m, source), start_xy_m)
    first = _first_cell(grid, start_m, seed)
    stops, is_reached, searches = _choose_stops(grid, asked, first)
    _check_stops(stops, is_reached, clearance_m, source)
    legs = _join_stops(stops, searches, fixed_start=first is not None, closed=kind == "hallways")
    corners_m = [_straighten(grid, leg, part, ground.obstacles_m) for leg in legs]
    named = [(_room_label(*room), ok) for room, ok in zip(asked, is_reached, strict=True)]
    return Route(
        waypoints_m=np.vstack([*corners_m, grid.xy_m[legs[-1][-1]]]),
        reached=tuple(name for name, ok in named if ok),
        missed=tuple(name for name, ok in named if not ok),
    )


def join_places(
    floor_m: BaseGeometry,
    obstacles_m: BaseGeometry,
    places_m: FloatArray,
    source: FilePath,
    *,
    clearance_m: float,
) -> FloatArray:
    """Return the corners (n, 2) of a way through places in their order.

    Parameters
    ----------
    floor_m, obstacles_m : shapely geometry
        Where there is floor, and what stands on it.
    places_m : (k, 2) float, k >= 2
        Each stands for the nearest free ground that is connected to that of the first.
    source : path-like
        What errors name as their origin.
    clearance_m : float
        What the way keeps from any obstacle.

    Raises
    ------
    StageError
        If there is no free ground, or it is too large.
    """
    free = free_ground(floor_m, obstacles_m, clearance_m)
    parts = [part for part in shapely.get_parts(free) if part.area > 0]
    part = min(parts, key=lambda p: p.distance(Point(places_m[0])), default=Polygon())
    grid = roadmap.connected_grid(_grid_over(part, clearance_m, source))
    if len(grid.xy_m) == 0:
        raise StageError(f"{source}: has no free floor {clearance_m:g} m wide to either side")
    cells = [roadmap.nearest_cell(grid, place_m) for place_m in places_m]
    stops = [cell for i, cell in enumerate(cells) if i == 0 or cell != cells[i - 1]]
    corners_m = []
    for a, b in pairwise(stops):
        _, cell_before = roadmap.cheapest_ways(grid, a)
        leg = roadmap.trace_cells(cell_before, a, b)
        corners_m.append(_straighten(grid, leg, part, obstacles_m))
    return np.vstack([*corners_m, grid.xy_m[stops[-1]]])


def free_ground(
    floor_m: BaseGeometry, obstacles_m: BaseGeometry, clearance_m: float
) -> BaseGeometry:
    """Return where the rover's middle can be: `clearance_m` from obstacles and the floor's edge."""
    # a buffer's arc is a polygon inside the circle; a millimetre more covers the difference
    blocked = overlays.buffer_shapes(obstacles_m, clearance_m + 0.001, quad_segs=16)
    return overlays.subtract_areas(overlays.buffer_shapes(floor_m, -clearance_m), blocked)


def _asked_rooms(
    floor_m: BaseGeometry, rooms: Rooms, kind: str, source: FilePath
) -> tuple[Rooms, BaseGeometry]:
    """Return the rooms to visit and the ground to do it on."""
    asked = rooms
    area_m = floor_m
    lacking = "no rooms"
    if kind == "hallways":
        halls = hallways.find_hallways(rooms)
        area_m = overlays.intersect_areas(hallways.join_hallways(halls), floor_m)
        asked = [(name, hall) for name, hall in halls if area_m.intersects(hall)]
        lacking = f"no hallway among its {len(rooms)} rooms; set simulate.site.route: rooms"
    if not asked:
        raise StageError(f"{source}: has {lacking}, or give simulate.site.waypoints_m")
    return asked, area_m


def _room_label(name: str, room: Polygon) -> str:
    return name or f"({room.centroid.x:.1f}, {room.centroid.y:.1f})"


def _first_cell(grid: RoadmapGrid, start_m: Sequence[float] | str | None, seed: int) -> int | None:
    """Return the cell that the way begins at, None where it may be any."""
    if start_m is None or len(grid.xy_m) == 0:
        return None
    if isinstance(start_m, str):
        return int(open_stream(seed, RandomStream.ROUTE_START).integers(len(grid.xy_m)))
    return roadmap.nearest_cell(grid, start_m)


def _part_of(
    free: BaseGeometry,
    start_m: Sequence[float] | None,
    clearance_m: float,
    rooms: Rooms,
    source: FilePath,
) -> Polygon:
    """Return the connected ground that holds the start, or else the most room."""
    polygons = [part for part in shapely.get_parts(free) if part.geom_type == "Polygon"]
    parts = [part for part in polygons if part.area > 0]
    if start_m is None:
        floors = overlays.unite_areas([room for _, room in rooms])
        return max(
            parts, key=lambda part: overlays.intersect_areas(part, floors).area, default=Polygon()
        )
    for part in parts:
        if part.covers(Point(start_m)):
            return part
    raise StageError(
        f"simulate.site.start_m: in {source}: the start ({start_m[0]:g}, {start_m[1]:g}) lies"
        f" within {clearance_m:g} m of a wall or furniture or off the floor; move it to free floor,"
        " or lower simulate.site.clearance_m"
    )


def _grid_over(part: Polygon, clearance_m: float, source: FilePath) -> RoadmapGrid:
    """Return the grid over connected free ground, in cells as fine as its size allows."""
    if part.is_empty:
        return roadmap.make_grid(part, clearance_m, _CELLS_M[0])
    cell_m = _CELLS_M[part.area >= _LARGE_M2]
    x0, y0, x1, y1 = part.bounds
    limit_m2 = _MAX_CELLS * cell_m**2
    if (x1 - x0) * (y1 - y0) > limit_m2:
        raise StageError(
            f"{source}: its floor of {x1 - x0:.0f} x {y1 - y0:.0f} m is too large to plan a way"
            f" over (limit {limit_m2:,.0f} m2); check simulate.site.unit, or give"
            " simulate.site.waypoints_m"
        )
    return roadmap.make_grid(part, clearance_m, cell_m)


def _choose_stops(
    grid: RoadmapGrid, rooms: Rooms, first: int | None
) -> tuple[list[int], list[bool], Searches]:
    """Return places in the rooms, which rooms have any, and the ways to every stop.

    The middle of a room is everywhere near a stop.
    """
    cells = [roadmap.room_cells(grid, room) for _, room in rooms]
    stops = [] if first is None else [first]
    stops += [c[0] for c in cells if len(c)]
    searches = [roadmap.cheapest_ways(grid, stop) for stop in stops]
    # ASSUME what is seen from the middle of a room is the room: cells along its walls need no visit
    middle = np.concatenate([np.empty(0, int), *(c[grid.middle[c]] for c in cells)])
    far = np.min([cost[middle] for cost, _ in searches], axis=0) if searches else np.empty(0)
    # a drive needs two places; then always the one farthest from those chosen
    while len(middle) > 1 and (len(stops) < 2 or far.max() > _SPACING_M):
        stops.append(int(middle[far.argmax()]))
        searches.append(roadmap.cheapest_ways(grid, stops[-1]))
        far = np.minimum(far, searches[-1][0][middle])
    return stops, [len(c) > 0 for c in cells], searches


def _check_stops(
    stops: list[int], is_reached: list[bool], clearance_m: float, source: FilePath
) -> None:
    if not any(is_reached):
        raise StageError(
            f"simulate.site.clearance_m: in {source}: none of {len(is_reached)} rooms can be"
            f" entered with {clearance_m:g} m to either side; lower it, widen a door, or give"
            " simulate.site.waypoints_m"
        )
    if len(stops) < 2:
        raise StageError(
            f"{source}: its free floor is too small to drive on; give simulate.site.waypoints_m"
        )


def _join_stops(
    stops: list[int], searches: Searches, *, fixed_start: bool, closed: bool
) -> list[list[int]]:
    """Return the ways from stop to stop in the order of a short tour, as cells."""
    cost = np.stack([costs[stops] for costs, _ in searches])
    order = tour.shortest_tour((cost + cost.T) / 2, closed=closed, first=0 if fixed_start else None)
    legs = []
    for a, b in pairwise([*order, order[0]] if closed else order):
        _, cell_before = searches[a]
        legs.append(roadmap.trace_cells(cell_before, stops[a], stops[b]))
    return legs


def _straighten(
    grid: RoadmapGrid, leg: list[int], part: Polygon, obstacles_m: BaseGeometry
) -> FloatArray:
    """Return the corners of a leg, its last left out, that keep its cells' space up to a limit."""
    xy_m = grid.xy_m[leg]
    near_m = np.minimum(shapely.distance(shapely.points(xy_m), obstacles_m), roadmap.ROOMY_M)
    corners_m = []
    waiting = [(0, len(xy_m) - 1)]
    while waiting:
        a, b = waiting.pop()
        chord = LineString([xy_m[a], xy_m[b]])
        space_m = near_m[a : b + 1].min() - _YIELD_M
        if b - a <= 1 or (part.covers(chord) and chord.distance(obstacles_m) >= space_m):
            corners_m.append(xy_m[a])
            continue
        off_m = shapely.distance(shapely.points(xy_m[a : b + 1]), chord)
        middle = (a + b) // 2
        if off_m.max() > 1e-9:
            middle = a + int(np.clip(off_m.argmax(), 1, b - a - 1))
        waiting += [(middle, b), (a, middle)]
    return np.array(corners_m)
