"""Circles that chains of faces lie on: one arc explains their points better than chords do."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry import arcs, intersections
from scanplan.geometry.arcs import Circles
from scanplan.plan.curves.face_samples import FaceSamples
from scanplan.plan.model import priors
from scanplan.plan.tolerances import CORNER_M, NOISE_M
from scanplan.types import BoolArray, FloatArray, IntArray

_PARALLEL = 1e-3  # sine: a chord of a metre on a circle of a kilometre bows by 0.1 mm
_MOST_ROUNDS = 10  # of faces gathered by a circle and the circle fitted to them; two to four are
INNER, OUTER = 0, 1
"""Sides of a curved wall, as the circles of `arcs.fit_circles`: facing its centre, and away."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Faces on one circle, or on two about one centre: the sides of a curved wall.

    Attributes
    ----------
    rows : (k,) int64
        Which faces.
    side : (k,) int64
        `INNER` or `OUTER`.
    circles : arcs.Circles
        By side: one where one side was seen.
    gain : float
        By how much the sum of squares, in variances, is less than that of as many chords; in what
        places scatter by about the circles, if that is more than they are said to.
    """

    rows: IntArray
    side: IntArray
    circles: Circles
    gain: float

    def radius_m(self, side: int) -> float:
        """The radius of a side; NaN where it was not seen."""
        sides = np.unique(self.side)
        return float(self.circles.radii_m[sides == side][0]) if side in sides else math.nan


def find_curves(
    faces: Sequence[FaceSamples], *, max_gap_m: float, thickness_m: tuple[float, float]
) -> list[Curve]:
    """Find the curves that explain faces better than straight walls do, the surest first.

    Two chords that meet propose a circle; faces that lie on it, or as a wall's other side beside
    it, and go on from each other along it, are gathered, and it is fitted to them, until they stay
    the same. An arc has fewer parameters than chords; yet it is drawn only where points show it
    curved: where its sum of squares is less than theirs by what makes up for the odds.

    Parameters
    ----------
    faces : sequence of FaceSamples
    max_gap_m : float
        How wide an opening may be along it.
    thickness_m : (float, float)
        How thick a wall may be at least and at most.
    """
    table = _Faces(faces, max_gap_m, thickness_m)
    found: dict[bytes, Curve] = {}
    for first, second in table.pairs_that_meet():
        curve = table.grow(first, second)
        if curve is not None and priors.WITNESS * curve.gain > -2 * math.log(priors.CURVED_SHARE):
            found.setdefault(curve.rows.tobytes(), curve)
    chosen: list[Curve] = []
    taken: set[int] = set()
    for curve in sorted(found.values(), key=lambda of: (-of.gain, of.rows.tolist())):
        if taken.isdisjoint(curve.rows.tolist()):
            taken.update(curve.rows.tolist())
            chosen.append(curve)
    return chosen


class _Faces:
    """The faces among which curves are looked for."""

    def __init__(
        self, faces: Sequence[FaceSamples], max_gap_m: float, thickness_m: tuple[float, float]
    ) -> None:
        self.faces = faces
        self._max_gap_m = max_gap_m
        self._thickness_m = thickness_m
        self._ends_m = np.array([of.face.ends for of in faces]).reshape(-1, 2, 2)
        self._middle_m = self._ends_m.mean(axis=1)
        self._normal = np.array([of.face.line.normal for of in faces]).reshape(-1, 2)
        self._n = np.array([len(of.xy_m) for of in faces], np.int64)
        self._xy_m = np.concatenate([np.empty((0, 2)), *(of.xy_m for of in faces)])
        self._owner = np.repeat(np.arange(len(faces)), self._n)

    def pairs_that_meet(self) -> Iterator[tuple[int, int]]:
        """Yield pairs of faces that end near each other."""
        ends = np.asarray(shapely.points(self._ends_m.reshape(-1, 2)), object)
        one, other = shapely.STRtree(ends).query(ends, predicate="dwithin", distance=2 * CORNER_M)
        pairs = np.unique(np.column_stack([one // 2, other // 2]), axis=0)
        yield from pairs[pairs[:, 0] < pairs[:, 1]].tolist()

    def grow(self, first: int, second: int) -> Curve | None:
        """Return the curve that two chords are part of, if they are of one."""
        start = self._propose(first, second)
        if start is None:
            return None
        centre_m, side = start
        rows, sides = np.array([first, second]), np.full(2, side)
        for _ in range(_MOST_ROUNDS):
            circles = self._fit(rows, sides, centre_m)
            if circles is None or side not in sides:
                return None
            # of two walls in a corner nothing else needs to be looked at
            if np.mean(circles.residual_m**2) > NOISE_M**2:
                return None
            radius_m = float(circles.radii_m[np.unique(sides) == side][0])
            gathered = self._gather(circles.centre_m, radius_m, side, first)
            if gathered is None:
                return None
            is_settled = np.array_equal(gathered[0], rows)
            rows, sides = gathered
            centre_m = circles.centre_m
            if is_settled:
                break
        circles = self._fit(rows, sides, centre_m)
        if circles is None or side not in sides or len(rows) < 2:
            return None
        # what is no wider than a wall may be thick is a column
        if circles.radii_m.max() <= self._thickness_m[1]:
            return None
        variance = np.concatenate([self.faces[row].variance for row in rows])
        misfit = float(np.sum(circles.residual_m**2 / variance))
        n_free = len(variance) - 2 - len(circles.radii_m)
        chords = sum(self.faces[row].misfit for row in rows)
        return Curve(rows, sides, circles, (chords - misfit) / max(misfit / n_free, 1.0))

    def _propose(self, first: int, second: int) -> tuple[FloatArray, int] | None:
        """Return where the normals of two chords cross, and which side of a wall they are."""
        pair = [first, second]
        turn = np.column_stack([self._normal[first], -self._normal[second]])
        apart_m = self._middle_m[second] - self._middle_m[first]
        if abs(np.linalg.det(turn)) < _PARALLEL:
            return None
        ahead_m = np.linalg.solve(turn, apart_m)
        # both face the centre, or neither; chords of one circle are about as far from it
        if ahead_m[0] * ahead_m[1] <= 0 or np.ptp(np.abs(ahead_m)) > np.abs(ahead_m).mean() / 2:
            return None
        centre_m = np.mean(self._middle_m[pair] + ahead_m[:, None] * self._normal[pair], axis=0)
        return centre_m, INNER if ahead_m[0] > 0 else OUTER

    def _fit(self, rows: IntArray, sides: IntArray, centre_m: FloatArray) -> Circles | None:
        _, circle = np.unique(sides, return_inverse=True)
        return arcs.fit_circles(
            np.concatenate([self.faces[row].xy_m for row in rows]),
            np.concatenate([self.faces[row].variance for row in rows]),
            np.repeat(circle, self._n[rows]),
            centre_m,
        )

    def _gather(
        self, centre_m: FloatArray, radius_m: float, side: int, first: int
    ) -> tuple[IntArray, IntArray] | None:
        """Return the faces on a circle and beside it that go on from the first, and their sides."""
        outward = self._middle_m - centre_m
        outward /= np.hypot(*outward.T)[:, None]
        away = np.einsum("ij,ij->i", outward, self._normal)
        is_radial = np.abs(away) >= math.cos(intersections.LEAST_RAD)
        of_side = np.where(away > 0, OUTER, INNER)
        off_m = np.hypot(*(self._xy_m - centre_m).T) - radius_m
        mean_m = np.bincount(self._owner, off_m) / self._n
        square = np.bincount(self._owner, off_m**2) / self._n
        is_on = (square <= NOISE_M**2) & (of_side == side)
        behind_m = mean_m if side == INNER else -mean_m
        is_bent = square - mean_m**2 <= NOISE_M**2
        low_m, high_m = self._thickness_m
        is_behind = is_bent & (behind_m >= low_m) & (behind_m <= high_m) & (of_side != side)
        is_behind &= is_radial
        rows = np.flatnonzero(is_on & is_radial | is_behind & self._is_usual(behind_m, is_behind))
        if first not in rows:
            return None
        rows = rows[self._go_on(rows, centre_m, int(np.flatnonzero(rows == first)[0]))]
        return rows, of_side[rows]

    def _is_usual(self, behind_m: FloatArray, is_behind: BoolArray) -> BoolArray:
        """Return which faces are as far behind as most length of those behind."""
        length_m = np.array([of.face.length_m for of in self.faces])
        near = np.abs(behind_m[:, None] - behind_m) <= NOISE_M
        alike_m = (near * (length_m * is_behind)).sum(axis=1)
        best = int(np.argmax(np.where(is_behind, alike_m, -1.0)))
        return np.abs(behind_m - behind_m[best]) <= NOISE_M

    def _go_on(self, rows: IntArray, centre_m: FloatArray, first: int) -> BoolArray:
        """Return which faces on a circle no gap wider than an opening parts from one of them."""
        begin_m, end_m, around_m = unroll(self._ends_m[rows], centre_m)
        order = np.argsort(begin_m, kind="stable")
        reach_m, part = -math.inf, 0
        parts = np.zeros(len(rows), np.int64)
        for row in order.tolist():
            part += begin_m[row] > reach_m + self._max_gap_m
            parts[row] = part
            reach_m = max(reach_m, float(end_m[row]))
        # around the whole circle the last may go on as the first
        if begin_m.min() + around_m <= reach_m + self._max_gap_m:
            parts[parts == part] = parts[order[0]]
        return parts == parts[first]


def unroll(ends_m: FloatArray, centre_m: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return from where (n,) to where (n,) chords (n, 2, 2) reach around a centre, and once around.

    Metres along a circle of their mean radius, counter-clockwise, from 0 on: what begins before a
    whole turn may end after it.
    """
    from_centre = (ends_m - centre_m) @ np.array([1, 1j])
    radius_m = float(np.abs(from_centre).mean())
    turn = np.angle(from_centre[:, 1] * from_centre[:, 0].conjugate())
    first = np.where(turn >= 0, from_centre[:, 0], from_centre[:, 1])
    begin_m = np.angle(first) % (2 * np.pi) * radius_m
    return begin_m, begin_m + np.abs(turn) * radius_m, 2 * np.pi * radius_m
