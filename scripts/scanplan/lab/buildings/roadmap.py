"""A grid over free ground: where the rover's middle can be, and what going from cell to cell costs."""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.ndimage import distance_transform_edt, maximum_filter
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from scanplan.errors import StageError

# what the planning keeps beyond the stated clearance, so that steps between cells keep the clearance itself
_MARGIN_M = 0.02
_FINE_M, _COARSE_M, _COARSE_ABOVE_M2 = 0.05, 0.1, 300.0
_MOST_CELLS = 20e6
# within this of an obstacle a step costs up to (1 + _NARROW) times its length: the way keeps to the middle
_PREFERRED_M, _NARROW = 0.6, 3.0
# the middle is where nothing near has more space about it, and all that has plenty
_RIDGE_M, _PLENTY_M = 0.6, 1.5


@dataclass(frozen=True)
class RoadmapGrid:
    """Cells that the rover's middle can be in: place, free space about it, if in the middle; costs of steps."""

    xy_m: np.ndarray
    near_m: np.ndarray
    middle: np.ndarray
    steps: coo_array


def make_grid(part, clearance_m, source):
    """Return the grid over connected free ground that keeps a clearance already.

    Raises
    ------
    StageError
        If that would take too many cells.
    """
    if part.is_empty:
        return RoadmapGrid(np.empty((0, 2)), np.empty(0), np.empty(0, bool), coo_array((0, 0)))
    cell_m = _FINE_M if part.area < _COARSE_ABOVE_M2 else _COARSE_M
    x0, y0, x1, y1 = part.bounds
    if (x1 - x0) * (y1 - y0) > _MOST_CELLS * cell_m**2:
        raise StageError(
            f"{source}: its floor of {x1 - x0:.0f} x {y1 - y0:.0f} m is too large to plan a way over (limit"
            f" {_MOST_CELLS * cell_m**2:,.0f} m2); check simulate.site.unit, or give simulate.site.waypoints_m"
        )
    x, y = (
        np.arange(low - cell_m, high + 2 * cell_m, cell_m) for low, high in ((x0, x1), (y0, y1))
    )
    inner = part.buffer(-_MARGIN_M)
    shapely.prepare(inner)
    inside = shapely.contains_xy(inner, *np.meshgrid(x, y))
    near_m = distance_transform_edt(inside) * cell_m + clearance_m
    number = np.full(inside.shape, -1)
    number[inside] = np.arange(np.count_nonzero(inside))
    row, column = np.nonzero(inside)
    ridge_m = maximum_filter(near_m, 1 + 2 * round(_RIDGE_M / 2 / cell_m))
    middle = (near_m >= np.minimum(ridge_m - cell_m / 2, _PLENTY_M))[inside]
    near_m = near_m[inside]
    cost = 1 + _NARROW * np.clip(1 - (near_m - clearance_m) / _PREFERRED_M, 0, 1)
    steps = [_steps(number, cost, dy, dx, cell_m) for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1))]
    a, b, metres = (np.concatenate(column) for column in zip(*steps, strict=True))
    costs = coo_array((metres, (a, b)), shape=(len(row),) * 2).tocsr()
    return RoadmapGrid(np.column_stack([x[column], y[row]]), near_m, middle, costs)


def connected_grid(grid, start_m=None):
    """Return the part of a grid that hangs together: that of the cell nearest a start, else the largest.

    Ground that is connected by a neck hardly wider than the rover makes a grid in parts.
    """
    if len(grid.xy_m) == 0:
        return grid
    _, label = connected_components(grid.steps, directed=False)
    kept = label == (
        np.bincount(label).argmax() if start_m is None else label[nearest_cell(grid, start_m)]
    )
    return RoadmapGrid(
        grid.xy_m[kept], grid.near_m[kept], grid.middle[kept], grid.steps.tocsr()[kept][:, kept]
    )


def _steps(number, cost, dy, dx, cell_m):
    """Pairs of neighbouring cells in one direction, and what going from one to the other costs."""
    rows, columns = number.shape
    here = number[: rows - dy, max(-dx, 0) : columns - max(dx, 0)].ravel()
    there = number[dy:, max(dx, 0) : columns + min(dx, 0)].ravel()
    both = (here >= 0) & (there >= 0)
    a, b = here[both], there[both]
    return a, b, cell_m * np.hypot(dx, dy) * (cost[a] + cost[b]) / 2


def cheapest_ways(grid, stop):
    """Return what going to a cell costs from every cell, and the cell before each on the way there."""
    return dijkstra(grid.steps, directed=False, indices=stop, return_predecessors=True)


def room_cells(grid, room):
    """The cells of a room, first that with most space about it, of equals the one nearest the room's middle."""
    shapely.prepare(room)
    within = np.flatnonzero(shapely.contains_xy(room, *grid.xy_m.T))
    off_m = np.hypot(*(grid.xy_m[within] - shapely.get_coordinates(room.centroid)[0]).T)
    return within[np.lexsort((off_m, -np.round(grid.near_m[within], 3)))]


def nearest_cell(grid, xy_m):
    """Return the cell nearest a place."""
    return int(np.argmin(np.hypot(*(grid.xy_m - np.asarray(xy_m)).T)))
