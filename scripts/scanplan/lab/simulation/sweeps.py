"""Turns of a sensor on the move: each column cast from where the sensor is then, and measured with errors."""

from dataclasses import dataclass

import numpy as np

from scanplan.lab.buildings.extrusion import Mesh
from scanplan.lab.simulation import people, raycast, rover
from scanplan.lab.simulation.sensors import Sensor, SensorErrors
from scanplan.stage import workers

_NOISE_STREAM, _LOSS_STREAM, _GLASS_STREAM = 0, 4, 5
_SCANS_PER_JOB = 8


@dataclass(frozen=True)
class SimulatedSurvey:
    """All that determines the scans of a drive.

    Attributes
    ----------
    mesh : extrusion.Mesh
    sensor : sensors.Sensor
    errors : sensors.SensorErrors
    drive : rover.Drive
    base_from_sensor : (4, 4) float64
    people : tuple of people.Person
    t_ns : (m,) int64
        Stamps of the scans, from the start of the drive.
    seed : int
        With the scan's index it determines the noise, whatever other scans are taken.
    """

    mesh: Mesh
    sensor: Sensor
    errors: SensorErrors
    drive: rover.Drive
    base_from_sensor: np.ndarray
    people: tuple
    t_ns: np.ndarray
    seed: int


@dataclass(frozen=True)
class SimulatedScan:
    """What one turn measured, by column and beam.

    Attributes
    ----------
    range_m : (c, b) float32
        NaN where nothing came back.
    intensity : (c, b) float32
        Undefined where nothing came back.
    """

    range_m: np.ndarray
    intensity: np.ndarray


def simulate_scans(survey, *, threads=1):
    """Take the scans of a survey.

    Parameters
    ----------
    survey : Survey
    threads : int
        Processes that cast; the scans are the same for any number. No more than a few scans are held at a time.

    Yields
    ------
    Scan
        In the order of their stamps.
    """
    if threads <= 1:
        scene = raycast.RayScene(survey.mesh)
        yield from (take_scan(survey, scene, scan_id) for scan_id in range(len(survey.t_ns)))
        return
    n = len(survey.t_ns)
    jobs = (
        (range(start, min(start + _SCANS_PER_JOB, n)),) for start in range(0, n, _SCANS_PER_JOB)
    )
    with workers.open_pool(threads, _prepare, survey) as run:
        for taken in run(_take_some, jobs):
            yield from taken


def take_scan(survey, scene, scan_id):
    """Take one scan.

    Parameters
    ----------
    survey : Survey
    scene : raycast.RayScene
        Of the survey's mesh.
    scan_id : int

    Returns
    -------
    Scan
    """
    sensor = survey.sensor
    fired_ns = survey.t_ns[scan_id] + np.round(sensor.time_s * 1e9).astype(np.int64)
    origin_m, direction = _rays(
        sensor.direction, rover.drive_poses(survey.drive, fired_ns) @ survey.base_from_sensor
    )
    opaque, pane = scene.first_hits(origin_m, direction)
    if survey.people:
        opaque = people.merge_hits(
            opaque, people.find_person_hits(survey.people, fired_ns / 1e9, origin_m, direction)
        )
    if pane is not None:
        opaque = pass_glass(opaque, pane, survey.errors, _generator(survey, _GLASS_STREAM, scan_id))
    shape = direction.shape[:2]
    range_m = drop_grazing(
        opaque, survey.errors, _generator(survey, _LOSS_STREAM, scan_id)
    ).reshape(shape)
    measured_m = add_range_errors(
        range_m, survey.errors, _generator(survey, _NOISE_STREAM, scan_id)
    )
    # the sensor knows what it measured, not how far that truly was
    within = (measured_m >= sensor.min_range_m) & (measured_m <= sensor.max_range_m)
    measured_m = np.where(within, measured_m, np.float32(np.nan))
    return SimulatedScan(measured_m, opaque.reflectivity.reshape(shape))


def pass_glass(opaque, pane, errors, generator):
    """Decide for every ray that comes to a pane whether it passes, is lost, or returns from it.

    ASSUME a ray that passes the first pane in its way passes all behind it: both faces of a pane are one decision.

    Parameters
    ----------
    opaque, pane : raycast.RayHits
    errors : sensors.SensorErrors
    generator : numpy Generator

    Returns
    -------
    raycast.RayHits
    """
    draw = generator.random(len(opaque.range_m), dtype=np.float32)
    comes = pane.range_m < opaque.range_m
    lost = comes & (draw < errors.glass_drop)
    returns = comes & (draw >= errors.glass_drop + errors.glass_pass)
    seen = (np.where(returns, on_pane, behind) for on_pane, behind in _pairs(pane, opaque))
    range_m, cosine, reflectivity = seen
    return raycast.RayHits(np.where(lost, np.float32(np.inf), range_m), cosine, reflectivity)


def drop_grazing(hits, errors, generator):
    """Return the ranges (n,) float32 of hits, NaN where the surface was met at too flat an angle to come back."""
    if errors.grazing_from_rad >= np.pi / 2:
        return hits.range_m
    range_m = hits.range_m.copy()
    (flat,) = np.nonzero((hits.cosine < np.cos(errors.grazing_from_rad)) & np.isfinite(range_m))
    angle = np.arccos(hits.cosine[flat])
    chance = (angle - errors.grazing_from_rad) / (np.pi / 2 - errors.grazing_from_rad)
    # drawn for all rays, so that one ray's fate does not hang on how many others graze
    draw = generator.random(len(range_m), dtype=np.float32)
    range_m[flat[draw[flat] < chance]] = np.nan
    return range_m


def add_range_errors(range_m, errors, generator):
    """Return ranges (c, b) as measured: each beam's bias and noise added, then rounded; NaN stays NaN."""
    measured_m = range_m + errors.bias_m
    if errors.noise_m:
        noise = generator.standard_normal(range_m.shape, dtype=np.float32)
        noise *= np.float32(errors.noise_m)
        measured_m += noise
    if errors.quantum_m:
        quantum_m = np.float32(errors.quantum_m)
        measured_m = np.rint(measured_m / quantum_m) * quantum_m
    return measured_m


def _rays(direction, world_from_sensor):
    """Origins (c, 3) and directions (c, b, 3) float32 in the map of columns that fire from poses (c, 4, 4)."""
    return world_from_sensor[:, :3, 3], direction @ world_from_sensor[:, :3, :3].transpose(
        0, 2, 1
    ).astype(np.float32)


def _pairs(a, b):
    return zip(*((hits.range_m, hits.cosine, hits.reflectivity) for hits in (a, b)), strict=True)


def _generator(survey, stream, scan_id):
    return np.random.default_rng([survey.seed, stream, scan_id])


def _prepare(survey):
    """Set a casting process up: the mesh is sent and built once, not with every job."""
    global _casting
    _casting = survey, raycast.RayScene(survey.mesh)


def _take_some(scan_ids):
    return [take_scan(*_casting, scan_id) for scan_id in scan_ids]
