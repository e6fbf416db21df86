"""What becomes of the rays of a scan, one phenomenon after the other, before they are measured."""

from collections.abc import Callable

import numpy as np

from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import mirroring, raycast, sensor_errors, spurious_returns
from scanplan.lab.simulation.scan_rays import ScanRays, Scene
from scanplan.lab.simulation.sensor_errors import SensorErrors
from scanplan.lab.simulation.sensors import Sensor
from scanplan.types import BoolArray


def find_returns(
    rays: ScanRays, scene: Scene, sensor: Sensor, errors: SensorErrors, seed: int, scan_id: int
) -> raycast.RayHits:
    """Return where the rays of a scan seem to end, before beams' biases and noise.

    Each phenomenon draws from a stream of its own, and none where it is absent.

    Parameters
    ----------
    seed, scan_id : int
        They determine all that is drawn.

    Returns
    -------
    raycast.RayHits
        Of all rays, flat (c * b,); infinite or NaN ranges where nothing comes back.
    """

    def stream(purpose: RandomStream) -> np.random.Generator:
        return open_stream(seed, purpose, scan_id)

    opaque, pane = scene.mesh.first_hits(rays.origin_m, rays.direction)
    solid = scene.merge_people(rays, opaque)
    hits, is_direct = _send_on(rays, solid, (opaque, pane), scene, errors, stream)
    if errors.mixed_rad:
        generator = stream(RandomStream.MIXED)
        is_edge = spurious_returns.find_edges(
            rays.direction, hits.range_m, sensor, errors.mixed_rad
        )
        hits = spurious_returns.mix_edges(
            rays, hits, is_edge & is_direct, scene, errors.mixed_rad, generator
        )
    if errors.polished_from_rad < np.pi / 2 and scene.mesh.has("polished"):
        is_polished = opaque.is_of("polished") & is_direct & (solid.range_m == opaque.range_m)
        generator = stream(RandomStream.POLISHED)
        hits = sensor_errors.drop_polished(hits, is_polished, errors, generator)
    generator = stream(RandomStream.GRAZING_LOSS)
    returned_m = sensor_errors.drop_grazing(hits, errors, generator)
    hits = raycast.RayHits(returned_m, hits.cosine, hits.reflectivity)
    if errors.bias_intensity_m or errors.bias_incidence_m:
        hits = spurious_returns.bias_ranges(hits, errors)
    if errors.stray_share:
        generator = stream(RandomStream.STRAY)
        hits = spurious_returns.scatter_strays(hits, errors.stray_share, sensor, generator)
    return hits


def _send_on(
    rays: ScanRays,
    solid: raycast.RayHits,
    first: tuple[raycast.MeshHits, raycast.MeshHits | None],
    scene: Scene,
    errors: SensorErrors,
    stream: Callable[[RandomStream], np.random.Generator],
) -> tuple[raycast.RayHits, BoolArray]:
    """Return hits with panes and mirrors minded, and which rays (n,) end before either.

    `first` is what rays meet of the building: what is opaque, and panes.
    """
    hits, (opaque, pane) = solid, first
    if pane is not None:
        generator = stream(RandomStream.GLASS)
        hits, is_mirrored = sensor_errors.pass_glass(solid, pane, errors, generator)
        hits = mirroring.return_images(rays, hits, is_mirrored, pane, scene)
    if scene.mesh.has("mirror"):
        generator = stream(RandomStream.MIRROR)
        hits, is_mirrored = mirroring.meet_mirrors(hits, opaque, generator)
        hits = mirroring.return_images(rays, hits, is_mirrored, opaque, scene)
    return hits, hits.range_m == solid.range_m
