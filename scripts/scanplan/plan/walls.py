"""The walls of the plan.

Paired faces with their openings, cut where nothing was seen, met at corners.
"""

import itertools
import math
from dataclasses import replace

import numpy as np

from scanplan.geometry import intersections
from scanplan.plan import wall_pairs
from scanplan.plan.openings import CLOSED, OPEN, UNKNOWN, classify_gap, find_gaps

_JAMB_M = 0.1


def assemble_walls(found, reading, pairing, gapping, *, corner_m):
    """Make walls of stretches.

    Parameters
    ----------
    found : list of intervals.FaceInterval
    reading : face_observation.RaySettings
    pairing : wall_pairs.PairSettings
    gapping : openings.OpeningSettings
    corner_m : float

    Returns
    -------
    list of PlanWall
        The longest first.
    """
    walls = []
    for paired in wall_pairs.pair_faces(found, pairing, reading):
        walls += _cut(paired, reading, gapping)
    stacked = intersections.stack_spans(walls)
    walls = [
        _with_end_openings(w, _crossings(w, walls, stacked), reading, gapping, corner_m)
        for w in walls
    ]
    stacked = intersections.stack_spans(walls)
    walls = [
        _with_closed_ends(w, _crossings(w, walls, stacked), reading, gapping, corner_m)
        for w in walls
    ]
    stacked = intersections.stack_spans(walls)
    walls = [_met(wall, _crossings(wall, walls, stacked), corner_m) for wall in walls]
    stacked = intersections.stack_spans(walls)
    walls = [_beside_walls(wall, _crossings(wall, walls, stacked), gapping) for wall in walls]
    return sorted(walls, key=lambda w: (-w.length_m, *w.ends.ravel()))


def _cut(wall, reading, gapping):
    """Return the parts of a wall between long pauses that are neither open nor closed."""
    spans_m = np.array([np.sort(wall.line.along_m(face.ends)) for face in wall.members])
    gaps = [
        classify_gap(wall.line, *gap, wall.lines, reading, gapping) for gap in find_gaps(spans_m)
    ]
    breaks = [g for g in gaps if g.state == UNKNOWN and g.width_m >= gapping.min_opening_m]
    breaks += _between_things(gaps, spans_m)
    breaks.sort(key=lambda g: g.low_m)
    bounds = [-math.inf, *((g.low_m + g.high_m) / 2 for g in breaks), math.inf]
    return [
        _part(wall, spans_m, [g for g in gaps if g not in breaks], begin_m, end_m)
        for begin_m, end_m in itertools.pairwise(bounds)
    ]


def _part(wall, spans_m, gaps, begin_m, end_m):
    """Return what of a wall lies between two places, with those of its gaps that do."""
    middle_m = spans_m.mean(axis=1)
    is_inside = (begin_m < middle_m) & (middle_m < end_m)
    inside = {id(face) for face, chosen in zip(wall.members, is_inside, strict=True) if chosen}
    of_part = spans_m[is_inside]
    gaps = [_between_sides(g, of_part) for g in gaps if begin_m < (g.low_m + g.high_m) / 2 < end_m]
    return replace(
        wall,
        low_m=float(of_part.min()),
        high_m=float(of_part.max()),
        left=[face for face in wall.left if id(face) in inside],
        right=[face for face in wall.right if id(face) in inside],
        openings=[g for g in gaps if g.state == OPEN],
        closed=[g for g in gaps if g.state == CLOSED],
    )


def _between_things(judged, spans_m):
    """Return the openings of what is open for longer than it is wall.

    An opening is a gap of a wall; a wider one than all of the wall is the space between two things.
    """
    ways = [g for g in judged if g.state == OPEN]
    unknown_m = sum(g.width_m for g in judged if g.state == UNKNOWN)
    open_m = sum(g.width_m for g in ways)
    solid_m = np.ptp(spans_m) - unknown_m - open_m
    return [g for g in ways if not g.below_wall] if open_m > solid_m else []


