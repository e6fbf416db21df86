"""A grid over free ground: where a rover's middle can be, and the costs of its steps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.ndimage import maximum_filter
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.ground_grid import Cells, list_cells
from scanplan.types import BoolArray, FloatArray, IntArray

_MARGIN_M = 0.02  # beyond the stated clearance, so that steps between cells keep the clearance
ROOMY_M = 0.6  # from an obstacle: the way keeps the middle of doors, with no detour in rooms
_NARROW = 3.0  # a step at an obstacle costs 1 + this times its length, falling to 1 at ROOMY_M
_PLENTY_M = 1.5  # free space about a place that makes it the middle of a room
_STRIP = 256  # rows: what is looked at twice around strips is little


@dataclass(frozen=True)
class RoadmapGrid:
    """Cells that the rover's middle can be in.

    Attributes
    ----------
    xy_m : (n, 2) float64
        Their places.
    near_m : (n,) float64
        Free space about each.
    middle : (n,) bool
        Whether it is in the middle of a room or hallway.
    steps : (n, n) sparse
        Costs of steps between neighbours.
    """

    xy_m: FloatArray
    near_m: FloatArray
    middle: BoolArray
    steps: csr_array


def make_grid(part: BaseGeometry, clearance_m: float, cell_m: float) -> RoadmapGrid:
    """Return the grid over free ground that keeps a clearance already.

    Parameters
    ----------
    part : Polygon or MultiPolygon
        Where the middle can be.
    clearance_m : float, > 0
    cell_m : float, > 0
        Edge of a cell: narrower grounds are lost.
    """
    if part.is_empty:
        return RoadmapGrid(np.empty((0, 2)), np.empty(0), np.empty(0, bool), csr_array((0, 0)))
    x0, y0, x1, y1 = part.bounds
    x = np.arange(x0 - cell_m, x1 + 2 * cell_m, cell_m)
    y = np.arange(y0 - cell_m, y1 + 2 * cell_m, cell_m)
    inner = overlays.buffer_shapes(part, -_MARGIN_M)
    shapely.prepare(inner)
    inside = np.empty((len(y), len(x)), bool)
    for row, y_m in enumerate(y.tolist()):
        inside[row] = shapely.contains_xy(inner, x, y_m)
    cells = list_cells(inside)
    near_m = cells.far * cell_m + clearance_m
    middle = _is_middle(inside, near_m, clearance_m, cell_m)
    cost = 1 + _NARROW * np.clip(1 - (near_m - clearance_m) / ROOMY_M, 0, 1)
    row, column = np.divmod(cells.flat, len(x))
    xy_m = np.column_stack([x[column], y[row]])
    return RoadmapGrid(xy_m, near_m, middle, _costs_of_steps(cells, cost, cell_m))


def connected_grid(grid: RoadmapGrid, start_m: Sequence[float] | None = None) -> RoadmapGrid:
    """Return the connected part of a grid: that of the cell nearest a start, else the largest.

    Ground that is connected by a neck hardly wider than the rover makes a grid in parts.
    """
    if len(grid.xy_m) == 0:
        return grid
    _, label = connected_components(grid.steps, directed=False)
    largest = np.bincount(label).argmax()
    inside = label == (largest if start_m is None else label[nearest_cell(grid, start_m)])
    steps = grid.steps[inside][:, inside]
    return RoadmapGrid(grid.xy_m[inside], grid.near_m[inside], grid.middle[inside], steps)


def cheapest_ways(grid: RoadmapGrid, stop: int) -> tuple[FloatArray, IntArray]:
    """Return the costs of going to a cell from every cell, and the cell before each on the way."""
    return dijkstra(grid.steps, directed=False, indices=stop, return_predecessors=True)


def trace_cells(cell_before: IntArray, stop: int, cell: int) -> list[int]:
    """Return the cells from a stop of `cheapest_ways` to a cell that can be reached from it."""
    cells = [cell]
    while cells[-1] != stop:
        cells.append(int(cell_before[cells[-1]]))
    return cells[::-1]


def room_cells(grid: RoadmapGrid, room: BaseGeometry) -> IntArray:
    """Return the cells of a room, first that with most space about it.

    Of equals first the one nearest the room's middle.
    """
    shapely.prepare(room)
    within = np.flatnonzero(shapely.contains_xy(room, *grid.xy_m.T))
    off_m = np.hypot(*(grid.xy_m[within] - shapely.get_coordinates(room.centroid)[0]).T)
    return within[np.lexsort((off_m, -np.round(grid.near_m[within], 3)))]


def nearest_cell(grid: RoadmapGrid, xy_m: Sequence[float]) -> int:
    """Return the cell nearest a place."""
    return int(np.argmin(np.hypot(*(grid.xy_m - np.asarray(xy_m)).T)))


def _is_middle(
    inside: BoolArray, near_m: FloatArray, clearance_m: float, cell_m: float
) -> BoolArray:
    """Return which cells inside a raster have as much space as any near them, or plenty."""
    reach = round(ROOMY_M / 2 / cell_m)
    of_row = np.concatenate([[0], np.cumsum(np.count_nonzero(inside, axis=1))])
    middle = np.empty(len(near_m), bool)
    # strip by strip: what lies around the ground is much
    for first in range(0, len(inside), _STRIP):
        last = min(first + _STRIP, len(inside))
        low, high = max(first - reach, 0), min(last + reach, len(inside))
        raster_m = np.full((high - low, inside.shape[1]), clearance_m)
        raster_m[inside[low:high]] = near_m[of_row[low] : of_row[high]]
        ridge_m = maximum_filter(raster_m, 1 + 2 * reach)
        is_most = raster_m >= np.minimum(ridge_m - cell_m / 2, _PLENTY_M)
        own = slice(first - low, last - low)
        middle[of_row[first] : of_row[last]] = is_most[own][inside[first:last]]
    return middle


def _costs_of_steps(cells: Cells, cost: FloatArray, cell_m: float) -> csr_array:
    """Return the costs (n, n) of steps between neighbours, diagonal ones among them."""
    n = len(cells.flat)
    steps = []
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1)):
        beside = cells.beside(dy, dx)
        (a,) = np.nonzero(beside < n)
        b = beside[a]
        steps.append((a, b, cell_m * np.hypot(dx, dy) * (cost[a] + cost[b]) / 2))
    a, b, costs = (np.concatenate(column) for column in zip(*steps, strict=True))
    return coo_array((costs, (a, b)), shape=(n, n)).tocsr()
