"""Surroundings of a plan's elements: a false wall seldom fits its neighbours."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.intersections import LEAST_RAD
from scanplan.geometry.lines import line_lengths_m
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.floorplan import line_shapes
from scanplan.plan.tolerances import CORNER_M
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import Array, FloatArray, IntArray


def count_joined_ends(lines_m: FloatArray, others_m: FloatArray, *, same: bool) -> IntArray:
    """Return how many of the two ends (n,) of lines lie within 0.3 m of another line.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    others_m : (m, 2, 2) float64
    same : bool
        Whether both are the same lines, of which none joins itself.
    """
    joined = np.zeros((len(lines_m), 2), bool)
    tree = shapely.STRtree(line_shapes(others_m))
    for end in (0, 1):
        ends = shapely.points(lines_m[:, end])
        row, other = tree.query(ends, predicate="dwithin", distance=CORNER_M)
        joined[row[(row != other) | (not same)], end] = True
    return joined.sum(axis=1)


def share_doubled(lines_m: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the share (n,) of faces before or behind which, within 0.3 m, another looks their way.

    Lines that meet too flatly for a corner count as parallel. Of two surfaces one behind the other
    that are both seen from the same side casings and niches are rare, walls that poses have doubled
    are not.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    normals : (n, 2) float64
        Unit vectors to the side that each was seen from.

    Returns
    -------
    (n,) float64
        Of the length of each: the most that any single other covers.
    """
    length_m = np.maximum(line_lengths_m(lines_m), SHORTEST_M)
    direction = (lines_m[:, 1] - lines_m[:, 0]) / length_m[:, None]
    tree = shapely.STRtree(line_shapes(lines_m))
    row, other = tree.query(tree.geometries, predicate="dwithin", distance=CORNER_M)
    alike = (normals[row] * normals[other]).sum(axis=1) > np.cos(LEAST_RAD)
    row, other = row[alike & (row != other)], other[alike & (row != other)]
    from_start_m = lines_m[other] - lines_m[row, 0][:, None]
    along_m = np.sort((from_start_m * direction[row][:, None]).sum(axis=-1), axis=1)
    covered_m = np.minimum(along_m[:, 1], length_m[row]) - np.maximum(along_m[:, 0], 0)
    # one that goes on along the same line overlaps by what their ends err
    covered_m = np.where(covered_m > CORNER_M, covered_m, 0.0)
    doubled = np.zeros(len(lines_m))
    np.maximum.at(doubled, row, np.minimum(covered_m / length_m[row], 1))
    return doubled


def share_floor_beyond(
    lines_m: FloatArray, sides_m: FloatArray, areas: Array, floor: BaseGeometry
) -> FloatArray:
    """Return the share (n,) of the ground beyond openings that was seen as floor.

    A square as wide as the opening on the side that is in no area; the greater share where both
    sides are, 0 where neither is.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
        Centrelines of the openings.
    sides_m : (n, 2) float64
        How far to the left of each line the wall's one face lies, and its other.
    areas : (r,) object
        Shapely polygons of rooms.
    """
    way_m = lines_m[:, 1] - lines_m[:, 0]
    width_m = np.maximum(np.hypot(*way_m.T), SHORTEST_M)
    left = np.column_stack([-way_m[:, 1], way_m[:, 0]]) / width_m[:, None]
    rooms = overlays.unite_areas(areas)
    shares = np.zeros(len(lines_m))
    for side_m, sign in zip(sides_m.T, (1, -1), strict=True):
        near_m = lines_m + (side_m[:, None] * left)[:, None]
        far_m = near_m + (sign * width_m[:, None] * left)[:, None]
        ground = shapely.polygons(np.concatenate([near_m, far_m[:, ::-1]], axis=1))
        is_beyond = ~shapely.contains(rooms, shapely.centroid(ground))
        seen_m2 = shapely.area(overlays.intersect_areas(ground, floor))
        shares = np.maximum(shares, np.where(is_beyond, seen_m2 / width_m**2, 0.0))
    return shares


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


def stand_alone(lines_m: FloatArray) -> FloatArray:
    """Return 1 (n,) of openings whose middle no other's is nearer to than half their width; else 0.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    """
    middles_m = lines_m.mean(axis=1)
    apart_m = np.hypot(*np.moveaxis(middles_m[:, None] - middles_m[None], -1, 0))
    np.fill_diagonal(apart_m, np.inf)
    nearest_m = apart_m.min(axis=1, initial=np.inf)
    return (nearest_m > line_lengths_m(lines_m) / 2).astype(float)
