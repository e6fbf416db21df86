"""The rover: its motion along a way, its pose at any moment, and when it records."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from scanplan.lab.simulation import hand_sway
from scanplan.types import FloatArray, IntArray

TICK_NS = 20_000_000  # ASSUME odometry at 50 Hz, usual of small rovers' bases


@dataclass(frozen=True)
class Drive:
    """A planar motion, linear between key moments, still before and after them; and its sway.

    Attributes
    ----------
    t_s : (k,) float64, strictly increasing from 0
    xy_m : (k, 2) float64
        The base's position in the map.
    yaw_rad : (k,) float64
        Its heading, continuous (not wrapped).
    sway : hand_sway.Sway or None
        What a walking hand adds; None on wheels.
    """

    t_s: FloatArray
    xy_m: FloatArray
    yaw_rad: FloatArray
    sway: hand_sway.Sway | None = None


def carry_in_hand(
    drive: Drive,
    base_from_sensor: FloatArray,
    *,
    sway_m: float,
    sway_deg: float,
    sway_hz: float = hand_sway.STEPS_HZ,
    seed: int,
) -> Drive:
    """Return a drive as a walking hand makes it, which sways about the sensor.

    Parameters
    ----------
    base_from_sensor : (4, 4) float64
    sway_m, sway_deg, sway_hz, seed
        As for `hand_sway.draw_sway`.

    Returns
    -------
    Drive
        As given where nothing sways.
    """
    if not sway_m and not sway_deg:
        return drive
    pivot_m = base_from_sensor[:3, 3]
    swaying = hand_sway.draw_sway(
        pivot_m, sway_m=sway_m, sway_deg=sway_deg, sway_hz=sway_hz, seed=seed
    )
    return replace(drive, sway=swaying)


def plan_drive(waypoints_m: ArrayLike, *, speed_m_s: float, turn_rate_deg_s: float) -> Drive:
    """Drive a way: straight at constant speed, turning on the spot at corners, the shorter way.

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
    corners_m = np.asarray(waypoints_m, float)
    legs_m = np.diff(corners_m, axis=0)
    moving = np.hypot(*legs_m.T) > 0
    if not moving.any() or speed_m_s <= 0 or turn_rate_deg_s <= 0:
        raise ValueError("a drive needs two waypoints that differ and positive rates")
    legs_m = legs_m[moving]
    turns_rad = np.diff(np.arctan2(legs_m[:, 1], legs_m[:, 0]), prepend=np.nan)
    turns_rad = -((np.pi - turns_rad) % (2 * np.pi) - np.pi)
    t_s = [0.0]
    xy_m = [corners_m[0]]
    yaw_rad = [float(np.arctan2(legs_m[0, 1], legs_m[0, 0]))]
    for leg_m, turn_rad in zip(legs_m, turns_rad, strict=True):
        if abs(turn_rad) > 1e-9:
            t_s.append(t_s[-1] + abs(turn_rad) / np.radians(turn_rate_deg_s))
            xy_m.append(xy_m[-1])
            yaw_rad.append(yaw_rad[-1] + turn_rad)
        t_s.append(t_s[-1] + np.hypot(*leg_m) / speed_m_s)
        xy_m.append(xy_m[-1] + leg_m)
        yaw_rad.append(yaw_rad[-1])
    return Drive(np.array(t_s), np.array(xy_m), np.array(yaw_rad))


def scan_stamps(drive: Drive, rate_hz: float) -> IntArray:
    """Return the moments of the scans of a drive: (n,) int64 nanoseconds from its start."""
    count = int(np.floor(drive.t_s[-1] * rate_hz + 1e-9)) + 1
    return np.round(np.arange(count) * 1e9 / rate_hz).astype(np.int64)


def tick_stamps(drive: Drive, margin_ns: int) -> IntArray:
    """Return the ticks of the rover's own clock: (n,) int64 nanoseconds from a drive's start.

    The first is `margin_ns` or more before the drive and the last as much after it, and none
    coincides with a scan at 10 Hz.
    """
    first_ns = -(margin_ns // TICK_NS + 1) * TICK_NS + TICK_NS // 2
    if first_ns > -margin_ns:
        first_ns -= TICK_NS
    return np.arange(first_ns, _end_ns(drive) + margin_ns + TICK_NS, TICK_NS, dtype=np.int64)


def trace_stamps(drive: Drive, margin_ns: int) -> IntArray:
    """Return moments between which a drive is even: (n,) int64 nanoseconds, strictly increasing.

    100 a second from the drive's start, and every moment at which the motion changes: interpolated
    linearly (positions) and spherically (rotations), the poses then are those of a sensor on the
    rover to a few micrometres; in a hand that sways, so many a second that they are to 10
    micrometres and 10 microradians. They reach `margin_ns` beyond both ends.
    """
    step_ns = TICK_NS // 2
    if drive.sway is not None:
        step_ns = min(step_ns, hand_sway.longest_step_ns(drive.sway))
    grid = np.arange(-margin_ns, _end_ns(drive) + margin_ns + step_ns, step_ns, dtype=np.int64)
    return np.union1d(grid, np.round(drive.t_s * 1e9).astype(np.int64))


def _end_ns(drive: Drive) -> int:
    return int(np.ceil(drive.t_s[-1] * 1e9))


def drive_poses(drive: Drive, t_ns: ArrayLike) -> FloatArray:
    """Return world_from_base at moments of a drive, sway included: (n, 4, 4) float64."""
    level = level_poses(drive, t_ns)
    return level if drive.sway is None else level @ hand_sway.sway_poses(drive.sway, t_ns)


def level_poses(drive: Drive, t_ns: ArrayLike) -> FloatArray:
    """Return the planar world_from_base at moments of a drive, without sway: (n, 4, 4) float64."""
    t_s = np.asarray(t_ns) / 1e9
    xy_m = np.column_stack([np.interp(t_s, drive.t_s, axis) for axis in drive.xy_m.T])
    return planar_poses(xy_m, np.interp(t_s, drive.t_s, drive.yaw_rad))


def mount_sensor(
    *,
    height_m: float,
    forward_m: float,
    yaw_deg: float,
    roll_deg: float = 0.0,
    pitch_deg: float = 0.0,
) -> FloatArray:
    """Return base_from_sensor (4, 4), the extrinsics of a sensor.

    It sits above the floor, ahead of the rover's middle: rolled about its own forward axis (by 180
    degrees it hangs upside down), then pitched (positive: it looks down), then turned about the
    vertical.
    """
    level = planar_poses([[forward_m, 0.0]], np.radians([yaw_deg]), height_m)[0]
    if not roll_deg and not pitch_deg:
        return level
    tilt = hand_sway.tilt_matrices(np.radians([[roll_deg, pitch_deg, 0.0]]))[0]
    level[:3, :3] = level[:3, :3] @ tilt
    return level


def planar_poses(xy_m: ArrayLike, yaw_rad: ArrayLike, z_m: float = 0.0) -> FloatArray:
    """Return the (n, 4, 4) poses of positions (n, 2) and headings (n,) on a level plane."""
    yaw_rad = np.asarray(yaw_rad, float)
    poses = np.tile(np.eye(4), (len(yaw_rad), 1, 1))
    poses[:, 0, 0] = poses[:, 1, 1] = np.cos(yaw_rad)
    poses[:, 1, 0] = np.sin(yaw_rad)
    poses[:, 0, 1] = -poses[:, 1, 0]
    poses[:, :2, 3] = xy_m
    poses[:, 2, 3] = z_m
    return poses
