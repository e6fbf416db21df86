"""A simulated survey put together from its settings."""

from pathlib import Path
from typing import Any

import numpy as np
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings import building, building_route, clutter, random_leaves
from scanplan.lab.buildings.truth import Feature
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.simulation import (
    companions,
    hand_sway,
    localisation,
    people,
    rover,
    sensor_errors,
    sensor_models,
    sweeps,
)
from scanplan.lab.simulation.survey_truth import mark_visible
from scanplan.types import FloatArray, IntArray, Settings

_START = ("start_off_m", "start_off_deg", "converge_m")
_SLAM = ("walk_m", "walk_deg", "loop_late_m")


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
    mount, sensor, errors, drive, people : dict
        Settings of `rover.mount_sensor`, `sensor_models.make_sensor`,
        `sensor_errors.draw_sensor_errors`, `plan_motion` and `invite_people`.

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
    lidar = sensor_models.make_sensor(**sensor)
    base_from_sensor = rover.mount_sensor(**mount)
    way = plan_motion(site.waypoints_m, base_from_sensor, **drive, seed=seed)
    free = overlays.subtract_areas(site.floor_m, site.obstacles_m)
    return sweeps.SimulatedSurvey(
        mesh=site.mesh,
        sensor=lidar,
        errors=sensor_errors.draw_sensor_errors(lidar, **errors, seed=seed),
        drive=way,
        base_from_sensor=base_from_sensor,
        people=invite_people(free, way, **people, seed=seed),
        t_ns=rover.scan_stamps(way, sensor["rate_hz"]),
        seed=seed,
    )


def plan_motion(
    waypoints_m: FloatArray,
    base_from_sensor: FloatArray,
    *,
    speed_m_s: float,
    turn_rate_deg_s: float,
    sway_m: float,
    sway_deg: float,
    sway_hz: float,
    sway_known: bool,
    seed: int,
) -> rover.Drive:
    """Return a drive as `rover.plan_drive`, swaying as `rover.carry_in_hand`.

    `sway_known` says whether the recorded poses state the sway; the motion is the same.
    """
    del sway_known
    way = rover.plan_drive(waypoints_m, speed_m_s=speed_m_s, turn_rate_deg_s=turn_rate_deg_s)
    hand = {"sway_m": sway_m, "sway_deg": sway_deg, "sway_hz": sway_hz}
    return rover.carry_in_hand(way, base_from_sensor, **hand, seed=seed)


def invite_people(
    free: BaseGeometry,
    way: rover.Drive,
    *,
    count: int,
    speed_m_s: float,
    standing: int,
    followers: int,
    seed: int,
) -> tuple[people.Person, ...]:
    """Return so many people who wander, who stand about and who follow the sensor.

    See `people.simulate_walkers`, `companions.place_standing` and `companions.follow_sensor`.
    """
    until_s = way.t_s[-1]
    return (
        *people.simulate_walkers(free, count, speed_m_s=speed_m_s, until_s=until_s, seed=seed),
        *companions.place_standing(free, way, standing, seed=seed),
        *companions.follow_sensor(free, way, followers),
    )


def survey_belief(
    survey: sweeps.SimulatedSurvey,
    odometry: Settings,
    *,
    kind: str,
    sway_known: bool,
    **localiser: Any,
) -> localisation.Belief:
    """Return what wheels and localiser estimate, a turn of the sensor beyond either end.

    Parameters
    ----------
    odometry : dict
        Settings of `odometry.integrate_odometry`.
    kind : {"amcl", "slam"}
        Whether the localiser knows the map, or makes it.
    sway_known : bool
        Whether odometry and localiser state how the hand sways; otherwise they are planar.
    **localiser
        Settings of `localisation.simulate_belief`, `localisation.draw_start` and
        `slam.track_poses`.
    """
    tick_ns = rover.tick_stamps(survey.drive, _turn_ns(survey))
    swaying = survey.drive.sway if sway_known else None
    slam = {key: localiser.pop(key) for key in _SLAM}
    return localisation.simulate_belief(
        tick_ns,
        rover.level_poses(survey.drive, tick_ns),
        odometry=odometry,
        start={key: localiser.pop(key) for key in _START},
        slam=slam if kind == "slam" else None,
        sway=None if swaying is None else hand_sway.sway_poses(swaying, tick_ns),
        **localiser,
        seed=survey.seed,
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
