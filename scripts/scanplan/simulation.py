"""A simulated survey put together from its settings, and what is true of it."""

import numpy as np

from scanplan import buildings, clutter, extrusion, localisation, rover, sensors, sweeps


def prepare(plan, source, *, seed, mount, sensor, errors, drive, people):
    """Put a rover with a sensor on its way through a floor.

    Parameters
    ----------
    plan : buildings.Plan
    source : path-like
        Where the plan is from, for errors.
    seed : int
    mount, sensor, errors, drive, people : dict
        Settings of `rover.mounted`, `sensors.of_model`, `sensors.errors_of`, `rover.drive` and `clutter.walkers`.

    Returns
    -------
    sweeps.Survey

    Raises
    ------
    StageError
        If the way is blocked or settings contradict each other.
    """
    ground, blocked = buildings.footprint(plan), buildings.obstacles(plan, mount["height_m"])
    rover.check_way(plan.waypoints_m, ground, blocked, source, reach_m=abs(mount["forward_m"]))
    device, way = sensors.of_model(**sensor), rover.drive(plan.waypoints_m, **drive)
    return sweeps.Survey(
        mesh=extrusion.building_mesh(plan),
        sensor=device,
        errors=sensors.errors_of(device, **errors, seed=seed),
        drive=way,
        base_from_sensor=rover.mounted(**mount),
        people=clutter.walkers(ground.difference(blocked), until_s=way.t_s[-1], **people, seed=seed),
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


def true_trajectory(survey):
    """Return stamps and poses like `true_poses`, dense enough to interpolate exactly (`rover.trace_stamps`)."""
    t_ns = rover.trace_stamps(survey.drive, _turn_ns(survey))
    return t_ns, rover.poses(survey.drive, t_ns) @ survey.base_from_sensor


def _turn_ns(survey):
    return int(np.ceil(survey.sensor.period_s * 1e9))
