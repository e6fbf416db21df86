"""A simulated survey put together from its settings, and what is true of it."""

import numpy as np

from scanplan.evaluation import visibility
from scanplan.simulation import building, clutter, localisation, rover, sensors, sweeps
from scanplan.simulation import truth as ground_truth


def site(data, source, mount, *, seed, route, waypoints_m, start_m, clearance_m, **reading):
    """Read a building and find the rover's way through it.

    Parameters
    ----------
    data : bytes
    source : pathlib.Path
        The file that `data` is from.
    mount : dict
        Settings of `rover.mounted`.
    seed, route, waypoints_m, start_m, clearance_m
        See `building.routed`.
    **reading
        Settings of `building.load`.

    Returns
    -------
    building.Building
        With a way.
    """
    found = building.load(data, source, slice_height_m=mount["height_m"], **reading)
    way = {"route": route, "waypoints_m": waypoints_m, "start_m": start_m, "seed": seed}
    return building.routed(found, source, **way, clearance_m=clearance_m, reach_m=abs(mount["forward_m"]))


def prepare(site, *, seed, mount, sensor, errors, drive, people):
    """Put a rover with a sensor on its way through a floor.

    Parameters
    ----------
    site : building.Building
        With a way.
    seed : int
    mount, sensor, errors, drive, people : dict
        Settings of `rover.mounted`, `sensors.of_model`, `sensors.errors_of`, `rover.drive` and `clutter.walkers`.

    Returns
    -------
    sweeps.Survey

    Raises
    ------
    StageError
        If settings contradict each other.
    """
    device, way = sensors.of_model(**sensor), rover.drive(site.waypoints_m, **drive)
    return sweeps.Survey(
        mesh=site.mesh,
        sensor=device,
        errors=sensors.errors_of(device, **errors, seed=seed),
        drive=way,
        base_from_sensor=rover.mounted(**mount),
        people=clutter.walkers(site.floor_m.difference(site.obstacles_m), until_s=way.t_s[-1], **people, seed=seed),
        t_ns=rover.scan_stamps(way, sensor["rate_hz"]),
        seed=seed,
    )


def belief(survey, **localiser):
    """Return what wheels and localiser say over a survey, a turn of the sensor beyond either end: localisation.Belief.

    Parameters
    ----------
    survey : sweeps.Survey
    **localiser
        Settings of `localisation.believe`.
    """
    tick_ns = rover.tick_stamps(survey.drive, _turn_ns(survey))
    return localisation.believe(tick_ns, rover.poses(survey.drive, tick_ns), **localiser, seed=survey.seed)


def true_poses(survey):
    """Return each scan's stamp (m,) int64 from the start of the drive and world_from_sensor (m, 4, 4) at it."""
    return survey.t_ns, rover.poses(survey.drive, survey.t_ns) @ survey.base_from_sensor


def truth(site, survey):
    """Return what is true of a survey.

    Returns
    -------
    features : list of (geometry, dict)
        `truth.features` of the site, with what the scans could see of its walls.
    sensor : dict
        How far, and how far around, each scan sees: `max_range_m`, `field_deg`.
    """
    sight = visibility.Sight(survey.sensor.max_range_m, survey.sensor.field_rad)
    features = ground_truth.with_sight(site.truth, true_poses(survey)[1], sight)
    return features, {"max_range_m": sight.max_range_m, "field_deg": round(float(np.degrees(sight.field_rad)), 3)}


def true_trajectory(survey):
    """Return stamps and poses like `true_poses`, dense enough to interpolate exactly (`rover.trace_stamps`)."""
    t_ns = rover.trace_stamps(survey.drive, _turn_ns(survey))
    return t_ns, rover.poses(survey.drive, t_ns) @ survey.base_from_sensor


def _turn_ns(survey):
    return int(np.ceil(survey.sensor.period_s * 1e9))
