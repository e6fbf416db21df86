"""The order of scans that covers most area soonest (thesis, algorithm 1).

The area of a union is monotone submodular, so `lazy_greedy` gives the very order that looking at
every scan in every step gives; what is left of each scan is `union_area.uncovered`.
"""

from itertools import islice

import numpy as np

from scanplan.geometry.polygons import Polygons
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.selection.lazy_greedy import (
    GreedyOrder,
    choose_greedily,
    gains_along,
    order_greedily,
)
from scanplan.selection.union_area.uncovered import Uncovered
from scanplan.types import FloatArray, IntArray


def order_by_area(polygons: Polygons, *, min_overlap: float = 0.0) -> GreedyOrder:
    """Order polygons so that each adds the most area to the union of those before it.

    Where several gains are within `SMALLEST_M2` of the largest, the lowest index comes first; those
    that add nothing more are therefore last, by index (thesis, algorithm 1).

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        Finite coordinates, metres. Empty ones, points and lines cover nothing; invalid ones are
        repaired.
    min_overlap : float, 0 to 1
        What a polygon must share with those before it, see `lazy_greedy.order_greedily`.

    Returns
    -------
    GreedyOrder
        In square metres.

    Raises
    ------
    ValueError
        If a geometry is missing, a coordinate is not finite or `min_overlap` is out of its range.
    """
    return order_greedily(Uncovered(polygons), tie=SMALLEST_M2, min_overlap=min_overlap)


def choose_first(polygons: Polygons, count: int) -> IntArray:
    """Return the first indices of `order_by_area`, without ordering what is left.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `order_by_area`.
    count : int, >= 0

    Returns
    -------
    (min(n, `count`),) int
    """
    left = Uncovered(polygons)
    chosen = [i for i, _ in islice(choose_greedily(left, tie=SMALLEST_M2), count)]
    rest = np.flatnonzero(left.remaining)[: count - len(chosen)]
    return np.concatenate([np.array(chosen, int), rest])


def area_gains(polygons: Polygons, order: IntArray) -> FloatArray:
    """Return the area (m,) that each polygon of an order adds to those before it, square metres.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `order_by_area`.
    order : (m,) int
        Distinct indices.

    Raises
    ------
    ValueError
        If an index occurs twice or is out of range, or the polygons are not usable.
    """
    return gains_along(Uncovered(polygons), order)
