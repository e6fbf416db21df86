"""A simulated survey put together from its settings, and what is true of it."""

import numpy as np

from scanplan.lab.buildings import building
from scanplan.lab.buildings.truth import mark_visible
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.simulation import localisation, rover, sensors, sweeps
from scanplan.lab.simulation.people import simulate_walkers


def prepare_site(data, source, mount, *, seed, route, waypoints_m, start_m, clearance_m, **reading):
    """Read a building and find the rover's way through it.

    Parameters
    ----------
    data : bytes
    source : pathlib.Path
        The file that `data` is from.
    mount : dict
        Settings of `rover.mount_sensor`.
    seed, route, waypoints_m, start_m, clearance_m
        See `building.plan_building_route`.
    **reading
        Settings of `building.load_building`.

    Returns
    -------
    building.Building
        With a way.
    """
    found = building.load_building(data, source, slice_height_m=mount["height_m"], **reading)
    way = {"route": route, "waypoints_m": waypoints_m, "start_m": start_m, "seed": seed}
    return building.plan_building_route(
        found, source, **way, clearance_m=clearance_m, reach_m=abs(mount["forward_m"])
    )


def prepare_survey(site, *, seed, mount, sensor, errors, drive, people):
    """Put a rover with a sensor on its way through a floor.

    Parameters
    ----------
    site : building.Building
        With a way.
    seed : int
    mount, sensor, errors, drive, people : dict
        Settings of `rover.mount_sensor`, `sensors.make_sensor`, `sensors.draw_sensor_errors`, `rover.plan_drive` and `people.simulate_walkers`.

    Returns
    -------
    sweeps.SimulatedSurvey

    Raises
    ------
    StageError
        If settings contradict each other.
    """
    device, way = sensors.make_sensor(**sensor), rover.plan_drive(site.waypoints_m, **drive)
    return sweeps.SimulatedSurvey(
        mesh=site.mesh,
        sensor=device,
        errors=sensors.draw_sensor_errors(device, **errors, seed=seed),
        drive=way,
        base_from_sensor=rover.mount_sensor(**mount),
        people=simulate_walkers(
            site.floor_m.difference(site.obstacles_m), until_s=way.t_s[-1], **people, seed=seed
        ),
        t_ns=rover.scan_stamps(way, sensor["rate_hz"]),
        seed=seed,
    )


def survey_belief(survey, **localiser):
    """Return what wheels and localiser say over a survey, a turn of the sensor beyond either end: localisation.Belief.

    Parameters
    ----------
    survey : sweeps.SimulatedSurvey
    **localiser
        Settings of `localisation.simulate_belief`.
    """
    tick_ns = rover.tick_stamps(survey.drive, _turn_ns(survey))
    return localisation.simulate_belief(
        tick_ns, rover.drive_poses(survey.drive, tick_ns), **localiser, seed=survey.seed
    )


def true_poses(survey):
    """Return each scan's stamp (m,) int64 from the start of the drive and world_from_sensor (m, 4, 4) at it."""
    return survey.t_ns, rover.drive_poses(survey.drive, survey.t_ns) @ survey.base_from_sensor


def survey_truth(site, survey):
    """Return what is true of a survey.

    Returns
    -------
    features : list of (geometry, dict)
        `truth.truth_features` of the site, with what the scans could see of its walls.
    sensor : dict
        How far, and how far around, each scan sees: `max_range_m`, `field_deg`.
    """
    sight = visible_faces.SensorView(survey.sensor.max_range_m, survey.sensor.field_rad)
    features = mark_visible(site.truth, true_poses(survey)[1], sight)
    return features, {
        "max_range_m": sight.max_range_m,
        "field_deg": round(float(np.degrees(sight.field_rad)), 3),
    }


def true_trajectory(survey):
    """Return stamps and poses like `true_poses`, dense enough to interpolate exactly (`rover.trace_stamps`)."""
    t_ns = rover.trace_stamps(survey.drive, _turn_ns(survey))
    return t_ns, rover.drive_poses(survey.drive, t_ns) @ survey.base_from_sensor


def _turn_ns(survey):
    return int(np.ceil(survey.sensor.period_s * 1e9))
