r"""Upper bounds of what is uncovered of many polygons, from how full cells of a grid are.

Nothing of a polygon P is uncovered in a cell but what lies in the polygon and outside the covered
region U there:

    area(P \ U) <= sum over cells of min(area of P in the cell, area of the cell outside U)

Equal where a cell is full or empty of either, so only cells that the edges of both cross make the
bound loose. An area in a cell is exact: the edges are cut at the lines of the grid, and what every
piece adds to its own cell and to all those to the right of it is summed up, as outlines of letters
are drawn with soft edges.
"""

import numpy as np
import shapely

from scanplan.geometry.intervals import number_within
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import Array, FloatArray, IntArray

_CELLS_PER_SIDE = 8  # of a part of common size; more are tighter, and slower to fill
_MOST_CELLS = 10**7  # of the plane: 80 MB
_AT_A_TIME = 4096  # polygons filled together: bounds the memory
_ROUNDING = np.finfo(np.float32).eps  # of a cell, added to its areas, which are kept so


class CellBounds:
    """How much of polygons may be uncovered.

    Parameters
    ----------
    polygons : (n,) numpy.ndarray of shapely Polygon
        Valid, with area, near the origin.
    """

    def __init__(self, polygons: Array) -> None:
        boxes = shapely.bounds(polygons).reshape(-1, 4)
        self._edge_m = _cell_edge_m(boxes)
        filled = [
            _fill_cells(polygons[start : start + _AT_A_TIME], self._edge_m)
            for start in range(0, len(polygons), _AT_A_TIME)
        ]
        # one cell more on every side: rounding puts corners of what is left just outside
        low, high = (np.floor(side / self._edge_m).astype(np.int64) for side in _extent(boxes))
        self._origin, self._shape = low - 1, high - low + 3
        n_cells = [
            np.bincount(row, minlength=min(_AT_A_TIME, len(polygons) - i * _AT_A_TIME))
            for i, (row, *_) in enumerate(filled)
        ]
        self._first = np.cumsum(np.concatenate([[0], *n_cells]).astype(np.int64))
        self._cell = np.concatenate(
            [self._number(at).astype(np.int32) for _, at, _ in filled] + [np.zeros(0, np.int32)]
        )
        no_share = np.zeros(0, np.float32)
        self._share = np.concatenate(
            [(share + _ROUNDING).astype(np.float32) for *_, share in filled] + [no_share]
        )
        n_unlisted = _grid(boxes, self._edge_m)[1].prod(axis=1) - np.diff(self._first)
        self._unlisted_m2 = ROUNDING * self._edge_m**2 * n_unlisted
        self._free = np.full(self._shape.prod(), 1 + _ROUNDING)
        self._pending: list[Array] = []

    def cover(self, polygons: Array) -> None:
        """Cover (m,) more valid Polygons, within those given and outside what is covered."""
        self._pending.append(polygons)

    def area_m2(self, some: IntArray) -> FloatArray:
        """Return the area (m,) that may be uncovered of polygons (m,) int, never too little."""
        if len(some) == 0:
            return np.zeros(0)
        self._bring_up_to_date()
        row, entry = list_members(self._first, some)
        uncovered = np.minimum(self._share[entry], self._free[self._cell[entry]])
        listed_m2 = np.bincount(row, uncovered, minlength=len(some)) * self._edge_m**2
        return listed_m2 + self._unlisted_m2[some]

    def _bring_up_to_date(self) -> None:
        if self._pending:
            _, at, share = _fill_cells(np.concatenate(self._pending), self._edge_m)
            np.subtract.at(self._free, self._number(at), share)
            self._pending = []

    def _number(self, at: IntArray) -> IntArray:
        x, y = (at - self._origin).T
        return y * self._shape[0] + x


def list_members(first: IntArray, some: IntArray) -> tuple[IntArray, IntArray]:
    """List the members of some groups (m,) int: those of group i are first[i] to first[i + 1] - 1.

    Returns
    -------
    place : (k,) int
        Which of `some` each member belongs to, 0 to m - 1.
    member : (k,) int
    """
    n_members = first[some + 1] - first[some]
    place = np.repeat(np.arange(len(some)), n_members)
    return place, np.arange(len(place)) + (first[some] - np.cumsum(n_members) + n_members)[place]


