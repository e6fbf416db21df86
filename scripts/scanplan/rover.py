"""The rover: where it drives, where it is at any moment, and where it believes itself to be."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, Point

from scanplan.errors import StageError

# half of the thesis's 18 inch rover (section 4.2.1)
RADIUS_M = 0.23
TICK_NS = 50_000_000
_TICK_LEAD_NS = 20_000_000
# ASSUME wheels and gyro of a small rover: 1 % scale error each, constant over a drive
_ODOMETRY_SCALE_ERROR = 0.01
_LOCALISER_STREAM, _ODOMETRY_STREAM = 1, 2


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


def drive(waypoints_m, *, speed_m_s, turn_rate_rad_s):
    """Drive a way: straight at constant speed, turning on the spot at every corner, the shorter way round.

    ASSUME the rover starts, stops and turns without inertia.

    Parameters
    ----------
    waypoints_m : (n, 2) float
        Corners; at least two that differ.
    speed_m_s, turn_rate_rad_s : float
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
    if not moving.any() or speed_m_s <= 0 or turn_rate_rad_s <= 0:
        raise ValueError("a drive needs two waypoints that differ and positive rates")
    legs_m = legs_m[moving]
    turns = np.diff(np.arctan2(legs_m[:, 1], legs_m[:, 0]), prepend=np.nan)
    turns = -((np.pi - turns) % (2 * np.pi) - np.pi)
    xy, yaw, t = [waypoints_m[0]], [float(np.arctan2(legs_m[0, 1], legs_m[0, 0]))], [0.0]
    for leg_m, turn in zip(legs_m, turns, strict=True):
        if abs(turn) > 1e-9:
            xy, yaw, t = [*xy, xy[-1]], [*yaw, yaw[-1] + turn], [*t, t[-1] + abs(turn) / turn_rate_rad_s]
        xy, yaw, t = [*xy, xy[-1] + leg_m], [*yaw, yaw[-1]], [*t, t[-1] + np.hypot(*leg_m) / speed_m_s]
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
            place = "inside a wall or furniture" if obstacles.intersects(point) else "outside the outer walls"
            raise StageError(f"{source}: waypoint {i} ({point.x:g}, {point.y:g}) lies {place}; move it to free floor")
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


def tick_stamps(driven):
    """Return the moments at which the rover's own clock ticks: (n,) int64 nanoseconds from the start of the drive.

    The first is before the first scan and the last after the last, and none coincides with a scan at 10 Hz.
    """
    last_ns = int(np.ceil(driven.t_s[-1] * 1e9))
    return np.arange(-_TICK_LEAD_NS, last_ns + TICK_NS, TICK_NS, dtype=np.int64)


def poses(driven, t_ns):
    """Return world_from_base at moments of a drive: (n, 4, 4) float64."""
    t_s = np.asarray(t_ns) / 1e9
    xy_m = np.column_stack([np.interp(t_s, driven.t_s, axis) for axis in driven.xy_m.T])
    return planar_poses(xy_m, np.interp(t_s, driven.t_s, driven.yaw_rad))


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


def localise(world_from_base, *, noise_m, noise_rad, update_distance_m, update_angle_rad, seed):
    """Return what a localiser publishes: noisy poses, and only after enough motion, as AMCL does.

    ASSUME the errors of one update are independent of the last one's, Gaussian, the same in all directions.

    Parameters
    ----------
    world_from_base : (n, 4, 4) float64
        True planar poses at the rover's ticks.
    noise_m, noise_rad : float
        Standard deviation of x and of y, and of the heading.
    update_distance_m, update_angle_rad : float
        Motion since the last update that brings the next.
    seed : int

    Returns
    -------
    tick : (m,) int64
        The ticks with an update: the first, the last, and those after enough motion.
    believed : (m, 4, 4) float64
        world_from_base with its error.
    """
    xy_m, yaw = world_from_base[:, :2, 3], _yaw(world_from_base)
    tick = [0]
    for i in range(1, len(yaw)):
        turned = abs(np.angle(np.exp(1j * (yaw[i] - yaw[tick[-1]]))))
        moved_m = np.hypot(*(xy_m[i] - xy_m[tick[-1]]))
        if moved_m >= update_distance_m or turned >= update_angle_rad or i == len(yaw) - 1:
            tick.append(i)
    error = np.random.default_rng([seed, _LOCALISER_STREAM]).standard_normal((len(tick), 3))
    return np.array(tick), planar_poses(xy_m[tick] + noise_m * error[:, :2], yaw[tick] + noise_rad * error[:, 2])


def odometry(world_from_base, *, seed):
    """Return odom_from_base (n, 4, 4): the motion summed up from its start with a small scale error, so it drifts."""
    scale = 1 + _ODOMETRY_SCALE_ERROR * np.random.default_rng([seed, _ODOMETRY_STREAM]).standard_normal(2)
    yaw = np.unwrap(_yaw(world_from_base))
    step_m = np.diff(world_from_base[:, :2, 3], axis=0)
    believed_yaw = scale[0] * (yaw - yaw[0])
    # a step is known in the base's frame, and is added in the direction the base is believed to face
    error = believed_yaw[:-1] - yaw[:-1]
    step_m = scale[1] * (step_m[:, 0] + 1j * step_m[:, 1]) * np.exp(1j * error)
    path_m = np.concatenate([[0], np.cumsum(step_m)])
    return planar_poses(np.column_stack([path_m.real, path_m.imag]), believed_yaw)


def _yaw(pose):
    return np.arctan2(pose[:, 1, 0], pose[:, 0, 0])
