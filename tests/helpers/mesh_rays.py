"""What a ray meets first in a mesh, triangle by triangle (Moeller and Trumbore 1997), literally."""

import numpy as np

from scanplan.lab.buildings import extrusion


def first_hit(mesh, origin_m, direction):
    """Return range and kind of surface of the first triangle that a ray meets; (inf, "") if none.

    Which way triangles face does not matter.
    """
    direction = np.array(direction, float) / np.linalg.norm(direction)
    origin_m = np.array(origin_m, float)
    a, b, c = np.moveaxis(mesh.vertices_m[mesh.triangles], 1, 0)
    across = np.cross(direction, c - a)
    volume = np.einsum("ij,ij->i", across, b - a)
    volume = np.where(np.abs(volume) > 1e-12, volume, np.nan)  # a ray along a triangle meets none
    u = np.einsum("ij,ij->i", origin_m - a, across) / volume
    normal = np.cross(origin_m - a, b - a)
    v = normal @ direction / volume
    range_m = np.einsum("ij,ij->i", normal, c - a) / volume
    # a ray through an edge meets one of its triangles at least
    is_hit = (u > -1e-9) & (v > -1e-9) & (u + v < 1 + 1e-9) & (range_m > 1e-9)
    if not is_hit.any():
        return np.inf, ""
    row = np.flatnonzero(is_hit)[np.argmin(range_m[is_hit])]
    return float(range_m[row]), extrusion.SURFACES[mesh.surface[row]]