def _between_sides(gap, spans_m):
    """Return an opening with its jambs between where the faces of both sides end.

    Each errs its own way.
    """
    if gap.state != OPEN:
        return gap
    ends_m, starts_m = spans_m[:, 1], spans_m[:, 0]
    low_m = ends_m[(ends_m <= gap.low_m) & (ends_m >= gap.low_m - _JAMB_M)].mean()
    high_m = starts_m[(starts_m >= gap.high_m) & (starts_m <= gap.high_m + _JAMB_M)].mean()
    return replace(gap, low_m=float(low_m), high_m=float(high_m))


def _with_end_openings(wall, crossed, reading, gapping, corner_m):
    """Let a wall go on over an opening, under a lintel, to the wall that it ends at."""
    lines = wall.lines
    for name, sign in (("low_m", -1), ("high_m", 1)):
        end_m = getattr(wall, name)
        ahead = [
            (sign * (c - end_m) - other.half_m, c - sign * other.half_m) for other, c in crossed
        ]
        ahead = [
            a for a in ahead if max(corner_m, gapping.min_opening_m) < a[0] <= gapping.max_door_m
        ]
        if not ahead or lines[0].planar:
            continue
        low_m, high_m = sorted((end_m, min(ahead)[1]))
        gap = classify_gap(wall.line, low_m, high_m, lines, reading, gapping, needs_lintel=True)
        if gap.state == OPEN:
            openings = sorted([*wall.openings, gap], key=lambda g: g.low_m)
            wall = replace(wall, **{name: float(min(ahead)[1])}, openings=openings)
    return wall


def _with_closed_ends(wall, crossed, reading, gapping, corner_m):
    """Let a wall go on to the wall ahead through what no ray went through or showed.

    What stands on both sides hides it: a gap there would have let some ray pass, as in a pause of
    the wall.
    """
    lines = wall.lines
    for name, sign in (("low_m", -1), ("high_m", 1)):
        end_m = getattr(wall, name)
        ahead = [
            (sign * (c - end_m) - other.half_m, c - sign * other.half_m, c) for other, c in crossed
        ]
        ahead = [a for a in ahead if corner_m < a[0] <= min(gapping.max_closed_m, wall.length_m)]
        if not ahead:
            continue
        _, side_m, middle_m = min(ahead)
        gap = classify_gap(wall.line, *sorted((end_m, side_m)), lines, reading, gapping)
        if gap.state == CLOSED and gap.n_rays == 0:
            closed = sorted([*wall.closed, gap], key=lambda g: g.low_m)
            wall = replace(wall, **{name: float(middle_m)}, closed=closed)
    return wall


def _met(wall, crossed, corner_m):
    """Move the ends of a wall to the middles of walls that it meets there."""
    moved = {}
    for name in ("low_m", "high_m"):
        end_m = getattr(wall, name)
        near = [c for other, c in crossed if abs(c - end_m) <= corner_m + other.half_m]
        moved[name] = min(near, key=lambda c: (abs(c - end_m), c), default=end_m)
    return replace(wall, **moved) if moved["high_m"] - moved["low_m"] > wall.length_m / 2 else wall


def _beside_walls(wall, crossed, gapping):
    """Let openings begin beside the walls that cross there.

    A wall that ends at one goes on behind it with a way.
    """
    bodies = [(place_m - other.half_m, place_m + other.half_m) for other, place_m in crossed]
    openings = [_less(gap, bodies) for gap in wall.openings]
    return replace(wall, openings=[gap for gap in openings if gap.width_m >= gapping.min_opening_m])


def _less(gap, bodies_m):
    """Return what of an opening is left between walls that cross it near its ends."""
    low_m, high_m = gap.low_m, gap.high_m
    for begin_m, end_m in bodies_m:
        if begin_m - _JAMB_M <= gap.low_m <= end_m:
            low_m = max(low_m, end_m)
        if begin_m <= gap.high_m <= end_m + _JAMB_M:
            high_m = min(high_m, begin_m)
    return replace(gap, low_m=float(low_m), high_m=float(high_m))


def _crossings(wall, walls, stacked):
    """Return (other wall, where along this one its middle crosses) of walls that are there."""
    found = intersections.find_crossings(
        wall.line, stacked, reach_m=wall.half_m + wall_pairs.CORNER_M
    )
    return [
        (walls[i], place_m)
        for i, place_m in zip(found.which.tolist(), found.place_m.tolist(), strict=True)
    ]
