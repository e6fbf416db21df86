"""One floor of a building: its walls and openings, and the shapes that follow from them."""

from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings.details.things import (
    DrawnCeiling,
    DrawnColumn,
    DrawnFacade,
    DrawnFurniture,
    DrawnGround,
    DrawnMirror,
    DrawnOpening,
    DrawnPlatform,
    DrawnStairs,
    DrawnVoid,
    DrawnWall,
)
from scanplan.lab.buildings.tolerances import DRAWN_M
from scanplan.types import FloatArray


@dataclass(frozen=True)
class DrawnFloor:
    """One floor of a building in the map frame, from z = 0 to the ceiling at `height_m`.

    Attributes
    ----------
    height_m : float
    walls : tuple of DrawnWall
    openings : tuple of DrawnOpening
    furniture : tuple of DrawnFurniture
    room_names : tuple of (str, Point)
        A name and a point inside the room that bears it.
    waypoints_m : (n, 2) float64, n >= 2, or None
        The corners of the rover's way, where one is drawn.
    columns, ceilings, voids, stairs, platforms, mirrors : tuples
        Of the things that their names say; `ceilings` holds beams, too.
    polished_m : tuple of Polygon
        Where the floor is polished.
    grounds, facades : tuples
        What is seen outside.
    """

    height_m: float
    walls: tuple[DrawnWall, ...]
    openings: tuple[DrawnOpening, ...]
    furniture: tuple[DrawnFurniture, ...]
    room_names: tuple[tuple[str, Point], ...]
    waypoints_m: FloatArray | None
    columns: tuple[DrawnColumn, ...] = ()
    ceilings: tuple[DrawnCeiling, ...] = ()
    voids: tuple[DrawnVoid, ...] = ()
    stairs: tuple[DrawnStairs, ...] = ()
    platforms: tuple[DrawnPlatform, ...] = ()
    mirrors: tuple[DrawnMirror, ...] = ()
    polished_m: tuple[Polygon, ...] = ()
    grounds: tuple[DrawnGround, ...] = ()
    facades: tuple[DrawnFacade, ...] = ()

    @property
    def is_detailed(self) -> bool:
        """Whether it has more than walls, holes, panes in them and nameless furniture."""
        things = (*self.columns, *self.ceilings, *self.voids, *self.stairs, *self.platforms)
        around = (*self.mirrors, *self.polished_m, *self.grounds, *self.facades)
        return bool(
            things
            or around
            or any(o.leaf or o.frame_m > 0 for o in self.openings)
            or any(f.type or f.base_m > 0 for f in self.furniture)
            or any(w.is_glass or w.is_curved or w.end_thickness_m for w in self.walls)
        )


def cut_walls(plan: DrawnFloor, z_m: float) -> BaseGeometry:
    """Return the section of the walls at a height, openings left out: (Multi)Polygon, map frame."""
    bodies = [body for body, height_m in _bodies(plan) if z_m < height_m]
    open_here = [o for o in plan.openings if o.sill_m < z_m < o.lintel_m]
    holes = [o.line_m.buffer(o.thickness_m / 2 + DRAWN_M, cap_style="flat") for o in open_here]
    solid = shapely.union_all(bodies, grid_size=SAME_M)
    hole = shapely.union_all(holes, grid_size=SAME_M)
    return shapely.difference(solid, hole, grid_size=SAME_M).normalize()


def cut_wall_bands(plan: DrawnFloor) -> list[tuple[float, float, BaseGeometry]]:
    """Cut the walls into slabs of constant section.

    Returns
    -------
    list of (float, float, Polygon or MultiPolygon)
        Lower and upper edge of each slab, metres above the floor, and its section.
    """
    edges = {0.0, plan.height_m}
    edges.update(wall.height_m for wall in plan.walls)
    for opening in plan.openings:
        edges.update((opening.sill_m, opening.lintel_m))
    return [
        (low_m, high_m, cut_walls(plan, (low_m + high_m) / 2))
        for low_m, high_m in pairwise(sorted(edges))
    ]


def floor_footprint(plan: DrawnFloor) -> BaseGeometry:
    """Return the whole floor with the walls on it: all that the outer faces enclose."""
    filled = [Polygon(part.exterior) for part in shapely.get_parts(_footprint_of_walls(plan))]
    return shapely.union_all(filled, grid_size=SAME_M)


def floor_rooms(plan: DrawnFloor) -> list[tuple[str, Polygon]]:
    """Return the rooms: the free floor between the walls with every opening closed.

    Returns
    -------
    list of (str, Polygon)
        Name ("" where none is drawn) and floor, in a fixed order.
    """
    walls = _footprint_of_walls(plan)
    free = shapely.difference(floor_footprint(plan), walls, grid_size=SAME_M).normalize()
    rooms = [room for room in shapely.get_parts(free) if not room.is_empty]
    return [(_name_of_room(plan, room), room) for room in rooms]


def floor_obstacles(plan: DrawnFloor, height_m: float) -> BaseGeometry:
    """Return the ground that a vehicle of a height cannot stand on: walls, panes, furniture.

    Raises
    ------
    StageError
        If the height is not below the ceiling.
    """
    if not 0 < height_m < plan.height_m:
        raise StageError(
            f"the sensor is {height_m:g} m above the floor and the ceiling {plan.height_m:g} m;"
            " lower it"
        )
    sections = [section for low_m, _, section in cut_wall_bands(plan) if low_m < height_m]
    panes = [o.pane_m for o in plan.openings if o.glazed and o.sill_m < height_m]
    return shapely.union_all([*sections, *panes, *(f.footprint_m for f in plan.furniture)])


def _footprint_of_walls(plan: DrawnFloor) -> BaseGeometry:
    return shapely.union_all([body for body, _ in _bodies(plan)], grid_size=SAME_M)


def _name_of_room(plan: DrawnFloor, room: Polygon) -> str:
    return next((name for name, point in plan.room_names if room.contains(point)), "")


def _bodies(plan: DrawnFloor) -> list[tuple[BaseGeometry, float]]:
    """Return footprint and height of walls, openings not cut, and of corners where ends meet."""
    bodies = [(_thick(w.line_m, w.thickness_m), w.height_m) for w in plan.walls]
    ends = [(wall, *end) for wall in plan.walls for end in _ends(wall.line_m)]
    for (a, place_a, run_a), (b, place_b, run_b) in combinations(ends, 2):
        if place_a == place_b:
            corner = _thick(LineString([*run_a, *run_b[-2::-1]]), min(a.thickness_m, b.thickness_m))
            bodies.append((corner, min(a.height_m, b.height_m)))
    return bodies


def _ends(line_m: LineString) -> list[tuple[tuple[float, ...], FloatArray]]:
    """Return the place of each end of a line, to the millimetre, and the run that leads to it."""
    if line_m.is_closed:
        return []
    xy = shapely.get_coordinates(line_m)
    runs = (xy[1::-1], xy[-2:])
    return [(tuple(np.round(run[-1], 3)), run) for run in runs]


def _thick(line_m: LineString, thickness_m: float) -> BaseGeometry:
    return line_m.buffer(thickness_m / 2, cap_style="flat", join_style="mitre")
