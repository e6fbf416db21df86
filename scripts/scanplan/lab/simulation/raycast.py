"""Rays in a mesh, cast with Open3D (Embree)."""

from dataclasses import dataclass

import numpy as np
import open3d as o3d

from scanplan.lab.buildings.extrusion import SURFACES, Mesh
from scanplan.types import FloatArray, IntArray

# ASSUME paint, flooring, fabric, clothes, glass, on Velodyne's scale of 0 to 100 for diffuse ones;
# it fills the intensity of the recorded points, which no stage reads
REFLECTIVITY = {
    "wall": 80.0,
    "floor": 30.0,
    "ceiling": 90.0,
    "furniture": 50.0,
    "glass": 10.0,
    "door": 60.0,
    "other": 50.0,
    "person": 40.0,
    "mirror": 10.0,
    "polished": 20.0,
}


@dataclass(frozen=True)
class RayHits:
    """The first surface that each ray meets; infinite range where there is none.

    Attributes
    ----------
    range_m : (n,) float32
    cosine : (n,) float32
        Of the angle between ray and surface normal, 0 to 1; undefined where nothing is hit.
    reflectivity : (n,) float32
        As Velodyne calibrates it, 0 to 100 for diffuse surfaces; undefined where nothing is hit.
    """

    range_m: FloatArray
    cosine: FloatArray
    reflectivity: FloatArray


class RayScene:
    """A mesh ready for ray casting, its panes of glass apart from its opaque surfaces.

    Parameters
    ----------
    mesh : extrusion.Mesh
        Triangles whose surface is called `glass` are panes.
    """

    def __init__(self, mesh: Mesh):
        # Embree works in float32: near its own origin the mesh keeps micrometres wherever it stands
        self._centre_m = mesh.vertices_m.mean(axis=0)
        vertices_m = np.ascontiguousarray(mesh.vertices_m - self._centre_m, np.float32)
        is_glass = (np.array(SURFACES) == "glass")[mesh.surface]
        of_surface = np.array([REFLECTIVITY[name] for name in SURFACES], np.float32)
        reflectivity = of_surface[mesh.surface]
        opaque = ~is_glass
        self._opaque = _make_layer(vertices_m, mesh.triangles[opaque], reflectivity[opaque])
        self._glass = _make_layer(vertices_m, mesh.triangles[is_glass], reflectivity[is_glass])

    def first_hits(
        self, origin_m: FloatArray, direction: FloatArray
    ) -> tuple[RayHits, RayHits | None]:
        """Find the first opaque surface and the first pane that each ray meets.

        Parameters
        ----------
        origin_m : (c, 3) float
            Where each column of rays starts, map frame.
        direction : (c, b, 3) float32
            Unit vectors, map frame.

        Returns
        -------
        opaque : RayHits
            The first surface that is no glass, for all rays, flat (c * b,).
        pane : RayHits or None
            The first pane, before or behind that surface; None if the mesh has none.
        """
        rays = np.empty((*direction.shape[:2], 6), np.float32)
        rays[..., :3] = (origin_m - self._centre_m)[:, None]
        rays[..., 3:] = direction
        rays = rays.reshape(-1, 6)
        if self._opaque:
            opaque = self._opaque.hits(rays)
        else:
            opaque = RayHits(*np.full((3, len(rays)), np.inf, np.float32))
        return opaque, self._glass.hits(rays) if self._glass else None


class _Layer:
    """Triangles with the reflectivity of each."""

    def __init__(self, vertices_m: FloatArray, triangles: IntArray, reflectivity: FloatArray):
        self._reflectivity = reflectivity
        self._scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        rows = np.ascontiguousarray(triangles, np.uint32)
        self._scene.add_triangles(
            o3d.core.Tensor.from_numpy(vertices_m), o3d.core.Tensor.from_numpy(rows)
        )

    def hits(self, rays: FloatArray) -> RayHits:
        cast = self._scene.cast_rays(o3d.core.Tensor.from_numpy(rays), nthreads=1)
        cosine = np.abs(np.einsum("ij,ij->i", cast["primitive_normals"].numpy(), rays[:, 3:]))
        # the row that Open3D gives a miss is no row
        row = np.minimum(cast["primitive_ids"].numpy(), len(self._reflectivity) - 1)
        return RayHits(cast["t_hit"].numpy(), cosine, self._reflectivity[row])


def _make_layer(
    vertices_m: FloatArray, triangles: IntArray, reflectivity: FloatArray
) -> _Layer | None:
    """Return the layer of some triangles, None where there are none."""
    return _Layer(vertices_m, triangles, reflectivity) if len(triangles) else None
