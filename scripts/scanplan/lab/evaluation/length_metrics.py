"""How much of one set of lines lies near another: completeness and correctness of walls.

The buffer method of road extraction (Heipke, Mayer, Wiedemann and Jamet 1997, "Evaluation of
automatic road extraction"). The points of a line within a distance of another are one interval, as
both are convex: it is computed exactly, and nothing is sampled. Lines are (n, 2, 2) arrays: start
and end, x and y, metres.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike

from scanplan.geometry import intervals
from scanplan.geometry.lines import line_lengths_m
from scanplan.types import Columns, FloatArray, IntArray

_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")


@dataclass(frozen=True)
class NearIntervals:
    """Intervals of lines that lie near other lines.

    Attributes
    ----------
    line, other : (p,) int
        The line an interval is part of and the other line that it is near to.
    low_m, high_m : (p,) float64
        Where it begins and ends, measured along the line from its start; low < high.
    """

    line: IntArray
    other: IntArray
    low_m: FloatArray
    high_m: FloatArray


@dataclass(frozen=True)
class Agreement:
    """Completeness, correctness and their harmonic mean, each from 0 to 1."""

    completeness: float
    correctness: float
    f1: float


def table_lines_m(columns: Columns) -> FloatArray:
    """Return the lines (n, 2, 2) of a table with the columns x0_m, y0_m, x1_m, y1_m."""
    return np.column_stack([columns[name] for name in _ENDS]).reshape(-1, 2, 2)


def find_near_intervals(
    lines_m: ArrayLike, others_m: ArrayLike, distance_m: float
) -> NearIntervals:
    """Find the intervals of lines within a distance of other lines.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
    others_m : (m, 2, 2) float
    distance_m : float, > 0

    Returns
    -------
    NearIntervals
        By line, then by other line. Lines of no length have none and cause none.

    Raises
    ------
    ValueError
        If the distance is not above 0.
    """
    if distance_m <= 0:
        raise ValueError(f"distance_m is {distance_m}, must be above 0")
    lines_m = np.asarray(lines_m, float).reshape(-1, 2, 2)
    others_m = np.asarray(others_m, float).reshape(-1, 2, 2)
    tree = shapely.STRtree(np.asarray(shapely.linestrings(others_m)))
    near = tree.query(shapely.linestrings(lines_m), predicate="dwithin", distance=distance_m)
    line, other = near[:, np.lexsort(near[::-1])]
    low_m, high_m = _interval(lines_m[line], others_m[other], distance_m)
    kept = (high_m > low_m) & (line_lengths_m(others_m)[other] > 0)
    return NearIntervals(line[kept], other[kept], low_m[kept], high_m[kept])


def union_length_m(near: NearIntervals, n_lines: int) -> FloatArray:
    """Return how much (n_lines,) of each line lies in the union of its intervals."""
    order = np.lexsort((near.low_m, near.line))
    line, low_m, high_m = near.line[order], near.low_m[order], near.high_m[order]
    # all lines laid end to end, far enough apart: one running maximum serves for all of them
    shift = line * (2 * high_m.max(initial=0.0) + 1)
    added_m = intervals.added_lengths_m(low_m + shift, high_m + shift)
    return np.bincount(line, added_m, minlength=n_lines).astype(float)


def safe_share(part: float, whole: float) -> float:
    """Return part of whole; of nothing it is 1, as nothing of it is missing."""
    return min(float(part / whole), 1.0) if whole > 0 else 1.0


def f1_score(completeness: float, correctness: float) -> float:
    """Return the harmonic mean; 0 where both are."""
    total = completeness + correctness
    return 2 * completeness * correctness / total if total > 0 else 0.0


def compare_lines(result_m: ArrayLike, truth_m: ArrayLike, within_m: float) -> Agreement:
    """Compare resulting lines with true ones.

    Parameters
    ----------
    result_m : (n, 2, 2) float
        May overlap each other: completeness counts true length once, correctness every resulting
        length.
    truth_m : (m, 2, 2) float

    Returns
    -------
    Agreement
        Completeness is the share of true length within `within_m` of a result, 1 if there is no
        truth; correctness the share of resulting length within `within_m` of the truth, 1 if there
        is no result.
    """
    completeness = _near_share(truth_m, result_m, within_m)
    correctness = _near_share(result_m, truth_m, within_m)
    return Agreement(completeness, correctness, f1_score(completeness, correctness))


def _near_share(lines_m: ArrayLike, others_m: ArrayLike, within_m: float) -> float:
    lines_m = np.asarray(lines_m, float).reshape(-1, 2, 2)
    near_m = union_length_m(find_near_intervals(lines_m, others_m, within_m), len(lines_m))
    return safe_share(near_m.sum(), line_lengths_m(lines_m).sum())


def _interval(
    line_m: FloatArray, other_m: FloatArray, distance_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return where (p,) each line enters and leaves the stadium around the other one.

    Low is not below high if it does not. The stadium is a rectangle and two discs. It is convex, so
    what lies between the parts of the line inside those three lies inside too.
    """
    length_m, along = _unit(line_m)
    width_m, across = _unit(other_m)
    from_start = line_m[:, 0] - other_m[:, 0]
    from_end = line_m[:, 0] - other_m[:, 1]
    parts = [
        _in_rectangle(from_start, along, across, width_m, distance_m),
        _in_disc(from_start, along, distance_m),
        _in_disc(from_end, along, distance_m),
    ]
    lows, highs = (np.stack(side) for side in zip(*parts, strict=True))
    empty = lows >= highs
    low_m = np.where(empty, np.inf, lows).min(axis=0)
    high_m = np.where(empty, -np.inf, highs).max(axis=0)
    return np.maximum(low_m, 0.0), np.minimum(high_m, length_m)


def _in_rectangle(
    offset: FloatArray,
    along: FloatArray,
    across: FloatArray,
    width_m: FloatArray,
    distance_m: float,
) -> tuple[FloatArray, FloatArray]:
    forward = intervals.solve_range(_dot(offset, across), _dot(along, across), 0.0, width_m)
    sideways = intervals.solve_range(
        _cross(offset, across), _cross(along, across), -distance_m, distance_m
    )
    return np.maximum(forward[0], sideways[0]), np.minimum(forward[1], sideways[1])


def _in_disc(
    offset: FloatArray, along: FloatArray, radius_m: float
) -> tuple[FloatArray, FloatArray]:
    middle = -_dot(offset, along)
    half_squared = radius_m**2 - _cross(offset, along) ** 2
    half = np.sqrt(np.maximum(half_squared, 0))
    return middle - half, middle + half


def _unit(lines_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lengths (n,) and the unit directions (n, 2) of lines."""
    direction = lines_m[:, 1] - lines_m[:, 0]
    length_m = np.hypot(*direction.T)
    return length_m, direction / np.where(length_m > 0, length_m, 1)[:, None]


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
