"""Greedy choice for sums of best weights.

Every scan looked at in every step, and the best subset by trying all.
"""

from itertools import combinations


def value(weights, chosen):
    """Sum over cells of the largest weight of any chosen scan (cell to weight)."""
    return (
        sum(max(weights[i].get(c, 0) for i in chosen) for c in set().union(*weights))
        if chosen
        else 0
    )


def order(weights, tie, min_overlap=0.0):
    """Take the scan that adds most of those that share enough with what is taken."""
    chosen = []
    while len(chosen) < len(weights):
        before = value(weights, chosen)
        gains = {
            i: value(weights, [*chosen, i]) - before for i in range(len(weights)) if i not in chosen
        }
        allowed = {
            i: g
            for i, g in gains.items()
            if g > tie and _shares(g, value(weights, [i]), min_overlap)
        }
        if chosen and allowed:
            gains = allowed
        most = max(gains.values())
        chosen.append(min(i for i, gain in gains.items() if gain >= most - tie))
    return chosen


def best(weights, k):
    """Largest value of any k scans."""
    return max(value(weights, subset) for subset in combinations(range(len(weights)), k))


def _shares(gain, alone, min_overlap):
    return min_overlap == 0 or (alone - gain) / alone >= min_overlap - 1e-9
