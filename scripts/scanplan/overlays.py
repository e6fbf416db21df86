"""Polygons made fit for overlays, and overlays that rounding cannot stop."""

import numpy as np
import shapely

_GRID_M = 1e-6
_DUST_M = 1e-15
_WORTH_THREADS = 32


def near_origin(polygons):
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
    array[:] = [_polygonal(p) for p in shapely.transform(array, lambda xy: _without_dust(xy - centre))]
    return array


def difference(polygons, others, threads=None):
    """Subtract (n,) others from (n,) polygons, each from its own, on the threads of an executor if one is given.

    Where rounding makes an overlay inconsistent it is done again with all corners on a grid of a micrometre.
    """
    if threads is None or len(polygons) < _WORTH_THREADS:
        return _each(shapely.difference, polygons, others)
    shares = [np.array_split(side, len(polygons) // (_WORTH_THREADS // 2)) for side in (polygons, others)]
    return np.concatenate(list(threads.map(_each, [shapely.difference] * len(shares[0]), *shares)))


def intersection(polygons, others):
    """Intersect (n,) polygons with (n,) others, without points and lines where they only touch; see `difference`."""
    return np.array([_polygonal(p) for p in _each(shapely.intersection, polygons, others)], object)


def union(polygons):
    """Unite (n,) polygons; see `difference`."""
    try:
        return shapely.union_all(polygons)
    except shapely.GEOSException:
        return shapely.union_all(shapely.make_valid(polygons), grid_size=_GRID_M)


def _each(function, polygons, others):
    try:
        return function(polygons, others)
    except shapely.GEOSException:
        return np.array([_one(function, *pair) for pair in zip(polygons, others, strict=True)], object)


def _one(function, polygon, other):
    try:
        return function(polygon, other)
    except shapely.GEOSException:
        return function(shapely.make_valid(polygon), shapely.make_valid(other), grid_size=_GRID_M)


def _without_dust(xy_m):
    """Set numbers near 0 to 0: products of the very smallest underflow, and overlays and predicates go wrong."""
    return np.where(np.abs(xy_m) < _DUST_M, 0.0, xy_m)


def _polygonal(geometry):
    """Reduce a geometry to a valid Polygon or MultiPolygon of the same area."""
    if isinstance(geometry, shapely.Polygon | shapely.MultiPolygon) and geometry.is_valid:
        return geometry
    members = shapely.get_parts(shapely.get_parts(shapely.make_valid(geometry)))
    return shapely.union_all(members[shapely.get_dimensions(members) == 2])
