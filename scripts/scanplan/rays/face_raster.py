"""A surface as a raster of cells, each with its counts of occupied, free and occluded rays.

Columns run along the surface's line, rows up from the floor. Which of them are wall, open, crossed
or overlooked, and how high a surface is seen, are questions to these counts: asked here, for one
scan or many.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.types import BoolArray, FloatArray, IntArray

CELL_M = 0.05  # edge of a cell of all scans together: a few times the noise of a range
SCAN_COLUMN_M = 0.1  # column of a single scan: wider than what is between its rays
STOREY_M = 8.0  # height of a raster: no room is as high
BELOW_CEILING_M = 2.5  # its height where only furniture and ways through are asked for

_ROW_M = 0.05  # height of a row
_MOST_COLUMNS = 10_000  # farther than 500 m is no building
_CLEAR_M = 0.03  # above a surface's edge: the noise of a height
_LEAST_STRETCH_M = 0.3  # of a surface's length: less may be a return of something else
_GOOD_SHARE = 0.15  # of a surface's length, likewise
_ENDS_M = (0.4, 2.3)  # heights that furniture and partitions end between
_ENDS_STEP_M = 0.1  # finer than what one of them is higher than another by
_FEW_RAYS = 3  # one or two may be stray, of any number of scans
_OVER_SHARE = 0.15  # of what ends at a column: fewer over it are noise of heights and poses


Places = tuple[FloatArray, FloatArray]
"""Where rays are at a surface, (n,) float64 each: along its line, and above the floor."""


@dataclass(frozen=True, eq=False)
class FaceRaster:
    """What rays say of a surface, in cells; columns first. Each count is made once it is asked for.

    Attributes
    ----------
    first_m, column_m : float
        Where the first column begins along the line, and how wide each is.
    n_columns, n_rows : int
    occupied_places, free_places, occluded_places : Places
        Where rays end at the surface, go through it, and would have met it.
    free_until_m : (n,) float64, optional
        Until where along the line columns are free, too, by each ray through.
    """

    first_m: float
    column_m: float
    n_columns: int
    n_rows: int
    occupied_places: Places
    free_places: Places
    occluded_places: Places
    free_until_m: FloatArray | None = None

    def __len__(self) -> int:
        """Return the number of columns."""
        return self.n_columns

    @property
    def planar(self) -> bool:
        """Whether all rays lie in one level plane: then there is one row."""
        return self.n_rows == 1

    @cached_property
    def occupied(self) -> IntArray:
        """Rays that ended in each cell, (c, r)."""
        return self._count(self.occupied_places)

    @cached_property
    def free(self) -> IntArray:
        """Rays that went through each cell, (c, r)."""
        if self.free_until_m is None:
            return self._count(self.free_places)
        along_m, height_m = self.free_places
        begin, end = np.sort([self._clip(along_m), self._clip(self.free_until_m)], axis=0)
        row = self._row_of(height_m)
        size = (self.n_columns + 1) * self.n_rows
        entering = np.bincount(begin * self.n_rows + row, minlength=size)
        leaving = np.bincount((end + 1) * self.n_rows + row, minlength=size)
        return np.cumsum((entering - leaving).reshape(-1, self.n_rows), axis=0)[:-1]

    @cached_property
    def occluded(self) -> IntArray:
        """Rays that ended before each cell, (c, r)."""
        return self._count(self.occluded_places)

    @cached_property
    def top_m(self) -> FloatArray:
        """Height of the highest return of each column, (c,); minus infinity without any."""
        return self._highest(self.occupied_places)

    @cached_property
    def free_top_m(self) -> FloatArray:
        """Height of the highest ray through each column, (c,); minus infinity without any."""
        return self._highest(self.free_places)

    @property
    def middle_m(self) -> FloatArray:
        """Where the middle of each column is along the line, (c,)."""
        return self.first_m + self.column_m * (np.arange(len(self)) + 0.5)

    def column_of(self, along_m: FloatArray) -> IntArray:
        """Return the columns (n,) of places within them."""
        return ((along_m - self.first_m) / self.column_m).astype(np.int64)

    def between(self, low_m: float, high_m: float) -> slice:
        """Return the columns whose middles lie between two places."""
        places = (np.array([low_m, high_m]) - self.first_m) / self.column_m
        low, high = np.ceil(places - 0.5).astype(np.int64)
        return slice(max(low, 0), max(high, 0))

    def count_below(self, counts: IntArray, height_m: float) -> IntArray:
        """Return the sums (c,) of counts (c, r) in rows below a height; in the plane of all."""
        rows = counts.shape[1] if self.planar else round(height_m / _ROW_M)
        return counts[:, :rows].sum(axis=1)

    def is_crossed(self, below_m: float) -> BoolArray:
        """Return in which columns (c,) more rays go through below a height than end there."""
        return self.count_below(self.free, below_m) > self.count_below(self.occupied, below_m)

    def is_opened(self, below_m: float) -> BoolArray:
        """Return in which columns (c,) that are crossed not just one or two rays go through."""
        return self.is_crossed(below_m) & (self.count_below(self.free, below_m) >= _FEW_RAYS)

    def is_solid(self, below_m: float) -> BoolArray:
        """Return in which columns (c,) rays end below a height and hardly one goes through."""
        return (self.count_below(self.occupied, below_m) > 0) & ~self.is_opened(below_m)

    def is_overlooked(self, below_m: float) -> BoolArray:
        """Return in which columns (c,) rays go through above whatever rays end at."""
        over = self.count_below(self.free, below_m) if self.planar else self._n_over
        few = np.maximum(_FEW_RAYS, _OVER_SHARE * self.count_below(self.occupied, below_m))
        return over >= few

    def is_open(self, sill_m: float, *, low_m: float, door_m: float) -> BoolArray:
        """Return in which columns (c,) a ray goes through above what ends rays there.

        A sill up to `sill_m` does not close a column; what is higher than a door says nothing of
        what is below.
        """
        first, stop = round(low_m / _ROW_M), round(door_m / _ROW_M)
        rows = np.arange(self.free.shape[1])[:stop]
        top_row = np.where(self.occupied[:, :stop] > 0, rows, -1).max(axis=1, initial=-1)
        is_above = (rows >= first) & (rows > top_row[:, None])
        is_low = (top_row + 1) * _ROW_M <= sill_m
        return is_low & (is_above & (self.free[:, :stop] > 0)).any(axis=1)

    def is_stopped(self, *, low_m: float, door_m: float) -> BoolArray:
        """Return in which columns (c,) rays end lower than a door.

        At it, or before it above the skirting.
        """
        first, stop = round(low_m / _ROW_M), round(door_m / _ROW_M)
        n_before = self.occluded[:, first:stop].sum(axis=1)
        return (self.count_below(self.occupied, door_m) > 0) | (n_before > 0)

    def seen_top_m(self, columns: slice = slice(None)) -> float:
        """Return up to which height a surface is seen over a good stretch of its length.

        Of a surface so short that no stretch is as long, in any column; minus infinity where
        nothing is seen.
        """
        top_m = self.top_m[columns]
        tops_m = np.sort(top_m[np.isfinite(top_m)])[::-1]
        if len(tops_m) == 0:
            return -np.inf
        # the return of something else at an end may be all that a column has
        enough = max(int(np.ceil(_LEAST_STRETCH_M / self.column_m)) - 1, 1)
        return float(tops_m[min(enough, len(tops_m) - 1)])

    def over_share(self) -> float:
        """Return how surely the surface ends at some height.

        The share of what rays cross above it that is free.

        Of all heights at which a good part of the surface is free, the one that divides best; 0
        where none is.
        """
        ends_m = np.arange(_ENDS_M[0], _ENDS_M[1], _ENDS_STEP_M)[:, None]
        met = self.top_m > ends_m
        free = (self.free_top_m > ends_m + _CLEAR_M) & ~met & np.isfinite(self.top_m)
        n_met, n_free = met.sum(axis=1), free.sum(axis=1)
        enough = n_free >= max(_LEAST_STRETCH_M / self.column_m, _GOOD_SHARE * len(self))
        return float(np.max(n_free[enough] / (n_free + n_met)[enough], initial=0.0))

    @cached_property
    def _n_over(self) -> IntArray:
        """Rays (c,) that go through above the highest return of their column."""
        top_row = np.floor(np.maximum(self.top_m, -_ROW_M) / _ROW_M)
        above = np.arange(self.free.shape[1]) > top_row[:, None]
        return np.where(above, self.free, 0).sum(axis=1)

    def _clip(self, along_m: FloatArray) -> IntArray:
        """Return the columns of places, the first or the last for those beyond."""
        return np.clip(self.column_of(along_m), 0, self.n_columns - 1)

    def _row_of(self, height_m: FloatArray) -> IntArray:
        return np.clip(height_m / _ROW_M, 0, self.n_rows - 1).astype(np.int64)

    def _count(self, places: Places) -> IntArray:
        along_m, height_m = places
        cell = self._clip(along_m) * self.n_rows + self._row_of(height_m)
        counts = np.bincount(cell, minlength=self.n_columns * self.n_rows)
        return counts.reshape(self.n_columns, self.n_rows)

    def _highest(self, places: Places) -> FloatArray:
        along_m, height_m = places
        top_m = np.full(self.n_columns, -np.inf)
        np.maximum.at(top_m, self._clip(along_m), height_m)
        return top_m


def rasterise_rays(
    occupied_m: Places,
    free_m: Places,
    occluded_m: Places,
    *,
    span_m: tuple[float, float],
    column_m: float = CELL_M,
    high_m: float = STOREY_M,
    free_until_m: FloatArray | None = None,
    planar: bool = False,
) -> FaceRaster:
    """Count rays in the cells of a surface.

    Parameters
    ----------
    occupied_m, free_m, occluded_m : Places
        Where rays end at the surface, go through it, and would have met it.
    span_m : (float, float)
        From where to where along the line; rays beyond count for the first and the last column.
    column_m : float
        Width of a column, more where there would be too many.
    high_m : float
        Above the floor: rays that are higher count for the last row.
    free_until_m : (n,) float64, optional
        Until where along the line each ray through is within the thinnest wall's thickness of the
        surface: columns up to there are free, too.
    planar : bool
        Whether heights mean nothing: then there is one row.
    """
    low_m, end_m = span_m
    column_m = max(column_m, (end_m - low_m) / _MOST_COLUMNS)
    return FaceRaster(
        first_m=low_m,
        column_m=column_m,
        n_columns=int((end_m - low_m) / column_m) + 1,
        n_rows=1 if planar else round(high_m / _ROW_M),
        occupied_places=occupied_m,
        free_places=free_m,
        occluded_places=occluded_m,
        free_until_m=free_until_m,
    )
