"""Short tours through places whose distances are known."""

from itertools import pairwise

import numpy as np

_GAIN = 1e-9


def shortest_tour(metres, *, closed, first=None):
    """Return a short tour: from every place by nearest neighbours, improved by 2-opt, the shortest of all.

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
    if (
        metres.ndim != 2
        or metres.shape[0] != metres.shape[1]
        or not len(metres)
        or not np.isfinite(metres).all()
    ):
        raise ValueError(f"distances {metres.shape} are no square of finite values")
    starts = range(len(metres)) if first is None else [first]
    tours = [_improved(_nearest(metres, start), metres, closed) for start in starts]
    return min(tours, key=lambda tour: round(tour_length(tour, metres, closed=closed), 6))


def tour_length(tour, metres, *, closed):
    """Return how long a tour is."""
    legs = sum(metres[a, b] for a, b in pairwise(tour))
    return float(legs + (metres[tour[-1], tour[0]] if closed else 0.0))


def _nearest(metres, start):
    tour, left = [start], sorted(set(range(len(metres))) - {start})
    while left:
        tour.append(min(left, key=lambda place: metres[tour[-1], place]))
        left.remove(tour[-1])
    return tour


def _improved(tour, metres, closed):
    """Turn stretches round while that shortens the tour; the first place stays."""
    tour, better = list(tour), True
    while better:
        better = False
        for i in range(1, len(tour) - 1):
            for j in range(i + 1, len(tour)):
                if _gain(tour, metres, i, j, closed) > _GAIN:
                    tour[i : j + 1] = tour[i : j + 1][::-1]
                    better = True
    return tour


def _gain(tour, metres, i, j, closed):
    """What turning the stretch i..j round saves."""
    before, after = tour[i - 1], tour[(j + 1) % len(tour)] if closed or j + 1 < len(tour) else None
    old, new = metres[before, tour[i]], metres[before, tour[j]]
    if after is not None:
        old, new = old + metres[tour[j], after], new + metres[tour[i], after]
    return old - new
