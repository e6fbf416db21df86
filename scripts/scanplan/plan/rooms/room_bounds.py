"""What bounds a room though hardly a ray ends there: glass."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry import LineString

from scanplan.geometry import intersections, overlays
from scanplan.geometry.lines import Line
from scanplan.plan import wall_ground
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.rays import free_space

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
    grounds = [
        overlays.buffer_shapes(wall_ground.opening_polygon(wall, opening, unpaired_m), END_M)
        for wall in walls
        for opening in wall.openings
    ]
    open_m2 = overlays.unite_areas(grounds)
    shapely.prepare(open_m2)
    stacked = intersections.stack_spans(walls)
    extended = (_extend(*span, walls, stacked) for span in spans)
    panes = [PlanWall(*span, math.nan, [], []) for span in extended]
    found: dict[int, list[PlanWall]] = {}
    # several lines show one pane, or each another part of it; rounding does not choose among them
    for row in sorted(range(len(panes)), key=lambda row: (-round(panes[row].length_m, 3), row)):
        pane = panes[row]
        if not open_m2.covers(shapely.Point(pane.ends.mean(axis=0))):
            known = [other for parts in found.values() for other in parts]
            parts = _cut_known(pane, known, unpaired_m)
            found[row] = [part for part in parts if part.length_m >= min_length_m]
    return [part for row in sorted(found) for part in found[row]]


def _cut_known(pane: PlanWall, known: Sequence[PlanWall], unpaired_m: float) -> list[PlanWall]:
    """Return the parts of a pane that no known collinear pane covers."""
    along = [other for other in known if pane.goes_on_as(other)]
    if not along:
        return [pane]
    # wider by what lines err, and no longer: panes may meet at a mullion
    inner = [replace(p, low_m=p.low_m + END_M, high_m=p.high_m - END_M) for p in along]
    strips = wall_ground.wall_strips(inner, unpaired_m)
    ground = overlays.unite_areas(
        [overlays.buffer_shapes(strip, END_M, join_style="mitre") for strip in strips]
    )
    rest = overlays.subtract_lines(LineString(pane.ends), ground)
    if rest.length >= pane.length_m - free_space.GRID_M:
        return [pane]
    parts = shapely.get_parts(rest)
    spans_m = [np.sort(pane.line.along_m(shapely.get_coordinates(part))) for part in parts]
    return [replace(pane, low_m=float(m[0]), high_m=float(m[-1])) for m in spans_m if len(m)]


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
