"""The thesis's bitmap metric (5.1): walls and truth as binary maps, and the shares of their error.

Where the grid begins is arbitrary, and it decides the literal metric: a true face on the edge of
two cells and a wall 1 mm beside it have no cell in common. Here the shares are also averaged over
grids that begin at different parts of a cell. A wall beside its face by a part of a cell then
counts as wrong by that part, and one a whole cell off as wrong altogether, on whatever coordinates
the building was drawn.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import bitmap
from scanplan.types import BoolArray, FloatArray, IntArray

N_PHASES = 16
"""Grids of the mean: with cells of 5 cm a wall's place counts to 3 mm, finer than it is known."""


@dataclass(frozen=True)
class TrueBitmap:
    """The cells (c,) of a grid that true faces pass through: indices of the flat map, rising."""

    grid: bitmap.Grid
    cells: IntArray


@dataclass(frozen=True)
class DrawnCells:
    """The cells of a grid that lines pass through.

    Attributes
    ----------
    line, cell : (p,) int
        A line, and the row of a cell that it passes through.
    is_true : (c,) bool
        Whether the truth has a cell, too.
    n_true, n_cells : int
        Cells of the truth, and of the whole grid.
    """

    line: IntArray
    cell: IntArray
    is_true: BoolArray
    n_true: int
    n_cells: int


def shift_grid(grid: bitmap.Grid) -> list[bitmap.Grid]:
    """Return `N_PHASES` grids that begin at different parts of a cell before one, and hold it.

    Along either axis every part is met once, and both together are spread over the cell.
    """
    part = np.arange(N_PHASES)
    # an odd step meets each of 16 parts once; middles of parts, as drawings end on whole cells
    parts = (np.column_stack([part, 5 * part % N_PHASES]) + 0.5) / N_PHASES
    rows, columns = grid.shape
    return [
        bitmap.Grid(grid.low_m - shift * grid.cell_m, grid.cell_m, (rows + 1, columns + 1))
        for shift in parts
    ]


def trace_truth(faces_m: FloatArray, lines_m: FloatArray, cell_m: float) -> list[TrueBitmap]:
    """Return the truth's bitmaps: first of the literal grid, then of those of the mean.

    Parameters
    ----------
    faces_m : (n, 2, 2) float
    lines_m : (m, 2, 2) float
        All that is to be compared: the grids hold it and the faces.
    """
    literal = bitmap.fit_grid(np.concatenate([faces_m, lines_m]), cell_m)
    grids = [literal, *shift_grid(literal)]
    return [TrueBitmap(grid, np.unique(bitmap.trace_cells(faces_m, grid)[1])) for grid in grids]


def match_cells(lines_m: FloatArray, truth: TrueBitmap) -> DrawnCells:
    """Return which cells lines (n, 2, 2) pass through, and which of these the truth has."""
    line, index = bitmap.trace_cells(lines_m, truth.grid)
    cells, cell = np.unique(index, return_inverse=True)
    is_true = np.isin(cells, truth.cells, assume_unique=True)
    rows, columns = truth.grid.shape
    return DrawnCells(line, cell, is_true, len(truth.cells), rows * columns)


def measure_shares(drawn: DrawnCells, line_rank: IntArray, sizes: Sequence[int]) -> FloatArray:
    """Return the shares (k, 3) of the error map, of lines whose rank is at most each of the sizes.

    Parameters
    ----------
    line_rank : (n,) int
    sizes : (k,) sequence of int

    Returns
    -------
    (k, 3) float64
        False negative, correct match and false positive, of all cells.
    """
    first = np.full(len(drawn.is_true), np.iinfo(np.int64).max)
    np.minimum.at(first, drawn.cell, line_rank[drawn.line])
    n_found, n_false = (
        np.searchsorted(np.sort(first[some]), sizes, side="right")
        for some in (drawn.is_true, ~drawn.is_true)
    )
    n_missed = drawn.n_true - n_found
    counts = np.column_stack([n_missed, drawn.n_cells - n_missed - n_false, n_false])
    return counts / drawn.n_cells
