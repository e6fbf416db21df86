"""Rays that panes and mirrors send on, and the images that they return."""

import numpy as np

from scanplan.lab.simulation import raycast
from scanplan.lab.simulation.scan_rays import ScanRays, Scene, unit_rays
from scanplan.types import BoolArray, FloatArray, IntArray

# ASSUME a silvered mirror sends 95 % on in the near infrared; dust and the second way take the rest
_MIRROR_SHARE = 0.95
_OFF_SURFACE_M = 1e-4  # float32 keeps 4 micrometres at 50 m: a ray must not meet what it comes from


def meet_mirrors(
    hits: raycast.RayHits, opaque: raycast.MeshHits, generator: np.random.Generator
) -> tuple[raycast.RayHits, BoolArray]:
    """Draw for every ray that ends at a mirror whether it is sent on or lost.

    Parameters
    ----------
    hits : raycast.RayHits
        Where each ray ends, panes and people minded.
    opaque : raycast.MeshHits
        The mesh's first opaque surface along it.

    Returns
    -------
    hits : raycast.RayHits
        Infinite where a mirror was met.
    is_mirrored : (n,) bool
        Rays that go on from a mirror.
    """
    is_met = opaque.is_of("mirror") & (hits.range_m == opaque.range_m)
    draw = generator.random(len(is_met), dtype=np.float32)
    range_m = np.where(is_met, np.float32(np.inf), hits.range_m)
    lost = raycast.RayHits(range_m, hits.cosine, hits.reflectivity)
    return lost, is_met & (draw < _MIRROR_SHARE)


def return_images(
    rays: ScanRays,
    hits: raycast.RayHits,
    is_mirrored: BoolArray,
    surface: raycast.MeshHits,
    scene: Scene,
) -> raycast.RayHits:
    """Return hits in which mirrored rays have the range of what they meet, the ray unfolded.

    It is the way to the mirror and from there to what is mirrored, along the ray as it was sent:
    so mirror images stand in real scans (Koch, May, Koch and Nuechter, "Detection of specular
    reflections in range measurements for faultless robotic SLAM", ROBOT 2015).

    ASSUME the ray goes on through panes, and a second mirror swallows it.

    Parameters
    ----------
    is_mirrored : (n,) bool
    surface : raycast.MeshHits
        The pane or mirror that each of these rays meets.

    Returns
    -------
    raycast.RayHits
        Infinite range where nothing is mirrored.
    """
    (ray,) = np.nonzero(is_mirrored)
    if not len(ray):
        return hits
    way_m = surface.range_m[ray]
    bent = bend_rays(rays, ray, way_m, surface.normal[ray])
    image, opaque = scene.meet(bent)
    is_swallowed = opaque.is_of("mirror") & (image.range_m == opaque.range_m)
    range_m, cosine, reflectivity = (
        values.copy() for values in (hits.range_m, hits.cosine, hits.reflectivity)
    )
    range_m[ray] = np.where(is_swallowed, np.float32(np.inf), way_m + image.range_m)
    cosine[ray] = image.cosine
    reflectivity[ray] = image.reflectivity
    return raycast.RayHits(range_m, cosine, reflectivity)


def bend_rays(rays: ScanRays, ray: IntArray, way_m: FloatArray, normal: FloatArray) -> ScanRays:
    """Return rays (k,), counted flat, as they go on from mirrors.

    Parameters
    ----------
    ray : (k,) int
    way_m : (k,) float
        How far each comes to its mirror.
    normal : (k, 3) float
        Of that mirror, to either side.

    Returns
    -------
    scan_rays.ScanRays
        Each a column of its own, from the mirror's front.
    """
    direction = rays.direction.reshape(-1, 3)[ray].astype(float)
    normal = unit_rays(normal).astype(float)
    towards = np.einsum("ij,ij->i", direction, normal)[:, None]
    turned = rays.turn_rays(ray, unit_rays(direction - 2 * towards * normal))
    at_mirror_m = turned.origin_m + way_m[:, None] * direction
    front_m = at_mirror_m - _OFF_SURFACE_M * np.sign(towards) * normal
    return ScanRays(turned.t_s, front_m, turned.direction)
