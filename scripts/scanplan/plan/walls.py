"""The walls of the plan: paired faces with openings, cut where nothing was seen, met at corners."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import intersections
from scanplan.geometry.intervals import find_gaps
from scanplan.plan import wall_pairs
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import (
    CLOSED,
    OPEN,
    UNKNOWN,
    Opening,
    OpeningSettings,
    classify_gap,
)
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.plan.wall_pairs import PairSettings
from scanplan.types import FloatArray

Crossing = tuple[PlanWall, float]
"""Another wall, and where along this one its middle crosses."""


def assemble_walls(
    faces: Sequence[FaceInterval],
    pairing: PairSettings,
    opening: OpeningSettings,
    *,
    corner_m: float,
) -> list[PlanWall]:
    """Make walls of faces.

    1. Faces are paired, and a wall is cut at gaps in which nothing was seen.
    2. A wall goes on over an opening beside the wall that it ends at, and then
    3. through what is hidden there; both before ends move, as they need the gap between.
    4. Ends move to the middles of the walls that they meet.
    5. Openings end beside the walls that cross there, which step 4 has brought into place.
    6. What is open from one wall that runs on there to another is a corridor that crosses.

    Parameters
    ----------
    faces : list of intervals.FaceInterval
    pairing : wall_pairs.PairSettings
    opening : openings.OpeningSettings
    corner_m : float
        Ends no farther from a wall meet it.

    Returns
    -------
    list of plan_wall.PlanWall
        The longest first.
    """
    paired = wall_pairs.pair_faces(faces, pairing, door_height_m=opening.door_height_m)
    assembly = _Assembly(opening, corner_m)
    walls = [part for wall in paired for part in assembly.cut(wall)]
    for change in (
        assembly.extend_over_openings,
        assembly.extend_through_hidden,
        assembly.meet_walls,
        assembly.trim_openings,
    ):
        walls = [change(wall, crossings) for wall, crossings in _with_crossings(walls)]
    crossed = _with_crossings(walls)
    walls = [part for wall, crossings in crossed for part in _cut_at_corridors(wall, crossings)]
    return sorted(walls, key=lambda w: (-w.length_m, *w.ends.ravel()))


@dataclass(frozen=True)
class _Assembly:
    """The steps of `assemble_walls`, each of one wall, given those that cross it."""

    settings: OpeningSettings
    corner_m: float

    def cut(self, wall: PlanWall) -> list[PlanWall]:
        """Return the parts of a wall between long gaps that are neither open nor closed."""
        spans_m = np.array([np.sort(wall.line.along_m(face.ends)) for face in wall.members])
        gaps = [self._classify(wall, low_m, high_m) for low_m, high_m in find_gaps(spans_m)]
        least_m = self.settings.min_opening_m
        breaks = [g for g in gaps if g.state == UNKNOWN and g.width_m >= least_m]
        breaks += _openings_between_things(gaps, spans_m)
        places_m = sorted((g.low_m + g.high_m) / 2 for g in breaks)
        rest = [g for g in gaps if g not in breaks]
        bounds = itertools.pairwise([-math.inf, *places_m, math.inf])
        return [_part(wall, spans_m, rest, begin_m, end_m) for begin_m, end_m in bounds]

    def extend_over_openings(self, wall: PlanWall, crossings: Sequence[Crossing]) -> PlanWall:
        """Let a wall go on over an opening, under a lintel, to the wall that it ends at."""
        least_m = max(self.corner_m, self.settings.min_opening_m)
        for name, sign in (("low_m", -1), ("high_m", 1)):
            end_m = getattr(wall, name)
            ahead = [
                side_m
                for gap_m, side_m, _ in _ahead(crossings, end_m, sign)
                if least_m < gap_m <= self.settings.max_door_m
            ]
            if not ahead:
                continue
            low_m, high_m = sorted((end_m, ahead[0]))
            gap = self._classify(wall, low_m, high_m, needs_lintel=True)
            if gap.state == OPEN:
                openings = sorted([*wall.openings, gap], key=lambda g: g.low_m)
                wall = replace(wall, **{name: float(ahead[0]), "openings": openings})
        return wall

    def extend_through_hidden(self, wall: PlanWall, crossings: Sequence[Crossing]) -> PlanWall:
        """Extend a wall to the next crossing wall across an unobserved gap.

        What stands on both sides hides it: a gap there would have let some ray pass, as in a gap of
        the wall. It goes on no farther than it is long.
        """
        for name, sign in (("low_m", -1), ("high_m", 1)):
            end_m = getattr(wall, name)
            most_m = min(self.settings.max_closed_m, wall.length_m)
            ahead = [a for a in _ahead(crossings, end_m, sign) if self.corner_m < a[0] <= most_m]
            if not ahead:
                continue
            _, side_m, middle_m = ahead[0]
            gap = self._classify(wall, *sorted((end_m, side_m)))
            if gap.state == CLOSED and gap.n_rays == 0:
                closed = sorted([*wall.closed, gap], key=lambda g: g.low_m)
                wall = replace(wall, **{name: float(middle_m), "closed": closed})
        return wall

    def meet_walls(self, wall: PlanWall, crossings: Sequence[Crossing]) -> PlanWall:
        """Move the ends of a wall to the middles of walls that it meets there."""
        moved = {}
        for name in ("low_m", "high_m"):
            end_m = getattr(wall, name)
            near = [m for other, m in crossings if abs(m - end_m) <= self.corner_m + other.half_m]
            moved[name] = min(near, key=lambda m: (abs(m - end_m), m), default=end_m)
        is_long = moved["high_m"] - moved["low_m"] > wall.length_m / 2
        return replace(wall, **moved) if is_long else wall

    def trim_openings(self, wall: PlanWall, crossings: Sequence[Crossing]) -> PlanWall:
        """Let openings begin beside the walls that cross there, and none go on across a wall."""
        bodies_m = [
            (place_m - other.half_m, place_m + other.half_m) for other, place_m in crossings
        ]
        # what is no longer than a door is wide may be its leaf
        is_wall = [other.length_m > self.settings.max_door_m for other, _ in crossings]
        across_m = list(itertools.compress(bodies_m, is_wall))
        gaps = list(wall.closed)
        for opening in wall.openings:
            trimmed = _trim(opening, bodies_m)
            parts = _split(trimmed, across_m)
            if len(parts) > 1:
                parts = [self._classify(wall, part.low_m, part.high_m) for part in parts]
            gaps += [part for part in parts if part.width_m >= self.settings.min_opening_m]
        gaps.sort(key=lambda g: g.low_m)
        return replace(
            wall,
            openings=[g for g in gaps if g.state == OPEN],
            closed=[g for g in gaps if g.state == CLOSED],
        )

    def _classify(
        self, wall: PlanWall, low_m: float, high_m: float, *, needs_lintel: bool = False
    ) -> Opening:
        return classify_gap(
            wall.line,
            low_m,
            high_m,
            wall.observations,
            self.settings,
            needs_lintel=needs_lintel,
        )


def _part(
    wall: PlanWall, spans_m: FloatArray, gaps: Sequence[Opening], begin_m: float, end_m: float
) -> PlanWall:
    """Return what of a wall lies between two places, with those of its gaps that do."""
    middle_m = spans_m.mean(axis=1)
    is_inside = (begin_m < middle_m) & (middle_m < end_m)
    faces = {face for face, inside in zip(wall.members, is_inside, strict=True) if inside}
    of_part = [g for g in gaps if begin_m < (g.low_m + g.high_m) / 2 < end_m]
    of_part = [_between_sides(g, spans_m[is_inside]) for g in of_part]
    part = replace(
        wall,
        low_m=float(spans_m[is_inside].min()),
        high_m=float(spans_m[is_inside].max()),
        left=[face for face in wall.left if face in faces],
        right=[face for face in wall.right if face in faces],
        openings=[g for g in of_part if g.state == OPEN],
        closed=[g for g in of_part if g.state == CLOSED],
    )
    return part if is_inside.all() else wall_pairs.refit_wall(part)


def _openings_between_things(gaps: Sequence[Opening], spans_m: FloatArray) -> list[Opening]:
    """Return the openings of what is open for longer than it is wall.

    An opening is a gap of a wall; a wider one than all of the wall is the space between two things,
    unless wall is seen above it.
    """
    ways = [g for g in gaps if g.state == OPEN]
    unknown_m = sum(g.width_m for g in gaps if g.state == UNKNOWN)
    open_m = sum(g.width_m for g in ways)
    solid_m = np.ptp(spans_m) - unknown_m - open_m
    return [g for g in ways if not g.below_wall] if open_m > solid_m else []


def _cut_at_corridors(wall: PlanWall, crossings: Sequence[Crossing]) -> list[PlanWall]:
    """Return the parts of a wall beside corridors that cross it.

    Such is an opening between two walls that both run on there, unless wall is seen above it.
    """
    through_m = np.array([m for other, m in crossings if other.runs_through(wall, m)])
    ends_m = [wall.low_m, wall.high_m]
    crosses = False
    for opening in wall.openings:
        jambs_m = np.array([opening.low_m, opening.high_m])
        near = np.abs(through_m - jambs_m[:, None]) <= CORNER_M
        if near.any(axis=1).all() and not opening.below_wall:
            crosses = True
            ends_m += [float(through_m[row].mean()) for row in near]
    if not crosses:
        return [wall]
    parts = wall.part(np.sort(ends_m).reshape(-1, 2))
    return list(map(wall_pairs.refit_wall, parts))


def _between_sides(gap: Opening, spans_m: FloatArray) -> Opening:
    """Return an opening with its jambs between where the faces of both sides end."""
    if gap.state != OPEN:
        return gap
    starts_m, ends_m = spans_m.T
    low_m = ends_m[(ends_m <= gap.low_m) & (ends_m >= gap.low_m - END_M)].mean()
    high_m = starts_m[(starts_m >= gap.high_m) & (starts_m <= gap.high_m + END_M)].mean()
    return replace(gap, low_m=float(low_m), high_m=float(high_m))


def _ahead(
    crossings: Sequence[Crossing], end_m: float, sign: int
) -> list[tuple[float, float, float]]:
    """Return gap, near side and middle of the walls that cross beyond an end, the nearest first."""
    return sorted(
        (sign * (place_m - end_m) - other.half_m, place_m - sign * other.half_m, place_m)
        for other, place_m in crossings
    )


def _trim(opening: Opening, bodies_m: Sequence[tuple[float, float]]) -> Opening:
    """Return what of an opening is left between walls that cross it near its ends."""
    low_m, high_m = opening.low_m, opening.high_m
    for begin_m, end_m in bodies_m:
        if begin_m - END_M <= opening.low_m <= end_m:
            low_m = max(low_m, end_m)
        if begin_m <= opening.high_m <= end_m + END_M:
            high_m = min(high_m, begin_m)
    return replace(opening, low_m=float(low_m), high_m=float(high_m))


def _split(opening: Opening, bodies_m: Sequence[tuple[float, float]]) -> list[Opening]:
    """Return what of an opening is on either side of the walls that cross it."""
    parts = [opening]
    for begin_m, end_m in bodies_m:
        for part in [p for p in parts if p.low_m < begin_m and end_m < p.high_m]:
            parts.remove(part)
            parts += [replace(part, high_m=begin_m), replace(part, low_m=end_m)]
    return sorted(parts, key=lambda part: part.low_m)


def _with_crossings(walls: Sequence[PlanWall]) -> list[tuple[PlanWall, list[Crossing]]]:
    """Return each wall with those that cross it."""
    spans = intersections.stack_spans(walls)
    found = [wall.find_crossings(spans) for wall in walls]
    return [
        (wall, [(walls[row], m) for row, m in zip(of.which, of.place_m, strict=True)])
        for wall, of in zip(walls, found, strict=True)
    ]
