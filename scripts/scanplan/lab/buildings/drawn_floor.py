"""One floor of a building: its walls and openings, and the shapes that follow from them."""

from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import shapely
from shapely import LineString, Polygon

from scanplan.errors import StageError

GRID_M = 1e-6
ON_WALL_M = 0.001


@dataclass(frozen=True)
class DrawnWall:
    """A wall: its centreline, thickness and height above the floor."""

    line_m: LineString
    thickness_m: float
    height_m: float


@dataclass(frozen=True)
class DrawnOpening:
    """A hole through a wall: its stretch of the wall's centreline and its lower and upper edge above the floor."""

    line_m: LineString
    thickness_m: float
    sill_m: float
    lintel_m: float
    type: str


@dataclass(frozen=True)
class DrawnFurniture:
    """A box on the floor."""

    footprint_m: Polygon
    height_m: float


@dataclass(frozen=True)
class DrawnFloor:
    """One floor of a building in the map frame; the floor is at z = 0, the ceiling at `height_m`.

    Attributes
    ----------
    height_m : float
    walls : tuple of Wall
    openings : tuple of Opening
    furniture : tuple of Furniture
    room_names : tuple of (str, Point)
        A name and a point inside the room that bears it.
    waypoints_m : (n, 2) float64, n >= 2, or None
        The corners of the rover's way, where one is drawn.
    """

    height_m: float
    walls: tuple
    openings: tuple
    furniture: tuple
    room_names: tuple
    waypoints_m: np.ndarray | None


def cut_walls(plan, z_m):
    """Return the ground that walls stand on when cut at a height, openings left out: (Multi)Polygon, map frame."""
    bodies = [body for body, height_m in _bodies(plan) if z_m < height_m]
    holes = [
        o.line_m.buffer(o.thickness_m / 2 + ON_WALL_M, cap_style="flat")
        for o in plan.openings
        if o.sill_m < z_m < o.lintel_m
    ]
    solid = shapely.union_all(bodies, grid_size=GRID_M)
    return shapely.difference(solid, shapely.union_all(holes), grid_size=GRID_M).normalize()


def cut_wall_bands(plan):
    """Cut the walls into slabs of constant section.

    Returns
    -------
    list of (float, float, Polygon or MultiPolygon)
        Lower and upper edge of each slab, metres above the floor, and its section.
    """
    edges = {0.0, plan.height_m, *(w.height_m for w in plan.walls)}
    edges.update(edge for o in plan.openings for edge in (o.sill_m, o.lintel_m))
    edges = sorted(edges)
    return [(low, high, cut_walls(plan, (low + high) / 2)) for low, high in pairwise(edges)]


def floor_footprint(plan):
    """Return the whole floor with the walls on it: all that the outer faces enclose."""
    solid = shapely.union_all([body for body, _ in _bodies(plan)], grid_size=GRID_M)
    return shapely.union_all(
        [Polygon(part.exterior) for part in shapely.get_parts(solid)], grid_size=GRID_M
    )


def floor_rooms(plan):
    """Return the rooms: the free floor between the walls with every opening closed.

    Returns
    -------
    list of (str, Polygon)
        Name ("" where none is drawn) and floor, in a fixed order.
    """
    solid = shapely.union_all([body for body, _ in _bodies(plan)], grid_size=GRID_M)
    free = shapely.difference(floor_footprint(plan), solid, grid_size=GRID_M).normalize()
    named = []
    for room in (part for part in shapely.get_parts(free) if not part.is_empty):
        names = [name for name, point in plan.room_names if room.contains(point)]
        named.append((names[0] if names else "", room))
    return named


def floor_obstacles(plan, height_m):
    """Return the ground that a vehicle of a height cannot stand on: walls, parapets, furniture.

    Raises
    ------
    StageError
        If the height is not below the ceiling.
    """
    if not 0 < height_m < plan.height_m:
        raise StageError(
            f"the sensor is {height_m:g} m above the floor and the ceiling {plan.height_m:g} m; lower it"
        )
    sections = [section for low, _, section in cut_wall_bands(plan) if low < height_m]
    return shapely.union_all([*sections, *(f.footprint_m for f in plan.furniture)])


def _bodies(plan):
    """Footprint and height of every wall, openings not cut, and of the corners where walls' ends meet."""
    whole = [(_thick(w.line_m, w.thickness_m), w.height_m) for w in plan.walls]
    ends = [
        (tuple(np.round(end, 3)), run, wall)
        for wall in plan.walls
        for end, run in _ends(wall.line_m)
    ]
    for (node_a, run_a, a), (node_b, run_b, b) in combinations(ends, 2):
        if node_a == node_b:
            corner = LineString([*run_a, *run_b[-2::-1]])
            whole.append(
                (_thick(corner, min(a.thickness_m, b.thickness_m)), min(a.height_m, b.height_m))
            )
    return whole


def _ends(line_m):
    """Each end of a line with the straight run that leads to it."""
    xy = shapely.get_coordinates(line_m)
    return [] if line_m.is_closed else [(xy[0], xy[1::-1]), (xy[-1], xy[-2:])]


def _thick(line_m, thickness_m):
    return line_m.buffer(thickness_m / 2, cap_style="flat", join_style="mitre", mitre_limit=5.0)
