"""Lines as binary maps: the square cells that they pass through (thesis, section 5.1)."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.geometry.intervals import number_within
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

_MOST_CELLS = 100_000_000  # 100 MB a bitmap
_TILE = 512  # cells: distances take 2 MB, and what is done twice around tiles is little


@dataclass(frozen=True)
class Grid:
    """Square cells: (row, column) begins at `low_m` + (column, row) * `cell_m`.

    Attributes
    ----------
    low_m : (2,) float64
    cell_m : float
    shape : (int, int)
        Rows (y) and columns (x).
    """

    low_m: FloatArray
    cell_m: float
    shape: tuple[int, int]


def fit_grid(lines_m: npt.ArrayLike, cell_m: float) -> Grid:
    """Return the grid that just holds all lines (n, 2, 2), n >= 0.

    It begins whole cells from the map's origin. Of no line at all it is one cell.

    Raises
    ------
    StageError
        If it would have more than a hundred million cells.
    ValueError
        If the cell is not above 0.
    """
    if cell_m <= 0:
        raise ValueError(f"cell_m is {cell_m}, must be above 0")
    xy_m = np.asarray(lines_m, float).reshape(-1, 2)
    xy_m = xy_m if len(xy_m) else np.zeros((1, 2))
    first = np.floor(xy_m.min(axis=0) / cell_m + ROUNDING)
    last = np.maximum(np.ceil(xy_m.max(axis=0) / cell_m - ROUNDING), first + 1)
    columns, rows = (last - first).tolist()
    if rows * columns > _MOST_CELLS:
        raise StageError(
            f"truth and walls span {columns * cell_m:.6g} m x {rows * cell_m:.6g} m: a bitmap of"
            f" {rows * columns:.3g} cells, at most {_MOST_CELLS:,};"
            f" make evaluation.bitmap_cell_m ({cell_m:g} m) larger or mend truth.geojson"
        )
    return Grid(first * cell_m, float(cell_m), (int(rows), int(columns)))


def trace_cells(lines_m: npt.ArrayLike, grid: Grid) -> tuple[IntArray, IntArray]:
    """Find the cells that lines pass through, each line without a gap.

    Neighbours share an edge or a corner.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
        What lies outside of the grid has no cells.

    Returns
    -------
    line : (p,) int
    cell : (p,) int
        Index into the flattened map, row by row. A line that runs along the edge of a cell belongs
        to the cell with the larger coordinate, or the last one at the end of the grid.
    """
    ends = (np.asarray(lines_m, float).reshape(-1, 2, 2) - grid.low_m) / grid.cell_m
    ends = np.where(np.abs(ends - np.round(ends)) < ROUNDING, np.round(ends), ends)
    line, share = _crossings(ends)
    same = line[1:] == line[:-1]
    line = line[:-1][same]
    middle = (share[1:] + share[:-1])[same] / 2
    place = ends[line, 0] + middle[:, None] * (ends[line, 1] - ends[line, 0])
    place = np.where(np.abs(place - np.round(place)) < ROUNDING, np.round(place), place)
    rows, columns = grid.shape
    inside = ((place >= 0) & (place <= (columns, rows))).all(axis=1)
    column, row = np.minimum(np.floor(place[inside]), (columns - 1, rows - 1)).astype(np.int64).T
    return line[inside], row * columns + column


def rasterise_lines(lines_m: npt.ArrayLike, grid: Grid) -> BoolArray:
    """Return the binary map of lines: bool of the grid's shape, true where any pass through.

    >>> diagonal_m = [[[0.0, 0.0], [1.0, 1.0]]]
    >>> rasterise_lines(diagonal_m, fit_grid(diagonal_m, 0.5)).astype(int).tolist()
    [[1, 0], [0, 1]]
    """
    bitmap = np.zeros(grid.shape, bool)
    bitmap.flat[trace_cells(lines_m, grid)[1]] = True
    return bitmap


def fill_polygons(polygons: Iterable[BaseGeometry], grid: Grid) -> BoolArray:
    """Return which cells (rows, columns) have their middle in any of the polygons.

    Such a cell has an odd number of edges on its left. What lies beyond the grid is left out.
    """
    is_odd = np.zeros(grid.shape, np.uint8)
    n_rows, n_columns = grid.shape
    merged = overlays.unite_areas(list(polygons))
    for ring in shapely.get_rings(shapely.get_parts(merged)):
        corners = (shapely.get_coordinates(ring) - grid.low_m) / grid.cell_m - 0.5
        for (x0, y0), (x1, y1) in pairwise(corners):
            first, last = max(math.ceil(min(y0, y1)), 0), min(math.ceil(max(y0, y1)), n_rows)
            if first < last:
                rows = np.arange(first, last)
                columns = np.ceil(x0 + (rows - y0) * (x1 - x0) / (y1 - y0)).astype(int)
                # an edge beyond the last cell has none on its right
                is_left = columns < n_columns
                is_odd[rows[is_left], np.maximum(columns[is_left], 0)] ^= 1
    return np.bitwise_xor.accumulate(is_odd, axis=1).astype(bool)


def distances_to_outline(inside: BoolArray) -> FloatArray:
    """Return how far each cell is from the nearest that is not inside, in cells; 0 for those.

    Parameters
    ----------
    inside : (rows, columns) bool
        Some are not.

    Examples
    --------
    >>> distances_to_outline(np.array([[False, True, True]])).tolist()
    [[0.0, 1.0, 2.0]]
    """
    far = np.zeros(inside.shape)
    far[inside] = distances_of_inner(inside)
    return far


def distances_of_inner(inside: BoolArray) -> FloatArray:
    """Return `distances_to_outline` of the cells (k,) inside alone, row by row.

    The same numbers as scipy's distances, which take 50 bytes a cell of all that is around: of a
    building of 400 m that would be 3 GB. They are worked out tile by tile, as far around each as
    its farthest cell is from what is not inside; tiles without any are left out.
    """
    far = np.zeros(np.count_nonzero(inside))
    of_row = np.concatenate([[0], np.cumsum(np.count_nonzero(inside, axis=1))])
    for first_row in range(0, inside.shape[0], _TILE):
        for first_column in range(0, inside.shape[1], _TILE):
            tile = (slice(first_row, first_row + _TILE), slice(first_column, first_column + _TILE))
            row, column = np.nonzero(inside[tile])
            if len(row) == 0:
                continue
            # of a row's cells inside so many are left of the tile
            before = np.count_nonzero(inside[tile[0], :first_column], axis=1)
            begin = np.searchsorted(row, np.arange(len(before)))
            place = of_row[first_row + row] + before[row] + np.arange(len(row)) - begin[row]
            far[place] = _distances_in_tile(inside, first_row + row, first_column + column)
    return far


def _distances_in_tile(inside: BoolArray, row: IntArray, column: IntArray) -> FloatArray:
    """Return how far cells (k,), which lie near one another, are from what is not inside."""
    from scipy import ndimage  # 0.1 s, and most stages that fill grids do without

    around = _TILE // 8
    while True:
        low = np.maximum([row.min() - around, column.min() - around], 0)
        high = np.array([row.max(), column.max()]) + around + 1
        window = inside[low[0] : high[0], low[1] : high[1]]
        is_whole = window.shape == inside.shape
        if is_whole or not window.all():
            nearest = np.empty((2, *window.shape), np.int32)
            ndimage.distance_transform_edt(
                np.ascontiguousarray(window).view(np.int8),
                return_distances=False,
                return_indices=True,
                indices=nearest,
            )
            own = (row - low[0], column - low[1])
            down, along = nearest[0][own] - own[0], nearest[1][own] - own[1]
            far = np.sqrt(down.astype(float) ** 2 + along.astype(float) ** 2)
            # nothing beyond the window is nearer
            if is_whole or far.max() <= around:
                return far
        around *= 2


def _crossings(ends: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return where each line starts, crosses grid lines and ends, as shares (0 to 1) of its way.

    Returns
    -------
    line : (p,) int
        In order.
    share : (p,) float64
        Increasing within a line; a crossing of two grid lines at once is there once.
    """
    lines = [np.arange(len(ends))] * 2
    shares = [np.zeros(len(ends)), np.ones(len(ends))]
    for axis in (0, 1):
        low = ends[:, :, axis].min(axis=1)
        high = ends[:, :, axis].max(axis=1)
        first = np.floor(low) + 1
        count = np.maximum(np.ceil(high) - first, 0).astype(np.int64)
        owner = np.repeat(np.arange(len(ends)), count)
        step = number_within(count)
        start, end = ends[owner, :, axis].T
        lines.append(owner)
        shares.append((first[owner] + step - start) / (end - start))
    line, share = np.concatenate(lines), np.concatenate(shares)
    order = np.lexsort((share, line))
    line, share = line[order], share[order]
    apart = np.ones(len(line), bool)
    apart[1:] = (np.diff(share) > ROUNDING) | (np.diff(line) > 0)
    # a line of no length keeps both its ends
    point = (ends[line, 0] == ends[line, 1]).all(axis=1)
    return line[apart | point], share[apart | point]
