"""From a drawn floor to the triangles that rays hit."""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.lab.buildings import drawn_floor

SURFACES = ("wall", "floor", "ceiling", "furniture", "glass", "door", "other")


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

    vertices_m: np.ndarray
    triangles: np.ndarray
    surface: np.ndarray


def make_building_mesh(plan):
    """Return the mesh of a floor: closed walls with their openings and closed furniture between floor and ceiling.

    Floor and ceiling run through under and above the walls, so that no gap opens where they meet. Windows and doors
    are empty space (thesis, section 4.1).

    Parameters
    ----------
    plan : drawn_floor.DrawnFloor

    Returns
    -------
    Mesh
    """
    ground = drawn_floor.floor_footprint(plan)
    soups = [
        ("wall", extrude_bands(drawn_floor.cut_wall_bands(plan))),
        ("floor", _slab(ground, 0.0, up=True)),
        ("ceiling", _slab(ground, plan.height_m, up=False)),
        *(("furniture", extrude_bands([(0.0, f.height_m, f.footprint_m)])) for f in plan.furniture),
    ]
    return join_meshes(soups)


def join_meshes(soups):
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
    surface = np.repeat(
        [SURFACES.index(name) for name, _ in soups], [len(soup) for _, soup in soups]
    )
    return Mesh(vertices, inverse.reshape(-1, 3).astype(np.int32), surface.astype(np.uint8))


def extrude_bands(bands):
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
    sides = [_sides(section, low, high) for low, high, section in bands]
    nothing = shapely.Polygon()
    below = [nothing, *(section for _, _, section in bands)]
    above = [*(section for _, _, section in bands), nothing]
    levels = [bands[0][0], *(high for _, high, _ in bands)]
    for z_m, under, over in zip(levels, below, above, strict=True):
        sides.append(
            _slab(shapely.difference(under, over, grid_size=drawn_floor.GRID_M), z_m, up=True)
        )
        sides.append(
            _slab(shapely.difference(over, under, grid_size=drawn_floor.GRID_M), z_m, up=False)
        )
    return np.concatenate(sides)


def _sides(section, low_m, high_m):
    """Two triangles for every edge of a section."""
    rings = shapely.get_rings(shapely.get_parts(shapely.orient_polygons(section)))
    edges = [np.hstack([xy[:-1], xy[1:]]) for xy in map(shapely.get_coordinates, rings)]
    a, b = np.split(np.concatenate([np.empty((0, 4)), *edges]), 2, axis=1)
    a_low, b_low, b_high, a_high = (
        _raised(xy, z) for xy, z in ((a, low_m), (b, low_m), (b, high_m), (a, high_m))
    )
    return np.concatenate(
        [np.stack([a_low, b_low, b_high], 1), np.stack([a_low, b_high, a_high], 1)]
    )


def _slab(polygons, z_m, *, up):
    """Triangles of a level surface; lines and points that an overlay left are no surface."""
    parts = [p for p in shapely.get_parts(polygons) if p.geom_type == "Polygon" and not p.is_empty]
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(parts)) if parts else []
    pieces = shapely.orient_polygons(pieces, exterior_cw=not up)
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    return _raised(corners.reshape(-1, 2), z_m).reshape(-1, 3, 3)


def _raised(xy_m, z_m):
    return np.column_stack([xy_m, np.full(len(xy_m), z_m)])
