"""Chunks: equal contiguous parts of a long recording's work, each a job of its own."""

import numpy as np

from scanplan.types import IntArray


def rows_of_chunk(n_rows: int, chunk: str | None) -> IntArray:
    """Return which of some rows a chunk has.

    Parameters
    ----------
    chunk : str or None
        `2-of-5`: the second of five; None: all rows.

    Returns
    -------
    (n,) int, increasing
        Empty where there are too few rows.
    """
    number, count = (1, 1) if chunk is None else map(int, chunk.split("-of-"))
    return np.array_split(np.arange(n_rows), count)[number - 1]
