"""A curve unrolled: which walls are chords of it, and the walls that stand along it instead."""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import arcs
from scanplan.geometry.intervals import find_gaps
from scanplan.geometry.lines import Line
from scanplan.plan.curves import arc_faces
from scanplan.plan.curves.circle_search import INNER, OUTER, Curve
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import CLOSED, OPEN, UNKNOWN, Opening, OpeningSettings, classify_gap
from scanplan.plan.plan_wall import Bend, PlanWall
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_observation import RaySettings, observe_face
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray, IntArray

_MOST_TURN_RAD = math.radians(150)  # of one wall: a place on its chord is one on its arc below 180
_LEAST_P = 1e-6  # that a part is a wall, or is none: densities are not known better
_ROUNDING_RAD = 1e-6  # before where a ring begins


@dataclass(frozen=True, eq=False)
class Ring:
    """The circles of a curve unrolled: places around it, in radians from where it begins.

    Attributes
    ----------
    curve : circle_search.Curve
    faces : list of intervals.FaceInterval
        That lie on it.
    side : (n,) int64
        Which of its circles each is on.
    """

    curve: Curve
    faces: list[FaceInterval]
    side: IntArray

    @property
    def _ends_m(self) -> FloatArray:
        return np.array([face.ends for face in self.faces])

    @property
    def _centre_m(self) -> FloatArray:
        return self.curve.circles.centre_m

    @property
    def _radii_m(self) -> tuple[float, float]:
        """From its inner to its outer side; the same twice where one was seen."""
        radii_m = self.curve.circles.radii_m
        return float(radii_m.min()), float(radii_m.max())

    @property
    def _begin_rad(self) -> float:
        """Where the widest gap ends that no face is in."""
        begin, end = self._turned(self._ends_m, 0.0)
        order = np.argsort(begin, kind="stable")
        reach = np.maximum.accumulate(end[order])
        bare_rad = np.append(begin[order][1:], begin[order][0] + 2 * np.pi) - reach
        return float(begin[order][(int(bare_rad.argmax()) + 1) % len(order)])

    def _turned(self, ends_m: FloatArray, first_rad: float) -> tuple[FloatArray, FloatArray]:
        """Return from where (n,) to where (n,) chords (n, 2, 2) reach around the centre."""
        ends = (ends_m - self._centre_m) @ np.array([1, 1j])
        turn = np.angle(ends[:, 1] * ends[:, 0].conjugate())
        start = np.angle(np.where(turn >= 0, ends[:, 0], ends[:, 1]) * np.exp(-1j * first_rad))
        begin = np.where(start < -_ROUNDING_RAD, start + 2 * np.pi, start)
        return begin, begin + np.abs(turn)

    def find_chords(self, walls: Sequence[PlanWall]) -> BoolArray:
        """Return which walls (n,) are of the curve: by half of their faces, or by where they are.

        What lies between its sides all along, as they err, is a chord as well, or a jamb.
        """
        known = set(self.faces)
        lengths_m = [[(f in known, f.length_m) for f in wall.members] for wall in walls]
        shown_m = np.array([sum(m for is_own, m in of if is_own) for of in lengths_m])
        whole_m = np.array([sum(m for _, m in of) for of in lengths_m])
        low_m, high_m = self._radii_m
        ends_m = np.array([wall.ends for wall in walls]).reshape(-1, 2, 2)
        places_m = ends_m[:, :1] + np.linspace(0, 1, 5)[:, None] * np.diff(ends_m, axis=1)
        radius_m = np.hypot(*np.moveaxis(places_m - self._centre_m, 2, 0))
        is_between = ((radius_m >= low_m - END_M) & (radius_m <= high_m + END_M)).all(axis=1)
        first = self._begin_rad
        _, end = self._turned(self._ends_m, first)
        is_along = self._turned(ends_m, first)[1] <= end.max() + END_M / low_m
        return (2 * shown_m >= np.maximum(whole_m, END_M)) | (is_between & is_along)

    def add_faces(self, chords: Sequence[PlanWall]) -> "Ring":
        """Return it with all faces of its chords that lie on its circles, however short."""
        known = set(self.faces)
        rest = [face for wall in chords for face in wall.members if face not in known]
        ends_m = np.array([face.ends for face in rest]).reshape(-1, 2, 2) - self._centre_m
        normals = np.array([face.line.normal for face in rest]).reshape(-1, 2)
        away = np.sum(ends_m.mean(axis=1) * normals, axis=1)
        side = np.where(away > 0, OUTER, INNER)
        radius_m = np.array([self.curve.radius_m(of) for of in (INNER, OUTER)])[side]
        off_m = np.abs(np.hypot(*np.moveaxis(ends_m, 2, 0)) - radius_m[:, None]).max(axis=1)
        is_on = off_m <= END_M  # none where its side was not seen
        faces = [*self.faces, *itertools.compress(rest, is_on)]
        return replace(self, faces=faces, side=np.concatenate([self.side, side[is_on]]))

    def draw_walls(
        self,
        chords: Sequence[PlanWall],
        rays: RaySet,
        opening: OpeningSettings,
        reading: RaySettings,
    ) -> Iterator[PlanWall]:
        """Yield the walls along the curve, parted where it is not known what is there.

        What rays go through between its faces is a way, as in a straight wall, or a window.
        """
        first = self._begin_rad
        spans = np.column_stack(self._turned(self._ends_m, first))
        placed = self._choose_openings(chords, spans, first, opening.min_opening_m)
        known = np.concatenate([spans, np.array([of[0] for of in placed]).reshape(-1, 2)])
        closed: list[tuple[FloatArray, Opening]] = []
        low, high = float(known.min()), float(known.max())
        breaks: list[float] = []
        for span in [*find_gaps(known), np.array([high, max(low + 2 * np.pi, high)])]:
            gap = self._classify(first + span, rays, opening, reading)
            if gap.state == CLOSED:
                closed.append((span, gap))
            elif gap.state == OPEN and gap.n_rays:
                kind = "window" if gap.is_above_wall else "door"
                placed.append((span, replace(gap, kind=kind)))
            else:
                breaks += span.tolist()
        # around the whole circle nothing parts its end from where it began
        goes_around = not breaks or breaks[-2] != high
        breaks = [low, *breaks, low + 2 * np.pi] if goes_around else [low, *breaks[:-1]]
        for low, high in np.sort(breaks).reshape(-1, 2).tolist():
            for begin, end in itertools.pairwise(_part(low, high, [of for of, _ in placed])):
                wall = self._draw_wall(first, (begin, end), chords, placed, closed)
                if wall.members:
                    yield wall

    def _choose_openings(
        self,
        chords: Sequence[PlanWall],
        spans: FloatArray,
        first: float,
        min_width_m: float,
    ) -> list[tuple[FloatArray, Opening]]:
        """Return the openings of chords, each once, with from where to where each reaches.

        A chord runs on beyond the curve, where rays pass it: what another one shows to be wall down
        to the floor is no opening.
        """
        found = [(wall, gap) for wall in chords for gap in wall.openings]
        ends_m = [wall.line.at(np.array([gap.low_m, gap.high_m])) for wall, gap in found]
        reach = np.column_stack(self._turned(np.array(ends_m).reshape(-1, 2, 2), first))
        chosen: list[tuple[FloatArray, Opening]] = []
        ranked = sorted(
            zip(reach, (gap for _, gap in found), strict=True),
            key=lambda of: (-np.nan_to_num(of[1].p_kind), *of[0].tolist()),
        )
        for span, gap in ranked:
            free = find_gaps(spans, *span) if not gap.is_above_wall else span[None]
            others = [np.clip(other, *span) for other, _ in chosen]
            common = sum(float(np.ptp(other)) for other in others)
            if 2 * np.ptp(free, axis=1).sum() > np.ptp(span) and 2 * common < np.ptp(span):
                reached = span if gap.is_above_wall else _widest(free)
                if np.ptp(reached) * np.mean(self._radii_m) >= min_width_m:
                    chosen.append((reached, gap))
        return chosen

    def _classify(
        self, span: FloatArray, rays: RaySet, opening: OpeningSettings, reading: RaySettings
    ) -> Opening:
        """Return what rays say of a gap between faces, on a line across it."""
        radius_m = float(np.mean(self._radii_m))
        line, half_m = _chord(self._centre_m, radius_m, span, INNER)
        width_m = radius_m * float(np.ptp(span))
        if not opening.min_opening_m <= width_m <= opening.max_opening_m:
            nothing = (math.nan, math.nan)
            state = CLOSED if width_m < opening.min_opening_m else UNKNOWN
            return Opening(-half_m, half_m, state, 0, *nothing, below_wall=False)
        observation = observe_face(
            rays,
            line,
            -half_m - END_M,
            half_m + END_M,
            band_m=reading.band_m + 2 * END_M,
        )
        return classify_gap(line, -half_m, half_m, [observation], opening)

    def _draw_wall(
        self,
        first: float,
        span: tuple[float, float],
        chords: Sequence[PlanWall],
        placed: Sequence[tuple[FloatArray, Opening]],
        closed: Sequence[tuple[FloatArray, Opening]],
    ) -> PlanWall:
        is_thick = len(self.curve.circles.radii_m) == 2
        left = OUTER if not is_thick and self.curve.side[0] == OUTER else INNER
        radius_m = float(np.mean(self._radii_m))
        whole = first + np.array(span)
        line, half_m = _chord(self._centre_m, radius_m, whole, left)
        sides = {side: self._cut_faces(side, whole) for side in (INNER, OUTER)}

        def place(reach: FloatArray, gap: Opening) -> Opening:
            at = first + reach
            xy_m = self._centre_m + radius_m * np.column_stack([np.cos(at), np.sin(at)])
            low_m, high_m = np.sort(line.along_m(xy_m)).tolist()
            return replace(gap, low_m=low_m, high_m=high_m)

        def inside(gaps: Sequence[tuple[FloatArray, Opening]]) -> list[Opening]:
            own = [place(*of) for of in gaps if span[0] <= of[0].mean() <= span[1]]
            return sorted(own, key=lambda gap: gap.low_m)

        weight = np.array([wall.length_m for wall in chords])
        p_solid = float(np.average([wall.p_solid for wall in chords], weights=weight))
        return PlanWall(
            line,
            *(-half_m, half_m),
            thickness_m=float(np.ptp(self._radii_m)) if is_thick else math.nan,
            left=sides[left],
            right=sides[OUTER] if is_thick else [],
            openings=inside(placed),
            closed=inside(closed),
            p_wall=_pool(np.array([wall.p_wall for wall in chords]), weight),
            p_solid=p_solid,
            bend=Bend(self._centre_m, radius_m, float(self.curve.circles.sigmas_m.mean())),
        )

    def _cut_faces(self, side: int, span: FloatArray) -> list[FaceInterval]:
        """Return the faces of one side from one direction to another."""
        if side not in self.curve.side:
            return []
        own = list(itertools.compress(self.faces, self.side == side))
        at_m = self.curve.radius_m(side) * np.column_stack([np.cos(span), np.sin(span)])
        arc_m = arcs.trace_arc(self._centre_m + at_m, self._centre_m)
        return arc_faces.cut_faces(own, arc_m, self._centre_m, faces_centre=side == INNER)


