"""The union of a growing choice of polygons, in windows, so that nobody needs all of it."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.types import Array, IntArray


class Regions:
    """What is covered round each of many polygons.

    The plane is divided into squares as large as the largest polygon. A polygon belongs to the
    square that the lower left corner of its box lies in, and is therefore inside a window of two by
    two squares. Each window unites all that reaches into it
    when it is next asked: the union of many hulls has few corners, and is quickly subtracted.

    Parameters
    ----------
    polygons : (n,) numpy.ndarray of shapely Polygon
        With area.
    """

    def __init__(self, polygons: Array) -> None:
        boxes = shapely.bounds(polygons).reshape(-1, 4)
        side_m = (boxes[:, 2:] - boxes[:, :2]).max(initial=0.0)
        squares, window = np.unique(np.floor(boxes[:, :2] / side_m), axis=0, return_inverse=True)
        self._window = window.reshape(-1)
        low_m = squares * side_m
        self._tree = shapely.STRtree(shapely.box(*low_m.T, *(low_m + 2 * side_m).T))
        self._union = np.full(len(squares), shapely.Polygon(), object)
        self._pending: list[list[BaseGeometry]] = [[] for _ in squares]

    def cover(self, polygons: Array, new: Array) -> None:
        """Cover (m,) more polygons, each of which adds (m,) something new to what is covered."""
        which, window = self._tree.query(new)
        for i, one in zip(window.tolist(), polygons[which], strict=True):
            self._pending[i].append(one)

    def around(self, some: IntArray) -> Array:
        """Return the covered region (m,), prepared, near each of some polygons (m,) int.

        Inside a polygon's box it is all that is covered.
        """
        window = self._window[some]
        for i in np.unique(window):
            if self._pending[i]:
                self._union[i] = overlays.unite_areas([self._union[i], *self._pending[i]])
                shapely.prepare(self._union[i])
                self._pending[i] = []
        return self._union[window]
