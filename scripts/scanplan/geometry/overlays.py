"""All overlays: unions, differences, intersections, buffers and repairs that never raise.

Nothing else calls those of shapely. The name of a function says what it returns: areas (Polygon or
MultiPolygon), lines (LineString or MultiLineString), points, or shapes as they were given; what
else an overlay leaves, as a line where two areas touch, is dropped. Shapes are one geometry or an
array, as in shapely, and a grid is the distance that corners are rounded to, in the units of the
coordinates.

GEOS raises where rounding contradicts itself. Then shapes are repaired, divided by dimension and
rounded to ever coarser grids until it answers; `count_fallbacks` says how often that was.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.tolerances import ROUNDING, SAME_M, SHORTEST_M
from scanplan.types import Array

Shapes = BaseGeometry | Array | Sequence[Any]
Answer = Any
"""A geometry, or an array of them, as what was asked for; untyped, as shapely is."""

_LINE = 1
_AREA = 2
_ANY = -1
_EMPTY = {0: shapely.MultiPoint(), _LINE: shapely.MultiLineString(), _AREA: shapely.MultiPolygon()}
_MULTI = {0: shapely.multipoints, _LINE: shapely.multilinestrings, _AREA: shapely.multipolygons}
# by type of geometry: the dimension that it is of, -1 for collections
_DIMENSIONS = np.array([0, _LINE, _LINE, _AREA, 0, _LINE, _AREA, -1])
# each a thousand times as coarse: what is still inconsistent there is far larger than rounding
_GRIDS = (ROUNDING, SAME_M, SHORTEST_M)

_n_fallbacks = 0


def count_fallbacks() -> int:
    """Return how often GEOS raised in this process, and an overlay was done another way."""
    return _n_fallbacks


def unite_areas(areas: Shapes, grid: float | None = None) -> Answer:
    """Return the union of all areas (n,)."""
    return _unite(areas, grid, _AREA)


def unite_lines(lines: Shapes, grid: float | None = None) -> Answer:
    """Return the union of all lines (n,), parted where they cross."""
    return _unite(lines, grid, _LINE)


def unite_shapes(shapes: Shapes, grid: float | None = None) -> Answer:
    """Return the union of shapes (n,) of any dimensions, a collection if they are several."""
    return _unite(shapes, grid, _ANY)


def unite_each(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the union of each area with its other."""
    return _overlay(shapely.union, _unite_pair, _AREA, areas, others, grid)


