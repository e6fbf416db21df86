"""People who do not wander: who stand about, and who follow the sensor."""

import numpy as np
import shapely
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import people, rover
from scanplan.types import FloatArray

# ASSUME who guides or watches a survey keeps this far behind, and the next so much farther
_BEHIND_M = 1.2
_APART_M = 0.8
_FROM_WAY_M = 0.5  # ASSUME people stand beside where the sensor is to pass, not in its way


def place_standing(
    free: BaseGeometry, drive: rover.Drive, count: int, *, seed: int
) -> tuple[people.Person, ...]:
    """Let people stand about at random, clear of walls and of the way.

    Parameters
    ----------
    free : shapely geometry
        Floor without obstacles.

    Returns
    -------
    tuple of people.Person
        Empty where there is no room.
    """
    track = LineString(drive.xy_m)
    room = overlays.buffer_shapes(free, -people.CLEARANCE_M, quad_segs=8)
    room = overlays.subtract_areas(room, overlays.buffer_shapes(track, _FROM_WAY_M, quad_segs=8))
    if room.is_empty:
        return ()
    shapely.prepare(room)
    generators = (open_stream(seed, RandomStream.STANDING, i) for i in range(count))
    places = [people.draw_place(room, generator) for generator in generators]
    return tuple(people.Person(np.zeros(1), np.array([place])) for place in places)


def follow_sensor(free: BaseGeometry, drive: rover.Drive, count: int) -> tuple[people.Person, ...]:
    """Let people follow the sensor along its own way, one behind the other.

    Each is where the sensor was some way before, so in its steps, and stands while it turns. At the
    start they stand behind it, as far as the floor goes there. Where the sensor turns back it meets
    them, and they step aside.

    Parameters
    ----------
    free : shapely geometry
        Floor without obstacles.

    Returns
    -------
    tuple of people.Person
    """
    behind_m = _BEHIND_M + _APART_M * np.arange(count)
    return tuple(_follow(free, drive, lag_m) for lag_m in behind_m.tolist())


def _follow(free: BaseGeometry, drive: rover.Drive, lag_m: float) -> people.Person:
    steps_m = np.hypot(*np.diff(drive.xy_m, axis=0).T)
    way_m = np.concatenate([[0], np.cumsum(steps_m)])
    start_m = drive.xy_m[0] - _room_behind_m(free, drive, lag_m) * _heading(drive)
    # the person's own way begins there, and is as long before the start as the lag
    track_way_m = np.concatenate([[-lag_m], way_m])
    track_m = np.vstack([start_m, drive.xy_m])
    # its corners are passed when the sensor is ahead by the lag: until then and then straight on
    # (while it turns a hair of way keeps ways and moments one to one)
    passed_s = np.interp(way_m + lag_m, way_m + SAME_M * drive.t_s / drive.t_s[-1], drive.t_s)
    t_s = np.union1d(drive.t_s, passed_s)
    at_m = np.interp(t_s, drive.t_s, way_m) - lag_m
    xy_m = np.column_stack([np.interp(at_m, track_way_m, axis) for axis in track_m.T])
    return people.Person(t_s, xy_m)


def _heading(drive: rover.Drive) -> FloatArray:
    return np.array([np.cos(drive.yaw_rad[0]), np.sin(drive.yaw_rad[0])])


def _room_behind_m(free: BaseGeometry, drive: rover.Drive, lag_m: float) -> float:
    """Return how far behind the start, at most the lag, one can stand with floor all the way."""
    back = LineString([drive.xy_m[0], drive.xy_m[0] - lag_m * _heading(drive)])
    walked = overlays.intersect_lines(
        back, overlays.buffer_shapes(free, -people.CLEARANCE_M, quad_segs=8)
    )
    parts = [part for part in shapely.get_parts(walked) if part.length > 0]
    start = shapely.Point(drive.xy_m[0])
    return max((part.length for part in parts if part.distance(start) < SAME_M), default=0.0)
