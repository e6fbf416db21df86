"""Which lines part ground enough, by all parts anew for every line that is taken out."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.parted_ground import FURNITURE_M2
from scanplan.geometry.tolerances import SHORTEST_M, SMALLEST_M2
from scanplan.types import Array, FloatArray, IntArray


def part_enough(
    ground: BaseGeometry,
    lines: Sequence[FloatArray],
    visited: Array,
    min_area_m2: float,
    sliver_m: float,
) -> list[FloatArray]:
    """Return the lines that part ground enough; `visited` are points of shapely."""
    chosen = list(lines)
    while True:
        cuts = [_lengthen(line).buffer(SHORTEST_M) for line in chosen]
        parts = shapely.get_parts(shapely.difference(ground, shapely.union_all(cuts)))
        is_visited = np.array([_is_visited(part, visited) for part in parts], bool)
        is_small = shapely.area(parts) < np.where(is_visited, min_area_m2, FURNITURE_M2)
        is_wide = ~shapely.is_empty(shapely.buffer(parts, -sliver_m))
        beside = [_parts_beside(line, parts) for line in chosen]
        cut_off = [
            i
            for i, rows in enumerate(beside)
            if len(rows) > 1 and (is_wide[rows].sum() < 2 or is_small[rows[is_wide[rows]]].any())
        ]
        if not cut_off:
            return [line for line, rows in zip(chosen, beside, strict=True) if len(rows) > 1]
        # one at a time: what is small joins what is behind it, and another line parts both
        inner = [i for i in cut_off if not is_visited[beside[i]].any()]
        chosen.pop(max(inner or cut_off, key=lambda i: math.hypot(*(chosen[i][1] - chosen[i][0]))))


def _parts_beside(line: FloatArray, parts: Array) -> IntArray:
    """Return the rows of the parts along a line that was cut; not of what is beyond its ends."""
    beside = LineString(line).buffer(2 * SHORTEST_M, cap_style="flat")
    return np.flatnonzero(shapely.area(shapely.intersection(parts, beside)) > SMALLEST_M2)


def _is_visited(part: Polygon, visited: Array) -> bool:
    shapely.prepare(part)
    return bool(shapely.contains(part, visited).any())


def _lengthen(line: FloatArray) -> LineString:
    """Return a line that goes on a little beyond both ends."""
    beyond = (line[1] - line[0]) / 10
    return LineString([line[0] - beyond, line[1] + beyond])