def _chord(
    centre_m: FloatArray, radius_m: float, span: FloatArray, side: int
) -> tuple[Line, float]:
    """Return the chord of an arc, its normal towards the centre or away, and half its length."""
    middle, half = float(np.mean(span)), float(np.ptp(span)) / 2
    outward = np.array([math.cos(middle), math.sin(middle)])
    normal = -outward if side == INNER else outward
    foot_m = centre_m + radius_m * math.cos(half) * outward
    return Line(foot_m, normal), radius_m * math.sin(half)


def _pool(p: FloatArray, weight: FloatArray) -> float:
    """Return how likely one surface is a wall by what is known of its parts, which err alike."""
    known = np.clip(p, _LEAST_P, 1 - _LEAST_P)
    odds = math.exp(float(np.average(np.log(known / (1 - known)), weights=weight)))
    return odds / (1 + odds)


def _widest(spans: FloatArray) -> FloatArray:
    return spans[np.ptp(spans, axis=1).argmax()]


def _part(low: float, high: float, spans: Sequence[FloatArray]) -> list[float]:
    """Return where walls along a stretch begin and end, none turning too far nor in an opening."""
    n_walls = math.ceil((high - low) / _MOST_TURN_RAD)
    places = np.linspace(low, high, n_walls + 1)
    for number in range(1, n_walls):
        for span in spans:
            if span[0] < places[number] < span[1]:
                places[number] = span[np.abs(span - places[number]).argmin()]
    return places.tolist()
