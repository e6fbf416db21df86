"""The walls of the plan: paired faces with their openings, cut where nothing was seen, met at corners."""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import intersections, intervals
from scanplan.geometry.lines import Line, Span
from scanplan.plan import wall_pairs
from scanplan.plan.openings import CLOSED, OPEN, UNKNOWN, classify_gap

_JAMB_M = 0.1


@dataclass(frozen=True, eq=False)
class PlanWall(Span, wall_pairs.Sides):
    """A wall from `low_m` to `high_m` along its middle.

    Attributes
    ----------
    line : lines.Line
    low_m, high_m : float
    thickness_m : float
        NaN where one side is known; then the line is that of the face, and the wall is behind it.
    left, right : list of face_intervals.FaceInterval
        Its faces on the side of the line's normal, and on the other.
    openings, closed : list of openings.Opening
        Ways through, and pauses taken for wall; in order along it.
    """

    line: Line
    low_m: float
    high_m: float
    thickness_m: float
    left: list
    right: list
    openings: list
    closed: list


def assemble_walls(found, reading, pairing, gapping, *, planar, corner_m):
    """Make walls of stretches.

    Parameters
    ----------
    found : list of face_intervals.FaceInterval
    reading : face_profile.RaySettings
    pairing : wall_pairs.PairSettings
    gapping : openings.OpeningSettings
    planar : bool
    corner_m : float

    Returns
    -------
    list of PlanWall
        The longest first.
    """
    walls = []
    for paired in wall_pairs.pair_faces(found, pairing, reading, planar=planar):
        walls += _cut(paired, found, reading, gapping, planar)
    stacked = intersections.stack_spans(walls)
    walls = [
        _with_end_openings(w, _crossings(w, walls, stacked), reading, gapping, planar, corner_m)
        for w in walls
    ]
    stacked = intersections.stack_spans(walls)
    walls = [
        _with_closed_ends(w, _crossings(w, walls, stacked), reading, gapping, planar, corner_m)
        for w in walls
    ]
    stacked = intersections.stack_spans(walls)
    walls = [_met(wall, _crossings(wall, walls, stacked), corner_m) for wall in walls]
    stacked = intersections.stack_spans(walls)
    walls = [_beside_walls(wall, _crossings(wall, walls, stacked), gapping) for wall in walls]
    return sorted(walls, key=lambda w: (-w.length_m, *w.ends.ravel()))


def _cut(paired, found, reading, gapping, planar):
    """Return the walls that a paired wall falls into where it pauses for long and was seen neither open nor closed."""
    members = {i: np.sort(paired.line.along_m(found[i].ends)) for i in paired.members}
    pauses = intervals.find_gaps(np.array(list(members.values())))
    lines = list({id(found[i].seen): found[i].seen for i in paired.members}.values())
    judged = [
        classify_gap(paired.line, *pause, lines, reading, gapping, planar=planar)
        for pause in pauses
    ]
    breaks = [g for g in judged if g.state == UNKNOWN and g.width_m >= gapping.min_opening_m]
    breaks += _between_things(judged, np.array(list(members.values())))
    breaks.sort(key=lambda g: g.low_m)
    bounds = [-math.inf, *((g.low_m + g.high_m) / 2 for g in breaks), math.inf]
    parts = []
    for begin, end in itertools.pairwise(bounds):
        inside = {i: m for i, m in members.items() if begin < m.mean() < end}
        spans = np.array(list(inside.values()))
        of_it = [
            _between_sides(g, spans)
            for g in judged
            if begin < (g.low_m + g.high_m) / 2 < end and g not in breaks
        ]
        parts.append(
            PlanWall(
                *(paired.line, float(spans.min()), float(spans.max()), paired.thickness_m),
                *([found[i] for i in side if i in inside] for side in (paired.left, paired.right)),
                *([g for g in of_it if g.state == state] for state in (OPEN, CLOSED)),
            )
        )
    return parts


def _between_things(judged, spans_m):
    """Return the openings of what is open for longer than it is wall, unless wall is seen above them.

    An opening is a gap of a wall; a wider one than all of the wall is the space between two things.
    """
    ways = [g for g in judged if g.state == OPEN]
    unknown_m = sum(g.width_m for g in judged if g.state == UNKNOWN)
    open_m = sum(g.width_m for g in ways)
    solid_m = np.ptp(spans_m) - unknown_m - open_m
    return [g for g in ways if not g.below_wall] if open_m > solid_m else []


def _between_sides(gap, spans_m):
    """Return an opening with its jambs between where the faces of both sides end: each errs its own way."""
    if gap.state != OPEN:
        return gap
    ends_m, starts_m = spans_m[:, 1], spans_m[:, 0]
    low_m = ends_m[(ends_m <= gap.low_m) & (ends_m >= gap.low_m - _JAMB_M)].mean()
    high_m = starts_m[(starts_m >= gap.high_m) & (starts_m <= gap.high_m + _JAMB_M)].mean()
    return replace(gap, low_m=float(low_m), high_m=float(high_m))


def _with_end_openings(wall, crossed, reading, gapping, planar, corner_m):
    """Let a wall go on over an opening beside the wall that it ends at, where wall is seen above it."""
    lines = list({id(s.seen): s.seen for s in wall.members}.values())
    for name, sign in (("low_m", -1), ("high_m", 1)):
        end_m = getattr(wall, name)
        ahead = [
            (sign * (c - end_m) - other.half_m, c - sign * other.half_m) for other, c in crossed
        ]
        ahead = [
            a for a in ahead if max(corner_m, gapping.min_opening_m) < a[0] <= gapping.max_door_m
        ]
        if planar or not ahead:
            continue
        low_m, high_m = sorted((end_m, min(ahead)[1]))
        gap = classify_gap(
            wall.line, low_m, high_m, lines, reading, gapping, planar=planar, needs_lintel=True
        )
        if gap.state == OPEN:
            openings = sorted([*wall.openings, gap], key=lambda g: g.low_m)
            wall = replace(wall, **{name: float(min(ahead)[1])}, openings=openings)
    return wall


def _with_closed_ends(wall, crossed, reading, gapping, planar, corner_m):
    """Let a wall go on to the wall ahead of it through what no ray went through and nothing showed, if that is shorter.

    What stands on both sides hides it: a gap there would have let some ray pass, as in a pause of the wall.
    """
    lines = list({id(s.seen): s.seen for s in wall.members}.values())
    for name, sign in (("low_m", -1), ("high_m", 1)):
        end_m = getattr(wall, name)
        ahead = [
            (sign * (c - end_m) - other.half_m, c - sign * other.half_m, c) for other, c in crossed
        ]
        ahead = [a for a in ahead if corner_m < a[0] <= min(gapping.max_closed_m, wall.length_m)]
        if not ahead:
            continue
        _, side_m, middle_m = min(ahead)
        gap = classify_gap(
            wall.line, *sorted((end_m, side_m)), lines, reading, gapping, planar=planar
        )
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
    """Let openings begin beside the walls that cross there: a wall that ends at one goes on behind it with a way."""
    bodies = [(place_m - other.half_m, place_m + other.half_m) for other, place_m in crossed]
    openings = [_less(gap, bodies) for gap in wall.openings]
    return replace(wall, openings=[gap for gap in openings if gap.width_m >= gapping.min_opening_m])


def _less(gap, bodies_m):
    """Return what of an opening is left between walls that cross it within `_JAMB_M` of its ends."""
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
