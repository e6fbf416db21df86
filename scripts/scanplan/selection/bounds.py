"""How much better than greedy any other choice of scans could be at most."""

import numpy as np

from scanplan.selection import area_greedy


def bound_any_subset(order):
    """Bound the area that any k polygons can cover, for every k.

    Whatever j polygons are chosen first, k others add no more to them than the sum of the k largest
    gains that remain, because the area of a union is monotone and submodular:

        best_k <= min over j of (covered_j + sum of the k largest gains given the first j)

    (Nemhauser, Wolsey and Fisher 1978, "An analysis of approximations for maximizing submodular set
    functions I", proposition 2.1; as a bound for one instance: Leskovec et al. 2007,
    "Cost-effective outbreak detection in networks", theorem 4). The gains given the first j are
    those of the last checkpoint before j, which can only have shrunk since and, as the order is
    greedy, none exceeds the gain of the polygon chosen next. Nor can any subset cover more than all
    polygons do. Any j gives a bound: all small ones are tried, and of larger ones each a
    thirty-second above the last, so that the time grows hardly faster than n.

    Parameters
    ----------
    order : area_greedy.AreaOrder

    Returns
    -------
    (n,) float64
        At k - 1 the bound for k polygons, square metres; never below what the first k of the order
        cover.
    """
    n = len(order.order)
    if n == 0:
        return np.zeros(0)
    bound_m2 = np.full(n, order.covered[-1])
    covered_m2 = np.concatenate([[0.0], order.covered])
    position = np.argsort(order.order)
    for j in _steps(n):
        gain_m2 = order.checkpoints[max(start for start in order.checkpoints if start <= j)]
        remaining_m2 = np.minimum(gain_m2[position >= j], order.gain[j] + area_greedy.TIE_M2)
        reached_m2 = covered_m2[j] + np.cumsum(np.sort(remaining_m2)[::-1])
        # fewer than n are left: with more than that nothing more is reached
        bound_m2[: n - j] = np.minimum(bound_m2[: n - j], reached_m2)
        bound_m2[n - j :] = np.minimum(bound_m2[n - j :], reached_m2[-1])
    # equal where greedy is optimal, but for rounding
    return np.maximum(bound_m2, order.covered)


def _steps(n):
    """Numbers below n: all small ones, then each about 3 % above the last."""
    steps = [0]
    while steps[-1] < n - 1:
        steps.append(steps[-1] + max(1, steps[-1] // 32))
    return [j for j in steps if j < n]
