"""How `overlays` asks GEOS, and what is done where GEOS raises or loses a part.

A shape is a geometry, `shapes` are several or an array; `dimension` is what of an answer is wanted.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.fallbacks import note_fallbacks
from scanplan.geometry.tolerances import ROUNDING, SAME_M, SHORTEST_M, SMALLEST_M2
from scanplan.types import Array, BoolArray

Shapes = BaseGeometry | Array | Sequence[Any]
Answer = Any
"""A geometry, or an array of them, as what was asked for; untyped, as shapely is."""
Overlay = Callable[..., Answer]
Careful = Callable[[Sequence[BaseGeometry], float | None, int], BaseGeometry]
"""Overlays valid shapes of any dimensions on a grid, so that no mixture of dimensions is asked."""

POINT = 0
LINE = 1
AREA = 2
ANY = -1
"""Dimensions; `ANY` is whatever comes."""

_EMPTY = {
    POINT: shapely.MultiPoint(),
    LINE: shapely.MultiLineString(),
    AREA: shapely.MultiPolygon(),
}
_MULTI = {
    POINT: shapely.multipoints,
    LINE: shapely.multilinestrings,
    AREA: shapely.multipolygons,
}
# by type of geometry: the dimension that it is of, of collections none
_DIMENSIONS = np.array([POINT, LINE, LINE, AREA, POINT, LINE, AREA, ANY])
_COLLECTIONS = 4  # types of geometry from this on have parts
# each a thousand times as coarse: what is still inconsistent there is far larger than rounding
_GRIDS = (ROUNDING, SAME_M, SHORTEST_M)
# ten overlays of one sum may err by so much, and it still adds up
_DOUBT_M2 = SMALLEST_M2 / 10
# of the 53 binary digits of a number the last ones are left for what is reckoned with it
_DIGITS = 46
# GEOS divides by what underflows, numpy would warn, and what comes of it is looked at
_without_warnings = np.errstate(all="ignore")


@_without_warnings
def overlay_pairs(
    function: Overlay,
    carefully: Careful,
    dimension: int,
    shapes: Shapes,
    others: Shapes,
    grid: float | None,
) -> Answer:
    """Overlay each shape with its other: all at once, or if one goes wrong one after the other."""
    try:
        found = keep_dimension(function(shapes, others, grid_size=grid), dimension)
        if not np.any(_is_doubtful(function, dimension, (shapes, others), grid, found)):
            return found
    except shapely.GEOSException:
        pass
    pairs = np.broadcast(np.asarray(shapes, object), np.asarray(others, object))
    each = (overlay_one(function, carefully, dimension, pair, grid) for pair in pairs)
    return _gather(each, pairs.shape)


@_without_warnings
def overlay_one(
    function: Overlay,
    carefully: Careful,
    dimension: int,
    shapes: Sequence[BaseGeometry],
    grid: float | None,
) -> BaseGeometry:
    """Overlay shapes with one another; see `overlay_pairs`."""
    try:
        found = keep_dimension(function(*shapes, grid_size=grid), dimension)
        if not _is_doubtful(function, dimension, shapes, grid, found):
            return found
        grid = _finest_grid(shapes)
    except shapely.GEOSException:
        pass
    return _fall_back(carefully, dimension, shapes, grid)


@_without_warnings
def change_each(function: Overlay, dimension: int, shapes: Shapes, *values: Any) -> Answer:
    """Return `function(shape, *values)` of each shape by itself."""
    try:
        return keep_dimension(function(shapes, *values), dimension)
    except shapely.GEOSException:
        pass
    each = np.broadcast(np.asarray(shapes, object), *values)

    def change_one(shape: BaseGeometry, *own: Any) -> BaseGeometry:
        def carefully(fit: Sequence[BaseGeometry], grid: float | None, _: int) -> BaseGeometry:
            return function(fit[0] if grid is None else round_shape(fit[0], grid), *own)

        try:
            return keep_dimension(function(shape, *own), dimension)
        except shapely.GEOSException:
            return _fall_back(carefully, dimension, [shape], None)

    return _gather((change_one(*one) for one in each), each.shape)


def keep_dimension(found: Answer, dimension: int) -> Answer:
    """Return of each geometry what is of a dimension; all of it where none is asked for."""
    if dimension == ANY or found is None:
        return found
    of = _DIMENSIONS[shapely.get_type_id(found)]
    if np.all(of == dimension):
        return found
    if isinstance(found, BaseGeometry):
        return parts_of(found, dimension)
    found = found.copy()
    wrong = (of != dimension) & ~shapely.is_missing(found)
    found[wrong] = _gather([parts_of(one, dimension) for one in found[wrong]], (wrong.sum(),))
    return found


def parts_of(shape: BaseGeometry, dimension: int) -> BaseGeometry:
    """Return what of a geometry, which may be a nested collection, is of a dimension."""
    own = [part for part in _leaves(shape) if shapely.get_dimensions(part) == dimension]
    if len(own) == 1:
        return own[0]
    together = _MULTI[dimension](own) if own else _EMPTY[dimension]
    # what was collected may overlap
    return together if shapely.is_valid(together) else shapely.union_all(own)


def repair_shapes(shapes: Shapes, **options: Any) -> Answer:
    """Return valid shapes; options as for `shapely.make_valid`."""
    repaired = np.asarray(shapely.make_valid(shapes, **options), object)
    is_valid = shapely.is_valid(repaired)
    if not np.all(is_valid):
        # of slivers that cross one another GEOS makes holes outside of their shells
        by_rings = shapely.make_valid(shapes, method="structure", keep_collapsed=False)
        repaired = np.where(is_valid, repaired, np.asarray(by_rings, object))
    return repaired[()]


def round_shape(shape: BaseGeometry, grid: float) -> BaseGeometry:
    """Return a valid shape with its corners on a grid."""
    return repair_shapes(shapely.set_precision(shape, grid, mode="pointwise"))


def _is_doubtful(
    function: Overlay,
    dimension: int,
    shapes: Sequence[Shapes],
    grid: float | None,
    found: Answer,
) -> BoolArray | bool:
    """Return which areas differ from what rounded corners give, which is where GEOS lost a part.

    Beside edges that are common but for rounding it may take the inside of a part for its outside,
    and says nothing. Corners on a grid, however fine, are overlaid another way, and areas depend
    steadily on them, as lengths along edges do not.
    """
    if grid is not None or dimension in (POINT, LINE):
        return False
    try:
        rounded = function(*shapes, grid_size=_finest_grid(shapes))
    except shapely.GEOSException:
        return not all(np.all(shapely.is_valid(of)) for of in shapes)
    area: Answer = shapely.area(found)
    of_rounded = shapely.area(rounded)
    is_off = np.abs(area - of_rounded) > _DOUBT_M2 + ROUNDING * area
    if np.any(is_off) and all(np.all(shapely.is_valid(of)) for of in shapes):
        # beside slivers it is the rounded answer that may be lost
        is_off &= _can_be(function, shapes, of_rounded) | ~_can_be(function, shapes, area)
    return is_off


def _can_be(function: Overlay, shapes: Sequence[Shapes], area: Answer) -> Answer:
    """Return which areas are neither more nor less than valid shapes can have left."""
    areas: Sequence[Answer] = np.broadcast_arrays(*[shapely.area(of) for of in shapes])
    if function is shapely.intersection:
        least, most = 0.0, np.minimum(*areas)
    elif function is shapely.difference:
        least, most = areas[0] - areas[1], areas[0]
    else:
        least, most = np.max(areas, axis=0), np.sum(areas, axis=0)
    off = _DOUBT_M2 + ROUNDING * most
    return (least - off <= area) & (area <= most + off)


def _finest_grid(shapes: Sequence[Shapes]) -> float:
    """Return the finest grid that numbers as large as the shapes' corners can be rounded to."""
    bounds = [np.ravel(shapely.bounds(of)) for of in shapes]
    farthest = float(np.fmax.reduce(np.abs(np.concatenate([[1.0], *bounds]))))
    # a power of two: what is rounded to it stays exact
    return 2.0 ** (math.ceil(math.log2(farthest)) - _DIGITS)


