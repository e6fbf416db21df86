"""The order of scans that covers most area soonest (thesis, algorithm 1), by lazy evaluation.

The area of a union is monotone submodular: what a scan adds can only shrink while others are chosen. A gain computed
earlier is therefore an upper bound of today's, and a scan whose old gain is below the best new one need not be looked
at (Minoux 1978, "Accelerated greedy algorithms for maximizing submodular set functions"). The order is the very one
that looking at every scan in every step gives.
"""

import heapq
from dataclasses import dataclass

import numpy as np
import shapely

TIE_M2 = 1e-6
"""Gains this close to the largest are equal to it: overlays agree to about 1e-12 of the covered area only."""

_GRID_M = 1e-6


@dataclass(frozen=True, eq=False)
class Order:
    """A complete order of polygons by greedy choice.

    Attributes
    ----------
    order : (n,) int
        Indices of the polygons.
    gain_m2 : (n,) float64
        Area that each adds to the union of those before it.
    covered_m2 : (n,) float64
        Area of the union up to and including each.
    checkpoints : dict of int to (n,) float64
        For some numbers of chosen polygons, what each polygon (by index) would have added then.
    """

    order: np.ndarray
    gain_m2: np.ndarray
    covered_m2: np.ndarray
    checkpoints: dict


def greedy_order(polygons):
    """Order polygons so that each adds the most area to the union of those before it (thesis, algorithm 1).

    Where several gains are within `TIE_M2` of the largest, the lowest index comes first; those that add nothing more
    are therefore last, by index. After 0, 1, 2, 4, 8, ... choices the gains of all are kept, for bounds.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        Finite coordinates, metres. Empty ones, points and lines cover nothing; invalid ones are repaired.

    Returns
    -------
    Order

    Raises
    ------
    ValueError
        If a geometry is missing or a coordinate is not finite.
    """
    uncovered = _Uncovered(polygons)
    heap = [(-gain, i) for i, gain in enumerate(uncovered.gain_m2)]
    heapq.heapify(heap)
    checkpoints, order, gains = {0: uncovered.gain_m2.copy()}, [], []
    while heap and -heap[0][0] > TIE_M2:
        order.append(_pop_best(heap, uncovered))
        gains.append(uncovered.choose(order[-1]))
        if len(order).bit_count() == 1:
            heap = [(-uncovered.refresh(i), i) for _, i in heap]
            heapq.heapify(heap)
            checkpoints[len(order)] = _without(uncovered.gain_m2, order)
    rest = sorted(i for _, i in heap)
    gain_m2 = np.array(gains + [uncovered.choose(i) for i in rest])
    return Order(np.array(order + rest, int), gain_m2, np.cumsum(gain_m2), checkpoints)


def gains_of_order(polygons, order):
    """Return the area (n,) that each polygon of a given order adds to the union of those before it, square metres.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `greedy_order`.
    order : (m,) int
        Distinct indices.

    Raises
    ------
    ValueError
        If an index occurs twice or is out of range, or the polygons are not usable.
    """
    order = np.asarray(order, int)
    if len(np.unique(order)) != len(order) or not np.isin(order, np.arange(len(polygons))).all():
        raise ValueError(f"an order of {len(polygons)} polygons must hold distinct indices below that")
    polygons = _near_origin(polygons)
    gain_m2, union = np.zeros(len(order)), shapely.Polygon()
    for rank, i in enumerate(order):
        gain_m2[rank] = shapely.area(_overlay(shapely.difference, polygons[i], union))
        if gain_m2[rank] > 0:
            union = _overlay(shapely.union, union, polygons[i])
    return gain_m2


def _pop_best(heap, uncovered):
    """Take the polygon of the largest gain, the lowest index of equals, off the heap of old gains."""
    fresh, best_m2 = [], 0.0
    while heap and -heap[0][0] >= best_m2 - TIE_M2:
        _, i = heapq.heappop(heap)
        fresh.append(i)
        best_m2 = max(best_m2, uncovered.refresh(i))
    best = min(i for i in fresh if uncovered.gain_m2[i] >= best_m2 - TIE_M2)
    for i in fresh:
        if i != best:
            heapq.heappush(heap, (-uncovered.gain_m2[i], i))
    return best


def _without(gain_m2, order):
    gain_m2 = gain_m2.copy()
    gain_m2[order] = 0.0
    return gain_m2


