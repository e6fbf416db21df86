"""Rays in a mesh, cast with Open3D (Embree)."""

from dataclasses import dataclass

import numpy as np
import open3d as o3d

from scanplan.lab.buildings.extrusion import SURFACES, Mesh
from scanplan.types import BoolArray, FloatArray, IntArray

# ASSUME paint, flooring, fabric, clothes, glass, dark stone, on Velodyne's scale of 0 to 100 for
# diffuse ones; it fills the intensity of the recorded points, which no stage reads, and says how
# dark a surface is that ranges are biased by
REFLECTIVITY = {
    "wall": 80.0,
    "floor": 30.0,
    "ceiling": 90.0,
    "furniture": 50.0,
    "glass": 10.0,
    "door": 60.0,
    "other": 50.0,
    "mirror": 5.0,
    "polished": 10.0,
    "person": 40.0,
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


@dataclass(frozen=True)
class MeshHits(RayHits):
    """The first surface of a mesh that each ray meets.

    Attributes
    ----------
    normal : (n, 3) float32
        Unit normal of the triangle hit, to either side; undefined where nothing is hit.
    surface : (n,) uint8
        Its index in `extrusion.SURFACES`; undefined where nothing is hit.
    """

    normal: FloatArray
    surface: IntArray

    def is_of(self, name: str) -> BoolArray:
        """Return which rays (n,) hit a surface of `extrusion.SURFACES`."""
        if name not in SURFACES:
            return np.zeros(len(self.range_m), bool)
        return (self.surface == SURFACES.index(name)) & np.isfinite(self.range_m)


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
        self._opaque = _make_layer(vertices_m, mesh, ~is_glass)
        self._glass = _make_layer(vertices_m, mesh, is_glass)
        self._names = frozenset(SURFACES[i] for i in np.unique(mesh.surface).tolist())

    def has(self, name: str) -> bool:
        """Return whether the mesh has a surface of `extrusion.SURFACES`."""
        return name in self._names

    def first_hits(
        self, origin_m: FloatArray, direction: FloatArray
    ) -> tuple[MeshHits, MeshHits | None]:
        """Find the first opaque surface and the first pane that each ray meets.

        Parameters
        ----------
        origin_m : (c, 3) float
            Where each column of rays starts, map frame.
        direction : (c, b, 3) float32
            Unit vectors, map frame.

        Returns
        -------
        opaque : MeshHits
            The first surface that is no glass, for all rays, flat (c * b,).
        pane : MeshHits or None
            The first pane, before or behind that surface; None if the mesh has none.
        """
        rays = self._list_rays(origin_m, direction)
        return self._opaque_hits(rays), self._glass.hits(rays) if self._glass else None

    def opaque_hits(self, origin_m: FloatArray, direction: FloatArray) -> MeshHits:
        """Find the first opaque surface that each ray meets; as `first_hits`, which casts both."""
        return self._opaque_hits(self._list_rays(origin_m, direction))

    def _list_rays(self, origin_m: FloatArray, direction: FloatArray) -> FloatArray:
        """Return the rays (c * b, 6) float32 about the mesh's own centre."""
        rays = np.empty((*direction.shape[:2], 6), np.float32)
        rays[..., :3] = (origin_m - self._centre_m)[:, None]
        rays[..., 3:] = direction
        return rays.reshape(-1, 6)

    def _opaque_hits(self, rays: FloatArray) -> MeshHits:
        if self._opaque:
            return self._opaque.hits(rays)
        never = np.full(len(rays), np.inf, np.float32)
        return MeshHits(never, never, never, np.zeros_like(rays[:, 3:]), np.zeros(len(rays), int))


class _Layer:
    """Triangles with the surface of each."""

    def __init__(self, vertices_m: FloatArray, triangles: IntArray, surface: IntArray):
        self._surface = surface
        of_surface = np.array([REFLECTIVITY[name] for name in SURFACES], np.float32)
        self._reflectivity = of_surface[surface]
        self._scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        rows = np.ascontiguousarray(triangles, np.uint32)
        self._scene.add_triangles(
            o3d.core.Tensor.from_numpy(vertices_m), o3d.core.Tensor.from_numpy(rows)
        )

    def hits(self, rays: FloatArray) -> MeshHits:
        cast = self._scene.cast_rays(o3d.core.Tensor.from_numpy(rays), nthreads=1)
        normal = cast["primitive_normals"].numpy()
        cosine = np.abs(np.einsum("ij,ij->i", normal, rays[:, 3:]))
        # the row that Open3D gives a miss is no row
        row = np.minimum(cast["primitive_ids"].numpy(), len(self._surface) - 1)
        range_m = cast["t_hit"].numpy()
        return MeshHits(range_m, cosine, self._reflectivity[row], normal, self._surface[row])


def _make_layer(vertices_m: FloatArray, mesh: Mesh, chosen: BoolArray) -> _Layer | None:
    """Return the layer of some triangles, None where there are none."""
    if not chosen.any():
        return None
    return _Layer(vertices_m, mesh.triangles[chosen], mesh.surface[chosen])
