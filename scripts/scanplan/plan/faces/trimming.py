"""What stretches show too much.

Chords of a curve beyond each other, and stray points beyond a corner.
"""

import math
from dataclasses import replace

import numpy as np
import shapely

from scanplan.geometry import intersections

_MOST_RAD = math.radians(30)
_ROUND_M = 1e-9
_LONGER_M = 0.1
_REACH_M = 0.1
_TAIL_M = 1.0


def trim_overshoots(stretches):
    """Cut stretches of one side where they cross others at a flat angle.

    Beyond where two of them cross, both lie near the same wall, and the points lie nearer to one.
    The other one ends at the crossing, unless it goes on further.

    Parameters
    ----------
    stretches : list of intervals.FaceInterval

    Returns
    -------
    list of intervals.FaceInterval
        In the order given; some may have no length left.
    """
    low_m, high_m = ([float(getattr(s, name)) for s in stretches] for name in ("low_m", "high_m"))
    for one, other in _flat(stretches):
        a, b = stretches[one], stretches[other]
        place = _crossing_m(a, b), _crossing_m(b, a)
        for sign, bound in ((1, high_m), (-1, low_m)):
            arm = sign * (bound[one] - place[0]), sign * (bound[other] - place[1])
            if min(arm) <= _ROUND_M:
                continue
            scatter = [
                _scatter_m(s, p, p + sign * min(arm)) for s, p in zip((a, b), place, strict=True)
            ]
            loser = 0 if scatter[0] > scatter[1] else 1
            if arm[loser] <= arm[1 - loser] + _LONGER_M:
                bound[(one, other)[loser]] = place[loser]
    return [
        replace(s, low_m=a, high_m=max(a, b))
        for s, a, b in zip(stretches, low_m, high_m, strict=True)
    ]


def trim_tails(stretches, *, share):
    """Cut what goes on up to a metre behind a crossing face with too few points a metre.

    Parameters
    ----------
    stretches : list of intervals.FaceInterval
    share : float, 0 to 1
        Fewer points a metre than this share of the whole stretch's are too few; 0 cuts nothing.

    Returns
    -------
    list of intervals.FaceInterval
        In the order given.
    """
    stacked = intersections.stack_spans(stretches)
    return [
        _without_tails(
            s, intersections.find_crossings(s.line, stacked, reach_m=_REACH_M).place_m, share
        )
        for s in stretches
    ]


def _without_tails(stretch, places_m, share):
    few = share * stretch.n_points / max(stretch.length_m, _ROUND_M)
    on_it = places_m[(places_m >= stretch.low_m) & (places_m <= stretch.high_m)]
    for place_m in sorted(
        on_it.tolist(), key=lambda place: abs(place - (stretch.low_m + stretch.high_m) / 2)
    ):
        for name, sign in (("low_m", -1), ("high_m", 1)):
            tail_m = sign * (getattr(stretch, name) - place_m)
            far = sorted((place_m + sign * _REACH_M, getattr(stretch, name)))
            if _REACH_M < tail_m <= _TAIL_M and _count(stretch.seen, *far) < few * (
                tail_m - _REACH_M
            ):
                stretch = replace(stretch, **{name: place_m})
    return stretch


def _count(seen, low_m, high_m):
    points = seen.occupied_between(low_m, high_m)
    return points.stop - points.start


def _flat(stretches):
    """Return pairs that cross at a flat angle, of different lines of much the same normal."""
    lines = shapely.linestrings(np.array([s.ends for s in stretches]).reshape(-1, 2, 2))
    pairs = np.stack(shapely.STRtree(lines).query(lines, predicate="crosses"), axis=1).tolist()
    alike = math.cos(_MOST_RAD)
    return sorted(
        (i, j)
        for i, j in pairs
        if i < j and stretches[i].line.normal @ stretches[j].line.normal >= alike
    )


def _crossing_m(one, other):
    turn = float(one.line.direction @ other.line.normal)
    return -float(other.line.offset_m(one.line.centre)) / turn


def _scatter_m(stretch, begin_m, end_m):
    """Return how far points scatter about a part of a stretch; without any, endlessly."""
    points = stretch.seen.occupied_between(min(begin_m, end_m), max(begin_m, end_m))
    offset_m = stretch.seen.occupied_off_m[points]
    return float(np.sqrt(np.mean(offset_m**2))) if len(offset_m) else math.inf
