"""All overlays: unions, differences, intersections, buffers and repairs that never raise.

Nothing else calls those of shapely. The name of a function says what it returns: areas (Polygon or
MultiPolygon), lines (LineString or MultiLineString), points, or shapes of whatever kind; what else
an overlay leaves, as a line where two areas touch, is dropped. Shapes are one geometry or an array,
as in shapely, and a grid is the distance that corners are rounded to, in the units of the
coordinates.

Where rounding contradicts itself GEOS raises, or loses a part of an area and says nothing. Such
shapes are repaired, divided by dimension and rounded to ever coarser grids until it answers
(`overlay_steps`); `fallbacks` counts how often.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlay_steps as steps
from scanplan.geometry.overlay_steps import ANY, AREA, LINE, POINT, Answer, Shapes
from scanplan.types import Array


def unite_areas(areas: Shapes, grid: float | None = None) -> Answer:
    """Return the union of all areas (n,).

    >>> float(unite_areas([shapely.box(0, 0, 2, 1), shapely.box(1, 0, 3, 1)]).area)
    3.0
    """
    return _unite(areas, grid, AREA)


def unite_lines(lines: Shapes, grid: float | None = None) -> Answer:
    """Return the union of all lines (n,), parted where they cross."""
    return _unite(lines, grid, LINE)


def unite_shapes(shapes: Shapes, grid: float | None = None) -> Answer:
    """Return the union of shapes (n,) of any dimensions, a collection if they are several."""
    return _unite(shapes, grid, ANY)


def unite_each(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the union of each area with its other."""
    return steps.overlay_pairs(shapely.union, _unite_carefully, AREA, areas, others, grid)


