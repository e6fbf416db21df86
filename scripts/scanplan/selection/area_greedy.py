"""The order of scans that covers most area soonest (thesis, algorithm 1).

The area of a union is monotone submodular, so `lazy_greedy` gives the very order that looking at
every scan in every step gives; what is left of each scan is `union_area.uncovered`.
"""

from concurrent.futures import ThreadPoolExecutor
from itertools import islice

import numpy as np
import shapely

from scanplan.geometry.polygons import (
    Polygons,
    intersect_polygons,
    move_near_origin,
    subtract_polygons,
    unite_polygons,
)
from scanplan.selection.lazy_greedy import GreedyOrder, choose_greedily, order_greedily
from scanplan.selection.union_area.uncovered import Uncovered
from scanplan.types import Array, FloatArray, IntArray

TIE_M2 = 1e-6
"""Gains this close to the largest are equal to it: overlays agree to about 1e-12 of the covered
area only."""

_TILE_PER_POLYGON = 2.0  # so that few polygons are cut, and few lie in a tile


def order_by_area(polygons: Polygons, *, min_overlap: float = 0.0, threads: int = 1) -> GreedyOrder:
    """Order polygons so that each adds the most area to the union of those before it.

    Where several gains are within `TIE_M2` of the largest, the lowest index comes first; those that
    add nothing more are therefore last, by index (thesis, algorithm 1).

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        Finite coordinates, metres. Empty ones, points and lines cover nothing; invalid ones are
        repaired.
    min_overlap : float, 0 to 1
        What a polygon must share with those before it, see `lazy_greedy.order_greedily`.
    threads : int, >= 1
        The order is the same, to the last digit, with any number of them.

    Returns
    -------
    GreedyOrder
        In square metres.

    Raises
    ------
    ValueError
        If a geometry is missing, a coordinate is not finite or `min_overlap` is out of its range.
    """
    with ThreadPoolExecutor(threads) as executor:
        left = Uncovered(polygons, executor if threads > 1 else None)
        return order_greedily(left, tie=TIE_M2, min_overlap=min_overlap)


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
    chosen = [i for i, _ in islice(choose_greedily(left, tie=TIE_M2), count)]
    rest = np.flatnonzero(left.remaining)[: count - len(chosen)]
    return np.concatenate([np.array(chosen, int), rest])


def area_gains(polygons: Polygons, order: IntArray) -> FloatArray:
    """Return the area (m,) that each polygon of an order adds to those before it, square metres.

    The plane is cut into tiles and every tile done by itself, so that what a polygon is compared
    with does not grow with the building.

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
    n = len(polygons)
    if len(np.unique(order)) != len(order) or not np.isin(order, np.arange(n)).all():
        raise ValueError(f"an order of {n} polygons must hold distinct indices below that")
    pieces, rank, tile = _cut(move_near_origin(polygons)[order])
    gain_m2 = np.zeros(len(order))
    for same in np.split(np.arange(len(tile)), np.flatnonzero(np.diff(tile)) + 1):
        gain_m2[rank[same]] += _gains(pieces[same])
    return gain_m2


def _cut(polygons: Array) -> tuple[Array, IntArray, IntArray]:
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
    tiles = _tiles(boxes)
    row, tile = shapely.STRtree(tiles).query(polygons[with_area])
    by_tile = np.lexsort((row, tile))
    row = with_area[row[by_tile]]
    tile = tile[by_tile]
    return intersect_polygons(polygons[row], tiles[tile]), row, tile


def _tiles(boxes_m: FloatArray) -> Array:
    """Return square tiles (t,), shapely Polygons, over boxes (n, 4), no more than boxes."""
    low_m = boxes_m[:, :2].min(axis=0)
    high_m = boxes_m[:, 2:].max(axis=0)
    polygon_m = np.median((boxes_m[:, 2:] - boxes_m[:, :2]).max(axis=1))
    # no more tiles than polygons, however far apart they are
    least_m = (high_m - low_m).max() / np.sqrt(len(boxes_m))
    edge_m = max(_TILE_PER_POLYGON * polygon_m, least_m)
    x_m = np.arange(low_m[0], high_m[0], edge_m)
    y_m = np.arange(low_m[1], high_m[1], edge_m)
    x_m, y_m = (axis.ravel() for axis in np.meshgrid(x_m, y_m))
    return shapely.box(x_m, y_m, x_m + edge_m, y_m + edge_m)


def _gains(polygons: Array) -> FloatArray:
    """Return the area (m,) that each polygon adds to the union of those before it."""
    gain_m2 = np.zeros(len(polygons))
    union = shapely.Polygon()
    for i, polygon in enumerate(polygons):
        gain_m2[i] = subtract_polygons([polygon], [union])[0].area
        if gain_m2[i] > 0:
            union = unite_polygons([union, polygon])
    return gain_m2
