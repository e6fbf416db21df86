"""The order in which a person walks through what is to be verified on site."""

from collections.abc import Sequence

import numpy as np

from scanplan.geometry.tour import shortest_tour
from scanplan.types import FloatArray
from scanplan.validation.doubts import Doubt

Rooms = list[tuple[str, list[Doubt]]]


def order_rooms(rooms: Sequence[tuple[str, list[Doubt]]], start_m: FloatArray) -> Rooms:
    """Return doubts by room along a short way from a place (2,), as the crow flies.

    Parameters
    ----------
    rooms : sequence of (str, list of doubts.Doubt)
        As `doubts.group_by_room` returns them.
    """
    middles_m = [np.mean([doubt.place_m for doubt in found], axis=0) for _, found in rooms]
    places_m = np.array([start_m, *middles_m])
    apart_m = np.linalg.norm(places_m[:, None] - places_m, axis=2)
    return [rooms[place - 1] for place in shortest_tour(apart_m, closed=False, first=0)[1:]]
