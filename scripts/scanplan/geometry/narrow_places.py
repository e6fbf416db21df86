"""Where ground is narrow: lines that part it, by a watershed of the distance to its outline.

After Bormann et al., Room segmentation: survey, implementation, and analysis (ICRA 2016), whose
methods threshold or flood the same distances. Theirs take one threshold for all rooms; here a
narrow place is one that is narrow beside what it parts on either side.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.bare_parts import draw_way
from scanplan.geometry.bitmap import Grid, fill_polygons
from scanplan.geometry.parted_ground import FURNITURE_M2, part_enough
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.geometry.watershed import NARROWER, find_borders, flood_cells, list_cells
from scanplan.types import FloatArray


@dataclass(frozen=True)
class NarrowLimits:
    """What is narrow.

    Attributes
    ----------
    max_width_m : float, > 0
        Of lines that are no gaps.
    min_area_m2 : float, >= 0
        No less lies on a visited side, nor less than furniture parts off on another.
    cell_m : float, > 0
        Of the distances: a fraction of the width.
    """

    max_width_m: float
    min_area_m2: float
    cell_m: float


def find_narrow_places(
    ground: BaseGeometry,
    visited_m: FloatArray,
    limits: NarrowLimits,
    *,
    gaps_m: Sequence[FloatArray] = (),
    walls: BaseGeometry | None = None,
) -> list[FloatArray]:
    """Find where ground is narrower than on both sides, and no wider than a given width.

    Where nobody passed, it need not be wider just there: through a door one sees no more than a fan
    of what is behind it.

    Parameters
    ----------
    ground : Polygon or MultiPolygon
        What small islands leave out of it counts as ground, but where walls stand.
    visited_m : (n, 2) float64
        Places that were visited, one after another.
    gaps_m : sequence of (2, 2) float64
        Lines across ground that may part it however wide they are, if it is wider on both sides.
    walls : shapely geometry, optional
        Where walls stand that are no furniture.

    Returns
    -------
    list of (2, 2) float64
        The shortest lines across, from outline to outline.
    """
    max_width_m, cell_m = limits.max_width_m, limits.cell_m
    filled = _fill_islands(ground, shapely.MultiPolygon() if walls is None else walls)
    if filled.is_empty:
        return []
    grid = _fit_grid(filled, cell_m)
    cells = list_cells(fill_polygons([filled], grid))
    far_m = cells.far * cell_m
    track = draw_way(visited_m, cell_m)
    visited_m = visited_m[shapely.contains_xy(filled, *visited_m.T)]
    column, row = np.floor((visited_m - grid.low_m) / cell_m).astype(int).T
    places = np.unique(cells.find(row, column))
    basin = flood_cells(cells.near, far_m, places, max_width_m / 2, cell_m)
    visited = set(basin[places].tolist())
    # what is wider around a place than this is much wider
    reach_m = 3 * max_width_m
    lines = []
    for pair, border in find_borders(basin, cells):
        row, column = border[np.argmax(far_m[cells.find(*border.T)])]
        middle_m = grid.low_m + (np.array([column, row]) + 0.5) * cell_m
        near = overlays.clip_areas(filled, *(middle_m - reach_m), *(middle_m + reach_m))
        line = _shortest_across(near, middle_m)
        if line is None or not 0 < _length_m(line) <= max_width_m:
            continue
        is_passed = visited.issuperset(pair) and track.intersects(LineString(line))
        if not is_passed or _widens_on_both_sides(near, line):
            lines.append(line)
    lines += _choose_gaps(filled, gaps_m, lines)
    return part_enough(filled, lines, visited_m, limits.min_area_m2, sliver_m=4 * cell_m)


def _choose_gaps(
    ground: BaseGeometry, gaps_m: Sequence[FloatArray], lines: Sequence[FloatArray]
) -> list[FloatArray]:
    """Return the gaps that ground is much wider beside, the narrowest of those near each other."""
    chosen: list[FloatArray] = []
    for line_m in sorted(gaps_m, key=_length_m):
        # what is beyond its ends parts other ground
        beside = overlays.buffer_shapes(LineString(line_m), _length_m(line_m) / 2, cap_style="flat")
        is_known = any(beside.intersects(LineString(line)) for line in [*lines, *chosen])
        if is_known or not shapely.contains_xy(ground, *line_m.mean(axis=0)):
            continue
        if _widens_on_both_sides(ground, line_m):
            chosen.append(line_m)
    return chosen


def _fit_grid(ground: BaseGeometry, cell_m: float) -> Grid:
    """Return the grid that holds ground, with cells outside of it all around."""
    low_x, low_y, high_x, high_y = ground.bounds
    low_m = np.array([low_x, low_y]) - 2 * cell_m
    columns, rows = np.ceil((np.array([high_x, high_y]) - low_m) / cell_m).astype(int) + 2
    return Grid(low_m, cell_m, (int(rows), int(columns)))


def _fill_islands(ground: BaseGeometry, walls: BaseGeometry) -> BaseGeometry:
    parts = [part for part in shapely.get_parts(ground) if part.geom_type == "Polygon"]
    holes = [Polygon(ring) for part in parts for ring in part.interiors]
    small = [hole for hole in holes if hole.area <= FURNITURE_M2]
    # a wall between two doors stands alone, too
    islands = [hole for hole in small if overlays.intersect_areas(hole, walls).area < hole.area / 2]
    return overlays.unite_areas([*parts, *islands], grid=SHORTEST_M)


def _shortest_across(ground: BaseGeometry, middle_m: FloatArray) -> FloatArray | None:
    """Return the shortest line (2, 2) across ground through a place; None outside of it."""
    # every five degrees: a line that far off the shortest is no longer by a hundredth
    angle = np.radians(np.arange(0, 180, 5))
    directions = np.column_stack([np.cos(angle), np.sin(angle)])
    return _line_across(
        ground, middle_m, directions[np.argmin(_widths_m(ground, middle_m, directions))]
    )


def _widths_m(ground: BaseGeometry, place_m: FloatArray, directions: FloatArray) -> FloatArray:
    """Return how far it is from outline to outline through a place, along unit vectors (n, 2)."""
    corners_m, ring = shapely.get_coordinates(
        shapely.get_parts(shapely.boundary(shapely.get_parts(ground))), return_index=True
    )
    along_m = (corners_m - place_m) @ directions.T
    beside_m = (corners_m - place_m) @ np.stack([-directions[:, 1], directions[:, 0]])
    on_left = beside_m > 0
    edge, column = np.nonzero((on_left[1:] != on_left[:-1]) & (ring[1:] == ring[:-1])[:, None])
    (before_m, after_m), (low_m, high_m) = (
        (m[edge, column], m[edge + 1, column]) for m in (along_m, beside_m)
    )
    crossing_m = before_m + (after_m - before_m) * low_m / (low_m - high_m)
    nearest_m = np.full((2, len(directions)), np.inf)
    np.minimum.at(nearest_m, ((crossing_m < 0).astype(int), column), np.abs(crossing_m))
    return nearest_m.sum(axis=0)


def _line_across(
    ground: BaseGeometry, place_m: FloatArray, direction: FloatArray
) -> FloatArray | None:
    """Return the line (2, 2) through a place from outline to outline; None outside of ground."""
    reach = _diagonal_m(ground) * direction
    pieces = overlays.intersect_lines(ground, LineString([place_m - reach, place_m + reach]))
    place = shapely.Point(place_m)
    for piece in shapely.get_parts(pieces):
        if piece.geom_type == "LineString" and piece.distance(place) < SHORTEST_M:
            return shapely.get_coordinates(piece)[[0, -1]]
    return None


def _diagonal_m(ground: BaseGeometry) -> float:
    low_x, low_y, high_x, high_y = ground.bounds
    return math.hypot(high_x - low_x, high_y - low_y)


def _length_m(line: FloatArray) -> float:
    return math.hypot(*(line[1] - line[0]))


def _widens_on_both_sides(ground: BaseGeometry, line: FloatArray) -> bool:
    return all(_widens(ground, line, side) for side in (-1, 1))


def _widens(ground: BaseGeometry, line: FloatArray, side: int) -> bool:
    """Return whether ground is much wider than a line across it on its left (1) or right (-1)."""
    width_m = _length_m(line)
    direction = (line[1] - line[0]) / width_m
    across = side * np.array([-direction[1], direction[0]])
    # beyond the wall that a door is in, and beyond what stands just beside a door
    away_m = width_m * np.array([0.5, 1.0])
    places_m = line.mean(axis=0) + away_m[:, None] * across
    beside = [_line_across(ground, place_m, direction) for place_m in places_m]
    widest_m = max((_length_m(other) for other in beside if other is not None), default=0.0)
    return width_m < NARROWER * widest_m
