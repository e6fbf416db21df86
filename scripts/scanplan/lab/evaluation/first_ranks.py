"""The rank of the first scan of an ordering that shows each piece of truth.

A subset is the first k scans of an ordering: what it shows is what has a first rank of k or less.
"""

from collections.abc import Sequence

import numpy as np

from scanplan.types import BoolArray, IntArray

NEVER = int(np.iinfo(np.int32).max)  # rank of what no scan shows: above every other

CellRuns = tuple[IntArray, IntArray, IntArray]
"""Segment, begin and end, (p,) int each: a segment finds the cells begin <= c < end."""


def rank_of_rows(order: Sequence[int] | IntArray, n_scans: int) -> IntArray:
    """Return the rank (n_scans,), from 1, of each row in an order of rows; `NEVER` of others."""
    rank = np.full(n_scans, NEVER, np.int64)
    rank[order] = np.arange(1, len(order) + 1)
    return rank


def first_rank_seen(seen: BoolArray, rank: IntArray) -> IntArray:
    """Return the rank (c,) of the first scan that could see each cell.

    Parameters
    ----------
    seen : (n, c) bool
    rank : (n,) int
    """
    first = np.full(seen.shape[1], NEVER, np.int64)
    for row in np.argsort(-np.asarray(rank), kind="stable"):
        first[seen[row]] = rank[row]
    return first


def first_rank_found(found: CellRuns, segment_rank: IntArray, n_cells: int) -> IntArray:
    """Return the rank (n_cells,) of the first scan with a segment that finds each cell.

    Parameters
    ----------
    segment_rank : (s,) int
        Rank of the scan that shows each segment.
    """
    segment, begin, end = found
    rank = segment_rank[segment]
    order = np.argsort(-rank, kind="stable")
    runs = zip(begin[order].tolist(), end[order].tolist(), rank[order].tolist(), strict=True)
    first = np.full(n_cells, NEVER, np.int64)
    # the earlier scan is painted over the later one
    for begin_cell, end_cell, run_rank in runs:
        first[begin_cell:end_cell] = run_rank
    return first
