"""The faces of a plan, to be found by the lines that they lie on."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import intersections
from scanplan.plan.faces.face_tree import FaceTree
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.tolerances import CORNER_M, END_M, FACE_M
from scanplan.rays.tolerances import BEHIND_M, STRETCH_M
from scanplan.types import BoolArray, FloatArray


class PlanFaces(FaceTree):
    """The faces of a plan, to be found by where they and their lines are."""

    def __init__(self, faces: Sequence[FaceInterval]) -> None:
        super().__init__(faces)
        self._centre_m = self._ends_m.mean(axis=1)
        self._length_m = np.array([face.length_m for face in faces])
        self._normal = np.array([face.line.normal for face in faces]).reshape(-1, 2)
        self._on_line_m: dict[FaceInterval, tuple[FloatArray, FloatArray]] = {}

    def behind(self, ground: BaseGeometry) -> list[FaceInterval]:
        """Return the faces on whose lines ground before them ends, or near."""
        places_m = shapely.get_coordinates(ground)
        off_m = np.einsum("fpi,fi->fp", places_m - self._centre_m[:, None], self._normal)
        return self._faces[np.abs(off_m.min(axis=1)) <= CORNER_M].tolist()

    def backs(
        self, near: Sequence[FaceInterval], fronts: Sequence[FaceInterval]
    ) -> list[FaceInterval]:
        """Return the faces near a pocket that its fronts may stand before.

        Those that face the same way, as far from one end of a front as from the other; and others,
        such as the wall that a corner's cupboard ends at, if they go farther through the plan than
        the fronts do: else these are the wall.
        """
        reach_m = max((self.reach_on_line_m(front) for front in fronts), default=0.0)
        least = math.cos(intersections.LEAST_RAD)

        def is_along(face: FaceInterval, front: FaceInterval) -> bool:
            is_alike = face.line.normal @ front.line.normal >= least
            return bool(is_alike and np.ptp(face.line.offset_m(front.ends)) <= CORNER_M)

        return [
            face
            for face in near
            if any(is_along(face, front) for front in fronts)
            or self.reach_on_line_m(face) > reach_m
        ]

    def parallel(self, face: FaceInterval, most_m: float) -> list[FaceInterval]:
        """Return the faces of the same way whose lines lie behind a face, no farther than that."""
        off_m = np.einsum("fpi,fi->fp", face.ends - self._centre_m[:, None], self._normal)
        is_behind = (off_m.min(axis=1) > BEHIND_M) & (off_m.max(axis=1) <= most_m)
        return self._faces[self._faces_alike(face) & is_behind].tolist()

    def reach_on_line_m(self, face: FaceInterval) -> float:
        """Return how far all faces of the same way reach that lie on the line of one."""
        low_m, high_m = self._along_line_m(face)
        return float(high_m.max() - low_m.min())

    def gap_on_line_m(self, face: FaceInterval, places_m: FloatArray) -> float:
        """Return how far places (n,) along the line of a face are from what lies on it."""
        return float(self._gaps_m(face, places_m).min())

    def goes_on_beside(self, face: FaceInterval, places_m: FloatArray) -> bool:
        """Return whether a face's line continues beyond a trace on both sides of places (n,).

        What lies there begins where they end.
        """
        low_m, high_m = self._along_line_m(face)
        first_m, last_m = float(places_m.min()), float(places_m.max())
        before = (np.abs(high_m - first_m) <= CORNER_M) & (low_m < first_m - STRETCH_M)
        after = (np.abs(low_m - last_m) <= CORNER_M) & (high_m > last_m + STRETCH_M)
        return bool(before.any() and after.any())

    def is_between_others(self, face: FaceInterval) -> bool:
        """Return whether others lie on the line of a face on both sides of it, not next to it."""
        low_m, high_m = self._along_line_m(face)
        before = (high_m < face.low_m - CORNER_M).any()
        return bool(before and (low_m > face.high_m + CORNER_M).any())

    def is_outermost(self, face: FaceInterval, places_m: FloatArray) -> bool:
        """Return whether no surface lies behind the line of a face.

        From places (n,) along it to the nearest that lies on it; to all that are about as near.
        """
        low_m, high_m = self._along_line_m(face)
        gap_m = self._gaps_m(face, places_m)
        is_nearest = gap_m <= gap_m.min() + END_M
        first_m = min(low_m[is_nearest].min(), places_m.min())
        last_m = max(high_m[is_nearest].max(), places_m.max())
        along_m = face.line.along_m(self._ends_m)
        off_m = face.line.offset_m(self._ends_m)
        is_beside = (along_m.max(axis=1) > first_m) & (along_m.min(axis=1) < last_m)
        return not (is_beside & (off_m.min(axis=1) < -BEHIND_M)).any()

    def joined_m(self, face: FaceInterval) -> float:
        """Return how long a surface is with others in its line, no farther away than it is long.

        Pieces at its ends or along it, beside its line by what poses err by, are parts of it, too.
        """
        along_m, off_m = face.line.along_m(self._ends_m), face.line.offset_m(self._ends_m)
        lows_m, highs_m = along_m.min(axis=1), along_m.max(axis=1)
        is_alike = self._faces_alike(face)
        is_on = is_alike & (np.abs(off_m.mean(axis=1)) <= FACE_M)
        is_beside = is_alike & (np.abs(off_m).min(axis=1) <= BEHIND_M)
        span_m, joined_m = (face.low_m, face.low_m), (face.low_m, face.high_m)
        while joined_m != span_m:
            span_m = joined_m
            gap_m = _gaps_between(lows_m, highs_m, np.array(span_m))
            is_near = (is_on & (gap_m <= span_m[1] - span_m[0])) | (is_beside & (gap_m <= END_M))
            joined_m = (float(lows_m[is_near].min()), float(highs_m[is_near].max()))
        return span_m[1] - span_m[0]

    def _gaps_m(self, face: FaceInterval, places_m: FloatArray) -> FloatArray:
        """Return how far places along the line of a face are from each (n,) that lies on it."""
        return _gaps_between(*self._along_line_m(face), places_m)

    def _along_line_m(self, face: FaceInterval) -> tuple[FloatArray, FloatArray]:
        """Return from where (n,) to where faces of the same way lie on the line of one."""
        if face not in self._on_line_m:
            off_m = face.line.offset_m(self._centre_m)
            is_on = self._faces_alike(face) & (np.abs(off_m) <= FACE_M)
            along_m = face.line.along_m(self._centre_m[is_on])
            half_m = self._length_m[is_on] / 2
            self._on_line_m[face] = along_m - half_m, along_m + half_m
        return self._on_line_m[face]

    def _faces_alike(self, face: FaceInterval) -> BoolArray:
        """Return which faces (n,) face much the same way as one."""
        return self._normal @ face.line.normal >= math.cos(intersections.LEAST_RAD)


def _gaps_between(low_m: FloatArray, high_m: FloatArray, places_m: FloatArray) -> FloatArray:
    """Return how far places along a line are from each stretch (n,) of it, negative inside."""
    return np.maximum(low_m - places_m.max(), places_m.min() - high_m)
