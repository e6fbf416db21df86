"""Closed surfaces of slabs, and of solids between levels and slopes, as triangles."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings.details.things import Plane
from scanplan.types import FloatArray

Band = tuple[float, float, BaseGeometry]
"""Lower edge, upper edge and section of a slab."""


def extrude_bands(bands: Sequence[Band]) -> FloatArray:
    """Return the closed surface of slabs stacked without gaps.

    Parameters
    ----------
    bands : sequence of (float, float, Polygon or MultiPolygon)
        Lower edge, upper edge (the next one's lower edge), section.

    Returns
    -------
    (t, 3, 3) float64
        Corners of the triangles, normals outwards.
    """
    surfaces = [_sides(section, low_m, high_m) for low_m, high_m, section in bands]
    sections = [section for _, _, section in bands]
    levels_m = [bands[0][0], *(high_m for _, high_m, _ in bands)]
    below = [Polygon(), *sections]
    above = [*sections, Polygon()]
    for z_m, under, over in zip(levels_m, below, above, strict=True):
        tops = overlays.subtract_areas(under, over, grid=SAME_M)
        undersides = overlays.subtract_areas(over, under, grid=SAME_M)
        surfaces.append(triangulate(tops, z_m, up=True))
        surfaces.append(triangulate(undersides, z_m, up=False))
    return np.concatenate(surfaces)


def extrude_under(section: BaseGeometry, underside: Plane, top_m: float) -> FloatArray:
    """Return the closed surface (t, 3, 3) of the solid from a slope up to a level.

    Triangles without area, where the slope meets the level, are left out.
    """
    surfaces = [
        triangulate(section, underside, up=False),
        _sides(section, underside, top_m),
        triangulate(section, top_m, up=True),
    ]
    corners_m = np.concatenate(surfaces)
    normal = np.cross(corners_m[:, 1] - corners_m[:, 0], corners_m[:, 2] - corners_m[:, 0])
    return corners_m[np.linalg.norm(normal, axis=1) > SAME_M**2]


def line_shaft(section: BaseGeometry, depth_m: float) -> FloatArray:
    """Return the walls (t, 3, 3) of a shaft from z = 0 down, which face into it."""
    return _sides(section, -depth_m, 0.0)[:, ::-1]


def triangulate(polygons: BaseGeometry, level: float | Plane, *, up: bool) -> FloatArray:
    """Return triangles (t, 3, 3) of a plane surface that faces up or down.

    Lines and points that an overlay left are no surface.
    """
    parts = [p for p in shapely.get_parts(polygons) if p.geom_type == "Polygon" and not p.is_empty]
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(parts)) if parts else []
    pieces = shapely.orient_polygons(pieces, exterior_cw=not up)
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    return _raise_to(corners.reshape(-1, 2), level).reshape(-1, 3, 3)


def _sides(section: BaseGeometry, low: float | Plane, high: float) -> FloatArray:
    """Return two triangles for every edge of a section."""
    rings = shapely.get_rings(shapely.get_parts(shapely.orient_polygons(section)))
    edges = [np.hstack([xy[:-1], xy[1:]]) for xy in map(shapely.get_coordinates, rings)]
    a, b = np.split(np.concatenate([np.empty((0, 4)), *edges]), 2, axis=1)
    a_low = _raise_to(a, low)
    b_low = _raise_to(b, low)
    b_high = _raise_to(b, high)
    a_high = _raise_to(a, high)
    return np.concatenate(
        [np.stack([a_low, b_low, b_high], 1), np.stack([a_low, b_high, a_high], 1)]
    )


def _raise_to(xy_m: FloatArray, level: float | Plane) -> FloatArray:
    z_m = level.heights(xy_m) if isinstance(level, Plane) else np.full(len(xy_m), level)
    return np.column_stack([xy_m, z_m])
