"""How much area the polygons of scans have covered so far, as an objective for orders of scans."""

import numpy as np
import shapely

from scanplan import greedy, lazygreedy

_GRID_M = 1e-6


class PolygonArea:
    """Polygons: f(S) = area of the union of those of S.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `greedy.greedy_order`.
    """

    def __init__(self, polygons):
        self._polygons = polygons

    def greedy(self, min_overlap=0.0):
        """Return the greedy order, a `greedy.Order`; see `lazygreedy.order`."""
        if min_overlap == 0:
            return greedy.greedy_order(self._polygons)
        return lazygreedy.order(_Left(self._polygons), tie=greedy.TIE_M2, min_overlap=min_overlap)

    def gains(self, order):
        """Return the area (m,) that each polygon of a given order adds to those before it, square metres."""
        return greedy.gains_of_order(self._polygons, order)


class _Left:
    """What the chosen polygons leave of every polygon, brought up to date only when asked."""

    def __init__(self, polygons):
        self._left = np.empty(len(polygons), object)
        self._left[:] = [p if p.is_valid else shapely.make_valid(p) for p in polygons]
        self._whole, self._chosen = self._left.copy(), []
        self._looked = np.zeros(len(polygons), int)
        self.gain = shapely.area(self._left)

    def refresh(self, i):
        for chosen in self._chosen[self._looked[i] :]:
            # a box first: most pairs are far apart
            if self.gain[i] > 0 and shapely.intersects(shapely.box(*chosen.bounds), self._left[i]):
                self._left[i] = _difference(self._left[i], chosen)
                self.gain[i] = self._left[i].area
        self._looked[i] = len(self._chosen)
        return self.gain[i]

    def choose(self, i):
        gain_m2 = self.refresh(i)
        if gain_m2 > 0:
            self._chosen.append(self._whole[i])
        self.gain[i] = 0.0
        return gain_m2


def _difference(polygon, other):
    try:
        return shapely.difference(polygon, other)
    except shapely.GEOSException:
        # rounding made an overlay inconsistent: once more with all corners on a micrometre grid
        return shapely.difference(shapely.make_valid(polygon), shapely.make_valid(other), grid_size=_GRID_M)
