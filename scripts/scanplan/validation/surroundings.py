"""Surroundings of a plan's elements: a false wall seldom fits its neighbours."""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.floorplan import line_shapes
from scanplan.plan.tolerances import CORNER_M
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import Array, FloatArray, IntArray


def count_joined_ends(lines_m: FloatArray, others_m: FloatArray) -> IntArray:
    """Return how many of the two ends (n,) of lines lie within 0.3 m of any of other lines.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    others_m : (m, 2, 2) float64
    """
    joined = np.zeros((len(lines_m), 2), bool)
    tree = shapely.STRtree(line_shapes(others_m))
    for end in (0, 1):
        ends = shapely.points(lines_m[:, end])
        row, _ = tree.query(ends, predicate="dwithin", distance=CORNER_M)
        joined[row, end] = True
    return joined.sum(axis=1)


def share_along(lines_m: FloatArray, areas: Array) -> FloatArray:
    """Return the share (n,) of the length of lines that runs within 0.15 m of any area's outline.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    areas : (r,) object
        Shapely polygons.
    """
    outlines = shapely.boundary(areas)
    near = overlays.unite_areas(overlays.buffer_shapes(outlines, BEHIND_M, quad_segs=8))
    lines = line_shapes(lines_m)
    return shapely.length(overlays.intersect_lines(lines, near)) / np.maximum(
        shapely.length(lines), SHORTEST_M
    )


def share_faced(areas: Array, lines_m: FloatArray) -> FloatArray:
    """Return the share (n,) of areas' outlines that has a line within 0.15 m of it.

    Parameters
    ----------
    areas : (r,) object
        Shapely polygons.
    lines_m : (m, 2, 2) float64
    """
    near = overlays.buffer_shapes(overlays.unite_lines(line_shapes(lines_m)), BEHIND_M, quad_segs=8)
    outlines = shapely.boundary(areas)
    return shapely.length(overlays.intersect_lines(outlines, near)) / np.maximum(
        shapely.length(outlines), SHORTEST_M
    )


def measure_breadth(areas: Array) -> FloatArray:
    """Return how broad areas (r,) are, metres: the diameter of the largest circle in each.

    It is at least half the edge of a square as large: a long corridor is narrow, and no less a room
    for that. What is left between walls where a room is cut wrongly is narrow and small.

    Parameters
    ----------
    areas : (r,) object
        Shapely polygons.
    """
    circle_m = 2 * shapely.length(shapely.maximum_inscribed_circle(areas))
    return np.maximum(circle_m, np.sqrt(shapely.area(areas)) / 2)
