"""One floor of a building: its walls and openings, and the shapes that follow from them."""

from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings.details.ceilings import low_ground
from scanplan.lab.buildings.details.leaves import stand_leaves
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
from scanplan.lab.buildings.ground import HEADROOM_M
from scanplan.lab.buildings.tolerances import DRAWN_M, ROOM_M
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


def cut_walls(plan: DrawnFloor, z_m: float, *, glass: bool | None = None) -> BaseGeometry:
    """Return the section of the walls at a height, openings left out: (Multi)Polygon, map frame.

    Of panes alone if `glass`, without them if it is False; frames of openings in panes count
    as walls where both are asked for.
    """
    bodies = [body for body, height_m, _ in _bodies(plan, glass) if z_m < height_m]
    solid = overlays.unite_areas(bodies, grid=SAME_M)
    holes = (_hole(opening, z_m, whole=glass is True) for opening in plan.openings)
    hole = overlays.unite_areas([h for h in holes if h is not None], grid=SAME_M)
    if glass:
        hole = overlays.unite_each(hole, cut_walls(plan, z_m, glass=False), grid=SAME_M)
    return overlays.subtract_areas(solid, hole, grid=SAME_M).normalize()


def cut_wall_bands(
    plan: DrawnFloor, *, glass: bool | None = None
) -> list[tuple[float, float, BaseGeometry]]:
    """Cut the walls into slabs of constant section, see `cut_walls`.

    Returns
    -------
    list of (float, float, Polygon or MultiPolygon)
        Lower and upper edge of each slab, metres above the floor, and its section.
    """
    edges = {0.0, plan.height_m}
    edges.update(wall.height_m for wall in plan.walls)
    for opening in plan.openings:
        edges.update((opening.sill_m, opening.clear_lintel_m, opening.lintel_m))
    return [
        (low_m, high_m, cut_walls(plan, (low_m + high_m) / 2, glass=glass))
        for low_m, high_m in pairwise(sorted(edges))
    ]


def cut_curves(plan: DrawnFloor) -> BaseGeometry:
    """Return the ground that curved walls stand on."""
    curved = [_body(wall) for wall in plan.walls if wall.is_curved]
    return overlays.unite_areas(curved, grid=SAME_M)


def floor_footprint(plan: DrawnFloor) -> BaseGeometry:
    """Return the whole floor with the walls on it: all that the outer faces enclose."""
    filled = [Polygon(part.exterior) for part in shapely.get_parts(_footprint_of_walls(plan))]
    return overlays.unite_areas(filled, grid=SAME_M)


def floor_rooms(plan: DrawnFloor) -> list[tuple[str, Polygon]]:
    """Return the rooms: the free floor between the walls with every opening closed.

    Returns
    -------
    list of (str, Polygon)
        Name ("" where none is drawn) and floor, without voids, in a fixed order.
    """
    walls = _footprint_of_walls(plan)
    free = overlays.subtract_areas(floor_footprint(plan), walls, grid=SAME_M).normalize()
    rooms = [room for room in shapely.get_parts(free) if not room.is_empty]
    if plan.voids:
        hole = overlays.unite_areas([void.footprint_m for void in plan.voids], grid=SAME_M)
        parts = [overlays.subtract_areas(room, hole, grid=SAME_M).normalize() for room in rooms]
        # what a void leaves of the ground within its parapet is no room
        rooms = [
            r
            for r in shapely.get_parts(parts)
            if not overlays.buffer_shapes(r, -ROOM_M / 2).is_empty
        ]
    return [(_name_of_room(plan, room), room) for room in rooms]


