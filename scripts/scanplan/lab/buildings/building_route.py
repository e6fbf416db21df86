"""The rover's way through a building: given by its file or the settings, or planned."""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.lab.buildings import truth
from scanplan.lab.buildings.building import Building
from scanplan.lab.buildings.route import KINDS, Ground, Route, plan_route
from scanplan.types import FilePath

ROVER_RADIUS_M = 0.23  # half of the thesis's 18 inch rover (section 4.2.1)
_WAYPOINTS = "simulate.site.waypoints_m"


@dataclass(frozen=True, eq=False)
class WaySettings:
    """How the rover's way is found.

    Attributes
    ----------
    route : str
        `given`: by `waypoints_m`, else the file's own way, else as `rooms`; `rooms`, `hallways`:
        see `route.plan_route`.
    clearance_m : float
        What a planned way keeps from any obstacle.
    waypoints_m : (n, 2) float or None
        Corners of the way.
    start_m : (2,) float, "random" or None
        Where a planned way begins, see `route.plan_route`.
    """

    route: str
    clearance_m: float
    waypoints_m: ArrayLike | None = None
    start_m: Any = None


def plan_building_route(
    site: Building,
    source: FilePath,
    settings: WaySettings,
    *,
    reach_m: float = 0.0,
    seed: int = 0,
) -> Building:
    """Return a building with the rover's way, and the rooms of its truth that this visits.

    Parameters
    ----------
    source : path-like
        What errors name as their origin.
    reach_m : float
        How far the sensor sits from the rover's middle, which any way keeps too.
    seed : int
        Of a random start.

    Returns
    -------
    Building

    Raises
    ------
    StageError
        If the way leads through walls or furniture, none can be planned, or it is both given and
        to be planned.
    """
    route, waypoints_m = settings.route, settings.waypoints_m
    _check_choice(site, route, waypoints_m, settings.start_m)
    way_m = site.waypoints_m if waypoints_m is None else np.array(waypoints_m, float)
    notes = site.notes
    if route != "given" or way_m is None:
        planned = plan_route(
            Ground(site.floor_m, site.obstacles_m, site.rooms),
            source,
            kind="rooms" if route == "given" else route,
            clearance_m=max(settings.clearance_m, reach_m),
            start_m=settings.start_m,
            seed=seed,
        )
        way_m = planned.waypoints_m
        notes = (*notes, _describe_route(planned, source))
    origin = source if waypoints_m is None else f"{_WAYPOINTS}: in {source}"
    check_way(way_m, site.floor_m, site.obstacles_m, origin, reach_m=reach_m)
    visited = truth.mark_visited(site.truth, way_m)
    return replace(site, waypoints_m=way_m, truth=visited, notes=notes)


def check_way(
    waypoints_m: ArrayLike,
    floor: BaseGeometry,
    obstacles: BaseGeometry,
    source: FilePath,
    *,
    reach_m: float = 0.0,
) -> None:
    """Refuse a way that leads through walls or furniture, too close to them, or off the floor.

    Parameters
    ----------
    waypoints_m : (n, 2) float
    floor, obstacles : shapely geometry
        Where there is floor; what stands on it.
    source : path-like
        What the error names as its origin.
    reach_m : float
        How far the sensor sits from the rover's middle; the way keeps this or the rover's radius
        from any obstacle.

    Raises
    ------
    StageError
        Naming the first waypoint or leg at fault.
    """
    corners_m = np.asarray(waypoints_m, float)
    for i, point in enumerate(map(Point, corners_m)):
        place = None if floor.contains(point) else "outside the outer walls"
        if obstacles.intersects(point):
            place = "inside a wall or furniture"
        if place:
            raise StageError(
                f"{source}: waypoint {i} ({point.x:g}, {point.y:g}) lies {place};"
                " move it to free floor"
            )
    clearance_m = max(ROVER_RADIUS_M, reach_m)
    for i, leg in enumerate(map(LineString, pairwise(corners_m))):
        room_m = leg.distance(obstacles)
        if room_m < clearance_m:
            at = shapely.get_coordinates(shapely.shortest_line(leg, obstacles))[0]
            raise StageError(
                f"{source}: the way from waypoint {i} to {i + 1} passes a wall or furniture at"
                f" {room_m:.2f} m near ({at[0]:.2f}, {at[1]:.2f}), the rover needs"
                f" {clearance_m:.2f} m; move the waypoints"
            )


def _check_choice(site: Building, route: str, waypoints_m: ArrayLike | None, start_m: Any) -> None:
    if route not in KINDS:
        raise ValueError(f"route {route!r} is none of {', '.join(KINDS)}")
    if waypoints_m is not None and (route != "given" or start_m is not None):
        raise StageError(
            f"{_WAYPOINTS}: they are given, and route {route} with start_m {start_m}; keep"
            " route: given and start_m: null, or leave out waypoints_m"
        )
    if route == "given" and start_m is not None and site.waypoints_m is not None:
        raise StageError(
            f"simulate.site.start_m: {start_m} is where a planned way begins, and the file gives"
            " one; set route: rooms or hallways"
        )


def _describe_route(planned: Route, source: FilePath) -> str:
    count = len(planned.reached) + len(planned.missed)
    missed = f"; cannot be reached: {', '.join(planned.missed)}" if planned.missed else ""
    return f"{source}: planned a way through {len(planned.reached)} of {count} rooms{missed}"
