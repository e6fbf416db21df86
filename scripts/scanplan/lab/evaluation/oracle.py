"""The order of scans that shows most true wall soonest: the ceiling for methods without the truth.

It is asked of what scans could see of the walls, and of what an extractor finds of them in each
scan. Either length is monotone submodular like covered area, so lazy evaluation gives the greedy
order (Minoux 1978).
"""

import heapq
from dataclasses import dataclass

import numpy as np

from scanplan.types import BoolArray, FloatArray, IntArray

_TIE_M = 1e-9  # gains nearer than this are equal: sums of lengths in another order differ by less


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

    order: IntArray
    gain_m: FloatArray


def order_by_truth(seen: BoolArray, length_m: FloatArray) -> OracleOrder:
    """Order scans so that each adds the most length, the first row of equals.

    Once no scan adds anything, the rest is ordered in the same way as if nothing had been shown
    yet: all walls are shown a second time as soon as can be, then a third.

    Parameters
    ----------
    seen : (n, c) bool
        Which cells of the true faces each scan shows: could see, or has a wall at.
    length_m : (c,) float
        Length of each cell.

    Returns
    -------
    OracleOrder
    """
    seen = np.asarray(seen, bool)
    order: list[int] = []
    gains_m: list[float] = []
    rest = list(range(len(seen)))
    while rest:
        rows, added_m = _order_once(seen, np.array(length_m, float), rest)
        gains_m += [0.0] * len(rows) if order else added_m
        order += rows
        rest = sorted(set(rest) - set(rows))
    return OracleOrder(np.array(order, int), np.array(gains_m))


def _order_once(
    seen: BoolArray, left_m: FloatArray, rows: list[int]
) -> tuple[list[int], list[float]]:
    """Return, greedily, the rows that add something to those before them, and what they add.

    All rows if none adds anything. `left_m`, the length of each cell that is not shown yet, is
    changed.
    """
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


def _pop_best(heap: list[tuple[float, int]], seen: BoolArray, left_m: FloatArray) -> int:
    """Take the scan of the largest gain, the first row of equals, off the heap of old gains."""
    fresh: dict[int, float] = {}
    best_m = 0.0
    while heap and -heap[0][0] >= best_m - _TIE_M:
        _, i = heapq.heappop(heap)
        fresh[i] = float(left_m[seen[i]].sum())
        best_m = max(best_m, fresh[i])
    best = min(i for i, gain_m in fresh.items() if gain_m >= best_m - _TIE_M)
    for i, gain_m in fresh.items():
        if i != best:
            heapq.heappush(heap, (-gain_m, i))
    return best
