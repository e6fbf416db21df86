"""Which openings of walls are drawn, once it is known what lies on both sides of them."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from scanplan.plan.model import priors
from scanplan.plan.openings import Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms.room import Room, rooms_beside
from scanplan.plan.tolerances import END_M

_LIKELY = 0.5  # what is less likely is not drawn


def settle_openings(wall: PlanWall, rooms: Sequence[Room], max_door_m: float) -> Iterator[PlanWall]:
    """Yield what is left of a wall, with those of its openings that are likelier than not.

    Where one down to the floor is none, nothing is known to be: the wall ends before it, and
    another begins behind it. What is of no kind, or wider than a door, stays as it is.
    """
    openings: list[Opening] = []
    ways: list[Opening] = []
    for opening in wall.openings:
        if opening.type_name(max_door_m) not in priors.LEAST_USUAL_M:
            openings.append(opening)
        elif (p := _weigh(opening, wall, rooms)) >= _LIKELY:
            openings.append(replace(opening, p_kind=p))
        elif not opening.is_above_wall:
            ways.append(opening)
    return _part(replace(wall, openings=openings), ways)


def _part(wall: PlanWall, ways: Sequence[Opening]) -> Iterator[PlanWall]:
    """Yield what is left of a wall before, between and behind ways."""
    if not ways:
        yield wall
        return
    spans_m = [(of.low_m, of.high_m) for of in ways]
    for (_, begin_m), (end_m, _) in pairwise(
        [(wall.low_m, wall.low_m), *spans_m, (wall.high_m, wall.high_m)]
    ):
        part = wall.between(begin_m, end_m)
        if end_m - begin_m >= END_M and part.members:
            yield part


def _weigh(opening: Opening, wall: PlanWall, rooms: Sequence[Room]) -> float:
    """Return how likely an opening is one of its kind, by its width and what it leads to."""
    beside = rooms_beside(rooms, wall.at((opening.low_m + opening.high_m) / 2), wall)
    log_odds = priors.weigh_opening(opening.kind, opening.p_kind, opening.width_m, beside)
    return 1 / (1 + math.exp(-log_odds))
