"""Polygons: their sides, their order, and how they are made fit for overlays."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import Array

Polygons = Sequence[BaseGeometry] | Array

_POLYGONAL = (shapely.GeometryType.POLYGON, shapely.GeometryType.MULTIPOLYGON)


def rectangle_sides_m(shape: BaseGeometry) -> tuple[float, float]:
    """Return the shorter and the longer side of the least rectangle around a shape.

    >>> rectangle_sides_m(shapely.box(0, 0, 3, 2))
    (2.0, 3.0)
    """
    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shape))
    if len(box) < 3:
        return 0.0, 0.0
    one_m, other_m = np.hypot(*(box[1:3] - box[:2]).T).tolist()
    return min(one_m, other_m), max(one_m, other_m)


def long_axis_m(shape: BaseGeometry) -> Array:
    """Return the longer middle line (2, 2) of the least rectangle around a shape.

    >>> long_axis_m(shapely.box(0, 0, 4, 2))[:, 1].tolist()
    [1.0, 1.0]
    """
    corners_m = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shape))[:4]
    one_m, other_m = np.hypot(*(corners_m[1:3] - corners_m[:2]).T)
    sides = corners_m if one_m < other_m else np.roll(corners_m, -1, axis=0)
    return np.array([sides[:2].mean(axis=0), sides[2:].mean(axis=0)])


def largest_first(polygon: BaseGeometry) -> tuple[float, ...]:
    """Return what polygons are sorted by: the largest first, those of one size by their place."""
    return (-polygon.area, *polygon.bounds)


def move_near_origin(polygons: Polygons) -> Array:
    """Check and repair polygons, and move them near the origin: far from it, areas lose digits.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        Metres. Empty ones, points and lines have no area; invalid ones are repaired.

    Returns
    -------
    (n,) numpy.ndarray of shapely Polygon or MultiPolygon
        All moved by the same whole number of metres.

    Raises
    ------
    ValueError
        If a geometry is missing or a coordinate is not finite.
    """
    array = np.empty(len(polygons), object)
    array[:] = polygons
    xy_m = shapely.get_coordinates(array)
    if shapely.is_missing(array).any() or not np.isfinite(xy_m).all():
        raise ValueError("every polygon must be there, with finite coordinates")
    centre = np.floor(xy_m.mean(axis=0)) if len(xy_m) else 0.0
    return _polygonal(shapely.transform(array, lambda xy: _without_dust(xy - centre)))


def _without_dust(xy_m: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Set numbers near 0 to 0: products of the smallest underflow, and overlays go wrong."""
    return np.where(np.abs(xy_m) < ROUNDING, 0.0, xy_m)


def _polygonal(geometries: Array) -> Array:
    """Reduce geometries (n,) to valid Polygons or MultiPolygons of the same area."""
    geometries = geometries.copy()
    is_polygon = np.isin(shapely.get_type_id(geometries), _POLYGONAL)
    fit = is_polygon & shapely.is_valid(geometries)
    geometries[~fit] = overlays.repair_areas(geometries[~fit])
    return geometries
