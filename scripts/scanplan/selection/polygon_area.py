"""How much area the polygons of scans have covered so far, as an objective for orders of scans."""

import numpy as np

from scanplan.selection import area_greedy, lazy_greedy
from scanplan.selection.budget import choose_in_budget
from scanplan.selection.union_area import uncovered


class PolygonArea:
    """Polygons: f(S) = area of the union of those of S.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `area_greedy.order_by_area`.
    """

    def __init__(self, polygons):
        self._polygons = polygons

    def greedy(self, min_overlap=0.0):
        """Return the greedy order, a `area_greedy.AreaOrder`; see `lazy_greedy.order_greedily`."""
        if min_overlap == 0:
            return area_greedy.order_by_area(self._polygons)
        return lazy_greedy.order_greedily(
            _Left(self._polygons), tie=area_greedy.TIE_M2, min_overlap=min_overlap
        )

    def within(self, cost, budget):
        """Return the indices to take for a budget; see `budget.choose_in_budget`."""
        return choose_in_budget(lambda: _Left(self._polygons), cost, budget, tie=area_greedy.TIE_M2)

    def gains(self, order):
        """Return the area (m,) that each polygon of a given order adds to those before it, square metres."""
        return area_greedy.area_gains(self._polygons, order)


class _Left(uncovered.Uncovered):
    """What the chosen polygons leave of every polygon, one at a time; see `lazy_greedy`."""

    @property
    def gain(self):
        """Return what (n,) each polygon would add, as of when it was last looked at."""
        return self.gain_m2

    def refresh(self, some, floor_m2=-np.inf):
        """Bring the gain of one polygon, or of several, up to date; return it."""
        if not np.all(self.exact[some]):
            super().refresh(np.atleast_1d(some), floor_m2)
        return self.gain_m2[some]
