"""The plan as an occupancy grid, for the navigation of a robot."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from scanplan.geometry import bitmap
from scanplan.plan import floorplan

FREE, OCCUPIED, UNKNOWN = 254, 0, 205
_MARGIN_M = 0.5
_MOST_CELLS = 64_000_000
# the usual grey of the unknown, 205, is an occupancy of 0.196: nav2's own limit of 0.25 would take it for free
_FREE_BELOW, _OCCUPIED_ABOVE = 0.1, 0.65


@dataclass(frozen=True)
class GridMap:
    """An occupancy grid.

    Attributes
    ----------
    cells : (rows, columns) uint8
        `FREE`, `OCCUPIED` or `UNKNOWN`; the first row is the northernmost (greatest y), as in an image.
    resolution_m : float
        Edge of a cell.
    origin_m : (float, float)
        Place of the lower left corner of the lower left cell in the map frame.
    """

    cells: np.ndarray
    resolution_m: float
    origin_m: tuple


def draw_grid_map(plan, resolution_m):
    """Draw where a robot can drive.

    Occupied is every cell that a wall's surface passes through or whose middle lies in a wall; doors and passages are
    no wall, windows are. Free is a cell whose middle lies on floor that rays went over. Nothing is known of the rest.

    Parameters
    ----------
    plan : floorplan.FloorPlan
    resolution_m : float, > 0
        Doubled until the grid has at most 64 million cells.

    Returns
    -------
    GridMap
    """
    low_m, high_m = plan.bounds_m
    floor = shapely.from_wkb(np.asarray(plan.free["geometry"], object))
    if len(floor):
        x0, y0, x1, y1 = shapely.total_bounds(floor)
        low_m, high_m = np.minimum(low_m, (x0, y0)), np.maximum(high_m, (x1, y1))
    while np.prod(np.ceil((high_m - low_m + 2 * _MARGIN_M) / resolution_m)) > _MOST_CELLS:
        resolution_m *= 2
    # a round origin: the cells of plans of one building at one resolution fall on each other
    origin_m = np.floor((low_m - _MARGIN_M) / resolution_m) * resolution_m
    shape = tuple(np.ceil((high_m + _MARGIN_M - origin_m) / resolution_m).astype(int)[::-1])
    cells = np.full(shape, UNKNOWN, np.uint8)
    cells[_inside(floor, origin_m, resolution_m, shape)] = FREE
    solid, lines = _obstacles(plan)
    cells[_inside(solid, origin_m, resolution_m, shape)] = OCCUPIED
    cells[bitmap.rasterise_lines(lines, bitmap.Grid(origin_m, resolution_m, shape))] = OCCUPIED
    origin = tuple(round(float(v), 6) + 0.0 for v in origin_m)
    return GridMap(np.ascontiguousarray(cells[::-1]), resolution_m, origin)


def format_pgm(grid):
    """Return the grid's cells as the bytes of a binary PGM image."""
    rows, columns = grid.cells.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + grid.cells.tobytes()


def format_map_yaml(grid, image):
    """Return the text of the YAML file that tells nav2's map server how to read the image of that name."""
    x_m, y_m = grid.origin_m
    return (
        f"image: {image}\nmode: trinary\nresolution: {grid.resolution_m:g}\norigin: [{x_m:g}, {y_m:g}, 0]\n"
        f"negate: 0\noccupied_thresh: {_OCCUPIED_ABOVE}\nfree_thresh: {_FREE_BELOW}\n"
    )


def _obstacles(plan):
    """Return polygons, and lines (n, 2, 2) of surfaces, that are in the way; a window is no way through."""
    windows = plan.openings["type"] == "window"
    solid = [part for state in floorplan.STATES for part in shapely.get_parts(plan.solid(state))]
    lines = [line for state in floorplan.STATES for line in plan.single(state)]
    # of a window in a wall of which one side is known nothing but that side is in the way
    panes_m, thick_m = (
        floorplan.centrelines_m(plan.openings)[windows],
        plan.openings["thickness_m"][windows],
    )
    known = np.isfinite(thick_m)
    solid += list(floorplan.buffer_lines(panes_m[known], thick_m[known] / 2))
    lines += list(shapely.linestrings(panes_m[~known]))
    outlines = list(shapely.get_rings(np.array(solid, object))) if solid else []
    pairs = [
        np.stack([xy[:-1], xy[1:]], axis=1) for xy in map(shapely.get_coordinates, outlines + lines)
    ]
    return np.array(solid, object), np.concatenate(pairs) if pairs else np.zeros((0, 2, 2))


def _inside(polygons, origin_m, resolution_m, shape):
    """Tell which cells (rows, columns) have their middle in any of the polygons: left of an odd number of edges."""
    odd = np.zeros(shape, np.uint8)
    merged = shapely.union_all(polygons) if len(polygons) else shapely.Polygon()
    for ring in shapely.get_rings(shapely.get_parts(merged)):
        xy = (shapely.get_coordinates(ring) - origin_m) / resolution_m - 0.5
        for (x0, y0), (x1, y1) in pairwise(xy):
            rows = np.arange(math.ceil(min(y0, y1)), math.ceil(max(y0, y1)))
            if len(rows):
                columns = np.ceil(x0 + (rows - y0) * (x1 - x0) / (y1 - y0)).astype(int)
                odd[rows, columns] ^= 1
    return np.bitwise_xor.accumulate(odd, axis=1).astype(bool)
