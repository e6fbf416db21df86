"""How much of many small cells scans have shown so far, each at its best: a sparse monotone submodular function."""

import numpy as np

from scanplan.selection import lazy_greedy
from scanplan.selection.budget import choose_in_budget

TIE = 1e-9
"""Sums of a scan's cells agree far better than this, metres."""


class CellCoverage:
    """Sets of weighted cells: f(S) = sum over cells of the largest weight that any member of S gives the cell.

    Parameters
    ----------
    scan : (m,) int, sorted
        Index, below `n`, of the scan that gives a cell a weight.
    cell : (m,) int, >= 0
        The cell; not twice in one scan.
    weight : (m,) float, >= 0, finite
    n : int
        Number of scans, also those without a cell.

    Raises
    ------
    ValueError
        If the arrays are not of one length, not sorted by scan, or out of range.
    """

    def __init__(self, scan, cell, weight, n):
        self._first = np.searchsorted(scan, np.arange(n + 1))
        self._weight = np.asarray(weight, float)
        if not len(scan) == len(cell) == len(self._weight) or (np.diff(scan) < 0).any():
            raise ValueError(
                f"{len(scan)} scans, {len(cell)} cells and {len(weight)} weights must be one each, by scan"
            )
        if len(scan) and (
            scan[0] < 0 or scan[-1] >= n or not (self._weight >= 0).all() or np.isinf(weight).any()
        ):
            raise ValueError(f"scans must be 0 to {n - 1}, weights finite and not below 0")
        self._n, (_, self._cell) = n, np.unique(cell, return_inverse=True)

    def greedy(self, min_overlap=0.0):
        """Return the greedy order, a `area_greedy.AreaOrder`; see `lazy_greedy.order_greedily`."""
        return lazy_greedy.order_greedily(
            _Best(self._first, self._cell, self._weight), tie=TIE, min_overlap=min_overlap
        )

    def within(self, cost, budget):
        """Return the indices to take for a budget; see `budget.choose_in_budget`."""
        return choose_in_budget(
            lambda: _Best(self._first, self._cell, self._weight), cost, budget, tie=TIE
        )

    def gains(self, order):
        """Return what (m,) each scan of a given order adds to those before it."""
        return lazy_greedy.gains_along(_Best(self._first, self._cell, self._weight), order)


class _Best:
    """The largest weight so far of every cell, and what each scan would add to their sum."""

    def __init__(self, first, cell, weight):
        self._first, self._cell, self._weight = first.tolist(), cell, weight
        self._best = np.zeros(cell.max(initial=-1) + 1)
        # the sums that refresh makes, to the last digit: adding up in another order would break ties by rounding
        self.gain = np.array(
            [weight[a:b].sum() for a, b in zip(self._first[:-1], self._first[1:], strict=True)],
            float,
        )

    def refresh(self, i):
        own = slice(self._first[i], self._first[i + 1])
        self.gain[i] = np.maximum(self._weight[own] - self._best[self._cell[own]], 0.0).sum()
        return self.gain[i]

    def choose(self, i):
        gain, own = self.refresh(i), slice(self._first[i], self._first[i + 1])
        self._best[self._cell[own]] = np.maximum(self._best[self._cell[own]], self._weight[own])
        self.gain[i] = 0.0
        return gain
