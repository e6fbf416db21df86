"""The order of scans that shows most true wall soonest: the ceiling for every method that does not know the truth.

It is asked of what scans could see of the walls, and of what an extractor finds of them in each scan. Either length is
monotone submodular like covered area, so lazy evaluation gives the greedy order (Minoux 1978).
"""

import heapq
from dataclasses import dataclass

import numpy as np

_TIE_M = 1e-9


@dataclass(frozen=True)
class OracleOrder:
    """A complete order of scans.

    Attributes
    ----------
    order : (n,) int
        Rows of scans.
    gain_m : (n,) float64
        True wall length that each adds to what those before it show.
    """

    order: np.ndarray
    gain_m: np.ndarray


def order_by_truth(seen, length_m):
    """Order scans so that each adds the most length, the first row of equals.

    Once no scan adds anything, the rest is ordered in the same way as if nothing had been shown yet: all walls are
    shown a second time as soon as can be, then a third.

    Parameters
    ----------
    seen : (n, c) bool
        Which cells of the true faces each scan shows: could see, or has a wall at.
    length_m : (c,) float
        Length of each cell.

    Returns
    -------
    Order
    """
    seen = np.asarray(seen, bool)
    order, rest, gains_m = [], list(range(len(seen))), []
    while rest:
        taken, round_m = _once(seen, np.array(length_m, float), rest)
        gains_m += round_m if not order else [0.0] * len(taken)
        order += taken
        rest = sorted(set(rest) - set(taken))
    return OracleOrder(np.array(order, int), np.array(gains_m))


def oracle_columns(best, scans):
    """Return the columns of `schemas.ORACLE`.

    Parameters
    ----------
    best : dict of str to OracleOrder
        By extractor.
    scans : registered_scans.RegisteredScans
    """
    n = len(scans.scan_ids)
    orders = [best[extractor] for extractor in sorted(best)]
    return {
        "extractor": np.repeat(sorted(best), n),
        "rank": np.tile(np.arange(1, n + 1), len(best)),
        "scan_id": np.concatenate([scans.scan_ids[order.order] for order in orders]),
        "gain_m": np.concatenate([order.gain_m for order in orders]),
        "found_m": np.concatenate([np.cumsum(order.gain_m) for order in orders]),
    }


def _once(seen, left_m, rows):
    """Take of the rows, greedily, those that add something to the others; all of them if none does."""
    heap = [(-float(left_m[seen[i]].sum()), i) for i in rows]
    heapq.heapify(heap)
    order, gains_m = [], []
    while heap and -heap[0][0] > _TIE_M:
        best = _pop_best(heap, seen, left_m)
        gain_m = float(left_m[seen[best]].sum())
        left_m[seen[best]] = 0.0
        if gain_m > _TIE_M:
            order.append(best)
            gains_m.append(gain_m)
    return (order, gains_m) if order else (rows, [0.0] * len(rows))


def _pop_best(heap, seen, left_m):
    """Take the scan of the largest gain, the first row of equals, off the heap of old gains."""
    fresh, best_m = {}, 0.0
    while heap and -heap[0][0] >= best_m - _TIE_M:
        _, i = heapq.heappop(heap)
        fresh[i] = float(left_m[seen[i]].sum())
        best_m = max(best_m, fresh[i])
    best = min(i for i, gain_m in fresh.items() if gain_m >= best_m - _TIE_M)
    for i, gain_m in fresh.items():
        if i != best:
            heapq.heappush(heap, (-gain_m, i))
    return best
