"""Ranges that are no surface's, or not quite: mixed pixels, stray returns, biased ranges."""

import numpy as np

from scanplan.lab.simulation import raycast
from scanplan.lab.simulation.scan_rays import ScanRays, Scene, unit_rays
from scanplan.lab.simulation.sensor_errors import SensorErrors
from scanplan.lab.simulation.sensors import Sensor
from scanplan.types import BoolArray, FloatArray, IntArray

# ASSUME a pulse of 10 ns, 1.5 m there and back: echoes farther apart are told apart
_PULSE_M = 1.5
_EDGE_M = 0.05  # ASSUME lower steps are within what a range errs by
# ASSUME rays that differ by more than on a surface at 80 degrees to its normal pass an edge
_EDGE_SLOPE = float(np.tan(np.radians(80)))
_LEAST_RAD = 1e-4  # ASSUME no sensor's rays are nearer to one another
_STRAY_REFLECTIVITY = np.float32(2.0)  # ASSUME dust and crosstalk are faint
_FLATTEST_COSINE = 0.17  # of 80 degrees: ASSUME ranges at flatter angles are no farther off


def mix_edges(
    rays: ScanRays,
    hits: raycast.RayHits,
    is_mixed: BoolArray,
    scene: Scene,
    width_rad: float,
    generator: np.random.Generator,
) -> raycast.RayHits:
    """Return hits in which rays that pass an edge within their beam mix what is on both its sides.

    Mixed pixels lie anywhere between the two surfaces (Tuley, Vandapel and Hebert, "Analysis and
    removal of artifacts in 3-D LADAR data", ICRA 2005). Where a neighbouring ray is nearer or
    farther than one surface explains, another ray is cast at random within the beam; the range then
    is between both, nearer to the middle's, as an edge beside the middle leaves it more than half
    of the beam.

    Parameters
    ----------
    is_mixed : (n,) bool
        Rays at edges, see `find_edges`, that meet an opaque surface or a person without a pane or
        mirror.
    width_rad : float
        Of the beam.

    Returns
    -------
    raycast.RayHits
    """
    (ray,) = np.nonzero(is_mixed & np.isfinite(hits.range_m))
    own = rays.direction.reshape(-1, 3)[ray]
    beside = jitter_rays(own, width_rad, generator)
    other, _ = scene.meet(rays.turn_rays(ray, beside))
    share = generator.uniform(0.0, 0.5, len(ray)).astype(np.float32)
    own_m = hits.range_m[ray]
    apart_m = other.range_m - own_m
    range_m = hits.range_m.copy()
    range_m[ray] = own_m + np.where(np.abs(apart_m) <= _PULSE_M, share * apart_m, 0)
    return raycast.RayHits(range_m, hits.cosine, hits.reflectivity)


def find_edges(
    direction: FloatArray, range_m: FloatArray, sensor: Sensor, width_rad: float
) -> BoolArray:
    """Return which rays (n,) can have an edge of depth within their beam.

    Parameters
    ----------
    direction : (c, b, 3) float
    range_m : (n,) float
        Of these rays, flat.
    sensor : sensors.Sensor
        Whose rings say which beams are neighbours.
    width_rad : float
        Of the beam.

    Returns
    -------
    (n,) bool
        Those that differ in depth from a neighbour, and those so near to one that does.
    """
    order = np.argsort(sensor.ring, kind="stable")
    depth_m = range_m.reshape(direction.shape[:2])[:, order]
    rays = direction[:, order]
    is_edge = np.zeros(depth_m.shape, bool)
    _mark_edges(is_edge, rays, depth_m, width_rad)
    _mark_edges(is_edge.T, rays.swapaxes(0, 1), depth_m.T, width_rad)
    unordered = np.empty_like(is_edge)
    unordered[:, order] = is_edge
    return unordered.ravel()


