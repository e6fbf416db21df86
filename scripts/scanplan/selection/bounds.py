"""How much better than greedy any other choice of scans could be at most."""

import numpy as np

from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.selection.lazy_greedy import GreedyOrder
from scanplan.types import FloatArray


def bound_any_subset(order: GreedyOrder) -> FloatArray:
    """Bound what any k choices can cover, for every k.

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

    Returns
    -------
    (n,) float64
        At k - 1 the bound for k choices, in the order's unit; never below what the first k of the
        order cover.
    """
    n = len(order.order)
    if n == 0:
        return np.zeros(0)
    bound = np.full(n, order.covered[-1])
    covered = np.concatenate([[0.0], order.covered])
    position = np.argsort(order.order)
    for j in _steps(n):
        gain = order.checkpoints[max(start for start in order.checkpoints if start <= j)]
        remaining = np.minimum(gain[position >= j], order.gain[j] + SMALLEST_M2)
        reached = covered[j] + np.cumsum(np.sort(remaining)[::-1])
        # fewer than n are left: with more than that nothing more is reached
        bound[: n - j] = np.minimum(bound[: n - j], reached)
        bound[n - j :] = np.minimum(bound[n - j :], reached[-1])
    # equal where greedy is optimal, but for rounding
    return np.maximum(bound, order.covered)


def _steps(n: int) -> list[int]:
    """Return numbers below n: all small ones, then each about 3 % above the last."""
    steps = [0]
    while steps[-1] < n - 1:
        steps.append(steps[-1] + max(1, steps[-1] // 32))
    return [j for j in steps if j < n]
