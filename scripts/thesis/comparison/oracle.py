"""The order of scans that shows most true wall soonest: the ceiling for methods without the truth.

It is asked of what scans could see of the walls, and of what an extractor finds of them in each
scan. Either length is monotone submodular like covered area, so `lazy_greedy` orders by it.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.selection import lazy_greedy
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import BoolArray, Columns, FloatArray, IntArray


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
    """
    seen = np.asarray(seen, bool)
    order, gains_m = [], []
    rest = np.arange(len(seen))
    while len(rest):
        places, round_m = _choose_round(seen[rest], length_m)
        gains_m += [0.0] * len(places) if order else round_m
        order += rest[places].tolist()
        rest = np.delete(rest, places)
    return OracleOrder(np.array(order, int), np.array(gains_m))


def oracle_columns(best: Mapping[str, OracleOrder], scans: RegisteredScans) -> Columns:
    """Return the columns of `thesis_schemas.ORACLE`.

    Parameters
    ----------
    best : dict of str to OracleOrder
        By extractor.
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


def _choose_round(seen: BoolArray, length_m: FloatArray) -> tuple[list[int], list[float]]:
    """Choose greedily the scans that add something to the others; all of them if none does."""
    unseen = _UnseenLength(seen, length_m)
    adding = [
        (i, gain_m)
        for i, gain_m in lazy_greedy.choose_greedily(unseen, tie=ROUNDING)
        if gain_m > ROUNDING
    ]
    if not adding:
        return list(range(len(seen))), [0.0] * len(seen)
    return [i for i, _ in adding], [gain_m for _, gain_m in adding]


class _UnseenLength(lazy_greedy.SingleGains):
    """The length of the cells that no chosen scan shows."""

    def __init__(self, seen: BoolArray, length_m: FloatArray) -> None:
        self._seen, self._left_m = seen, np.array(length_m, float)
        super().__init__(len(seen))

    def measure_gain(self, i: int) -> float:
        """Return the length that a scan would show anew."""
        return float(self._left_m[self._seen[i]].sum())

    def cover(self, i: int) -> None:
        """Leave nothing of the cells that a scan shows."""
        self._left_m[self._seen[i]] = 0.0