def _mark_edges(
    is_edge: BoolArray, rays: FloatArray, depth_m: FloatArray, width_rad: float
) -> None:
    """Mark the rays (n, k) of rows at or near a step of depth from row to row."""
    n = len(depth_m)
    if n < 2:
        return
    # beside a ray that nothing returns there is nothing to mix with
    with np.errstate(invalid="ignore"):
        apart_m = np.abs(np.diff(depth_m, axis=0))
    row, beam = np.nonzero((apart_m > _EDGE_M) & (apart_m < np.inf))
    angle_rad = np.linalg.norm(rays[row + 1, beam] - rays[row, beam], axis=1)
    nearer_m = np.minimum(depth_m[row, beam], depth_m[row + 1, beam])
    is_step = apart_m[row, beam] > _EDGE_SLOPE * angle_rad * nearer_m
    row, beam = row[is_step], beam[is_step]
    # so many rays to either side have the step within half their beam
    spacing_rad = np.median(np.linalg.norm(rays[n // 2] - rays[n // 2 - 1], axis=-1))
    reach = max(int(np.ceil(width_rad / 2 / max(spacing_rad, _LEAST_RAD))), 1)
    for offset in range(1 - reach, reach + 1):
        is_edge[np.clip(row + offset, 0, n - 1), beam] = True


def jitter_rays(
    direction: FloatArray, width_rad: float, generator: np.random.Generator
) -> FloatArray:
    """Return one direction (k, 3) float32 within each beam (k, 3), evenly spread over its disc."""
    aside = unit_rays(np.cross(direction, _perpendicular_axis(direction)))
    across = np.cross(direction, aside)
    radius = width_rad / 2 * np.sqrt(generator.random(len(direction)))[:, None]
    angle = generator.uniform(0, 2 * np.pi, len(direction))[:, None]
    return unit_rays(direction + radius * (np.cos(angle) * aside + np.sin(angle) * across))


def _perpendicular_axis(direction: FloatArray) -> FloatArray:
    """Return for each direction (k, 3) the axis of the frame that it runs along least."""
    axis: IntArray = np.abs(direction).argmin(axis=1)
    return np.eye(3, dtype=np.float32)[axis]


def bias_ranges(hits: raycast.RayHits, errors: SensorErrors) -> raycast.RayHits:
    """Return hits whose ranges err by how dark the surface is and how obliquely it is met.

    A weak echo crosses the receiver's threshold later (range walk), and a slanted surface stretches
    it: biases of centimetres up to a decimetre at flat angles (Laconte et al., "Lidar measurement
    bias estimation via return waveform modelling in a context of 3D mapping", ICRA 2019). ASSUME
    the former linear in the reflectivity, 0 at 100, the latter in 1 / cosine - 1, which is 1 at 60
    degrees, up to 80 degrees.
    """
    dark = 1 - np.clip(hits.reflectivity / 100, 0, 1)
    slant = 1 / np.clip(hits.cosine, _FLATTEST_COSINE, 1) - 1
    bias_m = errors.bias_intensity_m * dark + errors.bias_incidence_m * slant
    range_m = (hits.range_m + bias_m).astype(np.float32)
    return raycast.RayHits(range_m, hits.cosine, hits.reflectivity)


def scatter_strays(
    hits: raycast.RayHits,
    share: float,
    sensor: Sensor,
    generator: np.random.Generator,
) -> raycast.RayHits:
    """Return hits of which a share comes from anywhere before the surface: dust, sun, crosstalk.

    ASSUME all ranges from the sensor's least up to the surface are as likely (up to its largest
    where the ray meets nothing): what comes later than the surface's echo is not looked at.
    """
    (ray,) = np.nonzero(generator.random(len(hits.range_m), dtype=np.float32) < share)
    far_m = np.where(np.isfinite(hits.range_m[ray]), hits.range_m[ray], sensor.max_range_m)
    far_m = np.clip(far_m, sensor.min_range_m, sensor.max_range_m)
    range_m, reflectivity, cosine = (
        values.copy() for values in (hits.range_m, hits.reflectivity, hits.cosine)
    )
    range_m[ray] = generator.uniform(sensor.min_range_m, far_m)
    reflectivity[ray] = _STRAY_REFLECTIVITY
    cosine[ray] = 1
    return raycast.RayHits(range_m, cosine, reflectivity)
