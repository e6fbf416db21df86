"""Leaves of open doors in planar scans.

A leaf stands in the room like a short wall. It hangs at a jamb of its door, is as long as the door
is wide, and ends free: a wall ends at another, or is as long as its room asks for.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.intersections import LEAST_RAD
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M, END_M
from scanplan.rays.tolerances import BEHIND_M
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
        return LineString(self.face.ends).buffer(END_M, cap_style="square")

    def hides(self, face: FaceInterval) -> bool:
        """Return whether most of a surface is of the same leaf, as it stood at another time."""
        is_parallel = abs(face.line.normal @ self.face.line.normal) >= math.cos(LEAST_RAD)
        return bool(is_parallel) and self._is_beside(face, BEHIND_M)

    def is_shown_again_by(self, face: FaceInterval) -> bool:
        """Return whether a surface may be the same one farther off, of a scan placed badly.

        It faces the same way and is no longer: nothing else but a wall behind it does.
        """
        faces_alike = face.line.normal @ self.face.line.normal >= math.cos(LEAST_RAD)
        is_as_short = face.length_m <= self.face.length_m + END_M
        return bool(faces_alike and is_as_short) and self._is_beside(face, CORNER_M)

    def _is_beside(self, face: FaceInterval, most_m: float) -> bool:
        along = LineString(face.ends)
        near = LineString(self.face.ends).buffer(most_m)
        return bool(along.intersection(near).length >= ALONG_SHARE * along.length)


def find_leaves(walls: Sequence[PlanWall], *, unpaired_m: float) -> list[Leaf]:
    """Find the surfaces of leaves.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        With their openings.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    """
    ways = [_Way.of_gap(wall, gap, unpaired_m) for wall in walls for gap in wall.openings]
    faces = [face for wall in walls for face in wall.members]
    leaves = []
    for wall in walls:
        for face in wall.members:
            for way in ways:
                tip_m = None if way.wall is wall else way.find_tip(face)
                if tip_m is not None and _is_free(face, tip_m, faces):
                    leaves.append(Leaf(face, way.ends_m))
                    break
    return leaves


def find_traces(leaves: Sequence[Leaf], faces: Sequence[FaceInterval]) -> list[FaceInterval]:
    """Return the surfaces among faces that are of leaves, as others are that stood elsewhere.

    What lies farther off than a leaf is thick is a trace of it where it ends free: a wall behind a
    leaf ends at another.
    """
    of_leaves = [face for face in faces if any(leaf.hides(face) for leaf in leaves)]
    known = set(map(id, of_leaves))
    others = [face for face in faces if id(face) not in known]
    traces = []
    for face in others:
        around = [leaf for leaf in leaves if leaf.is_shown_again_by(face)]
        if around and _is_free(face, _farther_end(face, around[0].way_m), others):
            traces.append(face)
    return [*of_leaves, *traces]


def _farther_end(face: FaceInterval, way_m: FloatArray) -> FloatArray:
    """Return the end (2,) of a surface that is farther from a way (2, 2)."""
    way = LineString(way_m)
    one_m, other_m = face.ends
    return max(one_m, other_m, key=lambda end_m: way.distance(Point(end_m)))


def _is_free(face: FaceInterval, tip_m: FloatArray, others: Sequence[FaceInterval]) -> bool:
    """Return whether nothing stands at an end of a surface but the other side of its body."""
    tip = Point(tip_m)
    for other in others:
        if LineString(other.ends).distance(tip) > CORNER_M:
            continue
        along_m = face.line.along_m(other.ends)
        beyond_m = max(face.low_m - along_m.min(), along_m.max() - face.high_m)
        if np.abs(face.line.offset_m(other.ends)).max() > BEHIND_M or beyond_m > CORNER_M:
            return False
    return True


@dataclass(frozen=True, eq=False)
class _Way:
    """An opening (2, 2) of a wall, from jamb to jamb, and its jambs from face to face."""

    wall: PlanWall
    ends_m: FloatArray
    jambs: tuple[LineString, LineString]

    @staticmethod
    def of_gap(wall: PlanWall, gap: Opening, unpaired_m: float) -> "_Way":
        """Return the way through an opening of a wall."""
        is_single = np.isnan(wall.thickness_m)
        across_m = np.array([-unpaired_m if is_single else -wall.half_m, wall.half_m])
        ends_m = wall.line.at(np.array([gap.low_m, gap.high_m]))
        low, high = (LineString(end + across_m[:, None] * wall.line.normal) for end in ends_m)
        return _Way(wall, ends_m, (low, high))

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
