"""Glass between walls: what bounds a room though hardly a ray ends there."""

import math

import numpy as np
import shapely

from scanplan.geometry import intersections
from scanplan.plan.wall_pairs import PlanWall
from scanplan.rays import free_space

_NEAR_M = 0.1  # what registration and a line's fit may be wrong by together, twice over
_REACH_M = 0.3  # a wall that ends this near before a pane's line meets it: half of a thick wall
_FRAME_M = 0.8  # frame, reveal and the part of a pane seen at grazing angles only


def find_glass_walls(walls, spans, *, min_length_m, unpaired_m):
    """Return panes as walls that nothing shows, drawn on to the walls beside them.

    Openings of walls are none.

    Rays that graze a frame or a deep reveal, or that furniture stops, leave the ends of a pane
    untold.

    Parameters
    ----------
    walls : list of walls.PlanWall
    spans : list of (lines.Line, float, float)
        From where to where along a line there is glass.
    min_length_m : float
        Shorter panes bound nothing.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.

    Returns
    -------
    list of walls.PlanWall
        Without any faces.
    """
    ways = [
        free_space.opening_polygon(w, g, unpaired_m).buffer(_NEAR_M)
        for w in walls
        for g in w.openings
    ]
    open_m2 = shapely.union_all(ways)
    stacked = intersections.stack_spans(walls)
    panes = [
        PlanWall(*_drawn_on(*span, walls, stacked), math.nan, [], [], [], []) for span in spans
    ]
    shapely.prepare(open_m2)
    return [
        p
        for p in panes
        if p.length_m >= min_length_m and not open_m2.covers(shapely.Point(p.ends.mean(axis=0)))
    ]


def _drawn_on(line, low_m, high_m, walls, stacked):
    """Return a span with its ends moved to the nearest walls on or across its line."""
    places_m = [intersections.find_crossings(line, stacked, reach_m=_REACH_M).place_m]
    places_m += [
        line.along_m(w.ends)[np.abs(line.offset_m(w.ends)) <= w.half_m + _NEAR_M] for w in walls
    ]
    places_m = np.concatenate(places_m)
    before_m = places_m[(places_m <= low_m) & (places_m >= low_m - _FRAME_M)]
    after_m = places_m[(places_m >= high_m) & (places_m <= high_m + _FRAME_M)]
    low_m, high_m = max(before_m, default=low_m), min(after_m, default=high_m)
    return line, float(low_m), float(high_m)