class _Uncovered:
    """What the chosen polygons leave of every polygon, brought up to date only when asked.

    Works on the polygons' parts (a scan's separate hulls): small, so that few pairs meet and each overlay is cheap.

    Attributes
    ----------
    gain_m2 : (n,) float64
        What each polygon would add, as of when it was last looked at: an upper bound of what it adds now.
    """

    def __init__(self, polygons):
        parts, owner = shapely.get_parts(_near_origin(polygons), return_index=True)
        has_area = shapely.area(parts) > 0
        self._whole, owner = parts[has_area], owner[has_area]
        self._left = self._whole.copy()
        self._area_m2 = shapely.area(self._left)
        self._box = shapely.bounds(self._left).reshape(-1, 4)
        self._first = np.searchsorted(owner, np.arange(len(polygons) + 1))
        self.gain_m2 = np.bincount(owner, self._area_m2, minlength=len(polygons))
        self._looked = np.zeros(len(polygons), int)
        self._chosen = np.empty(len(self._whole), object)
        self._chosen_box = np.empty((len(self._whole), 4))
        self._n_chosen = 0

    def refresh(self, i):
        """Subtract from polygon i what was chosen since it was last looked at; return its gain now."""
        since, self._looked[i] = self._looked[i], self._n_chosen
        if since < self._n_chosen and self.gain_m2[i] > 0:
            parts = range(self._first[i], self._first[i + 1])
            for part in parts:
                if self._area_m2[part] > 0:
                    self._subtract(part, since)
            self.gain_m2[i] = self._area_m2[parts.start : parts.stop].sum()
        return self.gain_m2[i]

    def choose(self, i):
        """Cover polygon i; return what it added."""
        gain_m2 = self.refresh(i)
        for part in range(self._first[i], self._first[i + 1]):
            if self._area_m2[part] > 0:
                # the whole part, not what is left of it: its few straight edges leave no slivers
                self._chosen[self._n_chosen] = self._whole[part]
                self._chosen_box[self._n_chosen] = shapely.bounds(self._whole[part])
                self._n_chosen += 1
        self._looked[i] = self._n_chosen
        self.gain_m2[i] = 0.0
        self._area_m2[self._first[i] : self._first[i + 1]] = 0.0
        return gain_m2

    def _subtract(self, part, since):
        x0, y0, x1, y1 = self._box[part]
        box = self._chosen_box[since : self._n_chosen]
        near = (box[:, 0] < x1) & (box[:, 2] > x0) & (box[:, 1] < y1) & (box[:, 3] > y0)
        near = self._chosen[since : self._n_chosen][near]
        left = _difference_all(self._left[part], near) if len(near) else self._left[part]
        if left is not self._left[part]:
            self._left[part], self._area_m2[part], self._box[part] = left, shapely.area(left), shapely.bounds(left)


def _difference_all(polygon, others):
    """Subtract several polygons from one; the same object if none of them meets it."""
    shapely.prepare(polygon)
    others = others[shapely.intersects(polygon, others)]
    if shapely.covers(others, polygon).any():
        return shapely.Polygon()
    for other in others:
        polygon = _overlay(shapely.difference, polygon, other)
        if polygon.is_empty:
            break
    return polygon


def _overlay(function, polygon, other):
    try:
        return function(polygon, other)
    except shapely.GEOSException:
        # rounding made an overlay inconsistent: once more with all corners on a micrometre grid
        return function(shapely.make_valid(polygon), shapely.make_valid(other), grid_size=_GRID_M)


def _near_origin(polygons):
    """Check and repair polygons, and move them near the origin: far from it, areas lose digits."""
    array = np.empty(len(polygons), object)
    array[:] = polygons
    xy_m = shapely.get_coordinates(array)
    if shapely.is_missing(array).any() or not np.isfinite(xy_m).all():
        raise ValueError("every polygon must be there, with finite coordinates")
    centre = np.floor(xy_m.mean(axis=0)) if len(xy_m) else 0.0
    array[:] = [_polygonal(p) for p in shapely.transform(array, lambda xy: xy - centre)]
    return array


def _polygonal(geometry):
    """Reduce a geometry to a valid Polygon or MultiPolygon of the same area."""
    if isinstance(geometry, shapely.Polygon | shapely.MultiPolygon) and geometry.is_valid:
        return geometry
    members = shapely.get_parts(shapely.get_parts(shapely.make_valid(geometry)))
    return shapely.union_all(members[shapely.get_dimensions(members) == 2])
