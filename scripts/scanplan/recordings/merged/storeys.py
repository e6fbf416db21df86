"""Storeys of a cloud by height, and places to look from on the floor of one.

A floor is what is seen from above with a person's height of nothing over it, and below a ceiling.
"""

from typing import NamedTuple

import numpy as np

from scanplan.geometry import bitmap
from scanplan.recordings.merged.lattice import column_keys, unpack_keys
from scanplan.types import BoolArray, FloatArray, IntArray

CELL_M = 0.1  # a quarter of a robot's width, and above the noise of any scanner
_STAND = 18  # cells: a person's height, and more than tables have below and above them
_LAYERS = 2  # cells up and down of what counts as one floor: thresholds, and slopes
_LEAST_FLOOR_M2 = 4.0  # a storey's: stairs have landings of half of that
_LEAST_WALL = 0.02  # cells of wall over a cell of floor: a hall of 100 m has 0.06, a roof nothing
_WALL_FROM = 3  # cells over the floor: what is lower are steps and things that lie about
MOST_CELLS = 64_000_000  # as of the map that is exported
_APART_M = 1.5  # of places: twice what a map's beams need, as these look up and down, too
_CLEAR_M = 0.25  # of obstacles: a robot's radius
_MOST_OPEN = 3  # of eight neighbours: a cell without points among more floor than this is floor


class Storey(NamedTuple):
    """A floor: its height over the cloud's origin, how much of it is clear, and how high that is.

    `clear_m` is the median height of what is over it, NaN where nothing is.
    """

    floor_z_m: float
    area_m2: float
    clear_m: float


class Columns(NamedTuple):
    """Cubes of a cloud, from below in each column, the height in each, and which are floor.

    `above` is how many cubes up the next one is, 0 where there is none.
    """

    cells: IntArray
    z_m: FloatArray
    is_floor: BoolArray
    above: IntArray


def find_floor(keys: IntArray, z_m: FloatArray) -> Columns:
    """Return which cubes (n,) of `CELL_M` show floor.

    Those with nothing in a person's height over them and something farther up; of a cloud that
    has hardly any, such as one without ceilings, those with nothing over them at all that are no
    ceilings themselves.

    Parameters
    ----------
    keys : (n,) int64
        Of cubes with points, increasing.
    z_m : (n,) float
        Of a point in each.
    """
    cells = unpack_keys(keys)
    is_same = np.diff(column_keys(keys)) == 0
    rise = np.diff(cells[:, 2])
    above = np.append(np.where(is_same, rise, 0), 0)[: len(cells)]
    below = np.insert(np.where(is_same, rise, 0), 0, 0)[: len(cells)]
    is_roofed = above > _STAND
    if np.count_nonzero(is_roofed) * CELL_M**2 >= _LEAST_FLOOR_M2:
        return Columns(cells, z_m, is_roofed, above)
    return Columns(cells, z_m, (above == 0) & (below <= _STAND), above)


def find_storeys(columns: Columns) -> list[Storey]:
    """Return the storeys from below; floors less than a person's height apart are one."""
    if len(columns.cells) == 0:
        return []
    z = columns.cells[:, 2]
    low = int(z.min())
    n_layers = int(z.max()) - low + 1 + 2 * _STAND
    floor = np.bincount(z[columns.is_floor] - low, minlength=n_layers)
    walls = np.bincount(z - low, minlength=n_layers)
    near = np.convolve(floor, np.ones(2 * _LAYERS + 1, int), "same")
    storeys = []
    while (n_cells := near.max()) * CELL_M**2 >= _LEAST_FLOOR_M2:
        layer = int(near.argmax())
        n_wall = walls[layer + _WALL_FROM : layer + _STAND].sum()
        if n_wall < _LEAST_WALL * n_cells:
            near[layer] = 0
            continue
        is_level = columns.is_floor & (np.abs(z - low - layer) <= _LAYERS)
        middle_m = float(np.median(columns.z_m[is_level]))
        above = columns.above[is_level]
        clear_m = float(np.median(above)) * CELL_M if above.all() else np.nan
        storeys.append(Storey(middle_m, float(n_cells * CELL_M**2), clear_m))
        near[max(0, layer - _STAND) : layer + _STAND + 1] = 0
    return sorted(storeys)


def choose_places(columns: Columns, storey: Storey) -> FloatArray:
    """Return places (n, 2) over a storey's clear floor, in metres: the ones most in the open first.

    They lie farther apart than both are from what stands beside them, or `_APART_M`: each room has
    some, however small.

    Raises
    ------
    ValueError
        If its floor goes on for more cells than a map has.
    """
    cells = columns.cells
    rise = (columns.z_m - storey.floor_z_m) / CELL_M
    is_clear = columns.is_floor & (np.abs(rise) <= _LAYERS)
    low, high = (limit(cells[is_clear, :2], axis=0) for limit in (np.min, np.max))
    shape = tuple((high - low + 3).tolist())  # with an edge that is no floor
    if shape[0] * shape[1] > MOST_CELLS:
        raise ValueError("floor too wide")
    is_near = ((cells[:, :2] >= low) & (cells[:, :2] <= high)).all(axis=1)
    is_near &= (rise > -_WALL_FROM) & (rise < _STAND)
    has_points = _raster(cells[is_near, :2] - low + 1, shape)
    free = _fill_holes(_raster(cells[is_clear, :2] - low + 1, shape), has_points)
    found = _pack_discs(bitmap.distances_to_outline(free) * CELL_M)
    return (found - 1 + low + 0.5) * CELL_M


def _raster(cells: IntArray, shape: tuple[int, ...]) -> BoolArray:
    grid = np.zeros(shape, bool)
    grid[tuple(cells.T)] = True
    return grid


def _fill_holes(free: BoolArray, has_points: BoolArray) -> BoolArray:
    """Return floor with what few points happen to miss of it."""
    n_free = np.zeros((free.shape[0] - 2, free.shape[1] - 2), np.int8)
    for i in range(3):
        for j in range(3):
            n_free += free[i : i + n_free.shape[0], j : j + n_free.shape[1]]
    filled = free.copy()
    filled[1:-1, 1:-1] |= (n_free >= 8 - _MOST_OPEN) & ~has_points[1:-1, 1:-1]
    return filled


def _pack_discs(clear_m: FloatArray) -> IntArray:
    """Return cells (n, 2) whose discs of clear floor lie side by side, the widest first."""
    cells = np.argwhere(clear_m >= _CLEAR_M)
    order = np.argsort(-clear_m[tuple(cells.T)], kind="stable")
    is_taken = np.zeros(clear_m.shape, bool)
    reach = int(_APART_M / CELL_M) + 1
    found = []
    for row, column in cells[order].tolist():
        if is_taken[row, column]:
            continue
        found.append((row, column))
        rows = slice(max(0, row - reach), min(row + reach + 1, clear_m.shape[0]))
        columns = slice(max(0, column - reach), min(column + reach + 1, clear_m.shape[1]))
        down, along = np.ogrid[rows, columns]
        needed_m = np.minimum(clear_m[row, column] + clear_m[rows, columns], _APART_M)
        apart_m = np.hypot(down - row, along - column) * CELL_M
        is_taken[rows, columns] |= apart_m < needed_m
    return np.array(found, np.int64).reshape(-1, 2)
