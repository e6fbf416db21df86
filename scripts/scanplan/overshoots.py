"""Stretches that cross at a flat angle, as chords of a curve do: each is cut where the other shows the wall better."""

import math
from dataclasses import replace

import numpy as np
import shapely

_MOST_RAD = math.radians(30)
_ROUND_M = 1e-9
_LONGER_M = 0.1


def without(stretches):
    """Cut stretches of one side where they cross others at a flat angle.

    Beyond where two of them cross, both lie near the same wall, and the points lie nearer to one. The other one ends
    at the crossing, unless it goes on further.

    Parameters
    ----------
    stretches : list of stretches.Stretch

    Returns
    -------
    list of stretches.Stretch
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
            scatter = [_scatter_m(s, p, p + sign * min(arm)) for s, p in zip((a, b), place, strict=True)]
            loser = 0 if scatter[0] > scatter[1] else 1
            if arm[loser] <= arm[1 - loser] + _LONGER_M:
                bound[(one, other)[loser]] = place[loser]
    return [replace(s, low_m=a, high_m=max(a, b)) for s, a, b in zip(stretches, low_m, high_m, strict=True)]


def _flat(stretches):
    """Return pairs that cross at a flat angle, of different lines of much the same normal."""
    lines = shapely.linestrings(np.array([s.ends for s in stretches]).reshape(-1, 2, 2))
    pairs = np.stack(shapely.STRtree(lines).query(lines, predicate="crosses"), axis=1).tolist()
    alike = math.cos(_MOST_RAD)
    return sorted((i, j) for i, j in pairs if i < j and stretches[i].line.normal @ stretches[j].line.normal >= alike)


def _crossing_m(one, other):
    turn = float(one.line.direction @ other.line.normal)
    return -float(other.line.offset_m(one.line.centre)) / turn


def _scatter_m(stretch, begin_m, end_m):
    """Return how far points scatter about a part of a stretch; without any, endlessly."""
    points = stretch.seen.hits(min(begin_m, end_m), max(begin_m, end_m))
    offset_m = stretch.seen.hit_off_m[points]
    return float(np.sqrt(np.mean(offset_m**2))) if len(offset_m) else math.inf
