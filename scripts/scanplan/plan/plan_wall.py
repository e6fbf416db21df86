"""A wall of the plan: its middle, its faces on both sides, and its gaps."""

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from scanplan.geometry import arcs, intersections
from scanplan.geometry.lines import Line, Span
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import Opening
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.rays.face_observation import FaceObservation
from scanplan.types import BoolArray, FloatArray

_THICKNESS_M = 0.1  # of a partition, where no wall shows both sides


@dataclass(frozen=True, eq=False)
class InferredFace(Span):
    """A face that no point shows, between or opposite to observed ones of its wall.

    From `low_m` to `high_m` along the line; `is_left` if it is on the wall's left side, None of a
    reveal, which is across it.
    """

    line: Line
    low_m: float
    high_m: float
    is_left: bool | None


@dataclass(frozen=True, eq=False)
class Nearly:
    """What was nearly drawn: wall, door, window or glass, its ends (2, 2), and how likely it is."""

    kind: str
    ends_m: FloatArray
    p: float


@dataclass(frozen=True, eq=False)
class Bend:
    """The circle that the line of a curved wall lies on; what its radius errs by, by its fit."""

    centre_m: FloatArray
    radius_m: float
    sigma_m: float


@dataclass(frozen=True, eq=False)
class PlanWall(Span):
    """A wall of one or two sides, from `low_m` to `high_m` along its middle.

    Attributes
    ----------
    line : lines.Line
        Its middle, or its face where one side is known: then the wall is behind it. The normal is
        on the left of the way along it.
    low_m, high_m : float
    thickness_m : float
        NaN where one side is known, and no reveal shows it.
    left, right : list of intervals.FaceInterval
        Its faces on the side of the line's normal, and on the other, which is empty where one side
        is known.
    openings, closed : list of openings.Opening
        Ways through, and gaps taken for wall; in order along it.
    reveals : list of intervals.FaceInterval
        Surfaces of its openings across it.
    inferred : list of InferredFace
        What else it has of faces, once `wall_faces` has cut them.
    p_wall, p_solid : float
        Probability that it is a wall, no leaf, furniture or what is outside; and of its stretches
        between openings that they are solid, in the mean of their length. NaN: not weighed.
    nearly : sequence of Nearly
        Openings that it nearly has.
    bend : Bend, optional
        Of a curved wall: `line` is the chord of its middle, and places along it are those of the
        chord that they lie beside. It turns by less than half a circle.
    """

    line: Line
    low_m: float
    high_m: float
    thickness_m: float
    left: list[FaceInterval]
    right: list[FaceInterval]
    openings: list[Opening] = field(default_factory=list)
    closed: list[Opening] = field(default_factory=list)
    reveals: list[FaceInterval] = field(default_factory=list)
    inferred: list[InferredFace] = field(default_factory=list)
    p_wall: float = math.nan
    p_solid: float = math.nan
    nearly: Sequence[Nearly] = ()
    bend: Bend | None = None

    def at(self, along_m: FloatArray | float) -> FloatArray:
        """Return the places (..., 2) of its middle at positions (...,) along it."""
        if self.bend is None:
            return self.line.at(along_m)
        foot_m = self.line.at(self.line.along_m(self.bend.centre_m))
        chord_m = np.asarray(self.line.at(along_m))
        off_m = np.sum((chord_m - foot_m) ** 2, axis=-1)
        bow_m = np.sqrt(np.maximum(self.bend.radius_m**2 - off_m, 0.0))
        rise_m = -self._towards_centre * bow_m + float(self.line.offset_m(self.bend.centre_m))
        return chord_m + rise_m[..., None] * self.line.normal

    def trace(
        self, low_m: float, high_m: float, off_m: float = 0.0, beyond_m: float = 0.0
    ) -> FloatArray:
        """Return places (n, 2) along it from one position to another, so far on its left.

        They go on beyond both, so far along it: of a curved wall along its circle.
        """
        if self.bend is None:
            along_m = np.array([low_m - beyond_m, high_m + beyond_m])
            return self.line.at(along_m) + off_m * self.line.normal
        return arcs.trace_arc(
            self.at(np.array([low_m, high_m])),
            self.bend.centre_m,
            away_m=-self._towards_centre * off_m,
            beyond_m=beyond_m,
        )

    def reach_m(self, ends_m: FloatArray) -> tuple[float, float]:
        """Return from where to where along it what has two ends (2, 2) beside it reaches."""
        along_m = self.line.along_m(ends_m)
        if self.bend is not None:
            # straight out from the centre
            middle_m = self.line.along_m(self.bend.centre_m)
            from_centre_m = np.hypot(*(ends_m - self.bend.centre_m).T)
            along_m = middle_m + (along_m - middle_m) * self.bend.radius_m / from_centre_m
        low_m, high_m = np.sort(along_m).tolist()
        return low_m, high_m

    def offset_m(self, xy_m: FloatArray) -> FloatArray:
        """Return how far places (..., 2) are off its line, of a curved wall off its circle."""
        if self.bend is None:
            return self.line.offset_m(xy_m)
        from_centre_m = np.hypot(*np.moveaxis(xy_m - self.bend.centre_m, -1, 0))
        return self._towards_centre * (self.bend.radius_m - from_centre_m)

    def onto_line(self, xy_m: FloatArray) -> FloatArray:
        """Return places (n, 2) moved onto its line, of a curved wall onto its circle."""
        if self.bend is None:
            return self.line.at(self.line.along_m(xy_m))
        outward_m = xy_m - self.bend.centre_m
        scale = self.bend.radius_m / np.hypot(*outward_m.T)
        return self.bend.centre_m + scale[:, None] * outward_m

    def normal_at(self, place_m: FloatArray) -> FloatArray:
        """Return the unit normal (2,) on its left beside a place (2,)."""
        if self.bend is None:
            return self.line.normal
        towards_m = self._towards_centre * (self.bend.centre_m - place_m)
        return towards_m / np.hypot(*towards_m)

    def cross_bend(self, line: Line) -> list[float]:
        """Return where along a line it crosses the middle of this curved wall."""
        if self.bend is None:
            return []
        nearest_m = float(line.along_m(self.bend.centre_m))
        off_m = float(line.offset_m(self.bend.centre_m))
        half_m = math.sqrt(max(self.bend.radius_m**2 - off_m**2, 0.0))
        places_m = [nearest_m - half_m, nearest_m + half_m] if half_m else []
        return [place_m for place_m in places_m if self._is_beside(line.at(place_m))]

    def _is_beside(self, place_m: FloatArray) -> bool:
        """Return whether a place on its circle is on its arc."""
        is_between = self.low_m <= float(self.line.along_m(place_m)) <= self.high_m
        return is_between and float(self.line.offset_m(place_m)) * self._towards_centre <= 0

    @property
    def _towards_centre(self) -> int:
        """1 of a curved wall whose centre is on its left, else -1."""
        return 1 if self.bend and self.line.offset_m(self.bend.centre_m) > 0 else -1

    @property
    def members(self) -> list[FaceInterval]:
        """The faces of both sides."""
        return self.left + self.right

    @property
    def observations(self) -> list[FaceObservation]:
        """What was observed of the lines of its faces, each once."""
        return list(dict.fromkeys(face.observation for face in self.members))

    def between(self, begin_m: float, end_m: float) -> "PlanWall":
        """Return the wall from one place to another along it, with what has its middle there."""

        def is_inside(low_m: float, high_m: float) -> bool:
            return begin_m < (low_m + high_m) / 2 < end_m

        left, right = (
            [face for face in side if is_inside(*self.line.along_m(face.ends).tolist())]
            for side in (self.left, self.right)
        )
        openings, closed = (
            [gap for gap in gaps if is_inside(gap.low_m, gap.high_m)]
            for gaps in (self.openings, self.closed)
        )
        return replace(
            self,
            low_m=begin_m,
            high_m=end_m,
            left=left,
            right=right,
            openings=openings,
            closed=closed,
        )

    def part(self, spans_m: FloatArray) -> list["PlanWall"]:
        """Return it between places along it (n, 2), without what has no face there."""
        parts = [self.between(*span_m) for span_m in spans_m.tolist()]
        return [part for part in parts if part.members]

    def part_beside(self, openings: Sequence[Opening]) -> list["PlanWall"]:
        """Return what is left of it before, between and behind openings, without these."""
        if not openings:
            return [self]
        jambs_m = [jamb_m for opening in openings for jamb_m in (opening.low_m, opening.high_m)]
        return self.part(np.sort([self.low_m, *jambs_m, self.high_m]).reshape(-1, 2))

    def goes_on_as(self, other: "PlanWall") -> bool:
        """Return whether another wall is much the same way, in the line of this one."""
        return bool(self.are_in_line(other.line.normal[None], other.ends[None])[0])

    def are_in_line(self, normal: FloatArray, ends_m: FloatArray) -> BoolArray:
        """Return which walls (n,) are in its line, by their normals (n, 2) and ends (n, 2, 2)."""
        turn = np.abs(normal @ self.line.normal)
        nearest_m = np.abs(self.line.offset_m(ends_m)).min(axis=1)
        return (turn >= math.cos(intersections.LEAST_RAD)) & (nearest_m <= CORNER_M)

    def runs_through(self, other: "PlanWall", place_m: float) -> bool:
        """Return whether it goes on on both sides of another, which it crosses at a place there."""
        at_m = float(self.line.along_m(other.line.at(place_m)))
        return min(at_m - self.low_m, self.high_m - at_m) > other.half_m + CORNER_M

    def find_crossings(self, spans: intersections.SpanArrays) -> intersections.Crossings:
        """Find the spans that cross it, or end as near before it as walls that meet it do."""
        return intersections.find_crossings(self.line, spans, reach_m=self.half_m + CORNER_M)

    @property
    def half_m(self) -> float:
        """From the middle to either face; 0 where the line is that of the face."""
        return 0.0 if math.isnan(self.thickness_m) else self.thickness_m / 2