def _fall_back(
    carefully: Careful, dimension: int, shapes: Sequence[BaseGeometry], grid: float | None
) -> BaseGeometry:
    """Repair shapes and overlay them, at ever coarser grids, until GEOS does not raise."""
    note_fallbacks()
    coarser = [step for step in _GRIDS if grid is None or step > grid]
    for step in (grid, *coarser[:-1]):
        try:
            repaired = [repair_shapes(shape) for shape in shapes]
            return keep_dimension(carefully(repaired, step, dimension), dimension)
        except shapely.GEOSException:
            continue
    rounded = [round_shape(shape, _GRIDS[-1]) for shape in shapes]
    return keep_dimension(carefully(rounded, _GRIDS[-1], dimension), dimension)


def _gather(found: Iterable[BaseGeometry], shape: tuple[int, ...]) -> Answer:
    array = np.empty(shape, object)
    for place, one in zip(np.ndindex(shape), found, strict=True):
        array[place] = one
    return array[()] if shape == () else array


def _leaves(shape: BaseGeometry) -> Iterator[BaseGeometry]:
    """Yield the single points, lines and polygons that a geometry is made of."""
    for part in shapely.get_parts(shape):
        if shapely.get_type_id(part) >= _COLLECTIONS:
            yield from _leaves(part)
        elif not part.is_empty:
            yield part
