"""Candidates of faces: cut from common lines at gaps; and what holds for intervals, too.

Ends meet at corners, and no face is drawn over another.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from scanplan.geometry import intervals, lines
from scanplan.geometry.lines import Line, ObservedSegments, Span
from scanplan.plan.faces import face_pairs
from scanplan.types import FloatArray, IntArray

if TYPE_CHECKING:
    from scanplan.plan.faces.intervals import FaceInterval


FaceT = TypeVar("FaceT", "FaceCandidate", "FaceInterval")
"""A face of either form."""


@dataclass(frozen=True, eq=False)
class FaceCandidate(Span):
    """A part of a line that segments agree on, where they may show a face.

    From `low_m` to `high_m` along the line, and the segments (k,) that show it.
    """

    segments: ObservedSegments
    line: Line
    low_m: float
    high_m: float
    members: IntArray

    @cached_property
    def points(self) -> FloatArray:
        """How many points of each member lie on the candidate, (k,) float64."""
        low_m, high_m = lines.extents_along_m(self.line, self.segments, self.members)
        inside_m = np.minimum(high_m, self.high_m) - np.maximum(low_m, self.low_m)
        share = np.clip(inside_m, 0, None)
        return self.segments.n_points[self.members] * share / (high_m - low_m)

    @cached_property
    def n_points(self) -> float:
        """How many points lie on the candidate."""
        return float(self.points.sum())

    @cached_property
    def n_scans(self) -> int:
        """How many scans show the candidate."""
        return len(np.unique(self.segments.scan_id[self.members[self.points > 0]]))


def cut_candidates(
    segments: ObservedSegments, members: IntArray, *, max_gap_m: float
) -> list[FaceCandidate]:
    """Cut a group's line where none of its members shows the face for more than `max_gap_m`.

    Parameters
    ----------
    segments : lines.ObservedSegments
    members : (k,) int64
    max_gap_m : float

    Returns
    -------
    list of FaceCandidate
        All on the group's common line, in order along it.
    """
    line = lines.fit_segments_line(segments, members)
    low_m, high_m = lines.extents_along_m(line, segments, members)
    order = np.argsort(low_m, kind="stable")
    low_m = low_m[order]
    high_m = np.maximum.accumulate(high_m[order])
    breaks = intervals.find_run_starts(low_m, high_m, max_gap_m)
    begins_m = low_m[np.r_[0, breaks]]
    ends_m = high_m[np.r_[breaks, len(low_m)] - 1]
    shares = np.split(np.asarray(members)[order], breaks)
    return [
        FaceCandidate(segments, line, float(begin_m), float(end_m), np.sort(share))
        for begin_m, end_m, share in zip(begins_m, ends_m, shares, strict=True)
    ]


def meet_at_corners(faces: Sequence[FaceT], *, corner_m: float) -> list[FaceT]:
    """Move the ends of faces to where their lines cross, if that is no further than `corner_m`.

    A face ends at the corner of a room in front of the other face, at the edge of a pillar behind
    it; a face that butts against the middle of another ends on it. Lines keep their place, only
    extents change.

    Parameters
    ----------
    faces : list of FaceCandidate, or of intervals.FaceInterval
    corner_m : float
        0 moves nothing.

    Returns
    -------
    list of the same, in the order given
    """
    places_m: list[dict[str, list[float]]] = [{} for _ in faces]
    for number, end, place_m in face_pairs.find_corner_moves(faces, corner_m):
        places_m[number].setdefault(end, []).append(place_m)
    return [_move_ends(face, moves) for face, moves in zip(faces, places_m, strict=True)]


def remove_doubles(
    faces: Sequence[FaceT],
    *,
    max_angle_rad: float,
    distance_m: float,
    ghost_distance_m: float,
    ghost_share: float,
) -> list[FaceT]:
    """Take away from every face what a stronger one of the same side already draws.

    That is what runs closer than `distance_m` beside it, and, further off, up to
    `ghost_distance_m`, what shows less than `ghost_share` of its points per metre: the same wall
    once more from a scan that was placed badly.

    Parameters
    ----------
    faces : list of FaceCandidate, or of intervals.FaceInterval
    max_angle_rad : float
        Faces that turn further from each other are different faces, however close.
    distance_m : float
    ghost_distance_m : float
    ghost_share : float, 0 to 1
        0 leaves ghosts standing.

    Returns
    -------
    list of the same
        The strongest (longest seen by most points) first; a face may have become several or none.
    """
    points = np.array([face.n_points for face in faces])
    length_m = np.array([face.length_m for face in faces])
    widest_m = max(distance_m, ghost_distance_m)
    one, other = face_pairs.pair_same_side(faces, max_angle_rad, widest_m)
    is_ghost = points[one] * length_m[other] < ghost_share * points[other] * length_m[one]
    beside: list[list[tuple[int, float]]] = [[] for _ in faces]
    for weaker, stronger, width_m in zip(
        one.tolist(), other.tolist(), np.where(is_ghost, widest_m, distance_m), strict=True
    ):
        beside[weaker].append((stronger, width_m))
    order = np.argsort(-points * length_m, kind="stable").tolist()
    rests: dict[int, list[FaceT]] = {}
    for number in order:
        rest = [faces[number]]
        for stronger, width_m in beside[number]:
            for drawn in rests.get(stronger, ()):
                rest = [part for face in rest for part in _subtract(face, drawn, width_m)]
        rests[number] = rest
    return [face for number in order for face in rests[number]]


def doubled_interval_m(face: FaceT, other: FaceT, distance_m: float) -> tuple[float, float]:
    """Return where along a face it runs closer than `distance_m` beside another.

    The end is no less than the begin, and equal to it where the face does so nowhere.
    """
    along = (
        float(other.line.along_m(face.line.centre)),
        float(face.line.direction @ other.line.direction),
        other.low_m,
        other.high_m,
    )
    across = (
        float(other.line.offset_m(face.line.centre)),
        float(face.line.direction @ other.line.normal),
        -distance_m,
        distance_m,
    )
    low_m = face.low_m
    high_m = face.high_m
    for value, slope, least, most in (along, across):
        begin_m, end_m = intervals.solve_range(value, slope, least, most)
        low_m = max(low_m, float(begin_m))
        high_m = min(high_m, float(end_m))
    return low_m, max(low_m, high_m)


def _move_ends(face: FaceT, places_m: dict[str, list[float]]) -> FaceT:
    """Return a face with each end at the nearest of its places, unless little were left of it."""
    if not places_m:
        return face
    nearest_m = {end: _nearest(ends_m, getattr(face, end)) for end, ends_m in places_m.items()}
    moved = replace(face, **nearest_m)
    return moved if moved.length_m >= face.length_m / 2 else face


def _nearest(places_m: list[float], own_m: float) -> float:
    """Return the place nearest to an own one, the lower one of two as near."""
    return min(places_m, key=lambda place_m: (abs(place_m - own_m), place_m))


def _subtract(face: FaceT, stronger: FaceT, distance_m: float) -> list[FaceT]:
    """Return what is left of a face, one part or two, without what a stronger one draws."""
    low_m, high_m = doubled_interval_m(face, stronger, distance_m)
    if high_m <= low_m:
        return [face]
    parts = [replace(face, high_m=low_m), replace(face, low_m=high_m)]
    return [part for part in parts if part.length_m > 0]