def subtract_areas(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return what others leave of areas, each of its own.

    >>> float(subtract_areas(shapely.box(0, 0, 2, 1), shapely.box(1, 0, 3, 1)).area)
    1.0
    """
    return steps.overlay_pairs(shapely.difference, _subtract_carefully, AREA, areas, others, grid)


def subtract_lines(lines: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return what others, areas or lines, leave of lines, each of its own.

    >>> line = shapely.LineString([(0, 0), (3, 0)])
    >>> float(subtract_lines(line, shapely.box(1, -1, 2, 1)).length)
    2.0
    """
    return steps.overlay_pairs(shapely.difference, _subtract_carefully, LINE, lines, others, grid)


def intersect_areas(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the areas that areas have in common with others.

    >>> float(intersect_areas(shapely.box(0, 0, 2, 1), shapely.box(1, 0, 4, 1)).area)
    1.0
    """
    return steps.overlay_pairs(
        shapely.intersection, _intersect_carefully, AREA, areas, others, grid
    )


def intersect_lines(lines: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the lines that lines have in common with others, areas or lines; or areas with lines.

    Where areas touch, or lines cross, they have none.
    """
    return steps.overlay_pairs(
        shapely.intersection, _intersect_carefully, LINE, lines, others, grid
    )


def intersect_shapes(shapes: Shapes, others: Shapes) -> Answer:
    """Return what shapes have in common with others: areas, or lines or points where they touch."""
    return steps.overlay_pairs(
        shapely.intersection, _intersect_carefully, ANY, shapes, others, None
    )


def cross_lines(lines: Shapes, others: Shapes) -> Answer:
    """Return the points where lines cross others.

    >>> one, other = shapely.from_wkt(["LINESTRING (0 0, 2 2)", "LINESTRING (0 2, 2 0)"])
    >>> cross_lines(one, other).wkt
    'POINT (1 1)'
    """
    return steps.overlay_pairs(
        shapely.intersection, _intersect_carefully, POINT, lines, others, None
    )


def buffer_shapes(
    shapes: Shapes, by: float | Array, *, quad_segs: int = 16, **style: Any
) -> Answer:
    """Return the areas within a distance of shapes, or of areas what is as far from their edges.

    Parameters
    ----------
    by : float or (n,) float
        In the units of the coordinates; negative for what is left within areas.
    quad_segs : int
        Straight pieces that a quarter of a round corner is made of.
    **style
        `cap_style` and `join_style`, as for `shapely.buffer`.

    Examples
    --------
    >>> float(buffer_shapes(shapely.box(0, 0, 2, 1), -0.25).area)
    0.75
    """

    def buffer(*geometry: Any) -> Answer:
        return shapely.buffer(*geometry, quad_segs=quad_segs, **style)

    return steps.change_each(buffer, AREA, shapes, by)


def simplify_shapes(shapes: Shapes, tolerance: float) -> Answer:
    """Return shapes without the corners that bend them by no more than a tolerance."""
    return steps.change_each(shapely.simplify, ANY, shapes, tolerance)


def repair_areas(areas: Shapes, **options: Any) -> Answer:
    """Return valid areas of what may cross itself; options as for `shapely.make_valid`."""

    def repair(geometry: Any) -> Answer:
        return steps.repair_shapes(geometry, **options)

    return steps.change_each(repair, AREA, areas)


def round_shape(shape: BaseGeometry, digits: int) -> BaseGeometry:
    """Return a shape rounded to so many digits, an area that then crosses itself parted.

    >>> pinched = shapely.Polygon([(0, 0), (1, 0), (1, 1), (2, 2), (0, 2), (1 - 1e-9, 1)])
    >>> round_shape(pinched, 4).is_valid
    True
    """
    # + 0.0 turns a negative zero into zero
    rounded = shapely.transform(shape, lambda xy_m: np.round(xy_m, digits) + 0.0)
    if shapely.get_dimensions(rounded) != AREA or shapely.is_valid(rounded):
        return rounded
    return repair_areas(rounded, method="structure", keep_collapsed=False)


def merge_lines(lines: Shapes) -> Answer:
    """Return lines that end at one another as one."""
    return steps.change_each(shapely.line_merge, LINE, lines)


def enclose_areas(lines: Shapes) -> Array:
    """Return the areas (n,) that lines enclose, which meet at their ends only.

    >>> [float(area.area) for area in enclose_areas([shapely.box(0, 0, 2, 1).exterior])]
    [2.0]
    """
    return shapely.get_parts(steps.change_each(shapely.polygonize, ANY, lines))


def clip_areas(areas: Shapes, low_x: float, low_y: float, high_x: float, high_y: float) -> Answer:
    """Return what lies in a box of areas.

    >>> float(clip_areas(shapely.box(0, 0, 2, 2), 1, 1, 5, 5).area)
    1.0
    """
    return steps.change_each(shapely.clip_by_rect, AREA, areas, low_x, low_y, high_x, high_y)


def _unite(shapes: Shapes, grid: float | None, dimension: int) -> Answer:
    listed = list(np.ravel(np.asarray(shapes, object)))

    def unite(*geometries: BaseGeometry, grid_size: float | None) -> Answer:
        return shapely.union_all(geometries, grid_size=grid_size)

    return steps.overlay_one(unite, _unite_carefully, dimension, listed, grid)


def _unite_carefully(
    shapes: Sequence[BaseGeometry], grid: float | None, dimension: int
) -> BaseGeometry:
    wanted = (AREA, LINE, POINT) if dimension == ANY else (dimension,)
    united = [
        shapely.union_all([steps.parts_of(shape, of) for shape in shapes], grid_size=grid)
        for of in wanted
    ]
    return shapely.geometrycollections(united) if dimension == ANY else united[0]


def _subtract_carefully(
    shapes: Sequence[BaseGeometry], grid: float | None, dimension: int
) -> BaseGeometry:
    shape, other = shapes
    left = steps.parts_of(shape, dimension)
    for of in range(AREA, dimension - 1, -1):
        taken = steps.parts_of(other, of)
        left = steps.keep_dimension(shapely.difference(left, taken, grid_size=grid), dimension)
    return left


def _intersect_carefully(
    shapes: Sequence[BaseGeometry], grid: float | None, dimension: int
) -> BaseGeometry:
    """Return what two shapes have in common, each dimension of the one with each of the other's."""
    shape, other = shapes
    common = [
        shapely.intersection(steps.parts_of(shape, one), steps.parts_of(other, of), grid_size=grid)
        for one in (POINT, LINE, AREA)
        for of in (POINT, LINE, AREA)
        if dimension == ANY or min(one, of) == max(dimension, LINE)
    ]
    if dimension == ANY:
        parts = [part for of_two in common for part in shapely.get_parts(of_two)]
        return shapely.geometrycollections([part for part in parts if not part.is_empty])
    return shapely.union_all(
        [steps.keep_dimension(part, dimension) for part in common], grid_size=grid
    )
