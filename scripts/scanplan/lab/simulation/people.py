"""People who walk through a survey."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import raycast
from scanplan.types import FloatArray

RADIUS_M = 0.2  # ASSUME an adult seen from above is a disc of 40 cm
HEIGHT_M = 1.75  # ASSUME an adult
CLEARANCE_M = RADIUS_M + 0.1  # to walls, and to the sensor, of which they step out of the way
_GOAL_TRIES = 30  # places drawn for one in sight: few rests against the time of a simulation


@dataclass(frozen=True)
class Person:
    """A walk, linear between key moments; the person stands before the first and after the last.

    Attributes
    ----------
    t_s : (k,) float64, strictly increasing
        Seconds from the start of the drive.
    xy_m : (k, 2) float64
        Map frame.
    """

    t_s: FloatArray
    xy_m: FloatArray


def simulate_walkers(
    free: BaseGeometry, count: int, *, speed_m_s: float, until_s: float, seed: int
) -> tuple[Person, ...]:
    """Let people wander straight between random places, each in sight of the last.

    Where no place is in sight they rest.

    Parameters
    ----------
    free : shapely geometry
        Floor without obstacles.
    until_s : float
        How long they walk.

    Returns
    -------
    tuple of Person
        Empty where there is no room to walk.
    """
    room = overlays.buffer_shapes(free, -CLEARANCE_M, quad_segs=8)
    if room.is_empty:
        return ()
    shapely.prepare(room)
    generators = (open_stream(seed, RandomStream.PEOPLE, i) for i in range(count))
    return tuple(_walk(room, speed_m_s, until_s, generator) for generator in generators)


def list_apart(
    people: Sequence[Person], t_s: FloatArray, sensor_m: FloatArray
) -> tuple[Person, ...]:
    """Return the people who at no moment (c,) stand at the sensor (c, 3): others step aside."""
    return tuple(
        person
        for person in people
        if np.hypot(*(_places(person, t_s) - sensor_m[:, :2]).T).min() >= CLEARANCE_M
    )


def find_person_hits(
    people: Sequence[Person], t_s: FloatArray, origin_m: FloatArray, direction: FloatArray
) -> raycast.RayHits:
    """Find the first person that each ray meets: an upright cylinder on the floor.

    ASSUME nobody is seen from above: the top of a cylinder is open.

    Parameters
    ----------
    people : sequence of Person
        Who stands at the sensor is none of them (`list_apart`).
    t_s : (c,) float
        When each column of rays starts.
    origin_m : (c, 3) float
        Where it starts, map frame, the floor at z = 0.
    direction : (c, b, 3) float
        Unit vectors.

    Returns
    -------
    raycast.RayHits
        Of all rays, flat (c * b,).
    """
    n_beams = direction.shape[1]
    rays = direction.reshape(-1, 3)
    range_m = np.full(len(rays), np.inf, np.float32)
    cosine = np.zeros(len(rays), np.float32)
    for person in people:
        place_m = _places(person, t_s)
        ahead_m = place_m - origin_m[:, :2]
        met, met_m, met_cosine = _meet_cylinder(rays, np.repeat(ahead_m, n_beams, axis=0))
        z_m = origin_m[met // n_beams, 2] + met_m * rays[met, 2]
        first = (z_m >= 0) & (z_m <= HEIGHT_M) & (met_m < range_m[met])
        range_m[met[first]] = met_m[first]
        cosine[met[first]] = met_cosine[first]
    clothes = np.full(len(rays), raycast.REFLECTIVITY["person"], np.float32)
    return raycast.RayHits(range_m, cosine, clothes)


def merge_hits(building: raycast.RayHits, people: raycast.RayHits) -> raycast.RayHits:
    """Return the nearer of two hits of the same rays."""
    is_person = people.range_m < building.range_m
    return raycast.RayHits(
        np.where(is_person, people.range_m, building.range_m),
        np.where(is_person, people.cosine, building.cosine),
        np.where(is_person, people.reflectivity, building.reflectivity),
    )


def _places(person: Person, t_s: FloatArray) -> FloatArray:
    """Return where a person is (c, 2) at some moments (c,)."""
    return np.column_stack([np.interp(t_s, person.t_s, axis) for axis in person.xy_m.T])


def _meet_cylinder(
    rays: FloatArray, ahead_m: FloatArray
) -> tuple[np.ndarray, FloatArray, FloatArray]:
    """Return the rays that meet an endless upright cylinder, how far away, and the cosines there.

    `ahead_m` (n, 2) leads from the start of each ray to the cylinder's axis.
    """
    x, y = ahead_m.T.astype(np.float32)
    aside = rays[:, 0] * y - rays[:, 1] * x
    level = rays[:, 0] ** 2 + rays[:, 1] ** 2
    is_towards = rays[:, 0] * x + rays[:, 1] * y > 0
    (met,) = np.nonzero((aside**2 < RADIUS_M**2 * level) & is_towards)
    middle = rays[met, 0] * x[met] + rays[met, 1] * y[met]
    half_chord = np.sqrt(level[met] * RADIUS_M**2 - aside[met] ** 2)
    # the normal points from the axis to the hit: its product with the ray is -half_chord / radius
    return met, (middle - half_chord) / level[met], half_chord / RADIUS_M


def _walk(
    room: BaseGeometry, speed_m_s: float, until_s: float, generator: np.random.Generator
) -> Person:
    t_s = [0.0]
    xy_m = [draw_place(room, generator)]
    while t_s[-1] < until_s:
        here = xy_m[-1]
        goal = _draw_goal(room, here, generator)
        if goal is None:
            # a rest, then all is drawn anew
            t_s.append(t_s[-1] + 2.0)
            xy_m.append(here)
        else:
            t_s.append(t_s[-1] + float(np.hypot(goal[0] - here[0], goal[1] - here[1])) / speed_m_s)
            xy_m.append(goal)
    return Person(np.array(t_s), np.array(xy_m))


def _draw_goal(
    room: BaseGeometry, here: tuple[float, float], generator: np.random.Generator
) -> tuple[float, float] | None:
    """Return a random place in sight, None if none of some tries is."""
    for _ in range(_GOAL_TRIES):
        goal = draw_place(room, generator)
        if goal != here and room.contains(LineString([here, goal])):
            return goal
    return None


def draw_place(room: BaseGeometry, generator: np.random.Generator) -> tuple[float, float]:
    """Return a point (x, y) inside, evenly distributed."""
    low, high = np.array(room.bounds).reshape(2, 2)
    while True:
        x, y = generator.uniform(low, high).tolist()
        if room.contains(Point(x, y)):
            return x, y
