"""A simulated survey put together from its settings."""

from pathlib import Path
from typing import Any

import numpy as np

from scanplan.lab.buildings import building, building_route, clutter, random_leaves
from scanplan.lab.buildings.truth import Feature
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.simulation import localisation, rover, sensor_errors, sensors, sweeps
from scanplan.lab.simulation.people import simulate_walkers
from scanplan.lab.simulation.survey_truth import mark_visible
from scanplan.types import FloatArray, IntArray, Settings


def prepare_site(
    data: bytes,
    source: Path,
    mount: Settings,
    *,
    seed: int,
    route: str,
    waypoints_m: Any,
    start_m: Any,
    clearance_m: float,
    chairs: int,
    doors_ajar: float,
    leaves: float = 0.0,
    **reading: Any,
) -> building.Building:
    """Read a building and find the rover's way through it.

    Parameters
    ----------
    data : bytes
    source : pathlib.Path
        The file that `data` is from.
    mount : dict
        Settings of `rover.mount_sensor`.
    seed, route, waypoints_m, start_m, clearance_m
        See `building_route.plan_building_route`.
    chairs, doors_ajar
        See `clutter.add_clutter`.
    leaves
        Share of doors, see `random_leaves.hang_leaves`.
    **reading
        Settings of `building.load_building`; `planar` for a 2-D scanner.

    Returns
    -------
    building.Building
        With a way.
    """
    site = building.load_building(data, source, slice_height_m=mount["height_m"], **reading)
    if leaves > 0:
        given_m = site.waypoints_m if waypoints_m is None else waypoints_m
        site = random_leaves.hang_leaves(
            site,
            share=leaves,
            seed=seed,
            slice_height_m=mount["height_m"],
            planar=reading.get("planar", False),
            waypoints_m=given_m if route == "given" else None,
            clearance_m=max(building_route.ROVER_RADIUS_M, abs(mount["forward_m"])),
        )
    driven = building_route.plan_building_route(
        site,
        source,
        route=route,
        waypoints_m=waypoints_m,
        start_m=start_m,
        seed=seed,
        clearance_m=clearance_m,
        reach_m=abs(mount["forward_m"]),
    )
    return clutter.add_clutter(driven, chairs=chairs, doors_ajar=doors_ajar, seed=seed)


def prepare_survey(
    site: building.Building,
    *,
    seed: int,
    mount: Settings,
    sensor: Settings,
    errors: Settings,
    drive: Settings,
    people: Settings,
) -> sweeps.SimulatedSurvey:
    """Put a rover with a sensor on its way through a floor.

    Parameters
    ----------
    site : building.Building
        With a way.
    seed : int
    mount, sensor, errors, drive, people : dict
        Settings of `rover.mount_sensor`, `sensors.make_sensor`,
        `sensor_errors.draw_sensor_errors`, `rover.plan_drive` and `people.simulate_walkers`.

    Returns
    -------
    sweeps.SimulatedSurvey

    Raises
    ------
    StageError
        If settings contradict each other.
    ValueError
        If the building has no way.
    """
    if site.waypoints_m is None:
        raise ValueError("a survey needs a building with a way through it")
    lidar = sensors.make_sensor(**sensor)
    way = rover.plan_drive(site.waypoints_m, **drive)
    free = site.floor_m.difference(site.obstacles_m)
    return sweeps.SimulatedSurvey(
        mesh=site.mesh,
        sensor=lidar,
        errors=sensor_errors.draw_sensor_errors(lidar, **errors, seed=seed),
        drive=way,
        base_from_sensor=rover.mount_sensor(**mount),
        people=simulate_walkers(free, until_s=way.t_s[-1], **people, seed=seed),
        t_ns=rover.scan_stamps(way, sensor["rate_hz"]),
        seed=seed,
    )


def survey_belief(
    survey: sweeps.SimulatedSurvey, odometry: Settings, **localiser: Any
) -> localisation.Belief:
    """Return what wheels and localiser estimate, a turn of the sensor beyond either end.

    Parameters
    ----------
    survey : sweeps.SimulatedSurvey
    odometry : dict
        Settings of `localisation.integrate_odometry`.
    **localiser
        Settings of `localisation.simulate_belief`.
    """
    tick_ns = rover.tick_stamps(survey.drive, _turn_ns(survey))
    world_from_base = rover.drive_poses(survey.drive, tick_ns)
    return localisation.simulate_belief(
        tick_ns, world_from_base, odometry=odometry, **localiser, seed=survey.seed
    )


def true_poses(survey: sweeps.SimulatedSurvey) -> tuple[IntArray, FloatArray]:
    """Return each scan's stamp (m,) from the drive's start, and world_from_sensor (m, 4, 4)."""
    return survey.t_ns, rover.drive_poses(survey.drive, survey.t_ns) @ survey.base_from_sensor


def true_trajectory(survey: sweeps.SimulatedSurvey) -> tuple[IntArray, FloatArray]:
    """Return stamps and poses dense enough to interpolate exactly (`rover.trace_stamps`)."""
    t_ns = rover.trace_stamps(survey.drive, _turn_ns(survey))
    return t_ns, rover.drive_poses(survey.drive, t_ns) @ survey.base_from_sensor


def survey_truth(
    site: building.Building, survey: sweeps.SimulatedSurvey
) -> tuple[list[Feature], dict[str, float]]:
    """Return what is true of a survey.

    Returns
    -------
    features : list of (geometry, dict)
        `truth.truth_features` of the site, with what the scans could see of its walls.
    sensor : dict
        How far, and how far around, each scan sees: `max_range_m`, `field_deg`.
    """
    view = visible_faces.SensorView(survey.sensor.max_range_m, survey.sensor.field_rad)
    _, poses = true_poses(survey)
    field_deg = round(float(np.degrees(view.field_rad)), 3)
    sensor = {"max_range_m": view.max_range_m, "field_deg": field_deg}
    return mark_visible(site.truth, poses, view), sensor


def _turn_ns(survey: sweeps.SimulatedSurvey) -> int:
    return int(np.ceil(survey.sensor.period_s * 1e9))
