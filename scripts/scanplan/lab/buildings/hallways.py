"""Which rooms of a floor are hallways."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings.tolerances import ROOM_M

_HALL_WIDTH_M = 3.5  # ASSUME a hallway is no wider; those of ring_office have 3.2 m
_HALL_ASPECT = 4.0  # ASSUME a hallway is this many times as long as wide

Rooms = Sequence[tuple[str, Polygon]]
"""Name and floor of each."""


def find_hallways(rooms: Rooms) -> list[tuple[str, Polygon]]:
    """Return the corridor-like rooms: those shaped as `plan_route` states."""
    return [(name, room) for name, room in rooms if _is_hallway(room)]


def join_hallways(halls: Rooms) -> BaseGeometry:
    """Return the largest area of hallways that meet; what lies between two joins them."""
    union = overlays.unite_areas([hall for _, hall in halls])
    joined = overlays.buffer_shapes(union, ROOM_M, join_style="mitre")
    return max(shapely.get_parts(joined), key=lambda part: part.area, default=Polygon())


def _is_hallway(room: Polygon) -> bool:
    """Return whether the rectangle of the same area and perimeter is that of a hallway.

    Of a ring the perimeter counts both sides.
    """
    half_m = room.length / 2
    width_m = (half_m - np.sqrt(max(half_m**2 - 4 * room.area, 0.0))) / 2
    return 0 < width_m <= _HALL_WIDTH_M and half_m - width_m >= _HALL_ASPECT * width_m
