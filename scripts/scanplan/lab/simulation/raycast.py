"""Rays in a mesh, cast with Open3D (Embree)."""

from dataclasses import dataclass

import numpy as np
import open3d as o3d

from scanplan.lab.buildings.extrusion import SURFACES

_REFLECTIVITY = {
    "wall": 80.0,
    "floor": 30.0,
    "ceiling": 90.0,
    "furniture": 50.0,
    "glass": 10.0,
    "door": 60.0,
}
_UNKNOWN_REFLECTIVITY = 50.0


@dataclass(frozen=True)
class RayHits:
    """What rays meet first; infinite range where it is nothing.

    Attributes
    ----------
    range_m : (n,) float32
    cosine : (n,) float32
        Of the angle between ray and surface normal, 0 to 1; undefined where nothing is hit.
    reflectivity : (n,) float32
        As Velodyne calibrates it, 0 to 100 for diffuse surfaces; undefined where nothing is hit.
    """

    range_m: np.ndarray
    cosine: np.ndarray
    reflectivity: np.ndarray


class RayScene:
    """A mesh, ready to be hit; its panes of glass apart from what is opaque.

    Parameters
    ----------
    mesh : extrusion.Mesh
        Triangles whose surface is called `glass` are panes.
    """

    def __init__(self, mesh):
        # Embree works in float32: near its own origin the mesh keeps micrometres wherever the map's origin is
        self._centre_m = mesh.vertices_m.mean(axis=0)
        vertices_m = np.ascontiguousarray(mesh.vertices_m - self._centre_m, np.float32)
        is_glass = (np.array(SURFACES) == "glass")[mesh.surface]
        reflectivity = np.array(
            [_REFLECTIVITY.get(name, _UNKNOWN_REFLECTIVITY) for name in SURFACES], np.float32
        )
        self._opaque, self._glass = (
            _Layer(vertices_m, mesh.triangles[chosen], reflectivity[mesh.surface[chosen]])
            if chosen.any()
            else None
            for chosen in (~is_glass, is_glass)
        )

    def first_hits(self, origin_m, direction):
        """Find what rays meet first, and which panes they come to before that.

        Parameters
        ----------
        origin_m : (c, 3) float
            Where each column of rays starts, map frame.
        direction : (c, b, 3) float32
            Unit vectors, map frame.

        Returns
        -------
        opaque : Hits
            The first surface that is no glass, for all rays, flat (c * b,).
        pane : Hits or None
            The first pane, wherever it is; None if the mesh has none.
        """
        rays = np.empty((*direction.shape[:2], 6), np.float32)
        rays[..., :3] = (np.asarray(origin_m) - self._centre_m)[:, None]
        rays[..., 3:] = direction
        rays = rays.reshape(-1, 6)
        opaque = (
            self._opaque.hits(rays)
            if self._opaque
            else RayHits(*np.full((3, len(rays)), np.inf, np.float32))
        )
        return opaque, self._glass.hits(rays) if self._glass else None


class _Layer:
    """Triangles with the reflectivity of each."""

    def __init__(self, vertices_m, triangles, reflectivity):
        self._reflectivity = reflectivity
        self._scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        triangles = np.ascontiguousarray(triangles, np.uint32)
        self._scene.add_triangles(
            o3d.core.Tensor.from_numpy(vertices_m), o3d.core.Tensor.from_numpy(triangles)
        )

    def hits(self, rays):
        found = self._scene.cast_rays(o3d.core.Tensor.from_numpy(rays), nthreads=1)
        cosine = np.abs(np.einsum("ij,ij->i", found["primitive_normals"].numpy(), rays[:, 3:]))
        # the row that Open3D gives a miss is no row
        row = np.minimum(found["primitive_ids"].numpy(), len(self._reflectivity) - 1)
        return RayHits(found["t_hit"].numpy(), cosine, self._reflectivity[row])
