"""What intervals show too much.

Chords of a curve beyond each other, and stray points beyond a corner.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.geometry import intersections
from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_observation import FaceObservation
from scanplan.types import FloatArray

_TAIL_M = 1.0  # longer is no tail: a face that is seen poorly goes on


def trim_overshoots(intervals: Sequence[FaceInterval]) -> list[FaceInterval]:
    """Cut intervals of one side where they cross others at a flat angle.

    Beyond where two of them cross, both lie near the same wall, and the points lie nearer to one.
    The other one ends at the crossing, unless it goes on further.

    Parameters
    ----------
    intervals : list of FaceInterval

    Returns
    -------
    list of FaceInterval
        In the order given; some may have no length left.
    """
    low_m = [float(interval.low_m) for interval in intervals]
    high_m = [float(interval.high_m) for interval in intervals]
    for numbers in _cross_flat(intervals):
        pair = [intervals[number] for number in numbers]
        places_m = (_crossing_m(pair[0], pair[1]), _crossing_m(pair[1], pair[0]))
        for sign, ends_m in ((1, high_m), (-1, low_m)):
            arms_m = [
                sign * (ends_m[number] - place_m)
                for number, place_m in zip(numbers, places_m, strict=True)
            ]
            if min(arms_m) <= ROUNDING:
                continue
            loser = _select_loser(pair, places_m, sign * min(arms_m))
            if arms_m[loser] <= arms_m[1 - loser] + END_M:
                ends_m[numbers[loser]] = places_m[loser]
    return [
        replace(interval, low_m=begin_m, high_m=max(begin_m, end_m))
        for interval, begin_m, end_m in zip(intervals, low_m, high_m, strict=True)
    ]


def trim_tails(intervals: Sequence[FaceInterval], *, share: float) -> list[FaceInterval]:
    """Cut what goes on up to a metre behind a crossing face with too few points a metre.

    Parameters
    ----------
    intervals : list of FaceInterval
    share : float, 0 to 1
        Fewer points a metre than this share of the whole interval's are too few; 0 cuts nothing.

    Returns
    -------
    list of FaceInterval
        In the order given.
    """
    stacked = intersections.stack_spans(intervals)
    trimmed = []
    for interval in intervals:
        crossings = intersections.find_crossings(interval.line, stacked, reach_m=END_M)
        trimmed.append(_without_tails(interval, crossings.place_m, share))
    return trimmed


def _without_tails(interval: FaceInterval, places_m: FloatArray, share: float) -> FaceInterval:
    """Return an interval, cut at the places of crossings behind which too few points lie."""
    least_per_m = share * interval.n_points / max(interval.length_m, ROUNDING)
    is_on_it = (places_m >= interval.low_m) & (places_m <= interval.high_m)
    middle_m = (interval.low_m + interval.high_m) / 2
    for place_m in sorted(places_m[is_on_it].tolist(), key=lambda place_m: abs(place_m - middle_m)):
        for name, sign in (("low_m", -1), ("high_m", 1)):
            end_m = getattr(interval, name)
            tail_m = sign * (end_m - place_m)
            if not END_M < tail_m <= _TAIL_M:
                continue
            begin_m, stop_m = sorted((place_m + sign * END_M, end_m))
            n_points = _count_points(interval.observation, begin_m, stop_m)
            if n_points < least_per_m * (tail_m - END_M):
                interval = replace(interval, **{name: place_m})
    return interval


def _count_points(observation: FaceObservation, low_m: float, high_m: float) -> int:
    """Return the number of points of an observation between two places."""
    points = observation.occupied_between(low_m, high_m)
    return points.stop - points.start


def _cross_flat(intervals: Sequence[FaceInterval]) -> list[tuple[int, int]]:
    """Return pairs that cross at a flat angle, of different lines of much the same normal."""
    ends_m = np.array([interval.ends for interval in intervals]).reshape(-1, 2, 2)
    strings = np.asarray(shapely.linestrings(ends_m), object)
    pairs = shapely.STRtree(strings).query(strings, predicate="crosses").T.tolist()
    least_cosine = math.cos(intersections.LEAST_RAD)
    return sorted(
        (i, j)
        for i, j in pairs
        if i < j and intervals[i].line.normal @ intervals[j].line.normal >= least_cosine
    )


def _crossing_m(one: FaceInterval, other: FaceInterval) -> float:
    """Return the place along one interval's line at which it crosses the other's."""
    turn = float(one.line.direction @ other.line.normal)
    return -float(other.line.offset_m(one.line.centre)) / turn


def _select_loser(pair: list[FaceInterval], places_m: tuple[float, float], arm_m: float) -> int:
    """Return which of two, 0 or 1, the points from a crossing to an arm's end lie farther from."""
    scatter_m = [
        _scatter_m(interval, place_m, place_m + arm_m)
        for interval, place_m in zip(pair, places_m, strict=True)
    ]
    return 0 if scatter_m[0] > scatter_m[1] else 1


def _scatter_m(interval: FaceInterval, begin_m: float, end_m: float) -> float:
    """Return how far points scatter about a part of an interval; without any, endlessly."""
    points = interval.observation.occupied_between(min(begin_m, end_m), max(begin_m, end_m))
    offset_m = interval.observation.occupied_off_m[points]
    return float(np.sqrt(np.mean(offset_m**2))) if len(offset_m) else math.inf
