"""Leaves of open doors in planar scans.

A leaf stands in the room like a short wall. It hangs at a jamb of its door, is as long as the door
is wide, and ends free: a wall ends at another, or is as long as its room asks for.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from shapely import STRtree
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.intersections import LEAST_RAD
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall, list_faces
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M, END_M
from scanplan.rays.tolerances import BEHIND_M, STRETCH_M
from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class Leaf:
    """A surface of a door's leaf.

    Attributes
    ----------
    face : intervals.FaceInterval
    way_m : (2, 2) float64
        The door that it hangs at, from jamb to jamb.
    """

    face: FaceInterval
    way_m: FloatArray

    @property
    def ground(self) -> BaseGeometry:
        """What it stands on: as thick as ends err by."""
        return overlays.buffer_shapes(LineString(self.face.ends), END_M, cap_style="square")

    def cut_off(self, face: FaceInterval) -> list[FaceInterval]:
        """Return a surface, or it and the rest of the one that it was seen as a part of."""
        if face.observation is not self.face.observation:
            return [face]
        low_m, high_m = self.face.low_m, self.face.high_m
        if not face.low_m <= low_m < high_m <= face.high_m:
            return [face]
        before, behind = replace(face, high_m=low_m), replace(face, low_m=high_m)
        return [self.face, *(rest for rest in (before, behind) if rest.length_m > STRETCH_M)]

    def hides(self, face: FaceInterval) -> bool:
        """Return whether most of a surface is of the same leaf, as it stood at another time."""
        is_parallel = abs(face.line.normal @ self.face.line.normal) >= math.cos(LEAST_RAD)
        return bool(is_parallel) and self._is_beside(face, BEHIND_M)

    def is_shown_again_by(self, face: FaceInterval, most_m: float) -> bool:
        """Return whether a surface may be the same one farther off, of a scan placed badly.

        It faces the same way and is no longer: nothing else but a wall behind it does.
        """
        faces_alike = face.line.normal @ self.face.line.normal >= math.cos(LEAST_RAD)
        is_as_short = face.length_m <= self.face.length_m + END_M
        return bool(faces_alike and is_as_short) and self._is_beside(face, most_m)

    def _is_beside(self, face: FaceInterval, most_m: float) -> bool:
        return _beside_m(self.face, face, most_m) >= ALONG_SHARE * face.length_m


def find_leaves(walls: Sequence[PlanWall], *, unpaired_m: float, max_width_m: float) -> list[Leaf]:
    """Find the surfaces of leaves.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        With their openings.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    max_width_m : float
        Of a door from where one wall ends to where another goes on in its line.
    """
    doorways = [
        _Doorway.of_gap(wall, *gap_m, unpaired_m)
        for wall in walls
        for gap_m in _find_gaps(wall, walls, max_width_m)
    ]
    tree = STRtree([LineString(doorway.ends_m) for doorway in doorways])
    reach_m = max((doorway.reach_m for doorway in doorways), default=0.0)
    faces = list_faces(walls)
    leaves = []
    for wall in walls:
        for face in wall.members:
            near = tree.query(LineString(face.ends), predicate="dwithin", distance=reach_m)
            others = [doorways[i] for i in np.sort(near) if doorways[i].wall is not wall]
            leaf = next(_find_leaves_of(face, others, faces, max_width_m), None)
            if leaf:
                leaves.append(leaf)
    return leaves


def _find_leaves_of(
    face: FaceInterval,
    doorways: Sequence["_Doorway"],
    faces: Sequence[FaceInterval],
    max_width_m: float,
) -> Iterator[Leaf]:
    """Yield the leaves that a surface may be, or what of it lies on one side of a way."""
    for doorway in doorways:
        for piece in doorway.cut(face):
            for part in doorway.parts(piece, max_width_m):
                tip_m = part.find_tip(piece)
                if tip_m is not None and _is_free(piece, tip_m, faces):
                    yield Leaf(piece, part.ends_m)


def _find_gaps(
    wall: PlanWall, walls: Sequence[PlanWall], max_width_m: float
) -> Iterator[tuple[float, float]]:
    """Yield from where to where along a wall it is open, or another goes on beyond a door."""
    for opening in wall.openings:
        yield opening.low_m, opening.high_m
    for other in walls:
        low_m, high_m = np.sort(wall.line.along_m(other.ends)).tolist()
        gaps_m = ((high_m, wall.low_m), (wall.high_m, low_m))
        # what is open for longer than it is wall is the space between two things
        most_m = min(max_width_m, wall.length_m + other.length_m)
        gap_m = next((span_m for span_m in gaps_m if 0 < span_m[1] - span_m[0] <= most_m), None)
        if gap_m and wall.goes_on_as(other) and not _is_closed(wall, gap_m, walls):
            yield gap_m


def _is_closed(wall: PlanWall, gap_m: tuple[float, float], walls: Sequence[PlanWall]) -> bool:
    """Return whether another wall stands where one is to be open."""
    middle = Point(wall.line.at(sum(gap_m) / 2))
    return any(LineString(other.ends).distance(middle) <= BEHIND_M for other in walls)


def find_traces(
    leaves: Sequence[Leaf], faces: Sequence[FaceInterval], *, ghost_distance_m: float
) -> list[FaceInterval]:
    """Return the surfaces among faces that are of leaves, as others are that stood elsewhere.

    What lies farther off than a leaf is thick, up to `ghost_distance_m`, is a trace of it where it
    ends free: a wall behind a leaf ends at another.
    """
    of_leaves = [face for face in faces if any(leaf.hides(face) for leaf in leaves)]
    known = set(of_leaves)
    others = [face for face in faces if face not in known]
    traces = []
    for face in others:
        around = [leaf for leaf in leaves if leaf.is_shown_again_by(face, ghost_distance_m)]
        if around and _is_free(face, _farther_end(face, around[0].way_m), others):
            traces.append(face)
    return [*of_leaves, *traces]


def _farther_end(face: FaceInterval, way_m: FloatArray) -> FloatArray:
    """Return the end (2,) of a surface that is farther from a way (2, 2)."""
    line = LineString(way_m)
    one_m, other_m = face.ends
    return max(one_m, other_m, key=lambda end_m: line.distance(Point(end_m)))


def _is_free(face: FaceInterval, tip_m: FloatArray, others: Sequence[FaceInterval]) -> bool:
    """Return whether nothing stands at an end of a surface but the other side of its body.

    What is seen to be thin may also have been seen where it stood at another time.
    """
    tip = Point(tip_m)
    is_thin = any(_is_other_side(face, other) for other in others)
    most_off_m = CORNER_M if is_thin else BEHIND_M
    for other in others:
        is_whole = (
            other.observation is face.observation
            and other.low_m <= face.low_m < face.high_m <= other.high_m
        )
        if is_whole or LineString(other.ends).distance(tip) > CORNER_M:
            continue
        along_m = face.line.along_m(other.ends)
        beyond_m = max(face.low_m - along_m.min(), along_m.max() - face.high_m)
        if np.abs(face.line.offset_m(other.ends)).max() > most_off_m or beyond_m > STRETCH_M:
            return False
    return True


def _is_other_side(face: FaceInterval, other: FaceInterval) -> bool:
    """Return whether a surface is that of a thin body's other side."""
    is_opposite = bool(face.line.normal @ other.line.normal <= -math.cos(LEAST_RAD))
    return is_opposite and _beside_m(face, other, BEHIND_M) >= ALONG_SHARE * face.length_m