def floor_obstacles(plan: DrawnFloor, height_m: float) -> BaseGeometry:
    """Return the ground that a vehicle of a height cannot stand on.

    That is walls, panes, furniture, leaves, columns, voids, stairs, platforms, and what is below
    ceilings that it would touch.

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
    head_m = height_m + HEADROOM_M
    # ASSUME no rover drives below tables, where chairs stand and legs are seen late
    boxes = [f.footprint_m for f in plan.furniture if f.base_m < max(head_m, 1.2)]
    things = (*plan.columns, *plan.voids, *plan.stairs, *plan.platforms)
    standing = [thing.footprint_m for thing in things]
    doors = [body.footprint_m for o in plan.openings for body in stand_leaves(o)]
    low = [ground for c in plan.ceilings if (ground := low_ground(c, head_m)).area > 0]
    return overlays.unite_areas([*sections, *panes, *boxes, *standing, *doors, *low])


def _footprint_of_walls(plan: DrawnFloor) -> BaseGeometry:
    return overlays.unite_areas([body for body, _, _ in _bodies(plan)], grid=SAME_M)


def _name_of_room(plan: DrawnFloor, room: Polygon) -> str:
    return next((name for name, point in plan.room_names if room.contains(point)), "")


def _bodies(plan: DrawnFloor, glass: bool | None = None) -> list[tuple[BaseGeometry, float, bool]]:
    """Return footprint and height of walls, openings not cut, and of corners where ends meet.

    Each with whether it is a pane; those alone, or all others, where `glass` is not None.
    """
    bodies = [(_body(wall), wall.height_m, wall.is_glass) for wall in plan.walls]
    ends = [(wall, *end) for wall in plan.walls for end in _ends(wall)]
    for (a, place_a, run_a, wide_a), (b, place_b, run_b, wide_b) in combinations(ends, 2):
        # a pane ends at the wall that it meets: there is no corner of both
        if place_a == place_b and a.is_glass == b.is_glass:
            corner = _thick(LineString([*run_a, *run_b[-2::-1]]), min(wide_a, wide_b))
            bodies.append((corner, min(a.height_m, b.height_m), a.is_glass))
    return [body for body in bodies if glass is None or body[2] == glass]


def _hole(opening: DrawnOpening, z_m: float, *, whole: bool) -> BaseGeometry | None:
    """Return the ground that an opening leaves free at a height, if `whole` with its frame."""
    lintel_m = opening.lintel_m if whole else opening.clear_lintel_m
    if not opening.sill_m < z_m < lintel_m:
        return None
    line_m = opening.line_m if whole else opening.clear_line_m
    half_m = opening.thickness_m / 2 + opening.bow_m + DRAWN_M
    return overlays.buffer_shapes(line_m, half_m, cap_style="flat")


def _body(wall: DrawnWall) -> BaseGeometry:
    """Return the ground that a wall stands on, openings not cut."""
    if wall.end_thickness_m is None:
        return _thick(wall.line_m, wall.thickness_m)
    start, end = shapely.get_coordinates(wall.line_m)
    along = (end - start) / np.hypot(*(end - start))
    left = np.array([-along[1], along[0]])
    from_m, to_m = wall.thickness_m / 2 * left, wall.end_thickness_m / 2 * left
    return Polygon([start - from_m, end - to_m, end + to_m, start + from_m])


def _ends(wall: DrawnWall) -> list[tuple[tuple[float, ...], FloatArray, float]]:
    """Return of each end of a wall its place to the millimetre, the run to it, the thickness."""
    if wall.line_m.is_closed:
        return []
    xy = shapely.get_coordinates(wall.line_m)
    runs = [(xy[1::-1], wall.thickness_m), (xy[-2:], wall.last_thickness_m)]
    if wall.end_thickness_m is not None:
        runs = [(_last_of(run, 0.1 * wide_m), wide_m) for run, wide_m in runs]
    return [(tuple(np.round(run[-1], 3)), run, wide_m) for run, wide_m in runs]


def _last_of(run_m: FloatArray, length_m: float) -> FloatArray:
    """Return the last bit of a run: a tapering wall is as thick as at its end there alone."""
    way_m = run_m[1] - run_m[0]
    length_m = min(length_m, float(np.hypot(*way_m)))
    return np.array([run_m[1] - way_m / np.hypot(*way_m) * length_m, run_m[1]])


def _thick(line_m: LineString, thickness_m: float) -> BaseGeometry:
    return overlays.buffer_shapes(line_m, thickness_m / 2, cap_style="flat", join_style="mitre")
