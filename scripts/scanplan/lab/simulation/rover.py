"""The rover: where it drives, and where it is at any moment."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, Point

from scanplan.errors import StageError

# half of the thesis's 18 inch rover (section 4.2.1)
RADIUS_M = 0.23
TICK_NS = 20_000_000
_TRACE_NS = 10_000_000


@dataclass(frozen=True)
class Drive:
    """A planar motion, linear between key moments; the rover stands still before the first and after the last.

    Attributes
    ----------
    t_s : (k,) float64, strictly increasing from 0
    xy_m : (k, 2) float64
        The base's position in the map.
    yaw_rad : (k,) float64
        Its heading, continuous (not wrapped).
    """

    t_s: np.ndarray
    xy_m: np.ndarray
    yaw_rad: np.ndarray


def plan_drive(waypoints_m, *, speed_m_s, turn_rate_deg_s):
    """Drive a way: straight at constant speed, turning on the spot at every corner, the shorter way round.

    ASSUME the rover starts, stops and turns without inertia.

    Parameters
    ----------
    waypoints_m : (n, 2) float
        Corners; at least two that differ.
    speed_m_s, turn_rate_deg_s : float
        Positive.

    Returns
    -------
    Drive

    Raises
    ------
    ValueError
        If fewer than two waypoints differ or a rate is not positive.
    """
    waypoints_m = np.asarray(waypoints_m, float)
    legs_m = np.diff(waypoints_m, axis=0)
    moving = np.hypot(*legs_m.T) > 0
    if not moving.any() or speed_m_s <= 0 or turn_rate_deg_s <= 0:
        raise ValueError("a drive needs two waypoints that differ and positive rates")
    legs_m = legs_m[moving]
    turns = np.diff(np.arctan2(legs_m[:, 1], legs_m[:, 0]), prepend=np.nan)
    turns = -((np.pi - turns) % (2 * np.pi) - np.pi)
    xy, yaw, t = [waypoints_m[0]], [float(np.arctan2(legs_m[0, 1], legs_m[0, 0]))], [0.0]
    for leg_m, turn in zip(legs_m, turns, strict=True):
        if abs(turn) > 1e-9:
            xy, yaw, t = (
                [*xy, xy[-1]],
                [*yaw, yaw[-1] + turn],
                [*t, t[-1] + abs(turn) / np.radians(turn_rate_deg_s)],
            )
        xy, yaw, t = (
            [*xy, xy[-1] + leg_m],
            [*yaw, yaw[-1]],
            [*t, t[-1] + np.hypot(*leg_m) / speed_m_s],
        )
    return Drive(np.array(t), np.array(xy), np.array(yaw))


def check_way(waypoints_m, floor, obstacles, source, *, reach_m=0.0):
    """Refuse a way that leads through walls or furniture, too close to them, or off the floor.

    Parameters
    ----------
    waypoints_m : (n, 2) float
    floor, obstacles : shapely geometry
        Where there is floor; where something stands on it.
    source : path-like
        What the error names as its origin.
    reach_m : float
        How far the sensor sits from the rover's middle; the way keeps this or the rover's radius from any obstacle.

    Raises
    ------
    StageError
        Naming the first waypoint or leg at fault.
    """
    clearance_m = max(RADIUS_M, reach_m)
    for i, point in enumerate(map(Point, waypoints_m)):
        if obstacles.intersects(point) or not floor.contains(point):
            place = (
                "inside a wall or furniture"
                if obstacles.intersects(point)
                else "outside the outer walls"
            )
            raise StageError(
                f"{source}: waypoint {i} ({point.x:g}, {point.y:g}) lies {place}; move it to free floor"
            )
    for i, leg in enumerate(map(LineString, pairwise(waypoints_m))):
        room_m = leg.distance(obstacles)
        if room_m < clearance_m:
            at = shapely.get_point(shapely.shortest_line(leg, obstacles), 0)
            raise StageError(
                f"{source}: the way from waypoint {i} to {i + 1} passes a wall or furniture at {room_m:.2f} m"
                f" near ({at.x:.2f}, {at.y:.2f}), the rover needs {clearance_m:.2f} m; move the waypoints"
            )


def scan_stamps(driven, rate_hz):
    """Return the moments of the scans, from the start to the end of a drive: (n,) int64 nanoseconds from its start."""
    count = int(np.floor(driven.t_s[-1] * rate_hz + 1e-9)) + 1
    return np.round(np.arange(count) * 1e9 / rate_hz).astype(np.int64)


def tick_stamps(driven, margin_ns):
    """Return the moments at which the rover's own clock ticks: (n,) int64 nanoseconds from the start of the drive.

    The first is `margin_ns` or more before the drive and the last as much after it, and none coincides with a scan
    at 10 Hz.
    """
    first_ns = -(margin_ns // TICK_NS + 1) * TICK_NS + TICK_NS // 2
    first_ns -= TICK_NS * (first_ns > -margin_ns)
    return np.arange(first_ns, _end_ns(driven) + margin_ns + TICK_NS, TICK_NS, dtype=np.int64)


def trace_stamps(driven, margin_ns):
    """Return moments between which a drive is even: (n,) int64 nanoseconds from its start, strictly increasing.

    100 a second, and every moment at which the motion changes: interpolated linearly (positions) and spherically
    (rotations), the poses then are those of a sensor on the rover to a few micrometres. They reach `margin_ns` beyond
    both ends.
    """
    grid = np.arange(-margin_ns, _end_ns(driven) + margin_ns + _TRACE_NS, _TRACE_NS, dtype=np.int64)
    return np.union1d(grid, np.round(driven.t_s * 1e9).astype(np.int64))


def _end_ns(driven):
    return int(np.ceil(driven.t_s[-1] * 1e9))


def drive_poses(driven, t_ns):
    """Return world_from_base at moments of a drive: (n, 4, 4) float64."""
    t_s = np.asarray(t_ns) / 1e9
    xy_m = np.column_stack([np.interp(t_s, driven.t_s, axis) for axis in driven.xy_m.T])
    return planar_poses(xy_m, np.interp(t_s, driven.t_s, driven.yaw_rad))


def mount_sensor(*, height_m, forward_m, yaw_deg):
    """Return base_from_sensor (4, 4) of a level sensor: above the floor, before the rover's middle, turned."""
    return planar_poses([[forward_m, 0.0]], np.radians([yaw_deg]), height_m)[0]


def planar_poses(xy_m, yaw_rad, z_m=0.0):
    """Return the (n, 4, 4) poses of positions (n, 2) and headings (n,) on a level plane."""
    yaw_rad = np.asarray(yaw_rad, float)
    pose = np.tile(np.eye(4), (len(yaw_rad), 1, 1))
    pose[:, 0, 0] = pose[:, 1, 1] = np.cos(yaw_rad)
    pose[:, 1, 0] = np.sin(yaw_rad)
    pose[:, 0, 1] = -pose[:, 1, 0]
    pose[:, :2, 3] = xy_m
    pose[:, 2, 3] = z_m
    return pose