def _extent(boxes: FloatArray) -> tuple[FloatArray, FloatArray]:
    if len(boxes) == 0:
        return np.zeros(2), np.zeros(2)
    return boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)


def _cell_edge_m(boxes: FloatArray) -> float:
    """Return the edge of a cell: a share of a polygon's size, unless the plane takes too many."""
    if len(boxes) == 0:
        return 1.0
    sides_m = boxes[:, 2:] - boxes[:, :2]
    usual_m = np.sqrt(np.mean(sides_m.sum(axis=1) ** 2)) / 2
    low_m, high_m = _extent(boxes)
    plane_m2 = np.prod(high_m - low_m)
    least_m = np.sqrt(plane_m2 / _MOST_CELLS)
    return float(max(usual_m / _CELLS_PER_SIDE, least_m))


def _fill_cells(polygons: Array, edge_m: float) -> tuple[IntArray, IntArray, FloatArray]:
    """Fill cells with polygons (n,).

    Returns
    -------
    row : (m,) int, sorted
        Which polygon has a share in a cell.
    at : (m, 2) int
        The cell, x and y.
    share : (m,) float64
        Of the cell's area.
    """
    low, size = _grid(shapely.bounds(polygons).reshape(-1, 4), edge_m)
    width, height = size.T
    first = np.cumsum(np.concatenate([[0], width * height]))
    start, end, row = _edges(polygons, edge_m, low)
    start, end, row = _cut(*_cut(start, end, row, axis=1), axis=0)
    middle = (start + end) / 2
    down = start[:, 1] - end[:, 1]
    x, y = np.floor(middle).astype(np.int64).T
    # rounding puts pieces without length just outside
    x = np.clip(x, 0, width[row] - 2)
    y = np.clip(y, 0, height[row] - 1)
    own = first[row] + y * width[row] + x
    in_own = down * (1 + x - middle[:, 0])
    n_cells = int(first[-1])
    added = np.bincount(own, in_own, minlength=n_cells)
    added = added + np.bincount(own + 1, down - in_own, minlength=n_cells)
    share = np.cumsum(added, dtype=float)
    listed = np.flatnonzero(share > ROUNDING)
    row = np.repeat(np.arange(len(polygons)), width * height)[listed]
    y, x = np.divmod(listed - first[row], width[row])
    return row, np.column_stack([x, y]) + low[row], share[listed]


def _grid(boxes: FloatArray, edge_m: float) -> tuple[IntArray, IntArray]:
    """Return the first cell (n, 2) of the grid about each box, and its columns and rows (n, 2)."""
    low = np.floor(boxes[:, :2] / edge_m).astype(np.int64)
    high = np.floor(boxes[:, 2:] / edge_m).astype(np.int64)
    # one more column: what lies to the right of a piece of an edge is nothing beyond the last
    return low, high - low + [2, 1]


def _edges(
    polygons: Array, edge_m: float, low: IntArray
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the edges of polygons, counter-clockwise: start, end, polygon.

    In cells from each one's own first cell.
    """
    rings, of = shapely.get_rings(shapely.orient_polygons(polygons), return_index=True)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    xy = xy / edge_m - low[of[ring]]
    follows = ring[1:] == ring[:-1]
    return xy[:-1][follows], xy[1:][follows], of[ring[:-1][follows]]


def _cut(
    start: FloatArray, end: FloatArray, row: IntArray, axis: int
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Cut edges at the lines of the grid across one axis."""
    low = np.floor(np.minimum(start[:, axis], end[:, axis]))
    high = np.floor(np.maximum(start[:, axis], end[:, axis]))
    long = np.flatnonzero(low < high)
    n_pieces = (high - low)[long].astype(np.int64) + 1
    edge = np.repeat(long, n_pieces)
    line = low[edge] + number_within(n_pieces)
    a, b = start[edge], end[edge]
    step = (b - a) / (b - a)[:, axis, None]
    cut_a, cut_b = (
        a + (np.clip(p[:, axis], line, line + 1) - a[:, axis])[:, None] * step for p in (a, b)
    )
    whole = low == high
    return (
        np.concatenate([start[whole], cut_a]),
        np.concatenate([end[whole], cut_b]),
        np.concatenate([row[whole], row[edge]]),
    )
