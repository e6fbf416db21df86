"""The plan as an occupancy grid, for the navigation of a robot."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import shapely

from scanplan.geometry import bitmap, overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_MARGIN_M = 0.5  # around all that is known: room for a planner's inflation of obstacles
_MOST_CELLS = 64_000_000  # a robot's memory: 64 MB, 400 m x 400 m at 5 cm
# occupancy is (255 - grey) / 255, of `Grey.UNKNOWN` 0.196: nav2's own free_thresh of 0.25 would
# take the unknown for free
_MAP_YAML = """\
image: {image}
mode: {mode}
resolution: {resolution_m:g}
origin: [{x_m:g}, {y_m:g}, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.1
"""


_SLOW_M = 1.0  # around doors and passages: from where a person behind them is seen late
_SLOW_PERCENT = 50  # of the greatest speed: halves the way to stop by three quarters


class Grey(IntEnum):
    """Grey values of ROS map_server."""

    FREE = 254
    OCCUPIED = 0
    UNKNOWN = 205


@dataclass(frozen=True)
class GridMap:
    """An occupancy grid.

    Attributes
    ----------
    cells : (rows, columns) uint8
        Of `Grey`; the first row is that of the greatest y, as in an image.
    resolution_m : float
        Edge of a cell.
    origin_m : (float, float)
        Place of the lower left corner of the lower left cell in the map frame.
    """

    cells: IntArray
    resolution_m: float
    origin_m: tuple[float, float]


def draw_grid_map(plan: FloorPlan, resolution_m: float) -> GridMap:
    """Draw where a robot can drive.

    Occupied is every cell that a wall's surface passes through or whose middle lies in a wall;
    doors and passages are no wall, windows are. Free is a cell whose middle lies on floor that rays
    went over. The rest is unknown.

    Parameters
    ----------
    resolution_m : float, > 0
        Doubled until the grid has at most 64 million cells.
    """
    floor = shapely.from_wkb(np.asarray(plan.free["geometry"], object))
    grid = _fit_grid(*_extent_m(plan, floor), resolution_m)
    cells = np.full(grid.shape, Grey.UNKNOWN, np.uint8)
    cells[bitmap.fill_polygons(floor, grid)] = Grey.FREE
    solid, lines_m = _obstacles(plan)
    cells[bitmap.fill_polygons(solid, grid)] = Grey.OCCUPIED
    cells[bitmap.rasterise_lines(lines_m, grid)] = Grey.OCCUPIED
    x_m, y_m = (round(float(value), 6) + 0.0 for value in grid.low_m)
    return GridMap(np.ascontiguousarray(cells[::-1]), grid.cell_m, (x_m, y_m))


def draw_keepout(plan: FloorPlan, resolution_m: float) -> GridMap:
    """Draw where a robot is to keep out of: all but floor that rays went over, and ways outside.

    Those are doors and passages to where no scan shows a room. Of `Grey`, on the cells of
    `draw_grid_map`: what nav2's keepout filter takes for occupied.
    """
    grid = draw_grid_map(plan, resolution_m)
    cells = np.where(grid.cells == Grey.FREE, Grey.FREE, Grey.OCCUPIED).astype(np.uint8)
    openings = plan.openings
    is_out = np.isin(openings["type"], floorplan.WAYS)
    is_out &= (openings["room_a"] < 0) | (openings["room_b"] < 0)
    cells[_fill_around(plan, grid, is_out, 0.0)] = Grey.OCCUPIED
    return GridMap(cells, grid.resolution_m, grid.origin_m)


def draw_speed(plan: FloorPlan, resolution_m: float) -> GridMap:
    """Draw where a robot is to be slow: near doors and passages.

    Cells are percent of its greatest speed, 0 where it is not limited, as nav2's speed filter
    reads them (type 1), on the cells of `draw_grid_map`.
    """
    grid = draw_grid_map(plan, resolution_m)
    cells = np.zeros_like(grid.cells)
    is_way = np.isin(plan.openings["type"], floorplan.WAYS)
    cells[_fill_around(plan, grid, is_way, _SLOW_M)] = _SLOW_PERCENT
    return GridMap(cells, grid.resolution_m, grid.origin_m)


def _fill_around(
    plan: FloorPlan, grid: GridMap, is_wanted: BoolArray, around_m: float
) -> BoolArray:
    """Return which cells lie within the walls of openings, or so far around these."""
    around = overlays.buffer_shapes(plan.gaps[is_wanted], around_m)
    under = bitmap.Grid(np.array(grid.origin_m), grid.resolution_m, grid.cells.shape)
    return bitmap.fill_polygons(around, under)[::-1]


def format_pgm(grid: GridMap) -> bytes:
    """Return the grid's cells as the bytes of a binary PGM image."""
    rows, columns = grid.cells.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + grid.cells.tobytes()


def format_map_yaml(grid: GridMap, image: str, mode: str = "trinary") -> str:
    """Return the text of the YAML file by which nav2's map server reads the image of that name.

    `mode` raw takes grey values for what they are, as those of `draw_speed`.
    """
    x_m, y_m = grid.origin_m
    return _MAP_YAML.format(
        image=image, mode=mode, resolution_m=grid.resolution_m, x_m=x_m, y_m=y_m
    )


def _extent_m(plan: FloorPlan, floor: Array) -> tuple[FloatArray, FloatArray]:
    """Return the least and the greatest x and y of a plan and its free floor."""
    low_m, high_m = plan.bounds_m
    if len(floor) == 0:
        return low_m, high_m
    x0_m, y0_m, x1_m, y1_m = shapely.total_bounds(floor)
    return np.minimum(low_m, (x0_m, y0_m)), np.maximum(high_m, (x1_m, y1_m))


def _fit_grid(low_m: FloatArray, high_m: FloatArray, resolution_m: float) -> bitmap.Grid:
    size_m = high_m - low_m + 2 * _MARGIN_M
    while np.prod(np.ceil(size_m / resolution_m)) > _MOST_CELLS:
        resolution_m *= 2
    # a round origin: the cells of plans of one building at one resolution fall on each other
    origin_m = np.floor((low_m - _MARGIN_M) / resolution_m) * resolution_m
    columns, rows = np.ceil((high_m + _MARGIN_M - origin_m) / resolution_m).astype(int).tolist()
    return bitmap.Grid(origin_m, resolution_m, (rows, columns))


def _obstacles(plan: FloorPlan) -> tuple[Array, FloatArray]:
    """Return polygons, and lines (n, 2, 2) of surfaces, that are in the way.

    Windows and glass are no ways through, nor is a gap that may be anything. In a wall of which one
    side is known only that side is in the way.
    """
    is_shut = ~np.isin(plan.openings["type"], floorplan.WAYS)
    panes_m = floorplan.centrelines_m(plan.openings)[is_shut]
    thickness_m = plan.openings["thickness_m"][is_shut]
    is_thick = np.isfinite(thickness_m)
    polygons = []
    lines = []
    for state in floorplan.STATES:
        polygons += [*shapely.get_parts(plan.solid(state))]
        lines += [*plan.single(state)]
    polygons += [*floorplan.buffer_lines(panes_m[is_thick], thickness_m[is_thick] / 2)]
    lines += [*floorplan.line_shapes(panes_m[~is_thick])]
    solid = np.array(polygons, object)
    outlines = shapely.get_rings(solid) if len(solid) else []
    segments_m = [_segments_m(shape) for shape in (*outlines, *lines)]
    return solid, np.concatenate([np.zeros((0, 2, 2)), *segments_m])


def _segments_m(line: shapely.LineString) -> FloatArray:
    """Return the segments (n, 2, 2) of a line or ring."""
    corners_m = shapely.get_coordinates(line)
    return np.stack([corners_m[:-1], corners_m[1:]], axis=1)
