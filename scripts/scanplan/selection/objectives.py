"""Objectives of orders: covered area, free space, length of visible wall.

Each `cover_*` function makes the objective of a survey that `methods.METHODS` names.
"""

from itertools import pairwise
from typing import Protocol

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.geometry.polygons import Polygons
from scanplan.geometry.tolerances import ROUNDING, SMALLEST_M2
from scanplan.selection import area_greedy, hulls, lazy_greedy, wall_cells
from scanplan.selection.budget import choose_in_budget
from scanplan.selection.lazy_greedy import GreedyOrder
from scanplan.selection.survey_scans import SurveyScans
from scanplan.selection.union_area.uncovered import Uncovered
from scanplan.types import FloatArray, IntArray


class Objective(Protocol):
    """A monotone submodular function of a choice of scans."""

    def greedy(self, min_overlap: float = 0.0) -> GreedyOrder:
        """Return the greedy order; see `lazy_greedy.order_greedily`."""
        ...

    def within(self, cost: IntArray, budget: float) -> list[int]:
        """Return the indices to take for a budget; see `budget.choose_in_budget`."""
        ...

    def gains(self, order: IntArray) -> FloatArray:
        """Return what (m,) each scan of a given order adds to those before it."""
        ...


def cover_cluster_hulls(scans: SurveyScans) -> Objective:
    """Area of the union of the hulls of scans' clusters (thesis 3.3.2, algorithm 1)."""
    return PolygonArea(hulls.scan_polygons(scans.tables["hulls"])[1])


def cover_full_hulls(scans: SurveyScans) -> Objective:
    """Area of the union of one convex hull per scan, the thesis's baseline (3.3.2)."""
    return PolygonArea(hulls.scan_full_hulls(scans.tables["hulls"])[1])


def cover_free_space(scans: SurveyScans) -> Objective:
    """Area of the union of the free space that scans looked through.

    Raises
    ------
    StageError
        If the table of visibility is not of these scans.
    """
    visible = scans.tables["visibility"]
    if not np.array_equal(visible["scan_id"], scans.scan_ids):
        raise StageError(
            f"visibility: holds {len(visible['scan_id'])} scans, not the {len(scans)} that have"
            " hulls; delete the results of this dataset and run again"
        )
    return PolygonArea(shapely.from_wkb(visible["geometry"]))


def cover_wall_length(scans: SurveyScans) -> Objective:
    """Length of wall that scans show well enough to be found, each cell at its best.

    This closes the loop between walls and selection (thesis, chapter 6) without extracting the
    walls of any scan.

    Raises
    ------
    StageError
        If the table of observations holds other scans.
    """
    observations = scans.tables["observations"]
    if not np.isin(observations["scan_id"], scans.scan_ids).all():
        raise StageError(
            f"observations: of scans that are none of the {len(scans)} that have hulls;"
            " delete the results of this dataset and run again"
        )
    row = np.searchsorted(scans.scan_ids, observations["scan_id"])
    return CellCoverage(
        row, wall_cells.number_cells(observations), observations["length_m"], len(scans)
    )


class PolygonArea:
    """Polygons: f(S) = area of the union of those of S, square metres.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `area_greedy.order_by_area`.
    """

    def __init__(self, polygons: Polygons) -> None:
        self._polygons = polygons

    def greedy(self, min_overlap: float = 0.0) -> GreedyOrder:
        """Return the greedy order; see `lazy_greedy.order_greedily`."""
        return area_greedy.order_by_area(self._polygons, min_overlap=min_overlap)

    def within(self, cost: IntArray, budget: float) -> list[int]:
        """Return the indices to take for a budget; see `budget.choose_in_budget`."""
        return choose_in_budget(lambda: Uncovered(self._polygons), cost, budget, tie=SMALLEST_M2)

    def gains(self, order: IntArray) -> FloatArray:
        """Return the area (m,) that each polygon of a given order adds to those before it."""
        return area_greedy.area_gains(self._polygons, order)


class CellCoverage:
    """Sets of weighted cells: f(S) = sum over cells of the largest weight any member of S gives it.

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

    def __init__(self, scan: IntArray, cell: IntArray, weight: FloatArray, n: int) -> None:
        weight = np.asarray(weight, float)
        if not len(scan) == len(cell) == len(weight) or (np.diff(scan) < 0).any():
            raise ValueError(
                f"{len(scan)} scans, {len(cell)} cells and {len(weight)} weights must be one each,"
                " by scan"
            )
        in_range = not len(scan) or (scan[0] >= 0 and scan[-1] < n)
        if not (in_range and (weight >= 0).all() and np.isfinite(weight).all()):
            raise ValueError(f"scans must be 0 to {n - 1}, weights finite and not below 0")
        self._first = np.searchsorted(scan, np.arange(n + 1))
        self._cell = np.unique(cell, return_inverse=True)[1]
        self._weight = weight

    def greedy(self, min_overlap: float = 0.0) -> GreedyOrder:
        """Return the greedy order; see `lazy_greedy.order_greedily`."""
        return lazy_greedy.order_greedily(self._nothing(), tie=ROUNDING, min_overlap=min_overlap)

    def within(self, cost: IntArray, budget: float) -> list[int]:
        """Return the indices to take for a budget; see `budget.choose_in_budget`."""
        return choose_in_budget(self._nothing, cost, budget, tie=ROUNDING)

    def gains(self, order: IntArray) -> FloatArray:
        """Return what (m,) each scan of a given order adds to those before it."""
        return lazy_greedy.gains_along(self._nothing(), order)

    def _nothing(self) -> "_BestWeights":
        return _BestWeights(self._first, self._cell, self._weight)


class _BestWeights(lazy_greedy.SingleGains):
    """The largest weight so far of every cell, and what each scan would add to their sum."""

    def __init__(self, first: IntArray, cell: IntArray, weight: FloatArray) -> None:
        self._own = [slice(a, b) for a, b in pairwise(first)]
        self._cell, self._weight = cell, weight
        self._best = np.zeros(cell.max(initial=-1) + 1)
        super().__init__(len(self._own))

    def measure_gain(self, i: int) -> float:
        """Return by how much a scan's cells are larger than the best so far."""
        own = self._own[i]
        return float(np.maximum(self._weight[own] - self._best[self._cell[own]], 0.0).sum())

    def cover(self, i: int) -> None:
        """Keep the larger weight of each of a scan's cells."""
        own = self._own[i]
        self._best[self._cell[own]] = np.maximum(self._best[self._cell[own]], self._weight[own])
