"""The order of scans that covers most area soonest (thesis, algorithm 1), by lazy evaluation.

The area of a union is monotone submodular: what a scan adds can only shrink while others are chosen. A gain computed
earlier is therefore an upper bound of today's, and a scan whose old gain is below the best new one need not be looked
at (Minoux 1978, "Accelerated greedy algorithms for maximizing submodular set functions"). The order is the very one
that looking at every scan in every step gives.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry.polygons import (
    intersect_polygons,
    move_near_origin,
    subtract_polygons,
    unite_polygons,
)
from scanplan.selection.union_area import uncovered

TIE_M2 = 1e-6
"""Gains this close to the largest are equal to it: overlays agree to about 1e-12 of the covered area only."""

_LARGEST_BATCH = 64
_BATCH_GROWTH = 4
_TILE_PER_POLYGON = 2.0


@dataclass(frozen=True, eq=False)
class AreaOrder:
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
        For some numbers of chosen polygons, an upper bound of what each polygon (by index) would have added then; 0 for
        the chosen ones.
    """

    order: np.ndarray
    gain_m2: np.ndarray
    covered_m2: np.ndarray
    checkpoints: dict


def order_by_area(polygons, *, threads=1):
    """Order polygons so that each adds the most area to the union of those before it (thesis, algorithm 1).

    Where several gains are within `TIE_M2` of the largest, the lowest index comes first; those that add nothing more
    are therefore last, by index. After 0, 1, 2, 4, 8, ... choices the gains of all are kept, for bounds.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        Finite coordinates, metres. Empty ones, points and lines cover nothing; invalid ones are repaired.
    threads : int, >= 1
        The order is the same, to the last digit, with any number of them.

    Returns
    -------
    Order

    Raises
    ------
    ValueError
        If a geometry is missing or a coordinate is not finite.
    """
    with ThreadPoolExecutor(threads) as executor:
        return _greedy_order(uncovered.Uncovered(polygons, executor if threads > 1 else None))


def choose_first(polygons, count):
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
    left, chosen = uncovered.Uncovered(polygons, None), []
    while len(chosen) < count and left.gain_m2.max(initial=0.0) > TIE_M2:
        chosen.append(_best(left))
        left.choose(chosen[-1])
        if len(chosen).bit_count() == 1:
            left.drop_covered()
    rest = np.flatnonzero(left.remaining)[: count - len(chosen)]
    return np.concatenate([np.array(chosen, int), rest])


def area_gains(polygons, order):
    """Return the area (m,) that each polygon of a given order adds to the union of those before it, square metres.

    The plane is cut into tiles and every tile done by itself, so that what a polygon is compared with does not grow
    with the building.

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
    order = np.asarray(order, int)
    if len(np.unique(order)) != len(order) or not np.isin(order, np.arange(len(polygons))).all():
        raise ValueError(
            f"an order of {len(polygons)} polygons must hold distinct indices below that"
        )
    pieces, rank, tile = _cut(move_near_origin(polygons)[order])
    gain_m2 = np.zeros(len(order))
    for same in np.split(np.arange(len(tile)), np.flatnonzero(np.diff(tile)) + 1):
        gain_m2[rank[same]] += _gains(pieces[same])
    return gain_m2


def _greedy_order(left):
    checkpoints, order, gain_m2 = {0: left.gain_m2.copy()}, [], []
    while left.gain_m2.max(initial=0.0) > TIE_M2:
        order.append(_best(left))
        gain_m2.append(left.choose(order[-1]))
        if len(order).bit_count() == 1:
            left.drop_covered()
            checkpoints[len(order)] = left.gain_m2.copy()
    if order:
        left.drop_covered()
    rest = np.flatnonzero(left.remaining).tolist()
    gain_m2 = np.array(gain_m2 + [left.choose(i) for i in rest])
    return AreaOrder(np.array(order + rest, int), gain_m2, np.cumsum(gain_m2), checkpoints)


def _best(left):
    """Index of the remaining polygon of the largest gain, the lowest of equals; few others are looked at."""
    batch = 1
    while True:
        largest_m2 = left.gain_m2[left.remaining & left.exact].max(initial=0.0)
        doubtful = np.flatnonzero(
            left.remaining & ~left.exact & (left.gain_m2 >= largest_m2 - TIE_M2)
        )
        if len(doubtful) == 0:
            return int(np.flatnonzero(left.remaining & (left.gain_m2 >= largest_m2 - TIE_M2))[0])
        by_gain = doubtful[np.argsort(-left.gain_m2[doubtful], kind="stable")]
        left.refresh(by_gain[:batch], largest_m2 - TIE_M2)
        batch = min(batch * _BATCH_GROWTH, _LARGEST_BATCH)


def _cut(polygons):
    """Cut polygons at a grid of tiles, most polygons smaller than a tile.

    Returns
    -------
    pieces : (m,) numpy.ndarray of shapely Polygon or MultiPolygon
    row, tile : (m,) int
        Which polygon is in which tile; sorted by tile, then by row.
    """
    with_area = np.flatnonzero(shapely.area(polygons) > 0)
    boxes = shapely.bounds(polygons[with_area]).reshape(-1, 4)
    if len(boxes) == 0:
        return polygons[:0], with_area, with_area
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    polygon_m = np.median((boxes[:, 2:] - boxes[:, :2]).max(axis=1))
    # no more tiles than polygons, however far apart they are
    edge_m = max(_TILE_PER_POLYGON * polygon_m, (high - low).max() / np.sqrt(len(boxes)))
    x_m, y_m = (
        axis.ravel()
        for axis in np.meshgrid(*(np.arange(a, b, edge_m) for a, b in zip(low, high, strict=True)))
    )
    tiles = shapely.box(x_m, y_m, x_m + edge_m, y_m + edge_m)
    row, tile = shapely.STRtree(tiles).query(polygons[with_area])
    by_tile = np.lexsort((row, tile))
    row, tile = with_area[row[by_tile]], tile[by_tile]
    return intersect_polygons(polygons[row], tiles[tile]), row, tile


def _gains(polygons):
    """Area that each polygon adds to the union of those before it."""
    gain_m2, union = np.zeros(len(polygons)), shapely.Polygon()
    for i, polygon in enumerate(polygons):
        gain_m2[i] = subtract_polygons([polygon], [union])[0].area
        if gain_m2[i] > 0:
            union = unite_polygons([union, polygon])
    return gain_m2
