"""Ground as cells of a grid: nothing here is as large as what lies around the ground."""

import itertools
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.bitmap import distances_of_inner
from scanplan.types import BoolArray, FloatArray, IntArray

_AROUND = tuple(itertools.product((-1, 0, 1), repeat=2))  # rows and columns from a cell


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells (k,) of a grid that ground fills, row by row, which is little of what is around.

    Attributes
    ----------
    flat : (k,) int64
        Row times the grid's columns plus column.
    far : (k,) float64
        How far each is from what is no ground, in cells.
    near : (9, k) int32
        Number of the cells around each and of itself, row by row; `k` is none.
    """

    flat: IntArray
    far: FloatArray
    near: IntArray

    def beside(self, down: int, along: int) -> IntArray:
        """Return the number (k,) of the cell a step from each, down and along of -1 to 1."""
        return self.near[_AROUND.index((down, along))]


def list_cells(inside: BoolArray) -> Cells:
    """Return the cells of a grid (rows, columns) that are inside, none of them at its edge."""
    n_columns = inside.shape[1]
    flat = np.flatnonzero(inside)
    near = np.empty((len(_AROUND), len(flat)), np.int32)
    for place, (down, along) in enumerate(_AROUND):
        near[place] = _find_flat(flat, flat + down * n_columns + along)
    return Cells(flat, distances_of_inner(inside), near)


def _find_flat(flat: IntArray, wanted: IntArray) -> IntArray:
    place = np.searchsorted(flat, wanted)
    is_there = np.append(flat, -1)[place] == wanted
    return np.where(is_there, place, len(flat))
