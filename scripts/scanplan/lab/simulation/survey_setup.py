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
    sensors,
    sweeps,
)
from scanplan.lab.simulation.odometry import WheelErrors
from scanplan.lab.simulation.survey_truth import mark_visible
from scanplan.types import FloatArray, IntArray, Settings

_START = ("start_off_m", "start_off_deg", "converge_m")
_SLAM = ("walk_m", "walk_deg")
_SPEAKING = ("update_distance_m", "update_angle_deg")
_ROUTE = ("route", "waypoints_m", "start_m", "clearance_m")
_TURNING = ("rate_hz", "sweep", "min_range_m", "max_range_m")
_CLUTTER = ("chairs", "doors_ajar")


def prepare_site(
    data: bytes, source: Path, settings: Settings, *, seed: int, planar: bool = False
) -> building.Building:
    """Read a building and find the rover's way through it.

    Parameters
    ----------
    source : pathlib.Path
        The file that `data` is from.
    settings : dict
        `mount`, see `rover.mount_sensor`, and `site`: settings of `building.load_building`,
        `building_route.plan_building_route`, `clutter.add_clutter`, and `leaves`, the share of
        doors for `random_leaves.hang_leaves`.
    planar : bool
        Whether the sensor is a 2-D scanner.

    Returns
    -------
    building.Building
        With a way.
    """
    mount, site = settings["mount"], settings["site"]
    route = {key: site[key] for key in _ROUTE}
    things = {key: site[key] for key in _CLUTTER}
    others = (*_ROUTE, *_CLUTTER, "leaves")
    reading = {key: value for key, value in site.items() if key not in others}
    found = building.load_building(
        data,
        source,
        slice_height_m=mount["height_m"],
        planar=planar,
        reading=building.FileReading(**reading),
    )
    if site.get("leaves", 0.0) > 0:
        given_m = found.waypoints_m if route["waypoints_m"] is None else route["waypoints_m"]
        found = random_leaves.hang_leaves(
            found,
            share=site["leaves"],
            seed=seed,
            slice_height_m=mount["height_m"],
            planar=planar,
            track=None
            if given_m is None or route["route"] != "given"
            else random_leaves.widen_track(given_m, abs(mount["forward_m"])),
        )
    driven = building_route.plan_building_route(
        found,
        source,
        building_route.WaySettings(**route),
        reach_m=abs(mount["forward_m"]),
        seed=seed,
    )
    return clutter.add_clutter(driven, **things, seed=seed)


def prepare_survey(
    site: building.Building, settings: Settings, *, seed: int
) -> sweeps.SimulatedSurvey:
    """Put a rover with a sensor on its way through a floor.

    Parameters
    ----------
    site : building.Building
        With a way.
    settings : dict
        `mount`, `sensor`, `errors`, `drive` and `people`: see `rover.mount_sensor`,
        `sensor_models.make_sensor`, `sensor_errors.StatedErrors`, `plan_motion` and
        `invite_people`.

    Raises
    ------
    StageError
        If settings contradict each other.
    ValueError
        If the building has no way.
    """
    if site.waypoints_m is None:
        raise ValueError("a survey needs a building with a way through it")
    turning = {key: settings["sensor"][key] for key in _TURNING}
    beams = {key: value for key, value in settings["sensor"].items() if key not in _TURNING}
    lidar = sensor_models.make_sensor(turning=sensors.Turning(**turning), **beams)
    base_from_sensor = rover.mount_sensor(**settings["mount"])
    drive = plan_motion(site.waypoints_m, base_from_sensor, settings["drive"], seed=seed)
    free = overlays.subtract_areas(site.floor_m, site.obstacles_m)
    stated = sensor_errors.StatedErrors(**settings["errors"])
    return sweeps.SimulatedSurvey(
        mesh=site.mesh,
        sensor=lidar,
        errors=sensor_errors.draw_sensor_errors(lidar, stated, seed=seed),
        drive=drive,
        base_from_sensor=base_from_sensor,
        people=invite_people(free, drive, settings["people"], seed=seed),
        t_ns=rover.scan_stamps(drive, settings["sensor"]["rate_hz"]),
        seed=seed,
    )


def plan_motion(
    waypoints_m: FloatArray, base_from_sensor: FloatArray, drive: Settings, *, seed: int
) -> rover.Drive:
    """Return a drive as `rover.plan_drive`, swaying as `rover.carry_in_hand`.

    Whether the recorded poses state the sway, `sway_known`, is another's: the motion is the same.
    """
    speed = {key: drive[key] for key in ("speed_m_s", "turn_rate_deg_s")}
    hand = {key: drive[key] for key in ("sway_m", "sway_deg")}
    planned = rover.plan_drive(waypoints_m, **speed)
    return rover.carry_in_hand(planned, base_from_sensor, **hand, seed=seed)


def invite_people(
    free: BaseGeometry, drive: rover.Drive, wanted: Settings, *, seed: int
) -> tuple[people.Person, ...]:
    """Return so many people who wander, who stand about and who follow the sensor.

    Parameters
    ----------
    wanted : dict
        `count` and `speed_m_s` of `people.simulate_walkers`, `standing` of
        `companions.place_standing`, `followers` of `companions.follow_sensor`.
    """
    pace = {"speed_m_s": wanted["speed_m_s"], "until_s": drive.t_s[-1]}
    return (
        *people.simulate_walkers(free, wanted["count"], **pace, seed=seed),
        *companions.place_standing(free, drive, wanted["standing"], seed=seed),
        *companions.follow_sensor(free, drive, wanted["followers"]),
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
        Settings of `odometry.WheelErrors`.
    kind : {"amcl", "slam"}
        Whether the localiser knows the map, or makes it.
    sway_known : bool
        Whether odometry and localiser state how the hand sways; otherwise they are planar.
    **localiser
        Settings of `localisation.Localiser` and `localisation.LocaliserErrors`,
        `localisation.draw_start` and `slam.track_poses`.
    """
    tick_ns = rover.tick_stamps(survey.drive, _turn_ns(survey))
    swaying = survey.drive.sway if sway_known else None
    slam = {key: localiser.pop(key) for key in _SLAM}
    start = {key: localiser.pop(key) for key in _START}
    speaking = {key: localiser.pop(key) for key in _SPEAKING}
    return localisation.simulate_belief(
        tick_ns,
        rover.level_poses(survey.drive, tick_ns),
        localisation.Localiser(
            **speaking,
            errors=localisation.LocaliserErrors(**localiser),
            start=start,
            slam=slam if kind == "slam" else None,
        ),
        WheelErrors(**odometry),
        sway=None if swaying is None else hand_sway.sway_poses(swaying, tick_ns),
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
