"""Glass between walls: what bounds a room though hardly a ray ends there."""

import math
from collections.abc import Sequence

import numpy as np
import shapely

from scanplan.geometry import intersections
from scanplan.geometry.lines import Line
from scanplan.plan import wall_ground
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M

_FRAME_M = 0.8  # frame, reveal and the part of a pane seen at grazing angles only


def find_glass_walls(
    walls: Sequence[PlanWall],
    spans: Sequence[tuple[Line, float, float]],
    *,
    min_length_m: float,
    unpaired_m: float,
) -> list[PlanWall]:
    """Return panes that are no openings of walls as walls without faces, up to the walls beside.

    Rays that graze a frame or a deep reveal, or that furniture stops, leave the ends of a pane
    unknown.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    spans : list of (lines.Line, float, float)
        From where to where along a line there is glass.
    min_length_m : float
        Shorter panes bound nothing.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    """
    ways = [(wall, opening) for wall in walls for opening in wall.openings]
    grounds = [wall_ground.opening_polygon(*way, unpaired_m).buffer(END_M) for way in ways]
    open_m2 = shapely.union_all(grounds)
    shapely.prepare(open_m2)
    stacked = intersections.stack_spans(walls)
    extended = (_extend(*span, walls, stacked) for span in spans)
    panes = [PlanWall(*span, math.nan, [], []) for span in extended]
    return [
        pane
        for pane in panes
        if pane.length_m >= min_length_m
        and not open_m2.covers(shapely.Point(pane.ends.mean(axis=0)))
    ]


def _extend(
    line: Line,
    low_m: float,
    high_m: float,
    walls: Sequence[PlanWall],
    stacked: intersections.SpanArrays,
) -> tuple[Line, float, float]:
    """Return a span with its ends moved to the nearest walls on or across its line."""
    places_m = [intersections.find_crossings(line, stacked, reach_m=CORNER_M).place_m]
    for wall in walls:
        is_on = np.abs(line.offset_m(wall.ends)) <= wall.half_m + END_M
        places_m.append(line.along_m(wall.ends)[is_on])
    place_m = np.concatenate(places_m)
    before_m = place_m[(place_m <= low_m) & (place_m >= low_m - _FRAME_M)]
    after_m = place_m[(place_m >= high_m) & (place_m <= high_m + _FRAME_M)]
    first_m = float(before_m.max()) if len(before_m) else float(low_m)
    last_m = float(after_m.min()) if len(after_m) else float(high_m)
    return line, first_m, last_m
