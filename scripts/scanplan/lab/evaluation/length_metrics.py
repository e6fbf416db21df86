"""How much of one set of lines lies near another: completeness and correctness of walls.

The buffer method of road extraction (Heipke, Mayer, Wiedemann and Jamet 1997, "Evaluation of automatic road
extraction"). The points of a line within a distance of another are one interval, as both are convex: it is computed
exactly, and nothing is sampled. Lines are (n, 2, 2) arrays: start and end, x and y, metres.
"""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry import intervals


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

    line: np.ndarray
    other: np.ndarray
    low_m: np.ndarray
    high_m: np.ndarray


@dataclass(frozen=True)
class Agreement:
    """Completeness, correctness and their harmonic mean, each from 0 to 1."""

    completeness: float
    correctness: float
    f1: float


def line_lengths_m(lines_m):
    """Return the lengths (n,) of lines."""
    return np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)


def find_near_intervals(lines_m, others_m, distance_m):
    """Find the stretches of lines within a distance of other lines.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
    others_m : (m, 2, 2) float
    distance_m : float, > 0

    Returns
    -------
    Stretches
        By line, then by other line. Lines of no length have none and cause none.
    """
    if distance_m <= 0:
        raise ValueError(f"distance_m is {distance_m}, must be above 0")
    lines_m, others_m = (
        np.asarray(lines_m, float).reshape(-1, 2, 2),
        np.asarray(others_m, float).reshape(-1, 2, 2),
    )
    tree = shapely.STRtree(shapely.linestrings(others_m))
    i, j = tree.query(shapely.linestrings(lines_m), predicate="dwithin", distance=distance_m)
    order = np.lexsort((j, i))
    i, j = i[order], j[order]
    low_m, high_m = _interval(lines_m[i], others_m[j], distance_m)
    there = (high_m > low_m) & (line_lengths_m(others_m)[j] > 0)
    return NearIntervals(i[there], j[there], low_m[there], high_m[there])


def union_length_m(stretches, n_lines):
    """Return how much (n_lines,) of each line lies in the union of its stretches."""
    order = np.lexsort((stretches.low_m, stretches.line))
    line, low_m, high_m = stretches.line[order], stretches.low_m[order], stretches.high_m[order]
    # all lines laid end to end, far enough apart: one running maximum serves for all of them
    shift = line * (2 * high_m.max(initial=0.0) + 1)
    fresh_m = intervals.added_lengths_m(low_m + shift, high_m + shift)
    return np.bincount(line, fresh_m, minlength=n_lines)


def safe_share(part, whole):
    """Return part of whole; of nothing it is 1, as nothing of it is missing."""
    return min(float(part / whole), 1.0) if whole > 0 else 1.0


def f1_score(completeness, correctness):
    """Return the harmonic mean; 0 where both are."""
    total = completeness + correctness
    return 2 * completeness * correctness / total if total > 0 else 0.0


def compare_lines(result_m, truth_m, within_m):
    """Compare resulting lines with true ones.

    Parameters
    ----------
    result_m : (n, 2, 2) float
        May overlap each other: completeness counts true length once, correctness every resulting length.
    truth_m : (m, 2, 2) float
    within_m : float

    Returns
    -------
    Agreement
        Completeness is the share of true length within `within_m` of a result, 1 if there is no truth; correctness
        the share of resulting length within `within_m` of the truth, 1 if there is no result.
    """
    completeness = _near_share(truth_m, result_m, within_m)
    correctness = _near_share(result_m, truth_m, within_m)
    return Agreement(completeness, correctness, f1_score(completeness, correctness))


def _near_share(lines_m, others_m, within_m):
    lines_m = np.asarray(lines_m, float).reshape(-1, 2, 2)
    near_m = union_length_m(find_near_intervals(lines_m, others_m, within_m), len(lines_m))
    return safe_share(near_m.sum(), line_lengths_m(lines_m).sum())


def _interval(line_m, other_m, distance_m):
    """Return where (p,) each line enters and leaves the stadium around the other one; low >= high if it does not.

    The stadium is a rectangle and two discs. It is convex, so what lies between the parts of the line inside those
    three lies inside too.
    """
    length_m, along = _unit(line_m)
    width_m, across = _unit(other_m)
    from_start, from_end = line_m[:, 0] - other_m[:, 0], line_m[:, 0] - other_m[:, 1]
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


def _in_rectangle(offset, along, across, width_m, distance_m):
    forward = _dot(offset, across), _dot(along, across)
    sideways = _cross(offset, across), _cross(along, across)
    low_0, high_0 = intervals.solve_range(*forward, 0.0, width_m)
    low_1, high_1 = intervals.solve_range(*sideways, -distance_m, distance_m)
    return np.maximum(low_0, low_1), np.minimum(high_0, high_1)


def _in_disc(offset, along, radius_m):
    middle = -_dot(offset, along)
    half_squared = radius_m**2 - _cross(offset, along) ** 2
    half = np.sqrt(np.maximum(half_squared, 0))
    return middle - half, middle + half


def _unit(lines_m):
    way = lines_m[:, 1] - lines_m[:, 0]
    length_m = np.hypot(*way.T)
    return length_m, way / np.where(length_m > 0, length_m, 1)[:, None]


def _dot(a, b):
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
