"""Which openings of walls are drawn, once it is known what lies on both sides of them."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from scanplan.plan.model import line_labels, priors
from scanplan.plan.openings import Opening
from scanplan.plan.plan_wall import Nearly, PlanWall
from scanplan.plan.rooms.room import Room, rooms_beside
from scanplan.plan.tolerances import END_M

_LIKELY = 0.5  # what is less likely is not drawn


def settle_openings(
    wall: PlanWall, rooms: Sequence[Room], max_door_m: float
) -> tuple[list[PlanWall], list[Nearly]]:
    """Return what is left of a wall, with its openings that are likelier than not, and the others.

    Where one down to the floor is none, nothing is known to be: the wall ends before it, and
    another begins behind it. What is of no kind, or wider than a door, stays as it is; so do curved
    walls, whose openings are found with their circle, and all where no room is known.
    """
    if wall.bend or not rooms:
        return [wall], []
    openings: list[Opening] = []
    ways: list[Opening] = []
    nearly: list[Nearly] = []
    for opening in wall.openings:
        if opening.type_name(max_door_m) not in priors.LEAST_USUAL_M:
            openings.append(opening)
            continue
        p = _weigh(opening, wall, rooms)
        if p >= _LIKELY:
            openings.append(replace(opening, p_kind=p))
            continue
        if not opening.is_above_wall:
            ways.append(opening)
        if p >= line_labels.NEARLY:
            ends_m = wall.at(np.array([opening.low_m, opening.high_m]))
            nearly.append(Nearly(opening.kind, ends_m, p))
    parts = replace(wall, openings=openings).part_beside(ways)
    return [part for part in parts if not ways or part.length_m >= END_M], nearly


def _weigh(opening: Opening, wall: PlanWall, rooms: Sequence[Room]) -> float:
    """Return how likely an opening is one of its kind, by its width, wall, and what it leads to."""
    beside = rooms_beside(rooms, wall.at((opening.low_m + opening.high_m) / 2), wall)
    log_odds = priors.weigh_opening(
        opening.kind, opening.p_kind, opening.width_m, beside, wall.p_wall
    )
    return 1 / (1 + math.exp(-log_odds))
