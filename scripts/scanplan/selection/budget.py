"""Choices that cover much and together cost no more than a budget."""

import heapq

import numpy as np


def choose_in_budget(new_cover, cost, budget, *, tie):
    """Choose within a budget: by gain per cost, by gain alone, or one alone, whichever covers most.

    Greedy by the ratio of gain to cost can be arbitrarily bad (one cheap choice in front of a good one that then no
    longer fits), and so can greedy by gain; the best of the three covers at least (1 - 1/e) / 2 of the best set within
    the budget (Khuller, Moss and Naor 1999, "The budgeted maximum coverage problem"; for any monotone submodular
    function Leskovec et al. 2007, "Cost-effective outbreak detection in networks", theorem 3). Choices that no longer
    fit are passed over, so the budget is used as far as something fits and adds.

    Parameters
    ----------
    new_cover : callable
        Returns a cover with nothing chosen; see `lazy_greedy`.
    cost : (n,) float, > 0
    budget : float
        In the unit of the costs.
    tie : float
        Gains no larger than this add nothing; ratios equal to 1e-9 of the largest are equal: the lowest index first.

    Returns
    -------
    list of int
        In the order they were chosen; empty if nothing fits.

    Raises
    ------
    ValueError
        If there is not one cost above 0 for each choice.
    """
    cost = np.asarray(cost, float)
    alone = np.array(new_cover().gain, float)
    if cost.shape != alone.shape or not (cost > 0).all():
        raise ValueError(f"{len(alone)} choices need as many costs above 0")
    fits = np.flatnonzero(cost <= budget)
    if len(fits) == 0:
        return []
    single = int(fits[alone[fits].argmax()])
    # by gain first: of choices that cover the same it has the best beginnings, and sums differ by rounding
    best = _greedy(new_cover(), cost, budget, np.ones(len(cost)), tie)
    for other in (_greedy(new_cover(), cost, budget, 1 / cost, tie), ([single], alone[single])):
        best = other if other[1] > best[1] + len(cost) * tie else best
    return best[0]


def _greedy(cover, cost, budget, weight, tie):
    """Take the largest weight times gain that still fits, again and again; return the choices and what they cover."""
    heap = [
        (-gain * weight[i], i)
        for i, gain in enumerate(cover.gain)
        if gain > tie and cost[i] <= budget
    ]
    heapq.heapify(heap)
    chosen, covered, left = [], 0.0, budget
    while heap:
        fresh, best = {}, 0.0
        while heap and -heap[0][0] >= best * (1 - 1e-9):
            _, i = heapq.heappop(heap)
            # what does not fit now never will, what adds nothing now never will
            if cost[i] <= left and cover.refresh(i) > tie:
                fresh[i] = cover.gain[i] * weight[i]
                best = max(best, fresh[i])
        if fresh:
            taken = min(i for i, worth in fresh.items() if worth >= best * (1 - 1e-9))
            covered += cover.choose(taken)
            left -= cost[taken]
            chosen.append(taken)
            for i in fresh.keys() - {taken}:
                heapq.heappush(heap, (-fresh[i], i))
    return chosen, covered
