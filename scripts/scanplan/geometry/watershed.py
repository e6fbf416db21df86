"""Ground as cells, flooded from its widest places down: basins that stay apart at narrow ones.

Nothing here is as large as what lies around the ground.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from scanplan.geometry.bitmap import distances_of_inner
from scanplan.types import BoolArray, FloatArray, IntArray

NARROWER = 0.75
"""Of the widest on either side: a corridor's pillars and cupboards leave more."""
_NARROWER_UNVISITED = 0.8  # where nobody went on no way says that both sides are one room
_AROUND = tuple(itertools.product((-1, 0, 1), repeat=2))  # rows and columns from a cell


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells (k,) of a grid that ground fills, row by row, which is little of what is around.

    Attributes
    ----------
    n_columns : int
    flat : (k,) int64
        Row times `n_columns` plus column.
    far : (k,) float64
        How far each is from what is no ground, in cells.
    near : (9, k) int32
        Number of the cells around each and of itself, row by row; `k` is none.
    """

    n_columns: int
    flat: IntArray
    far: FloatArray
    near: IntArray

    def find(self, row: IntArray, column: IntArray) -> IntArray:
        """Return the numbers of cells (n,), of those that are no ground `k`."""
        return _find_flat(self.flat, row * self.n_columns + column)

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
    return Cells(n_columns, flat, distances_of_inner(inside), near)


def _find_flat(flat: IntArray, wanted: IntArray) -> IntArray:
    place = np.searchsorted(flat, wanted)
    is_there = np.append(flat, -1)[place] == wanted
    return np.where(is_there, place, len(flat))


def flood_cells(
    near: IntArray, far_m: FloatArray, visited: IntArray, most_m: float, cell_m: float
) -> IntArray:
    """Return the basin (k + 1,) of each cell and of none, 0, of ground flooded from its widest.

    Basins stay apart that meet where it is much narrower than at the widest place of either; the
    less narrow, if one of them is a part of ground that was visited and the other is not.

    Parameters
    ----------
    near : (9, k) int
        As of `Cells`.
    far_m : (k,) float64
        Distance of each cell to the outline of ground.
    visited : (n,) int
        Cells that were visited.
    most_m : float
        Distances beyond this count as this: what is as wide is one basin.
    """
    basin = np.zeros(near.shape[1] + 1, np.int32)
    number = np.full(near.shape[1] + 1, -1, np.int32)
    widest_m = np.zeros(1)
    meetings = []
    most = max(round(most_m / cell_m), 1)
    level_of = np.minimum(np.floor(far_m / cell_m + 0.5), most).astype(np.int32)
    of_level = np.argsort(-level_of, kind="stable")
    level_of = level_of[of_level]
    for level in range(level_of[0] if len(level_of) else 0, 0, -1):
        cells = of_level[np.searchsorted(-level_of, -level) : np.searchsorted(-level_of, 1 - level)]
        _grow(basin, cells, near)
        rest = cells[basin[cells] == 0]
        count, fresh = _connect(rest, number, near)
        basin[rest] = fresh + len(widest_m)
        widest_m = np.append(widest_m, np.zeros(count))
        np.maximum.at(widest_m, basin[rest], far_m[rest])
        meetings += [(*pair, level * cell_m) for pair in _touching(basin, cells, near)]
    parts = _JoinedBasins(widest_m)
    for one, other, level_m in meetings:
        parts.meet(one, other, level_m, _NARROWER_UNVISITED)
    is_visited = np.isin(parts.joined, parts.joined[basin[visited]])
    joined = _JoinedBasins(widest_m)
    for one, other, level_m in meetings:
        is_looked_into = is_visited[one] != is_visited[other]
        joined.meet(one, other, level_m, _NARROWER_UNVISITED if is_looked_into else NARROWER)
    return joined.joined.astype(np.int32)[basin]


def _grow(basin: IntArray, cells: IntArray, near: IntArray) -> None:
    """Give cells the basin beside them; over and over, while any is."""
    rest = cells[basin[cells] == 0]
    while len(rest):
        beside = np.zeros(len(rest), np.int32)
        for step in near:
            np.maximum(beside, basin[step[rest]], out=beside)
        if not beside.any():
            return
        basin[rest] = beside
        rest = rest[beside == 0]


def _connect(cells: IntArray, number: IntArray, near: IntArray) -> tuple[int, IntArray]:
    """Return how many groups of connected cells there are, and the group of each, from 0.

    Groups are numbered by their first cells. First cells that follow one another in a row are made
    one, of which there are few.

    Parameters
    ----------
    cells : (n,) int, increasing
    number : (k + 1,) int
        -1 for all cells, before and after.
    """
    number[cells] = 0
    is_first = number[near[_AROUND.index((0, -1)), cells]] < 0
    run = np.cumsum(is_first) - 1
    number[cells] = run
    pairs: list[IntArray] = [np.empty((0, 2), np.int64)]
    for step in ((1, -1), (1, 0), (1, 1)):
        below = number[near[_AROUND.index(step), cells]]
        is_link = below >= 0
        links = np.column_stack([run[is_link], below[is_link]])
        pairs.append(links[np.any(np.diff(links, axis=0, prepend=-1), axis=1)])
    number[cells] = -1
    n_runs = int(is_first.sum())
    one, other = np.concatenate(pairs).T
    links = coo_array((np.ones(len(one)), (one, other)), shape=(n_runs, n_runs))
    count, of_run = connected_components(links, directed=False)
    return count, of_run[run]


def _touching(basin: IntArray, cells: IntArray, near: IntArray) -> list[tuple[int, int]]:
    """Return the pairs of basins of which one has a cell among those given, beside the other."""
    own = basin[cells]
    found: set[tuple[int, int]] = set()
    for step in near:
        beside = basin[step[cells]]
        is_border = (beside != own) & (beside > 0)
        pairs = np.sort(np.stack([own[is_border], beside[is_border]], axis=1), axis=1)
        found.update((a, b) for a, b in np.unique(pairs, axis=0).tolist())
    return sorted(found)


class _JoinedBasins:
    """Which basins were joined, by number from 1; 0 is no basin.

    Parameters
    ----------
    widest_m : (n,) float64
        Distance at the widest place of each.
    """

    def __init__(self, widest_m: FloatArray) -> None:
        self._widest_m = widest_m
        self.joined = np.arange(len(widest_m))
        self._apart: set[tuple[int, int]] = set()

    def meet(self, one: int, other: int, level_m: float, narrower: float) -> None:
        """Join two basins that touch at a level, unless it is so much narrower than both."""
        weak, strong = sorted(self.joined[[one, other]].tolist(), key=lambda b: self._widest_m[b])
        pair = (min(weak, strong), max(weak, strong))
        if weak == strong or pair in self._apart:
            return
        if level_m < narrower * self._widest_m[weak]:
            self._apart.add(pair)
            return
        self.joined[self.joined == weak] = strong
        renamed = [
            sorted((strong if a == weak else a, strong if b == weak else b)) for a, b in self._apart
        ]
        self._apart = {(a, b) for a, b in renamed}


def find_borders(basin: IntArray, cells: Cells) -> list[tuple[list[int], IntArray]]:
    """Return two basins, and cells (n, 2: row, column), of each place where basins touch.

    Parameters
    ----------
    basin : (k + 1,) int32
        As of `flood_cells`.
    """
    borders = []
    own = basin[:-1]
    for step in ((1, 0), (0, 1)):
        other = basin[cells.beside(*step)]
        (at,) = np.nonzero((own != other) & (own > 0) & (other > 0))
        pair = np.sort(np.stack([own[at], other[at]], axis=1), axis=1)
        borders.append(np.column_stack([pair, *np.divmod(cells.flat[at], cells.n_columns)]))
    rows = np.concatenate(borders)
    pairs, of_pair = np.unique(rows[:, :2], axis=0, return_inverse=True)
    places = []
    for number in range(len(pairs)):
        border = np.unique(rows[of_pair.ravel() == number, 2:], axis=0)
        first = border.min(axis=0)
        here = np.zeros(border.max(axis=0) - first + 1, bool)
        here[tuple((border - first).T)] = True
        label = np.zeros(here.shape, np.int64)
        ndimage.label(here, np.ones((3, 3)), output=label)
        for place in range(1, int(label.max()) + 1):
            places.append((pairs[number].tolist(), np.argwhere(label == place) + first))
    return places
