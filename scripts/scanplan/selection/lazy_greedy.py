"""The greedy order of anything that covers, by lazy evaluation, also under a condition that keeps it connected.

What a choice adds to a monotone submodular function can only shrink while others are chosen, so an old gain is an upper
bound of today's (Minoux 1978, "Accelerated greedy algorithms for maximizing submodular set functions").

A cover has `gain` (n,), what each of n choices would add as of when it was last looked at; `refresh(i)`, which brings
that up to date and returns it; and `choose(i)`, which takes i and returns what it added.
"""

import heapq

import numpy as np

from scanplan.selection import area_greedy

_ROUNDING = 1e-9


def order_greedily(cover, *, tie, min_overlap=0.0):
    """Order all choices of a cover so that each adds the most to those before it.

    Parameters
    ----------
    cover : object with `gain`, `refresh` and `choose`
        With nothing chosen; it is used up.
    tie : float
        Gains this close to the largest are equal to it: the lowest index comes first. Choices that add no more than
        this are last, by index.
    min_overlap : float, 0 to 1
        Take only what shares at least this much of its own worth with what is chosen: 1 - gain / worth alone. Where
        nothing that adds anything does, the best of all is taken, as in a survey of two unconnected parts.

    Returns
    -------
    area_greedy.AreaOrder
        In the cover's unit; the gains of all after 0, 1, 2, 4, 8, ... choices are kept, for bounds.

    Raises
    ------
    ValueError
        If `min_overlap` is out of its range.
    """
    if not 0 <= min_overlap <= 1:
        raise ValueError(f"min_overlap is {min_overlap}, must be 0 to 1")
    alone = np.array(cover.gain, float)
    anything, sharing = np.full(len(alone), np.inf), alone * (1 - min_overlap + _ROUNDING)
    heap = [(-gain, i) for i, gain in enumerate(alone.tolist())]
    heapq.heapify(heap)
    checkpoints, chosen, gains = {0: alone}, [], []
    while heap and -heap[0][0] > tie:
        # with nothing chosen there is nothing to share
        chosen.append(
            _pop_best(heap, cover, tie, sharing if chosen and min_overlap > 0 else anything)
        )
        gains.append(cover.choose(chosen[-1]))
        if len(chosen).bit_count() == 1:
            heap = [(-cover.refresh(i), i) for _, i in heap]
            heapq.heapify(heap)
            checkpoints[len(chosen)] = _gains_left(heap, len(alone))
    rest = sorted(i for _, i in heap)
    gain = np.array(gains + [cover.choose(i) for i in rest], float)
    return area_greedy.AreaOrder(np.array(chosen + rest, int), gain, np.cumsum(gain), checkpoints)


def gains_along(cover, order):
    """Return what (m,) each choice of a given order of distinct indices adds to those before it."""
    if len(np.unique(order)) != len(order) or not np.isin(order, np.arange(len(cover.gain))).all():
        raise ValueError(
            f"an order of {len(cover.gain)} choices must hold distinct indices below that"
        )
    return np.array([cover.choose(i) for i in np.asarray(order, int).tolist()], float)


def _pop_best(heap, cover, tie, largest_gain):
    """Take the allowed choice of the largest gain off the heap of old gains; any choice if none is allowed."""
    fresh, best = {}, 0.0
    while heap and -heap[0][0] >= best - tie:
        _, i = heapq.heappop(heap)
        fresh[i] = cover.refresh(i)
        if fresh[i] <= largest_gain[i]:
            best = max(best, fresh[i])
    allowed = [i for i, gain in fresh.items() if tie < gain <= largest_gain[i]]
    if not allowed:
        allowed, best = list(fresh), max(fresh.values())
    taken = min(i for i in allowed if fresh[i] >= best - tie)
    for i, gain in fresh.items():
        if i != taken:
            heapq.heappush(heap, (-gain, i))
    return taken


def _gains_left(heap, n):
    gain = np.zeros(n)
    for negative, i in heap:
        gain[i] = -negative
    return gain
