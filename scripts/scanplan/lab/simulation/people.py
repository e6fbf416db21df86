"""People who walk through a survey."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Point

from scanplan.lab.simulation import raycast

RADIUS_M = 0.2
HEIGHT_M = 1.75
# a person keeps this far from walls, and steps out of the way of a sensor nearer than it
_CLEARANCE_M = RADIUS_M + 0.1
_REFLECTIVITY = 40.0
_STREAM = 6
_TRIES = 30
_REST_S = 2.0


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

    t_s: np.ndarray
    xy_m: np.ndarray


def simulate_walkers(free, count, *, speed_m_s, until_s, seed):
    """Let people wander: straight ways between random places, each in sight of the last, with a rest where none is.

    Parameters
    ----------
    free : shapely geometry
        Floor without obstacles.
    count : int
    speed_m_s : float
    until_s : float
        How long they walk.
    seed : int

    Returns
    -------
    tuple of Person
        Empty where there is no room to walk.
    """
    room = shapely.buffer(free, -_CLEARANCE_M)
    if room.is_empty:
        return ()
    shapely.prepare(room)
    return tuple(
        _walk(room, speed_m_s, until_s, np.random.default_rng([seed, _STREAM, i]))
        for i in range(count)
    )


def find_person_hits(people, t_s, origin_m, direction):
    """Find which rays meet a person: an upright cylinder on the floor.

    ASSUME nobody is seen from above: the top of a cylinder is open.

    Parameters
    ----------
    people : sequence of Person
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
    ray = direction.reshape(-1, 3)
    range_m = np.full(len(ray), np.inf, np.float32)
    cosine = np.zeros(len(ray), np.float32)
    for person in people:
        ahead_m = (
            np.column_stack([np.interp(t_s, person.t_s, axis) for axis in person.xy_m.T])
            - origin_m[:, :2]
        )
        if np.hypot(*ahead_m.T).min() < _CLEARANCE_M:
            continue
        x, y = np.repeat(ahead_m, n_beams, axis=0).T.astype(np.float32)
        aside = ray[:, 0] * y - ray[:, 1] * x
        level = ray[:, 0] ** 2 + ray[:, 1] ** 2
        (near,) = np.nonzero((aside**2 < RADIUS_M**2 * level) & (ray[:, 0] * x + ray[:, 1] * y > 0))
        middle = ray[near, 0] * x[near] + ray[near, 1] * y[near]
        half = np.sqrt(level[near] * RADIUS_M**2 - aside[near] ** 2)
        met_m = (middle - half) / level[near]
        z_m = origin_m[near // n_beams, 2] + met_m * ray[near, 2]
        first = (z_m >= 0) & (z_m <= HEIGHT_M) & (met_m < range_m[near])
        range_m[near[first]] = met_m[first]
        # the normal points from the axis to the hit: its product with the ray is -half / radius
        cosine[near[first]] = half[first] / RADIUS_M
    return raycast.RayHits(range_m, cosine, np.full(len(ray), _REFLECTIVITY, np.float32))


def merge_hits(building, people):
    """Return of two sets of raycast.RayHits on the same rays what comes first."""
    person = people.range_m < building.range_m
    return raycast.RayHits(
        np.where(person, people.range_m, building.range_m),
        np.where(person, people.cosine, building.cosine),
        np.where(person, people.reflectivity, building.reflectivity),
    )


def _walk(room, speed_m_s, until_s, generator):
    at = _place(room, generator)
    t_s, xy_m = [0.0], [at]
    while t_s[-1] < until_s:
        onward = (_place(room, generator) for _ in range(_TRIES))
        goal = next((xy for xy in onward if xy != at and room.contains(LineString([at, xy]))), None)
        seconds = (
            _REST_S
            if goal is None
            else float(np.hypot(goal[0] - at[0], goal[1] - at[1])) / speed_m_s
        )
        at = goal or at
        t_s, xy_m = [*t_s, t_s[-1] + seconds], [*xy_m, at]
    return Person(np.array(t_s), np.array(xy_m))


def _place(room, generator):
    """Return a point (x, y) inside, evenly distributed."""
    low, high = np.array(room.bounds).reshape(2, 2)
    while True:
        xy = tuple(generator.uniform(low, high).tolist())
        if room.contains(Point(xy)):
            return xy
