"""Faces paired into walls: which are sides of one wall, where its middle is and how thick it is."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.geometry.lines import Line, least_scatter_normal, rows_scatter
from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_raster import CELL_M, ROW_M
from scanplan.rays.tolerances import STRETCH_M
from scanplan.types import FloatArray

_OPEN_SHARE = 0.3  # of one side's length: more that is free while the other is seen contradicts
_SAME_LINE, _OPPOSITE, _ONWARD = range(3)  # order in which pairs are joined: the surest first


@dataclass(frozen=True)
class PairSettings:
    """When faces are sides of one wall.

    Attributes
    ----------
    max_angle_deg : float, above 0, below 45
    min_thickness_m, max_thickness_m : float, > 0
    offset_m : float, > 0
        All faces of one side of a wall lie this near to one line.
    max_gap_m : float, >= 0
        Faces of one side that are farther apart are different walls, unless the other side goes on.
    """

    max_angle_deg: float
    min_thickness_m: float
    max_thickness_m: float
    offset_m: float
    max_gap_m: float

    def is_thick(self, thickness_m: float) -> bool:
        """Return whether a wall may be so thick; NaN, where one side is known, is."""
        is_in_range = self.min_thickness_m <= thickness_m <= self.max_thickness_m
        return is_in_range or math.isnan(thickness_m)

    def may_be_sides(self, one: FaceInterval, other: FaceInterval) -> bool:
        """Return whether two faces, maybe at different ends of a wall, may be its two sides."""
        cosine = one.line.normal @ other.line.normal
        if cosine > -math.cos(math.radians(self.max_angle_deg)):
            return False
        overlap_m, behind_m = _overlap(one, other)
        return self.is_thick(behind_m) and -overlap_m <= self.max_gap_m


def pair_faces(
    faces: Sequence[FaceInterval], settings: PairSettings, *, door_height_m: float
) -> list[PlanWall]:
    """Sort faces into walls.

    Faces of one line are joined first, then those opposite to each other, the longest overlap
    before others, then those that go on from each other; never so that a side would not be straight
    within `offset_m`, nor where rays went through what would be one side while the other was seen.

    Parameters
    ----------
    faces : list of intervals.FaceInterval
    settings : PairSettings
    door_height_m : float
        Rays that are higher say nothing of the other side.

    Returns
    -------
    list of PlanWall
        Every face is in exactly one; openings are not looked for yet.
    """
    walls = {index: _Sides([index], faces) for index in range(len(faces))}
    wall_of = list(range(len(faces)))
    for one, other in _offer_pairs(faces, settings, door_height_m):
        first, second = wall_of[one], wall_of[other]
        if first == second:
            continue
        joined = _Sides(walls[first].members + walls[second].members, faces)
        if joined.bend_m <= settings.offset_m and settings.is_thick(joined.thickness_m):
            walls[first] = joined
            del walls[second]
            for index in joined.members:
                wall_of[index] = first
    return [wall.make() for _, wall in sorted(walls.items())]


def refit_wall(wall: PlanWall) -> PlanWall:
    """Return a part of a wall where its own faces lie, and as thick, with its openings.

    What other parts of the line showed, across a corridor or a wide opening, says nothing of it.
    """
    fitted = _Sides(list(range(len(wall.members))), wall.members).make()

    def move(low_m: float, high_m: float) -> dict[str, float]:
        ends_m = wall.line.at(np.array([low_m, high_m]))
        return dict(zip(("low_m", "high_m"), fitted.reach_m(ends_m), strict=True))

    openings, closed = (
        sorted((replace(of, **move(of.low_m, of.high_m)) for of in gaps), key=lambda of: of.low_m)
        for gaps in (wall.openings, wall.closed)
    )
    return replace(
        wall,
        line=fitted.line,
        **move(wall.low_m, wall.high_m),
        thickness_m=fitted.thickness_m,
        left=fitted.left,
        right=fitted.right,
        openings=openings,
        closed=closed,
    )


def _offer_pairs(
    faces: Sequence[FaceInterval], settings: PairSettings, door_height_m: float
) -> list[tuple[int, int]]:
    """Return pairs that may be of one wall, the surest first."""
    ends = np.array([face.ends for face in faces]).reshape(-1, 2, 2)
    lines = np.asarray(shapely.linestrings(ends))
    reach_m = max(settings.max_gap_m, settings.max_thickness_m)
    one, other = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=reach_m)
    pairs = np.column_stack([one, other])[one < other]
    normal = np.array([face.line.normal for face in faces]).reshape(-1, 2)
    cosine = np.einsum("ij,ij->i", normal[pairs[:, 0]], normal[pairs[:, 1]])
    is_parallel = np.abs(cosine) >= math.cos(math.radians(settings.max_angle_deg))
    offers = []
    for i, j in pairs[is_parallel].tolist():
        overlap_m, behind_m = _overlap(faces[i], faces[j])
        if faces[i].line.normal @ faces[j].line.normal < 0:
            is_opposite = settings.is_thick(behind_m) and overlap_m >= 2 * END_M
            if is_opposite and not _contradict(faces[i], faces[j], door_height_m):
                offers.append((_OPPOSITE, -overlap_m, i, j))
        elif -overlap_m <= settings.max_gap_m and abs(behind_m) <= settings.offset_m:
            kind = _SAME_LINE if faces[i].observation is faces[j].observation else _ONWARD
            offers.append((kind, abs(behind_m), i, j))
    return [(i, j) for _, _, i, j in sorted(offers)]


def _overlap(one: FaceInterval, other: FaceInterval) -> tuple[float, float]:
    """Return by how much two faces overlap (negative: are apart), how far the other is behind."""
    longer, shorter = (one, other) if one.length_m >= other.length_m else (other, one)
    along_m = np.sort(longer.line.along_m(shorter.ends))
    overlap_m = min(along_m[1], longer.high_m) - max(along_m[0], longer.low_m)
    return float(overlap_m), -float(longer.line.offset_m(shorter.ends).mean())


def _contradict(one: FaceInterval, other: FaceInterval, door_height_m: float) -> bool:
    """Return whether rays go through one side where the other was seen and it was not."""
    for shown, unseen in ((one, other), (other, one)):
        if _share_passed(unseen, shown) > _OPEN_SHARE:
            return True
        raster = unseen.observation.raster
        is_opened = raster.is_opened(door_height_m)
        first_m, last_m = np.sort(unseen.line.along_m(shown.ends)).tolist()
        beside_m = ((first_m, min(last_m, unseen.low_m)), (max(first_m, unseen.high_m), last_m))
        open_m = unseen_m = 0.0
        for low_m, high_m in beside_m:
            if high_m > low_m:
                open_m += CELL_M * is_opened[raster.between(low_m, high_m)].sum()
                unseen_m += high_m - low_m
        # less may be noise of poses at an end
        if open_m > max(STRETCH_M, _OPEN_SHARE * unseen_m):
            return True
    return False


def _share_passed(low: FaceInterval, high: FaceInterval) -> float:
    """Return how much of what two sides have in common rays pass above one, where the other is.

    Such a side stands before the wall.
    """
    of_low, of_high = low.observation.raster, high.observation.raster
    first_m, last_m = np.sort(low.line.along_m(high.ends)).tolist()
    columns = of_low.between(max(first_m, low.low_m), min(last_m, low.high_m))
    along_m = high.line.along_m(low.line.at(of_low.middle_m[columns]))
    is_passed = of_low.passed_cells[columns] & of_high.seen_cells[of_high.column_of(along_m)]
    return float((is_passed.sum(axis=1) * ROW_M >= STRETCH_M).mean()) if len(along_m) else 0.0


class _Sides:
    """Faces, by their indices, as the two sides of one wall."""

    def __init__(self, members: list[int], faces: Sequence[FaceInterval]):
        self.members = sorted(members)
        longest = max(self.members, key=lambda i: faces[i].length_m)
        normal = faces[longest].line.normal
        chosen = [faces[i] for i in self.members]
        self.left = [face for face in chosen if face.line.normal @ normal > 0]
        self.right = [face for face in chosen if not face.line.normal @ normal > 0]
        self._line, self._offsets_m = _fit_sides([self.left, self.right], normal)

    @property
    def bend_m(self) -> float:
        """How far an end of a face lies from the line of its side, at most."""
        return max(
            float(np.abs(self._line.offset_m(face.ends) - offset_m).max())
            for side, offset_m in zip((self.left, self.right), self._offsets_m, strict=True)
            for face in side
        )

    @property
    def thickness_m(self) -> float:
        """From one side to the other; NaN where one is known."""
        return float(self._offsets_m[0] - self._offsets_m[1]) if self.right else math.nan

    def make(self) -> PlanWall:
        """Return the wall, as long as its faces."""
        middle_m = sum(self._offsets_m) / 2 if self.right else self._offsets_m[0]
        line = Line(self._line.centre + middle_m * self._line.normal, self._line.normal)
        along_m = [line.along_m(face.ends) for face in self.left + self.right]
        return PlanWall(
            line=line,
            low_m=float(np.min(along_m)),
            high_m=float(np.max(along_m)),
            thickness_m=self.thickness_m,
            left=self.left,
            right=self.right,
        )


def _fit_sides(
    sides: Sequence[Sequence[FaceInterval]], normal: FloatArray
) -> tuple[Line, list[float]]:
    """Fit parallel lines to the two sides: a common line, and each side's offset from it.

    A face counts as a uniform row of points, by its length.
    """
    scatter = np.zeros(3)
    centres = []
    for side in sides:
        if not side:
            centres.append(None)
            continue
        ends = np.array([face.ends for face in side])
        half = (ends[:, 1] - ends[:, 0]) / 2
        length = np.hypot(*half.T)
        weight = length / max(length.sum(), ROUNDING)
        centre, of_side = rows_scatter(ends.mean(axis=1), half, weight)
        scatter += length.sum() * of_side
        centres.append(centre)
    fitted = least_scatter_normal(*scatter, arctan2=math.atan2)
    fitted = fitted if fitted @ normal >= 0 else -fitted
    line = Line(next(centre for centre in centres if centre is not None), fitted)
    offsets_m = [0.0 if centre is None else float(line.offset_m(centre)) for centre in centres]
    return line, offsets_m
