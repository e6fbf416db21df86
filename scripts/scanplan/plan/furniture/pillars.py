"""Pillars at the ends of walls: what stands free beside an opening that is none of a wall."""

from collections.abc import Callable, Sequence

import numpy as np

from scanplan.geometry import intersections
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M


def cut_off_pillars(
    walls: Sequence[PlanWall],
    glass_walls: Sequence[PlanWall],
    classify: Callable[..., Opening],
    *,
    min_width_m: float,
    max_thickness_m: float,
) -> list[list[PlanWall]]:
    """Return the parts of each wall beside pillars at its ends.

    What ends free behind an opening, and goes on no farther than walls are thick, is a pillar: no
    wall or glass meets it, and rays go by beyond it as well. The opening is the space beside it,
    unless wall is seen above.

    Parameters
    ----------
    walls, glass_walls : sequence of plan_wall.PlanWall
    classify : callable
        `openings.classify_gap` of a line, a stretch of it and its faces.
    min_width_m : float
        Of an opening.
    max_thickness_m : float
        Of a wall.
    """
    stacked = intersections.stack_spans([*walls, *glass_walls])

    def ends_free(wall: PlanWall, end_m: float, sign: int) -> bool:
        low_m, high_m = sorted([end_m, end_m + sign * min_width_m])
        return classify(wall.line, low_m, high_m, wall.observations).state == OPEN

    def leads_to_pillar(
        wall: PlanWall, opening: Opening, met_m: Sequence[float], sign: int
    ) -> bool:
        jamb_m = opening.high_m if sign > 0 else opening.low_m
        end_m = wall.high_m if sign > 0 else wall.low_m
        first_m, last_m = sorted([jamb_m, end_m + sign * CORNER_M])
        is_met = any(first_m <= place_m <= last_m for place_m in met_m)
        is_short = abs(end_m - jamb_m) <= max_thickness_m
        return is_short and not is_met and ends_free(wall, end_m, sign)

    parts = []
    for wall in walls:
        crossed_m = wall.find_crossings(stacked).place_m
        met_m = [*crossed_m.tolist(), *_ends_on_line(wall, glass_walls)]
        beside = [
            opening
            for opening in wall.openings
            if not opening.below_wall
            and any(leads_to_pillar(wall, opening, met_m, sign) for sign in (-1, 1))
        ]
        parts.append(wall.part_beside(beside))
    return parts


def _ends_on_line(wall: PlanWall, others: Sequence[PlanWall]) -> list[float]:
    """Return where along a wall others end on its line: glass goes on there."""
    ends_m = np.array([other.ends for other in others]).reshape(-1, 2)
    is_on = np.abs(wall.line.offset_m(ends_m)) <= CORNER_M
    return wall.line.along_m(ends_m[is_on]).tolist()
