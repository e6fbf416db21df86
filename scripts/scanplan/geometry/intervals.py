"""Intervals on a line: what they cover, their gaps, and where a linear function is in range.

Intervals are (n, 2) arrays of begin and end, or two arrays (n,) of begins and ends, metres; they
may overlap.
"""

import numpy as np

from scanplan.types import Array, FloatArray, IntArray


def find_gaps(
    intervals_m: FloatArray, low_m: float | None = None, high_m: float | None = None
) -> FloatArray:
    """Return the gaps (m, 2) that intervals (n, 2), n >= 1, leave between two places, in order.

    Without places, the gaps between the first begin and the last end.

    >>> find_gaps(np.array([[1.0, 2.0], [4.0, 5.0]]), 0.0, 5.0).tolist()
    [[0.0, 1.0], [2.0, 4.0]]
    """
    begin_m, end_m = intervals_m[np.argsort(intervals_m[:, 0], kind="stable")].T
    first_m = begin_m[0] if low_m is None else low_m
    last_m = end_m.max() if high_m is None else high_m
    gap_begin_m = np.maximum.accumulate(np.concatenate([[first_m], end_m]))
    gap_end_m = np.minimum(np.concatenate([begin_m, [last_m]]), last_m)
    gaps_m = np.column_stack([gap_begin_m, gap_end_m])
    return gaps_m[gap_end_m > gap_begin_m]


def find_run_starts(begin_m: FloatArray, end_m: FloatArray, max_gap_m: float) -> IntArray:
    """Return which intervals, but the first, begin a new run: those after more than `max_gap_m`.

    Parameters
    ----------
    begin_m, end_m : (n,) float
        By begin; equal where the intervals are positions.

    Examples
    --------
    >>> find_run_starts(np.array([0.0, 1.1, 3.0]), np.array([1.0, 2.0, 4.0]), 0.5).tolist()
    [2]
    """
    reached_m = np.maximum.accumulate(end_m)
    return np.flatnonzero(begin_m[1:] - reached_m[:-1] > max_gap_m) + 1


def added_lengths_m(begin_m: FloatArray, end_m: FloatArray) -> FloatArray:
    """Return the length (n,) that each interval adds to the union of those before it.

    Parameters
    ----------
    begin_m, end_m : (n,) float
        By begin.

    Examples
    --------
    >>> added_lengths_m(np.array([0.0, 1.0]), np.array([2.0, 5.0])).tolist()
    [2.0, 3.0]
    """
    reached_m = np.maximum.accumulate(np.concatenate([[-np.inf], end_m]))[:-1]
    return np.maximum(end_m - np.maximum(begin_m, reached_m), 0)


def solve_range(
    start: Array | float, slope: Array | float, least: float | Array, most: float | Array
) -> tuple[FloatArray, FloatArray]:
    """Return the interval of s with least <= start + slope * s <= most: low (p,), high (p,).

    All of the line where the slope is 0 and the start is in range; low > high where nothing solves
    it.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = np.divide(least - start, slope), np.divide(most - start, slope)
    is_level = np.equal(slope, 0)
    is_inside = is_level & (np.less_equal(least, start) & np.less_equal(start, most))
    low = np.where(is_level, np.where(is_inside, -np.inf, np.inf), np.minimum(one, other))
    high = np.where(is_level, np.where(is_inside, np.inf, -np.inf), np.maximum(one, other))
    return low, high


def number_within(counts: IntArray) -> IntArray:
    """Return 0, 1 and so on for the members of each group in turn, given how many (n,) each has.

    >>> number_within(np.array([2, 0, 3])).tolist()
    [0, 1, 0, 1, 2]
    """
    return np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
