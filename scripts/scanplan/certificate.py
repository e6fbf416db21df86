"""How much better than greedy any other choice of scans could be at most."""

import numpy as np

from scanplan import greedy


def upper_bound(order):
    """Bound the area that any k polygons can cover, for every k.

    Whatever j polygons are chosen first, k others add no more to them than the sum of the k largest gains that remain,
    because the area of a union is monotone and submodular:

        best_k <= min over j of (covered_j + sum of the k largest gains given the first j)

    (Nemhauser, Wolsey and Fisher 1978, "An analysis of approximations for maximizing submodular set functions I",
    proposition 2.1; as a bound for one instance: Leskovec et al. 2007, "Cost-effective outbreak detection in networks",
    theorem 4). The gains given the first j are those of the last checkpoint before j, which can only have shrunk since
    and, as the order is greedy, none exceeds the gain of the polygon chosen next. Nor can any subset cover more than
    all polygons do.

    Parameters
    ----------
    order : greedy.Order

    Returns
    -------
    (n,) float64
        At k - 1 the bound for k polygons, square metres; never below what the first k of the order cover.
    """
    n = len(order.order)
    if n == 0:
        return np.zeros(0)
    bound_m2 = np.full(n, order.covered_m2[-1])
    covered_m2 = np.concatenate([[0.0], order.covered_m2])
    starts = sorted(order.checkpoints)
    for start, end in zip(starts, [*starts[1:], n], strict=True):
        by_size = np.argsort(-order.checkpoints[start], kind="stable")
        gain_m2, position = order.checkpoints[start][by_size], np.argsort(order.order)[by_size]
        for j in range(start, end):
            remaining_m2 = np.minimum(gain_m2[position >= j], order.gain_m2[j] + greedy.TIE_M2)
            reached_m2 = covered_m2[j] + np.cumsum(remaining_m2)
            bound_m2 = np.minimum(bound_m2, np.pad(reached_m2, (0, j), mode="edge"))
    # equal where greedy is optimal, but for rounding
    return np.maximum(bound_m2, order.covered_m2)