def list_faces(walls: Sequence[PlanWall]) -> list[FaceInterval]:
    """Return the faces of walls, those of one after those of the other."""
    return [face for wall in walls for face in wall.members]


def usual_thickness_m(walls: Sequence[PlanWall]) -> float:
    """Return how thick walls usually are: the lower middle of those that show both sides.

    Of two it is the thinner: the other may be a wall with what stands before it.
    """
    return median_thickness_m([wall.thickness_m for wall in walls])


def median_thickness_m(thickness_m: Sequence[float]) -> float:
    """Return the lower middle of what is known, NaN is not; of a partition where nothing is."""
    known_m = [of_m for of_m in thickness_m if not math.isnan(of_m)]
    return float(statistics.median_low(known_m)) if known_m else _THICKNESS_M


def greatest_thickness_m(walls: Sequence[PlanWall]) -> float:
    """Return how thick walls are at most: as several are, one with a door, a pier, or twice usual.

    A wall that is thicker than all others, and shows no jamb, may be one with a cupboard before it.
    """
    paired = [wall for wall in walls if wall.right]
    thickness_m = np.array([wall.thickness_m for wall in paired])
    n_alike = (np.abs(thickness_m[:, None] - thickness_m) <= END_M).sum(axis=1)
    has_ends = [bool(w.openings) or w.length_m <= 2 * w.thickness_m for w in paired]
    shown_m = thickness_m[(n_alike > 1) | np.array(has_ends, bool)]
    return max(2 * usual_thickness_m(walls), float(shown_m.max(initial=0.0)))
