"""How far walls go on beyond their faces: doors stand at the ends of walls, too."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from scanplan.geometry import intersections
from scanplan.plan.model.line_labels import Stretch
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.types import FloatArray

_OPENINGS = ("door", "shut", "glass", "window")


def lengthen_walls(walls: Sequence[PlanWall], most_m: float) -> list[PlanWall]:
    """Return walls that go on to the next one across their way, or in it; of two one goes on.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    most_m : float
        Of a door, which is all that may be beyond a wall's faces.
    """
    spans = intersections.stack_spans(walls)
    ends_m = np.array([wall.ends for wall in walls]).reshape(-1, 2, 2)
    return [_lengthen(number, walls, spans, ends_m, most_m) for number in range(len(walls))]


def find_corridors(walls: Sequence[PlanWall]) -> list[FloatArray]:
    """Return from where to where others that run on cross each wall, (n, 2), with their corners."""
    spans = intersections.stack_spans(walls)
    return [_find_crossed(wall, walls, spans) for wall in walls]


def find_facades(walls: Sequence[PlanWall]) -> list[FloatArray]:
    """Return the places along each wall where its end goes through one to where nobody was."""
    spans = intersections.stack_spans(walls)
    return [_find_facades(wall, walls, spans) for wall in walls]


def end_where_seen(stretches: Sequence[Stretch], low_m: float, high_m: float) -> list[Stretch]:
    """Return stretches of a wall that was lengthened, beyond its faces none but openings.

    Parameters
    ----------
    stretches : sequence of line_labels.Stretch
    low_m, high_m : float
        From where to where it has faces.
    """
    middles_m = [_middle_m(stretch) for stretch in stretches if stretch.kind in _OPENINGS]
    begin_m = low_m if not any(middle_m < low_m for middle_m in middles_m) else -np.inf
    end_m = high_m if not any(middle_m > high_m for middle_m in middles_m) else np.inf
    cut = [replace(s, low_m=max(s.low_m, begin_m), high_m=min(s.high_m, end_m)) for s in stretches]
    return [stretch for stretch in cut if stretch.high_m > stretch.low_m]


def _middle_m(stretch: Stretch) -> float:
    return (stretch.low_m + stretch.high_m) / 2


def _find_crossed(
    wall: PlanWall, walls: Sequence[PlanWall], spans: intersections.SpanArrays
) -> FloatArray:
    found = wall.find_crossings(spans)
    crossed_m = []
    for row, place_m, sine in zip(found.which, found.place_m, found.sine, strict=True):
        if walls[row].runs_through(wall, float(place_m)):
            reach_m = walls[row].half_m / sine + CORNER_M
            crossed_m.append((place_m - reach_m, place_m + reach_m))
    return np.array(crossed_m).reshape(-1, 2)


def _find_facades(
    wall: PlanWall, walls: Sequence[PlanWall], spans: intersections.SpanArrays
) -> FloatArray:
    found = wall.find_crossings(spans)
    places_m = [
        place_m
        for row, place_m in zip(found.which.tolist(), found.place_m.tolist(), strict=True)
        if not walls[row].right and _ends_behind(wall, walls[row], place_m)
    ]
    return np.sort(np.array(places_m, float))


def _ends_behind(wall: PlanWall, facade: PlanWall, place_m: float) -> bool:
    """Return whether a wall's shorter part goes on behind one that runs through it."""
    to_low_m, to_high_m = place_m - wall.low_m, wall.high_m - place_m
    end_m = wall.line.at(wall.low_m if to_low_m < to_high_m else wall.high_m)
    is_behind = float(facade.line.offset_m(end_m)) < 0
    return is_behind and min(to_low_m, to_high_m) > END_M and facade.runs_through(wall, place_m)


def _lengthen(
    number: int,
    walls: Sequence[PlanWall],
    spans: intersections.SpanArrays,
    ends_m: FloatArray,
    most_m: float,
) -> PlanWall:
    wall = walls[number]
    crossings = wall.find_crossings(spans)
    half_m = np.array([walls[row].half_m for row in crossings.which]) / crossings.sine
    later = slice(number + 1, None)
    goes_on = wall.are_in_line(spans.normal[later], ends_m[later])
    ahead_m = wall.line.along_m(ends_m[later][goes_on]).reshape(-1)
    near_m = np.concatenate([crossings.place_m - half_m, crossings.place_m + half_m, ahead_m])

    def go_on(end_m: float, sign: int) -> float:
        if (np.abs(crossings.place_m - end_m) <= half_m + CORNER_M).any():
            return end_m
        beyond_m = sign * (near_m - end_m)
        beyond_m = beyond_m[(beyond_m > 0) & (beyond_m <= most_m)]
        return end_m + sign * float(beyond_m.min(initial=np.inf)) if len(beyond_m) else end_m

    return replace(wall, low_m=go_on(wall.low_m, -1), high_m=go_on(wall.high_m, 1))
