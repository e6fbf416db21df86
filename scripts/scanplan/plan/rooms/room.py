"""A room of the plan, and which rooms are beside a wall."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.plan.plan_wall import PlanWall
from scanplan.types import FloatArray

CLOSED_SHARE = 0.9
"""Of an outline along walls: corners and short gaps leave a tenth."""
_BESIDE_WALL_M = np.array([0.15, 0.3, 0.5])  # what stands at a wall may hide the nearest floor


@dataclass(frozen=True)
class RoomSettings:
    """What a room is.

    Attributes
    ----------
    min_area_m2 : float, > 0
    min_walled : float, 0 to 1
        A part of the floor that no sensor was in is a room only if so much of its outline runs
        along walls and openings,
    min_width_m : float
        and if it is wider than this somewhere: a wall may be as thick.
    """

    min_area_m2: float
    min_walled: float
    min_width_m: float


@dataclass(frozen=True, eq=False)
class Room:
    """A room of the plan.

    Attributes
    ----------
    polygon : shapely.Polygon
    walled : float
        Share of its outline that runs along walls and openings.
    entered : bool
        Whether a sensor was in it.
    n_scans : int
        How many of the chosen scans saw a part of its floor.
    p_whole, p_apart : float
        Probability that no part of it is a room of its own, and that none beside it is one with
        it, by the lines that may part floor. NaN: not weighed.
    """

    polygon: Polygon
    walled: float
    entered: bool
    n_scans: int
    p_whole: float = math.nan
    p_apart: float = math.nan

    @property
    def closed(self) -> bool:
        """Whether walls and openings enclose it, all but a tenth of its outline."""
        return self.walled >= CLOSED_SHARE


def rooms_beside(rooms: Sequence[Room], place_m: FloatArray, wall: PlanWall) -> tuple[int, int]:
    """Return the rooms (indices, -1: none) on the left and right of a place (2,) in a wall."""
    away = np.outer(wall.half_m + _BESIDE_WALL_M, wall.normal_at(place_m))
    return _first_room(rooms, place_m + away), _first_room(rooms, place_m - away)


def _first_room(rooms: Sequence[Room], places_m: FloatArray) -> int:
    """Return the room that the first of places (n, 2) in any room is in; -1 for none."""
    for place in np.asarray(shapely.points(places_m), object):
        for number, room in enumerate(rooms):
            if room.polygon.covers(place):
                return number
    return -1
