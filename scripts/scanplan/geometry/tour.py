"""Short tours through places, of whose distances few are asked for where more are not known."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from scanplan.geometry.tolerances import SAME_M
from scanplan.types import FloatArray, IntArray


@runtime_checkable
class Distances(Protocol):
    """Symmetric finite distances of places, `metres[a, b]`, each found when it is asked for.

    Attributes
    ----------
    least_m : (n, n) float64
        What each is at least.
    """

    least_m: FloatArray

    def __getitem__(self, pair: tuple[int, int]) -> float: ...


class _Known:
    """Distances that are known: what each is at least is what it is."""

    def __init__(self, metres: FloatArray) -> None:
        self.least_m = metres

    def __getitem__(self, pair: tuple[int, int]) -> float:
        return self.least_m[pair]


def shortest_tour(
    metres: ArrayLike | Distances, *, closed: bool, first: int | None = None
) -> list[int]:
    """Return a short tour: nearest neighbours from every place, improved by 2-opt, the shortest.

    Parameters
    ----------
    metres : (n, n) float64, symmetric, n >= 1, or Distances
        Finite distances.
    closed : bool
        Whether it returns to its first place.
    first : int or None
        The place it starts at; any where None.

    Returns
    -------
    list of int
        Every place once; equal tours are decided by the lowest first place.

    Examples
    --------
    >>> metres = np.abs(np.subtract.outer([0.0, 5.0, 1.0], [0.0, 5.0, 1.0]))
    >>> shortest_tour(metres, closed=False)
    [0, 2, 1]
    """
    known = metres if isinstance(metres, Distances) else _Known(np.asarray(metres, float))
    least_m = known.least_m
    is_square = least_m.ndim == 2 and least_m.shape[0] == least_m.shape[1]
    if not is_square or not len(least_m) or not np.isfinite(least_m).all():
        raise ValueError(f"distances {least_m.shape} are no square of finite values")
    starts = range(len(least_m)) if first is None else [first]
    tours = [_improve(_nearest_neighbours(known, start), known, closed) for start in starts]
    return min(tours, key=lambda tour: round(tour_length(tour, known, closed=closed), 6))


def tour_length(tour: Sequence[int], metres: FloatArray | Distances, *, closed: bool) -> float:
    """Return the length of a tour.

    >>> metres = np.array([[0.0, 2.0], [2.0, 0.0]])
    >>> float(tour_length([0, 1], metres, closed=True))
    4.0
    """
    legs_m = sum(metres[a, b] for a, b in pairwise(tour))
    return float(legs_m + (metres[tour[-1], tour[0]] if closed else 0.0))


def _nearest_neighbours(metres: Distances, start: int) -> list[int]:
    tour = [start]
    is_left = np.ones(len(metres.least_m), bool)
    is_left[start] = False
    while is_left.any():
        left = np.flatnonzero(is_left)
        tour.append(_find_nearest(metres, tour[-1], left))
        is_left[tour[-1]] = False
    return tour


def _find_nearest(metres: Distances, here: int, left: IntArray) -> int:
    """Return the nearest of some places, the first of equals; none is asked that is farther."""
    least_m = metres.least_m[here, left]
    nearest = (np.inf, -1)
    for row in np.argsort(least_m, kind="stable").tolist():
        if least_m[row] > nearest[0]:
            break
        place = int(left[row])
        nearest = min(nearest, (float(metres[here, place]), place))
    return nearest[1]


def _improve(tour: list[int], metres: Distances, closed: bool) -> list[int]:
    """Turn stretches round while that shortens the tour; the first place stays."""
    places = np.array(tour)
    legs_m = _measure_legs(places, metres, closed)
    is_better = True
    while is_better:
        is_better = False
        for i in range(1, len(places) - 1):
            j = i
            while (j := _find_turn(places, legs_m, metres, i, j + 1, closed)) < len(places):
                places[i : j + 1] = places[i : j + 1][::-1]
                legs_m = _measure_legs(places, metres, closed)
                is_better = True
    return places.tolist()


def _measure_legs(places: IntArray, metres: Distances, closed: bool) -> FloatArray:
    """Return how far it is from each place (n,) to the next; 0 from the last of an open tour."""
    legs_m = [metres[a, b] for a, b in pairwise(places.tolist())]
    return np.array([*legs_m, metres[int(places[-1]), int(places[0])] if closed else 0.0])


def _find_turn(
    places: IntArray, legs_m: FloatArray, metres: Distances, i: int, first: int, closed: bool
) -> int:
    """Return the first j, from one on, of which turning the stretch i..j round saves; else n."""
    before, here = int(places[i - 1]), int(places[i])
    after = np.roll(places, -1)
    after_m = metres.least_m[here, after[first:]]
    # an open tour goes nowhere after its last place
    if not closed:
        after_m[-1:] = 0.0
    # most turns cannot save anything, and their distances are not asked for
    most_m = legs_m[i - 1] + legs_m[first:] - metres.least_m[before, places[first:]] - after_m
    for j in (first + np.flatnonzero(most_m > 0)).tolist():
        goes_on = closed or j + 1 < len(places)
        new_m = metres[before, int(places[j])] + (metres[here, int(after[j])] if goes_on else 0.0)
        # what saves less may save nothing but rounding, and never end
        if legs_m[i - 1] + legs_m[j] - new_m > SAME_M:
            return j
    return len(places)
