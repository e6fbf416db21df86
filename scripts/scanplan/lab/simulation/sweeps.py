"""Scans of a sensor on the move: each column of rays cast from where the sensor is then."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from scanplan.lab.buildings.extrusion import Mesh
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import people, ray_fates, raycast, rover, sensor_errors
from scanplan.lab.simulation.scan_rays import ScanRays, Scene
from scanplan.lab.simulation.sensors import Sensor, turn_directions
from scanplan.stage import workers
from scanplan.types import FloatArray, IntArray

_SCANS_PER_JOB = 8  # a job's overhead against the scans held in memory; no result depends on it


@dataclass(frozen=True)
class SimulatedSurvey:
    """All that determines the scans of a drive.

    Attributes
    ----------
    mesh : extrusion.Mesh
    sensor : sensors.Sensor
    errors : sensor_errors.SensorErrors
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
    errors: sensor_errors.SensorErrors
    drive: rover.Drive
    base_from_sensor: FloatArray
    people: tuple[people.Person, ...]
    t_ns: IntArray
    seed: int


@dataclass(frozen=True)
class SimulatedScan:
    """The measurements of one turn, by column and beam.

    Attributes
    ----------
    range_m : (c, b) float32
        NaN where nothing came back.
    intensity : (c, b) float32
        Undefined where nothing came back.
    """

    range_m: FloatArray
    intensity: FloatArray


def simulate_scans(survey: SimulatedSurvey, *, threads: int = 1) -> Iterator[SimulatedScan]:
    """Take the scans of a survey.

    Parameters
    ----------
    threads : int
        Processes that cast; the scans are the same for any number. No more than a few scans are
        held at a time.

    Yields
    ------
    SimulatedScan
        In the order of their stamps.
    """
    n = len(survey.t_ns)
    if threads <= 1:
        scene = raycast.RayScene(survey.mesh)
        yield from (take_scan(survey, scene, scan_id) for scan_id in range(n))
        return
    starts = range(0, n, _SCANS_PER_JOB)
    jobs = ((range(start, min(start + _SCANS_PER_JOB, n)),) for start in starts)
    with workers.open_pool(threads, _prepare, survey) as run:
        for scans in run(_take_scans, jobs):
            yield from scans


def take_scan(survey: SimulatedSurvey, scene: raycast.RayScene, scan_id: int) -> SimulatedScan:
    """Take one scan.

    Parameters
    ----------
    scene : raycast.RayScene
        Of the survey's mesh.

    Returns
    -------
    SimulatedScan
    """
    sensor = survey.sensor
    fired_ns = survey.t_ns[scan_id] + np.round(sensor.time_s * 1e9).astype(np.int64)
    world_from_sensor = rover.drive_poses(survey.drive, fired_ns) @ survey.base_from_sensor
    origin_m = world_from_sensor[:, :3, 3]
    map_from_sensor = world_from_sensor[:, :3, :3].transpose(0, 2, 1).astype(np.float32)
    direction = turn_directions(sensor, scan_id) @ map_from_sensor
    rays = ScanRays(fired_ns / 1e9, origin_m, direction)
    apart = people.list_apart(survey.people, rays.t_s, origin_m)
    hits = ray_fates.find_returns(
        rays, Scene(scene, apart), sensor, survey.errors, survey.seed, scan_id
    )
    shape = sensor.direction.shape[:2]
    measured_m = sensor_errors.add_range_errors(
        hits.range_m.reshape(shape),
        survey.errors,
        open_stream(survey.seed, RandomStream.RANGE_NOISE, scan_id),
    )
    # the sensor limits the ranges that it measured; the true ones it does not know
    is_within = (measured_m >= sensor.min_range_m) & (measured_m <= sensor.max_range_m)
    measured_m = np.where(is_within, measured_m, np.float32(np.nan))
    return SimulatedScan(measured_m, hits.reflectivity.reshape(shape))


def _prepare(survey: SimulatedSurvey) -> None:
    """Set a worker process up: the mesh is sent and built once, not with every job."""
    global _casting
    _casting = (survey, raycast.RayScene(survey.mesh))


def _take_scans(scan_ids: range) -> list[SimulatedScan]:
    survey, scene = _casting
    return [take_scan(survey, scene, scan_id) for scan_id in scan_ids]
