"""Short tours through places whose distances are known."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from scanplan.geometry.tolerances import SAME_M
from scanplan.types import FloatArray


def shortest_tour(metres: ArrayLike, *, closed: bool, first: int | None = None) -> list[int]:
    """Return a short tour: nearest neighbours from every place, improved by 2-opt, the shortest.

    Parameters
    ----------
    metres : (n, n) float64, symmetric, n >= 1
        Finite distances.
    closed : bool
        Whether it returns to its first place.
    first : int or None
        The place it starts at; any where None.

    Returns
    -------
    list of int
        Every place once; equal tours are decided by the lowest first place.
    """
    metres = np.asarray(metres, float)
    is_square = metres.ndim == 2 and metres.shape[0] == metres.shape[1]
    if not is_square or not len(metres) or not np.isfinite(metres).all():
        raise ValueError(f"distances {metres.shape} are no square of finite values")
    starts = range(len(metres)) if first is None else [first]
    tours = [_improve(_nearest_neighbours(metres, start), metres, closed) for start in starts]
    return min(tours, key=lambda tour: round(tour_length(tour, metres, closed=closed), 6))


def tour_length(tour: Sequence[int], metres: FloatArray, *, closed: bool) -> float:
    """Return the length of a tour."""
    legs_m = sum(metres[a, b] for a, b in pairwise(tour))
    return float(legs_m + (metres[tour[-1], tour[0]] if closed else 0.0))


def _nearest_neighbours(metres: FloatArray, start: int) -> list[int]:
    tour = [start]
    left = sorted(set(range(len(metres))) - {start})
    while left:
        here = tour[-1]
        nearest = min(left, key=lambda place: metres[here, place])
        tour.append(nearest)
        left.remove(nearest)
    return tour


def _improve(tour: list[int], metres: FloatArray, closed: bool) -> list[int]:
    """Turn stretches round while that shortens the tour; the first place stays."""
    tour = list(tour)
    is_better = True
    while is_better:
        is_better = False
        for i in range(1, len(tour) - 1):
            for j in range(i + 1, len(tour)):
                # what saves less may save nothing but rounding, and never end
                if _gain(tour, metres, i, j, closed) > SAME_M:
                    tour[i : j + 1] = tour[i : j + 1][::-1]
                    is_better = True
    return tour


def _gain(tour: list[int], metres: FloatArray, i: int, j: int, closed: bool) -> float:
    """Return what turning the stretch i..j round saves."""
    before = tour[i - 1]
    old = metres[before, tour[i]]
    new = metres[before, tour[j]]
    if closed or j + 1 < len(tour):
        after = tour[(j + 1) % len(tour)]
        old = old + metres[tour[j], after]
        new = new + metres[tour[i], after]
    return old - new