def subtract_areas(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return what others leave of areas, each of its own."""
    return _overlay(shapely.difference, _subtract, _AREA, areas, others, grid)


def subtract_lines(lines: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return what others, areas or lines, leave of lines, each of its own."""
    return _overlay(shapely.difference, _subtract, _LINE, lines, others, grid)


def intersect_areas(areas: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the areas that areas have in common with others."""
    return _overlay(shapely.intersection, _intersect, _AREA, areas, others, grid)


def intersect_lines(lines: Shapes, others: Shapes, grid: float | None = None) -> Answer:
    """Return the lines that lines have in common with others, areas or lines; or areas with lines.

    Where areas touch, or lines cross, they have none.
    """
    return _overlay(shapely.intersection, _intersect, _LINE, lines, others, grid)


def intersect_shapes(shapes: Shapes, others: Shapes) -> Answer:
    """Return what shapes have in common with others: areas, or lines or points where they touch."""
    return _overlay(shapely.intersection, _intersect, _ANY, shapes, others, None)


def cross_lines(lines: Shapes, others: Shapes) -> Answer:
    """Return the points where lines cross others."""
    return _overlay(shapely.intersection, _intersect, 0, lines, others, None)


def buffer_shapes(
    shapes: Shapes, by: float | Array, *, quad_segs: int = 16, **style: Any
) -> Answer:
    """Return the areas within a distance of shapes, or of areas what is as far from their edges.

    Parameters
    ----------
    shapes : geometry or array
    by : float or (n,) float
        In the units of the coordinates; negative for what is left within areas.
    quad_segs : int
        Straight pieces that a quarter of a round corner is made of.
    **style
        `cap_style` and `join_style`, as for `shapely.buffer`.
    """

    def buffer(*geometry: Any) -> Answer:
        return shapely.buffer(*geometry, quad_segs=quad_segs, **style)

    return _unary(buffer, _AREA, shapes, by)


def simplify_shapes(shapes: Shapes, tolerance: float) -> Answer:
    """Return shapes without the corners that bend them by no more than a tolerance."""
    return _unary(shapely.simplify, _ANY, shapes, tolerance)


def repair_areas(areas: Shapes, **options: Any) -> Answer:
    """Return valid areas of what may cross itself; options as for `shapely.make_valid`."""

    def repair(geometry: Any) -> Answer:
        return shapely.make_valid(geometry, **options)

    return _unary(repair, _AREA, areas)


def merge_lines(lines: Shapes) -> Answer:
    """Return lines that end at one another as one."""
    return _unary(shapely.line_merge, _LINE, lines)


def enclose_areas(lines: Shapes) -> Array:
    """Return the areas (n,) that lines enclose, which meet at their ends only."""
    return shapely.get_parts(_unary(shapely.polygonize, _ANY, lines))


def clip_areas(areas: Shapes, low_x: float, low_y: float, high_x: float, high_y: float) -> Answer:
    """Return what lies in a box of areas."""
    return _unary(shapely.clip_by_rect, _AREA, areas, low_x, low_y, high_x, high_y)


def _unite(shapes: Shapes, grid: float | None, dimension: int) -> Answer:
    try:
        return _keep(shapely.union_all(shapes, grid_size=grid), dimension)
    except shapely.GEOSException:
        return _fall_back(
            _unite_all, dimension, list(np.ravel(np.asarray(shapes, object))), grid=grid
        )


def _overlay(
    function: Callable[..., Answer],
    carefully: Callable[..., BaseGeometry],
    dimension: int,
    shapes: Shapes,
    others: Shapes,
    grid: float | None,
) -> Answer:
    try:
        return _keep(function(shapes, others, grid_size=grid), dimension)
    except shapely.GEOSException:
        pass
    pairs = np.broadcast(np.asarray(shapes, object), np.asarray(others, object))

    def overlay_one(shape: BaseGeometry, other: BaseGeometry) -> BaseGeometry:
        try:
            return _keep(function(shape, other, grid_size=grid), dimension)
        except shapely.GEOSException:
            return _fall_back(carefully, dimension, [shape, other], grid=grid)

    return _gather([overlay_one(*pair) for pair in pairs], pairs.shape)


def _unary(function: Callable[..., Answer], dimension: int, shapes: Shapes, *values: Any) -> Answer:
    try:
        return _keep(function(shapes, *values), dimension)
    except shapely.GEOSException:
        pass
    each = np.broadcast(np.asarray(shapes, object), *values)

    def change_one(shape: BaseGeometry, *own: Any) -> BaseGeometry:
        def carefully(shapes: list[BaseGeometry], _grid: float | None, _dimension: Any) -> Answer:
            return function(shapes[0], *own)

        try:
            return _keep(function(shape, *own), dimension)
        except shapely.GEOSException:
            return _fall_back(carefully, dimension, [shape], grid=None)

    return _gather([change_one(*one) for one in each], each.shape)


def _gather(found: Iterable[BaseGeometry], shape: tuple[int, ...]) -> Answer:
    array = np.empty(shape, object)
    for place, one in zip(np.ndindex(shape), found, strict=True):
        array[place] = one
    return array[()] if shape == () else array


def _keep(found: Answer, dimension: int) -> Answer:
    """Return of each geometry what is of a dimension; all of it where none is asked for."""
    if dimension is _ANY:
        return found
    of = _DIMENSIONS[shapely.get_type_id(found)]
    if np.all(of == dimension):
        return found
    if isinstance(found, BaseGeometry):
        return _parts_of(found, dimension)
    found = found.copy()
    wrong = (of != dimension) & ~shapely.is_missing(found)
    found[wrong] = _gather([_parts_of(one, dimension) for one in found[wrong]], (wrong.sum(),))
    return found


def _parts_of(shape: BaseGeometry, dimension: int) -> BaseGeometry:
    """Return what of a geometry, which may be a nested collection, is of a dimension."""
    own = [part for part in _leaves(shape) if shapely.get_dimensions(part) == dimension]
    if len(own) == 1:
        return own[0]
    together = _MULTI[dimension](own) if own else _EMPTY[dimension]
    # what was collected may overlap
    return together if shapely.is_valid(together) else shapely.union_all(own)


def _leaves(shape: BaseGeometry) -> Iterator[BaseGeometry]:
    for part in shapely.get_parts(shape):
        if shapely.get_type_id(part) > 3:
            yield from _leaves(part)
        elif not part.is_empty:
            yield part


def _fall_back(
    carefully: Callable[..., BaseGeometry],
    dimension: int,
    shapes: list[BaseGeometry],
    *,
    grid: float | None,
) -> BaseGeometry:
    """Repair shapes and overlay them, at ever coarser grids, until GEOS does not raise."""
    global _n_fallbacks
    _n_fallbacks += 1
    coarser = [step for step in _GRIDS if grid is None or step > grid]
    for step in (grid, *coarser):
        try:
            repaired = [shapely.make_valid(shape) for shape in shapes]
            return _keep(carefully(repaired, step, dimension), dimension)
        except shapely.GEOSException:
            if step == coarser[-1]:
                raise
    raise AssertionError("unreachable")


def _unite_all(shapes: list[BaseGeometry], grid: float | None, dimension: int) -> Answer:
    wanted = (_AREA, _LINE, 0) if dimension is _ANY else (dimension,)
    united = [
        shapely.union_all([_parts_of(shape, of) for shape in shapes], grid_size=grid)
        for of in wanted
    ]
    return shapely.geometrycollections(united) if dimension is _ANY else united[0]


def _unite_pair(shapes: list[BaseGeometry], grid: float | None, dimension: int) -> Answer:
    return shapely.union(*(_parts_of(shape, dimension) for shape in shapes), grid_size=grid)


def _subtract(shapes: list[BaseGeometry], grid: float | None, dimension: int) -> Answer:
    shape, other = shapes
    left = _parts_of(shape, dimension)
    for of in range(_AREA, dimension - 1, -1):
        left = _keep(shapely.difference(left, _parts_of(other, of), grid_size=grid), dimension)
    return left


def _intersect(shapes: list[BaseGeometry], grid: float | None, dimension: int) -> Answer:
    """Return what two shapes have in common, each dimension of the one with each of the other's."""
    shape, other = shapes
    dimensions = [(one, of) for one in (1, 2) for of in (1, 2) if min(one, of) == max(dimension, 1)]
    common = [
        shapely.intersection(_parts_of(shape, one), _parts_of(other, of), grid_size=grid)
        for one, of in dimensions
    ]
    return shapely.union_all([_keep(part, dimension) for part in common], grid_size=grid)
