"""A surface as a raster of cells, each with its counts of occupied, free and occluded rays.

Columns run along the surface's line, rows up from the floor. What a wall, a way through it, a sill,
the top of a partition or a railing is are questions to these counts: asked here, once, for one scan
or many.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.types import BoolArray, FloatArray, IntArray

CELL_M = 0.05
"""Edge of a cell of all scans together.

A few times the noise of a range, a third of the least wall end.
"""
SCAN_COLUMN_M = 0.1
"""Width of a column of a single scan.

Wider than what is between its rays at the usual distances.
"""

_ROW_M = 0.05  # height of a row
_MOST_ROWS = 160  # up to 8 m: a storey
_MOST_COLUMNS = 10_000  # farther than 500 m is no building
_CLEAR_M = 0.03  # above a surface's edge: the noise of a height
_LEAST_STRETCH_M = 0.3  # of a surface's length: less may be a return of something else
_GOOD_SHARE = 0.15  # of a surface's length, likewise
_ENDS_M = (0.4, 2.3)  # heights that furniture and partitions end between
_ENDS_STEP_M = 0.1  # finer than what one of them is higher than another by
_FEW_RAYS = 3  # one or two may be stray, of any number of scans
_OVER_SHARE = 0.15  # of what ends at a column: fewer over it are noise of heights and poses


@dataclass(frozen=True, eq=False)
class FaceRaster:
    """What rays say of a surface, in cells; columns first.

    Attributes
    ----------
    first_m, column_m : float
        Where the first column begins along the line, and how wide each is.
    occupied, free, occluded : (c, r) int64
        Rays that ended in a cell, went through it, and ended before it.
    top_m, free_top_m : (c,) float64
        Height of the highest return at the surface, and of the highest ray through; minus infinity
        without any.
    planar : bool
        Whether all rays lie in one level plane: then there is one row.
    """

    first_m: float
    column_m: float
    occupied: IntArray
    free: IntArray
    occluded: IntArray
    top_m: FloatArray
    free_top_m: FloatArray
    planar: bool

    def __len__(self) -> int:
        """Return the number of columns."""
        return len(self.top_m)

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


def rasterise_rays(
    occupied_m: tuple[FloatArray, FloatArray],
    free_m: tuple[FloatArray, FloatArray],
    occluded_m: tuple[FloatArray, FloatArray],
    *,
    span_m: tuple[float, float],
    column_m: float = CELL_M,
    free_until_m: FloatArray | None = None,
    planar: bool = False,
) -> FaceRaster:
    """Count rays in the cells of a surface.

    Parameters
    ----------
    occupied_m, free_m, occluded_m : ((n,) float64, (n,) float64)
        Places along the line, and heights above the floor, where rays end at the surface, go
        through it, and would have met it.
    span_m : (float, float)
        From where to where along the line; rays beyond count for the first and the last column.
    column_m : float
        Width of a column, more where there would be too many.
    free_until_m : (n,) float64, optional
        Until where along the line each ray through is within the thinnest wall's thickness of the
        surface: columns up to there are free, too.
    planar : bool
        Whether heights mean nothing: then there is one row.
    """
    low_m, high_m = span_m
    column_m = max(column_m, (high_m - low_m) / _MOST_COLUMNS)
    shape = (int((high_m - low_m) / column_m) + 1, 1 if planar else _MOST_ROWS)

    def column_of(along_m: FloatArray) -> IntArray:
        return np.clip((along_m - low_m) / column_m, 0, shape[0] - 1).astype(np.int64)

    def row_of(height_m: FloatArray) -> IntArray:
        return np.clip(height_m / _ROW_M, 0, shape[1] - 1).astype(np.int64)

    def count(along_m: FloatArray, height_m: FloatArray) -> IntArray:
        cell = column_of(along_m) * shape[1] + row_of(height_m)
        return np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape)

    def highest(along_m: FloatArray, height_m: FloatArray) -> FloatArray:
        top_m = np.full(shape[0], -np.inf)
        np.maximum.at(top_m, column_of(along_m), height_m)
        return top_m

    def count_along(along_m: FloatArray, until_m: FloatArray, height_m: FloatArray) -> IntArray:
        begin, end = np.sort([column_of(along_m), column_of(until_m)], axis=0)
        row, size = row_of(height_m), (shape[0] + 1) * shape[1]
        entering = np.bincount(begin * shape[1] + row, minlength=size)
        leaving = np.bincount((end + 1) * shape[1] + row, minlength=size)
        return np.cumsum((entering - leaving).reshape(-1, shape[1]), axis=0)[:-1]

    if free_until_m is None:
        free = count(*free_m)
    else:
        free = count_along(free_m[0], free_until_m, free_m[1])
    return FaceRaster(
        first_m=low_m,
        column_m=column_m,
        occupied=count(*occupied_m),
        free=free,
        occluded=count(*occluded_m),
        top_m=highest(*occupied_m),
        free_top_m=highest(*free_m),
        planar=planar,
    )
