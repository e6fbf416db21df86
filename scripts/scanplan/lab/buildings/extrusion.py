"""From a drawn floor to the triangles that rays hit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings import drawn_floor
from scanplan.types import FloatArray, IntArray

SURFACES = (
    *("wall", "floor", "ceiling", "furniture", "glass", "door", "other"),
    *("mirror", "polished"),
)

Band = tuple[float, float, BaseGeometry]
"""Lower edge, upper edge and section of a slab."""


@dataclass(frozen=True)
class Mesh:
    """Triangles in the map frame, their normals out of the matter by the right-hand rule.

    Attributes
    ----------
    vertices_m : (v, 3) float64
    triangles : (t, 3) int32
        Rows of `vertices_m`.
    surface : (t,) uint8
        Index in `SURFACES`.
    """

    vertices_m: FloatArray
    triangles: IntArray
    surface: IntArray


def make_building_mesh(plan: drawn_floor.DrawnFloor) -> Mesh:
    """Return the mesh of a floor: closed walls and furniture between floor and ceiling.

    Floor and ceiling run through under and above the walls, so that no gap opens where they meet.
    Windows and doors are empty space (thesis, section 4.1), but for those that are drawn glazed.

    Parameters
    ----------
    plan : drawn_floor.DrawnFloor

    Returns
    -------
    Mesh
    """
    footprint = drawn_floor.floor_footprint(plan)
    soups = [
        ("wall", extrude_bands(drawn_floor.cut_wall_bands(plan))),
        ("floor", _triangulate(footprint, 0.0, up=True)),
        ("ceiling", _triangulate(footprint, plan.height_m, up=False)),
    ]
    for box in plan.furniture:
        soups.append(("furniture", extrude_bands([(0.0, box.height_m, box.footprint_m)])))
    for opening in plan.openings:
        if opening.glazed:
            pane = (opening.sill_m, opening.lintel_m, opening.pane_m)
            soups.append(("glass", extrude_bands([pane])))
    return join_meshes(soups)


def join_meshes(soups: Sequence[tuple[str, FloatArray]]) -> Mesh:
    """Return one mesh of triangles given by the kind of their surface.

    Parameters
    ----------
    soups : sequence of (str, (t, 3, 3) float64)
        One of `SURFACES` and the corners of triangles.

    Returns
    -------
    Mesh
        The triangles in the order given, equal corners stored once.
    """
    corners = np.concatenate([np.empty((0, 3, 3)), *(soup for _, soup in soups)]).reshape(-1, 3)
    vertices, inverse = np.unique(corners, axis=0, return_inverse=True)
    kinds = [SURFACES.index(name) for name, _ in soups]
    surface = np.repeat(kinds, [len(soup) for _, soup in soups])
    return Mesh(vertices, inverse.reshape(-1, 3).astype(np.int32), surface.astype(np.uint8))


def extend_mesh(mesh: Mesh, soups: Sequence[tuple[str, FloatArray]]) -> Mesh:
    """Return a mesh with more triangles, given as `join_meshes` takes them, behind its own."""
    more = join_meshes(soups)
    return Mesh(
        np.concatenate([mesh.vertices_m, more.vertices_m]),
        np.concatenate([mesh.triangles, more.triangles + np.int32(len(mesh.vertices_m))]),
        np.concatenate([mesh.surface, more.surface]),
    )


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
        tops = shapely.difference(under, over, grid_size=SAME_M)
        undersides = shapely.difference(over, under, grid_size=SAME_M)
        surfaces.append(_triangulate(tops, z_m, up=True))
        surfaces.append(_triangulate(undersides, z_m, up=False))
    return np.concatenate(surfaces)


def _sides(section: BaseGeometry, low_m: float, high_m: float) -> FloatArray:
    """Return two triangles for every edge of a section."""
    rings = shapely.get_rings(shapely.get_parts(shapely.orient_polygons(section)))
    edges = [np.hstack([xy[:-1], xy[1:]]) for xy in map(shapely.get_coordinates, rings)]
    a, b = np.split(np.concatenate([np.empty((0, 4)), *edges]), 2, axis=1)
    a_low = _raise_to(a, low_m)
    b_low = _raise_to(b, low_m)
    b_high = _raise_to(b, high_m)
    a_high = _raise_to(a, high_m)
    return np.concatenate(
        [np.stack([a_low, b_low, b_high], 1), np.stack([a_low, b_high, a_high], 1)]
    )


def _triangulate(polygons: BaseGeometry, z_m: float, *, up: bool) -> FloatArray:
    """Return triangles of a level surface; lines and points that an overlay left are no surface."""
    parts = [p for p in shapely.get_parts(polygons) if p.geom_type == "Polygon" and not p.is_empty]
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(parts)) if parts else []
    pieces = shapely.orient_polygons(pieces, exterior_cw=not up)
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    return _raise_to(corners.reshape(-1, 2), z_m).reshape(-1, 3, 3)


def _raise_to(xy_m: FloatArray, z_m: float) -> FloatArray:
    return np.column_stack([xy_m, np.full(len(xy_m), z_m)])
