"""The ways between few stops on a large grid, each searched for no farther than it is long."""

import numpy as np
from scipy.sparse.csgraph import dijkstra

from scanplan.geometry.roadmap import RoadmapGrid, trace_cells
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import Array, FloatArray, IntArray


class StopWays:
    """Costs of the ways between stops, of which no more is kept than the costs.

    They are `tour.Distances`: a metre of a way costs at least 1.

    Parameters
    ----------
    grid : RoadmapGrid
        Connected.
    cells : (n,) int64
        The cell of each stop.
    """

    def __init__(self, grid: RoadmapGrid, cells: IntArray) -> None:
        self._grid, self._cells = grid, cells
        self._xy_m = np.ascontiguousarray(grid.xy_m.T)
        apart_m = grid.xy_m[cells][:, None] - grid.xy_m[cells]
        self.least_m: FloatArray = np.hypot(apart_m[..., 0], apart_m[..., 1]) * (1 - ROUNDING)
        self._costs = np.full(self.least_m.shape, np.inf)
        # of how much the ways from each stop are known at most
        self._known = np.zeros(len(cells))
        self._dearest = float(grid.steps.sum())

    def __getitem__(self, pair: tuple[int, int]) -> float:
        """Return what the way between two stops costs."""
        # one search from the stop that more is known of
        one, other = sorted(pair, key=lambda stop: -self._known[stop])
        return self._find_cost(one, other)

    def trace(self, one: int, other: int) -> IntArray:
        """Return the cells of the cheapest way from a stop to another."""
        most = self._find_cost(one, other) * (1 + ROUNDING)
        near, start, (_, before) = self._search(one, most)
        end = int(np.searchsorted(near, self._cells[other]))
        return near[trace_cells(before, start, end)]

    def _find_cost(self, one: int, other: int) -> float:
        while self._costs[one, other] == np.inf:
            if self._known[one] > self._dearest:
                raise ValueError(f"no way leads from stop {one} to stop {other}")
            # twice as far: all searches from a stop take little more than the last
            self._known[one] = 2 * max(self._known[one], self.least_m[one, other], 1.0)
            near, _, (costs, _) = self._search(one, self._known[one])
            rows = np.minimum(np.searchsorted(near, self._cells), len(near) - 1)
            found = np.where(near[rows] == self._cells, costs[rows], np.inf)
            self._costs[one] = np.minimum(self._costs[one], found)
            self._costs[:, one] = self._costs[one]
        return float(self._costs[one, other])

    def _search(self, stop: int, most: float) -> tuple[IntArray, int, tuple[FloatArray, Array]]:
        """Return the cells (m,) near a stop, its row, costs from it and the row before each."""
        cell = self._cells[stop]
        x_m, y_m = self._xy_m
        # cells are row by row
        first = int(np.searchsorted(y_m, y_m[cell] - most))
        end = int(np.searchsorted(y_m, y_m[cell] + most, side="right"))
        near = first + np.flatnonzero(np.abs(x_m[first:end] - x_m[cell]) <= most)
        steps = self._grid.steps[near][:, near]
        start = int(np.searchsorted(near, cell))
        found = dijkstra(steps, directed=False, indices=start, limit=most, return_predecessors=True)
        return near, start, found
