"""A spinning multi-beam LiDAR in a mesh, its rays cast with Open3D (Embree)."""

from dataclasses import dataclass

import numpy as np
import open3d as o3d

from scanplan.extrusion import SURFACES

_NOISE_STREAM = 0
_REFLECTIVITY = {
    "wall": 80.0,
    "floor": 30.0,
    "ceiling": 90.0,
    "furniture": 50.0,
    "glass": 10.0,
    "door": 60.0,
    "other": 50.0,
}
_VLP16_ELEVATION_DEG = np.arange(-15.0, 16.0, 2.0)
_VLP16_FIRING_ORDER = np.array([0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15])


@dataclass(frozen=True)
class Lidar:
    """A sensor: the directions of one turn, in the order it fires, and how well it measures.

    Attributes
    ----------
    direction : (n, 3) float64
        Unit vectors in the sensor's frame: x forward, z up.
    ring : (n,) uint16
        The beam, counted from the lowest.
    max_range_m : float
        Beyond it nothing comes back.
    range_noise_m : float
        Standard deviation of a range, along the ray.
    """

    direction: np.ndarray
    ring: np.ndarray
    max_range_m: float
    range_noise_m: float


@dataclass(frozen=True)
class Returns:
    """What one turn brought back, in the order fired; rays without a return are left out.

    Attributes
    ----------
    xyz_m : (n, 3) float32
        Sensor frame.
    intensity : (n,) float32
        Calibrated reflectivity as Velodyne gives it, 0 to 100 for diffuse surfaces.
    ring : (n,) uint16
    """

    xyz_m: np.ndarray
    intensity: np.ndarray
    ring: np.ndarray


def vlp16(*, n_azimuth, max_range_m, range_noise_m):
    """Return a Velodyne VLP-16: 16 beams from -15 to +15 degrees, turning clockwise seen from above.

    Source: Velodyne VLP-16 user manual, laser IDs and elevation angles. ASSUME all beams start at one point; the real
    ones sit up to 11 mm higher or lower.

    Parameters
    ----------
    n_azimuth : int
        Firings per turn; the real sensor makes 1800 at 10 Hz.
    max_range_m, range_noise_m : float

    Returns
    -------
    Lidar
    """
    if n_azimuth < 1 or max_range_m <= 0 or range_noise_m < 0:
        raise ValueError(f"{n_azimuth} firings, range {max_range_m} m, noise {range_noise_m} m are no sensor")
    azimuth = np.repeat(-2 * np.pi * np.arange(n_azimuth) / n_azimuth, len(_VLP16_FIRING_ORDER))
    ring = np.tile(_VLP16_FIRING_ORDER, n_azimuth)
    elevation = np.radians(_VLP16_ELEVATION_DEG)[ring]
    level = np.cos(elevation)
    direction = np.column_stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])
    return Lidar(direction, ring.astype(np.uint16), float(max_range_m), float(range_noise_m))


class Scene:
    """A mesh, ready to be hit.

    Parameters
    ----------
    mesh : extrusion.Mesh
    """

    def __init__(self, mesh):
        # Embree works in float32: near its own origin the mesh keeps micrometres wherever the map's origin is
        self._centre_m = mesh.vertices_m.mean(axis=0)
        self._scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        vertices = np.ascontiguousarray(mesh.vertices_m - self._centre_m, np.float32)
        triangles = np.ascontiguousarray(mesh.triangles, np.uint32)
        self._scene.add_triangles(o3d.core.Tensor.from_numpy(vertices), o3d.core.Tensor.from_numpy(triangles))

    def first_hits(self, origin_m, direction):
        """Return how far each ray from one point goes, and what it hits.

        Parameters
        ----------
        origin_m : (3,) float
            Map frame.
        direction : (n, 3) float
            Unit vectors, map frame.

        Returns
        -------
        range_m : (n,) float32
            Infinite where nothing is hit.
        triangle : (n,) uint32
            Row of the mesh's triangles; undefined where nothing is hit.
        """
        rays = np.empty((len(direction), 6), np.float32)
        rays[:, :3] = np.asarray(origin_m) - self._centre_m
        rays[:, 3:] = direction
        hits = self._scene.cast_rays(o3d.core.Tensor.from_numpy(rays))
        return hits["t_hit"].numpy(), hits["primitive_ids"].numpy()


def survey(mesh, lidar, world_from_sensor, *, seed):
    """Take one scan from every pose.

    ASSUME the whole turn is seen from the pose at its stamp: the scans have no sweep distortion.

    Parameters
    ----------
    mesh : extrusion.Mesh
    lidar : Lidar
    world_from_sensor : (m, 4, 4) float64
    seed : int
        With the scan's index it determines the noise, whatever other scans are taken.

    Yields
    ------
    scan : Returns
    """
    scene = Scene(mesh)
    reflectivity = np.array([_REFLECTIVITY[name] for name in SURFACES], np.float32)[mesh.surface]
    for scan_id, pose in enumerate(world_from_sensor):
        range_m, triangle = scene.first_hits(pose[:3, 3], lidar.direction @ pose[:3, :3].T)
        back = range_m <= lidar.max_range_m
        noise = np.random.default_rng([seed, _NOISE_STREAM, scan_id]).standard_normal(len(range_m))
        measured_m = (range_m + lidar.range_noise_m * noise)[back]
        xyz_m = (lidar.direction[back] * measured_m[:, None]).astype(np.float32)
        yield Returns(xyz_m, reflectivity[triangle[back]], lidar.ring[back])
