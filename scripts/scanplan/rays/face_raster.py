"""A surface in columns and rows of cells: where rays are occupied, free and occluded there.

Columns run along the surface's line, rows up from the floor. Which of them are wall, open, crossed
or overlooked are questions to these rays: asked here, for one scan or many.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from scanplan.geometry.cell_runs import find_cell_runs
from scanplan.rays.tolerances import FEW, STRETCH_M
from scanplan.types import BoolArray, FloatArray, IntArray

CELL_M = 0.05  # edge of a cell of all scans together: a few times the noise of a range
SCAN_COLUMN_M = 0.1  # column of a single scan: wider than what is between its rays


ROW_M = 0.2
"""Of height, where rows hold several beams."""
_N_ROWS = 20  # up to 4 m
Places = tuple[FloatArray, FloatArray]
"""Where rays are at a surface, (n,) float64 each: along its line, and above the floor."""


class Cells(NamedTuple):
    """Column and row of the cell that each ray is in, (n,) int32: they are kept of all rays."""

    column: IntArray
    row: IntArray


@dataclass(frozen=True, eq=False)
class FaceRaster:
    """Ray counts of a surface, in cells.

    Attributes
    ----------
    first_m : float
        Where the first column begins along the line.
    n_columns : int
    planar : bool
        Whether all rays lie in one level plane: then all are in one row.
    occupied_places, free_places : Places
        Where rays end at the surface, and go through it.
    """

    first_m: float
    n_columns: int
    planar: bool
    occupied_places: Places
    free_places: Places

    def __len__(self) -> int:
        """Return the number of columns."""
        return self.n_columns

    @cached_property
    def occupied(self) -> Cells:
        """Where rays ended."""
        return self._cells_of(self.occupied_places)

    @cached_property
    def free(self) -> Cells:
        """Where rays went through."""
        return self._cells_of(self.free_places)

    @property
    def middle_m(self) -> FloatArray:
        """Where the middle of each column is along the line, (c,)."""
        return self.first_m + CELL_M * (np.arange(len(self)) + 0.5)

    def column_of(self, along_m: FloatArray) -> IntArray:
        """Return the columns (n,) of places, the first or the last for those beyond."""
        column = ((along_m - self.first_m) / CELL_M).astype(np.int32)
        return np.minimum(np.maximum(column, 0), self.n_columns - 1)

    def between(self, low_m: float, high_m: float) -> slice:
        """Return the columns whose middles lie between two places."""
        places = (np.array([low_m, high_m]) - self.first_m) / CELL_M
        low, high = np.ceil(places - 0.5).astype(np.int64)
        return slice(max(low, 0), max(high, 0))

    def count_occupied(self, below_m: float) -> IntArray:
        """Return how many rays of each column (c,) end below a height; in the plane all."""
        return self._count_below(self.occupied, self._n_occupied, below_m)

    def count_free(self, below_m: float) -> IntArray:
        """Return how many rays of each column (c,) go through below a height; in the plane all."""
        return self._count_below(self.free, self._n_free, below_m)

    def is_crossed(self, below_m: float) -> BoolArray:
        """Return the columns (c,) with more free than occupied rays below a height."""
        return self.count_free(below_m) > self.count_occupied(below_m)

    def is_opened(self, below_m: float) -> BoolArray:
        """Return the crossed columns (c,) with more than two free rays."""
        return self.is_crossed(below_m) & (self.count_free(below_m) >= FEW)

    def find_opened(self, below_m: float) -> FloatArray:
        """Return the stretches (n, 2) along the line that rays go through below a height.

        In the plane a column alone has few: those beside it count with it.
        """
        if not self.planar:
            return find_stretches(self.is_opened(below_m), self.first_m)
        free, occupied = self.count_free(below_m), self.count_occupied(below_m)
        around = np.ones(2 * round(SCAN_COLUMN_M / CELL_M) + 1)
        n_free, n_occupied = (
            np.convolve(count, around, mode="same")[: self.n_columns] for count in (free, occupied)
        )
        # a column that rays end in is none of it, whatever is beside it
        is_opened = (n_free > n_occupied) & (n_free >= FEW) & (free >= occupied)
        return find_stretches(is_opened, self.first_m)

    def is_solid(self, below_m: float) -> BoolArray:
        """Return the columns (c,) occupied below a height and not opened."""
        return (self.count_occupied(below_m) > 0) & ~self.is_opened(below_m)

    @cached_property
    def seen_cells(self) -> BoolArray:
        """Which cells (c, r) of 0.2 m of height more rays end in than go through."""
        occupied, free = self._counts
        return occupied > free

    @cached_property
    def passed_cells(self) -> BoolArray:
        """Which cells (c, r) of 0.2 m of height more rays go through than end in, and not few."""
        occupied, free = self._counts
        return (free > occupied) & (free >= FEW)

    @cached_property
    def _counts(self) -> tuple[IntArray, IntArray]:
        n_rows = 1 if self.planar else _N_ROWS
        shape = (self.n_columns, n_rows)
        counts = []
        for cells in (self.occupied, self.free):
            row = np.minimum(cells.row // round(ROW_M / CELL_M), n_rows - 1)
            number = np.ravel_multi_index((cells.column, row), shape)
            counts.append(np.bincount(number, minlength=shape[0] * n_rows).reshape(shape))
        return counts[0], counts[1]

    @cached_property
    def _n_occupied(self) -> dict[int, IntArray]:
        """What was counted: every pair of faces asks for the height of doors again."""
        return {}

    @cached_property
    def _n_free(self) -> dict[int, IntArray]:
        return {}

    def _count_below(self, cells: Cells, counted: dict[int, IntArray], below_m: float) -> IntArray:
        row = _row_at(below_m)
        if row not in counted:
            column = cells.column if self.planar else cells.column[cells.row < row]
            counted[row] = np.bincount(column, minlength=self.n_columns)
        return counted[row]

    def _cells_of(self, places: Places) -> Cells:
        along_m, height_m = places
        row = np.maximum(height_m / CELL_M, 0).astype(np.int32)
        return Cells(self.column_of(along_m), 0 * row if self.planar else row)


def find_stretches(is_found: BoolArray, first_m: float) -> FloatArray:
    """Return the stretches (n, 2) along a line of neighbouring columns where something is found.

    Shorter ones than `STRETCH_M` are left out.

    Parameters
    ----------
    is_found : (c,) bool
        Of each column, `CELL_M` wide.
    first_m : float
        Where the first column begins.
    """
    columns = np.column_stack(find_cell_runs(is_found)[1:])
    is_long = np.diff(columns, axis=1)[:, 0] >= round(STRETCH_M / CELL_M)
    return first_m + CELL_M * columns[is_long]


def _row_at(height_m: float) -> int:
    """Return the row that begins at a height."""
    return round(height_m / CELL_M)


def rasterise_rays(
    occupied_m: Places, free_m: Places, *, span_m: tuple[float, float], planar: bool = False
) -> FaceRaster:
    """Sort rays into the cells of a surface.

    Parameters
    ----------
    occupied_m, free_m : Places
        Where rays end at the surface, and go through it.
    span_m : (float, float)
        From where to where along the line; rays beyond count for the first and the last column.
    planar : bool
        Whether heights mean nothing: then there is one row.
    """
    low_m, end_m = span_m
    return FaceRaster(low_m, int((end_m - low_m) / CELL_M) + 1, planar, occupied_m, free_m)
