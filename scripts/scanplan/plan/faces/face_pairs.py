"""Pairs of faces that lie near each other, and which of their ends meet at corners."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import shapely

from scanplan.geometry import intersections
from scanplan.plan.tolerances import END_M, FACE_M
from scanplan.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from scanplan.plan.faces.candidates import FaceCandidate
    from scanplan.plan.faces.intervals import FaceInterval


def pair_near(
    faces: Sequence["FaceCandidate | FaceInterval"], distance_m: float
) -> tuple[IntArray, IntArray]:
    """Return the ordered pairs (k,), (k,), sorted, of different faces within a distance."""
    ends_m = np.array([face.ends for face in faces]).reshape(-1, 2, 2)
    strings = np.asarray(shapely.linestrings(ends_m), object)
    one, other = shapely.STRtree(strings).query(strings, predicate="dwithin", distance=distance_m)
    order = np.lexsort((other, one))
    order = order[one[order] != other[order]]
    return one[order], other[order]


def pair_same_side(
    faces: Sequence["FaceCandidate | FaceInterval"], max_angle_rad: float, distance_m: float
) -> tuple[IntArray, IntArray]:
    """Return the pairs of `pair_near` that are seen from the same side."""
    one, other = pair_near(faces, distance_m)
    normal = intersections.stack_spans(faces).normal
    same_side = _dot(normal[one], normal[other]) >= np.cos(max_angle_rad)
    return one[same_side], other[same_side]


def find_corner_moves(
    faces: Sequence["FaceCandidate | FaceInterval"], corner_m: float
) -> list[tuple[int, str, float]]:
    """Return (face, name of the end, place) of ends that may move to another's line."""
    one, other = pair_near(faces, 2 * corner_m)
    spans = intersections.stack_spans(faces)
    along = np.column_stack([spans.normal[:, 1], -spans.normal[:, 0]])
    turn = _dot(along[one], spans.normal[other])
    steep = np.abs(turn) >= np.sin(intersections.LEAST_RAD)
    one = one[steep]
    other = other[steep]
    turn = turn[steep]
    between_m = spans.centre[one] - spans.centre[other]
    place_m = -_dot(between_m, spans.normal[other]) / turn
    there_m = _dot(
        spans.centre[one] + place_m[:, None] * along[one] - spans.centre[other], along[other]
    )
    at_low, end_m = _nearest_end(place_m, spans.low_m[one], spans.high_m[one])
    beyond_m = np.maximum(spans.low_m[other] - there_m, there_m - spans.high_m[other])
    in_front = np.where(at_low, turn, -turn) > 0
    # an edge seen from outside: the other face, too, ends here and lies behind this one
    other_at_low, other_end_m = _nearest_end(there_m, spans.low_m[other], spans.high_m[other])
    other_ends = np.abs(there_m - other_end_m) <= corner_m
    other_behind = np.where(other_at_low, 1, -1) * _dot(along[other], spans.normal[one]) < 0
    before_m = np.where(at_low, place_m - end_m, end_m - place_m)
    other_before_m = np.where(other_at_low, there_m - other_end_m, other_end_m - there_m)
    is_edge = other_ends & other_behind & _do_meet(before_m, other_before_m)
    is_near = (np.abs(place_m - end_m) <= corner_m) & (np.maximum(beyond_m, 0) <= corner_m)
    moves = is_near & (in_front | is_edge)
    names = np.where(at_low, "low_m", "high_m")
    return list(
        zip(one[moves].tolist(), names[moves].tolist(), place_m[moves].tolist(), strict=True)
    )


def _nearest_end(
    place_m: FloatArray, low_m: FloatArray, high_m: FloatArray
) -> tuple[BoolArray, FloatArray]:
    """Return whether the low end is the nearer one of each place (k,), and the nearer end (k,)."""
    at_low = np.abs(place_m - low_m) <= np.abs(place_m - high_m)
    return at_low, np.where(at_low, low_m, high_m)


def _do_meet(before_m: FloatArray, other_before_m: FloatArray) -> BoolArray:
    """Return which pairs (k,) end at their crossing, by how far before it each is seen to begin.

    A face that is seen well before another one ends there only if that one is seen to begin there:
    one would look at the other's front from where the first is.
    """
    are_close = np.maximum(before_m, other_before_m) <= FACE_M
    return are_close | (np.minimum(before_m, other_before_m) >= -END_M)


def _dot(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.einsum("ij,ij->i", one, other)
