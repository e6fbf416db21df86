"""Where straight stretches cross a line."""

import math
from dataclasses import dataclass

import numpy as np

_LEAST_RAD = math.radians(30)


@dataclass(frozen=True, eq=False)
class SpanArrays:
    """Straight stretches as arrays: a point and the unit normal of each one's line, and its extent along that.

    Attributes
    ----------
    centre, normal : (n, 2) float64
    low_m, high_m : (n,) float64
    """

    centre: np.ndarray
    normal: np.ndarray
    low_m: np.ndarray
    high_m: np.ndarray


@dataclass(frozen=True, eq=False)
class Crossings:
    """The stretches that cross a line.

    Attributes
    ----------
    which : (k,) int64, increasing
    place_m : (k,) float64
        Where, along the line.
    sine : (k,) float64
        Of the angle between them.
    """

    which: np.ndarray
    place_m: np.ndarray
    sine: np.ndarray


def stack_spans(pieces):
    """Return pieces (anything with a `line`, `low_m` and `high_m`) as `SpanArrays`."""
    return SpanArrays(
        np.array([p.line.centre for p in pieces]).reshape(-1, 2),
        np.array([p.line.normal for p in pieces]).reshape(-1, 2),
        np.array([p.low_m for p in pieces], float),
        np.array([p.high_m for p in pieces], float),
    )


def find_crossings(line, others, *, reach_m):
    """Find the stretches that cross a line steeply.

    Parameters
    ----------
    line : lines.Line
    others : Stretches
    reach_m : float
        A stretch that ends this near before the line crosses it, too.

    Returns
    -------
    Crossings
        Of those that turn by 30 degrees or more.
    """
    turn = others.normal @ line.direction
    steep = np.flatnonzero(np.abs(turn) >= math.sin(_LEAST_RAD))
    centre, normal, turn = others.centre[steep], others.normal[steep], turn[steep]
    place_m = -np.einsum("ij,ij->i", line.centre - centre, normal) / turn
    along = np.column_stack([normal[:, 1], -normal[:, 0]])
    there_m = np.einsum("ij,ij->i", line.at(place_m) - centre, along)
    on_it = (there_m >= others.low_m[steep] - reach_m) & (there_m <= others.high_m[steep] + reach_m)
    return Crossings(steep[on_it], place_m[on_it], np.abs(turn[on_it]))