def _beside_m(face: FaceInterval, other: FaceInterval, most_m: float) -> float:
    """Return how much of another surface lies no farther from a surface than that, metres."""
    return float(
        overlays.intersect_lines(
            LineString(other.ends), overlays.buffer_shapes(LineString(face.ends), most_m)
        ).length
    )


@dataclass(frozen=True, eq=False)
class _Doorway:
    """An opening (2, 2) of a wall, from jamb to jamb, and its jambs from face to face."""

    wall: PlanWall
    ends_m: FloatArray
    jambs: tuple[LineString, LineString]
    unpaired_m: float

    @staticmethod
    def of_gap(wall: PlanWall, low_m: float, high_m: float, unpaired_m: float) -> "_Doorway":
        """Return the way through a wall, or beyond its end, from one place along it to another."""
        is_single = np.isnan(wall.thickness_m)
        across_m = np.array([-unpaired_m if is_single else -wall.half_m, wall.half_m])
        ends_m = wall.line.at(np.array([low_m, high_m]))
        low, high = (LineString(end + across_m[:, None] * wall.line.normal) for end in ends_m)
        return _Doorway(wall, ends_m, (low, high), unpaired_m)

    def cut(self, face: FaceInterval) -> list[FaceInterval]:
        """Return a surface, or its pieces on either side: no wall runs on through a way."""
        across = overlays.cross_lines(LineString(face.ends), LineString(self.ends_m))
        if across.geom_type != "Point" or across.is_empty:
            return [face]
        (at_m,) = face.line.along_m(np.array(across.coords)).tolist()
        half_m = self.jambs[0].length / 2
        low, high = replace(face, high_m=at_m - half_m), replace(face, low_m=at_m + half_m)
        return [low, high] if min(low.length_m, high.length_m) > STRETCH_M else [face]

    @property
    def reach_m(self) -> float:
        """How far from its middle line a leaf may begin: hinges are anywhere in a jamb."""
        return self.jambs[0].length / 2 + BEHIND_M + END_M

    def parts(self, face: FaceInterval, max_width_m: float) -> "Iterator[_Doorway]":
        """Yield the way, and doors on either side of where a surface hangs in it.

        There a jamb is that something before it hides.
        """
        yield self
        low_m, high_m = np.sort(self.wall.line.along_m(self.ends_m)).tolist()
        middle = LineString(self.ends_m)
        hung_m = [end_m for end_m in face.ends if middle.distance(Point(end_m)) <= self.reach_m]
        for along_m in self.wall.line.along_m(np.array(hung_m).reshape(-1, 2)).tolist():
            sides_m = ((low_m, along_m), (along_m, high_m))
            if min(end_m - begin_m for begin_m, end_m in sides_m) <= CORNER_M:
                continue
            for begin_m, end_m in sides_m:
                if end_m - begin_m <= max_width_m:
                    yield _Doorway.of_gap(self.wall, begin_m, end_m, self.unpaired_m)

    def find_tip(self, face: FaceInterval) -> FloatArray | None:
        """Return the end (2,) of a leaf that hangs here at its other; None of another surface."""
        width_m = float(np.hypot(*(self.ends_m[1] - self.ends_m[0])))
        for hinge_m, tip_m in (face.ends, face.ends[::-1]):
            near_m, jamb = min(
                ((jamb.distance(Point(hinge_m)), jamb) for jamb in self.jambs), key=lambda of: of[0]
            )
            # a part of it may stand in the wall, as hinges may be anywhere in a jamb
            if not ALONG_SHARE * width_m <= jamb.distance(Point(tip_m)) <= width_m + 2 * END_M:
                continue
            hinge_off_m, tip_off_m = abs(self.wall.line.offset_m(np.array([hinge_m, tip_m])))
            # what runs along the wall is the wall, or the back of a niche
            if near_m <= BEHIND_M + END_M and tip_off_m > hinge_off_m + CORNER_M:
                return tip_m
        return None
