"""Where spans cross a line."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line, SpanLike
from scanplan.types import FloatArray, IntArray

LEAST_RAD = math.radians(30)
"""Flatter crossings are of one curve, or noise moves them far along both lines."""


@dataclass(frozen=True, eq=False)
class SpanArrays:
    """Spans as arrays: a point and the unit normal of each one's line, and its extent along it.

    Attributes
    ----------
    centre, normal : (n, 2) float64
    low_m, high_m : (n,) float64
    """

    centre: FloatArray
    normal: FloatArray
    low_m: FloatArray
    high_m: FloatArray


@dataclass(frozen=True, eq=False)
class Crossings:
    """The spans that cross a line.

    Attributes
    ----------
    which : (k,) int64, increasing
    place_m : (k,) float64
        Where, along the line.
    sine : (k,) float64
        Of the angle between them.
    """

    which: IntArray
    place_m: FloatArray
    sine: FloatArray


def stack_spans(spans: Sequence[SpanLike]) -> SpanArrays:
    """Return spans as arrays."""
    return SpanArrays(
        np.array([span.line.centre for span in spans]).reshape(-1, 2),
        np.array([span.line.normal for span in spans]).reshape(-1, 2),
        np.array([span.low_m for span in spans], float),
        np.array([span.high_m for span in spans], float),
    )


def run_across(one: Line, other: Line) -> bool:
    """Return whether two lines are about square to each other."""
    return abs(float(one.direction @ other.normal)) >= math.cos(LEAST_RAD)


def find_crossings(line: Line, others: SpanArrays, *, reach_m: float) -> Crossings:
    """Find the spans that cross a line steeply.

    Parameters
    ----------
    reach_m : float
        A span that ends this near before the line crosses it, too.

    Returns
    -------
    Crossings
        Of those that turn by 30 degrees or more.
    """
    turn = others.normal @ line.direction
    steep = np.flatnonzero(np.abs(turn) >= math.sin(LEAST_RAD))
    centre, normal = others.centre[steep], others.normal[steep]
    turn = turn[steep]
    place_m = -np.einsum("ij,ij->i", line.centre - centre, normal) / turn
    along = np.column_stack([normal[:, 1], -normal[:, 0]])
    there_m = np.einsum("ij,ij->i", line.at(place_m) - centre, along)
    on_it = (there_m >= others.low_m[steep] - reach_m) & (there_m <= others.high_m[steep] + reach_m)
    return Crossings(steep[on_it], place_m[on_it], np.abs(turn[on_it]))
