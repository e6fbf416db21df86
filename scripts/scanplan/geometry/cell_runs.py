"""Runs of neighbouring cells of a raster."""

import numpy as np

from scanplan.types import BoolArray, IntArray


def find_cell_runs(chosen: BoolArray) -> tuple[IntArray, IntArray, IntArray]:
    """Return the row, first column and column behind the last of each run of chosen cells.

    Parameters
    ----------
    chosen : (r, c) or (c,) bool
        Runs go along the columns; one row may come alone.

    Returns
    -------
    rows, begins, ends : (n,) int64
        By row, from its first column on.

    Examples
    --------
    >>> rows, begins, ends = find_cell_runs(np.array([True, True, False, True]))
    >>> begins.tolist(), ends.tolist()
    ([0, 3], [2, 4])
    """
    change = np.diff(np.pad(np.atleast_2d(chosen).astype(np.int8), ((0, 0), (1, 1))), axis=1)
    rows, begins = np.nonzero(change > 0)
    _, ends = np.nonzero(change < 0)
    return rows, begins, ends
