"""Stretches of walls put together to what a person counts: one wall, though doors part it."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from scanplan.changes.verdicts import Change
from scanplan.geometry.lines import left_normals
from scanplan.types import BoolArray, IntArray

_JOINED_M = 0.3  # between ends of stretches in a line, and of an opening between them
_COSINE = math.cos(math.radians(10))


def list_wholes(changes: Sequence[Change]) -> list[list[Change]]:
    """Return changes by what they are of, in the order of the first of each, the longest first.

    Of a wall stretches of one verdict are one: of one number in either survey, or in one line
    with nothing or an opening in between. Whatever else is told is one each.

    Parameters
    ----------
    changes : sequence of Change
        With those of openings.
    """
    wholes: dict[int, list[Change]] = {}
    for change, whole in zip(changes, number_wholes(changes).tolist(), strict=True):
        wholes.setdefault(whole, []).append(change)
    return [sorted(parts, key=lambda of: -of.shape.length) for parts in wholes.values()]


def number_wholes(changes: Sequence[Change]) -> IntArray:
    """Return of each change (n,) the row of the first one that is of the same whole."""
    walls = [row for row, change in enumerate(changes) if change.table == "wall"]
    first = np.arange(len(changes))
    if not walls:
        return first
    openings = [change.shape for change in changes if change.table == "opening"]
    joined = _join([changes[row] for row in walls], openings)
    _, whole = connected_components(csr_array(joined), directed=False)
    _, begins = np.unique(whole, return_index=True)
    rows = np.array(walls)
    first[rows] = rows[begins[whole]]
    return first


def _join(walls: Sequence[Change], openings: Sequence[BaseGeometry]) -> BoolArray:
    """Return which stretches (n, n) are of one wall, and have become the same."""
    became = np.array([f"{wall.verdict} {wall.is_told}" for wall in walls])
    numbers = np.array([(wall.number_a, wall.number_b) for wall in walls])
    is_numbered = (numbers[:, None] == numbers) & (numbers >= 0)
    is_one = is_numbered.any(axis=2) | (_are_in_line(walls) & _meet(walls, openings))
    return is_one & (became[:, None] == became)


def _meet(walls: Sequence[Change], openings: Sequence[BaseGeometry]) -> BoolArray:
    """Return which stretches (n, n) meet, or an opening between them."""
    shapes, between = (np.array(of, object) for of in ([wall.shape for wall in walls], openings))
    row, opening = shapely.STRtree(between).query(shapes, "dwithin", _JOINED_M).reshape(2, -1)
    is_beside = csr_array((np.ones(len(row)), (row, opening)), shape=(len(shapes), len(between)))
    is_near = shapely.dwithin(shapes[:, None], shapes, _JOINED_M)
    return is_near | ((is_beside @ is_beside.T).toarray() > 0)


def _are_in_line(walls: Sequence[Change]) -> BoolArray:
    """Return which stretches (n, n) lie in one line."""
    ends_m = np.stack([shapely.get_coordinates(wall.shape)[[0, -1]] for wall in walls])
    normals = left_normals(ends_m)
    way_m = ends_m[:, None, :, :] - ends_m[None, :, :1, :]
    off_m = np.abs(np.einsum("ijek,jk->ije", way_m, normals)).max(axis=2)
    return (np.abs(normals @ normals.T) >= _COSINE) & (off_m <= _JOINED_M) & (off_m.T <= _JOINED_M)
