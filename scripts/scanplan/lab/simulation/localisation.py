"""What the rover estimates of its own pose: a particle filter's poses, and wheel odometry."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from scanplan.geometry import se3
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import rover
from scanplan.types import FloatArray, IntArray, Settings

_TICKS_PER_TRANSFORM = 5  # ASSUME laser scans at 10 Hz; AMCL sends its transform with each


@dataclass(frozen=True)
class Belief:
    """What wheels and localiser estimate over a drive.

    Attributes
    ----------
    t_ns : (n,) int64
        The rover's ticks.
    odom_from_base : (n, 4, 4) float64
        At every tick.
    update : (m,) int64
        The ticks at which the localiser sends a pose.
    map_from_base : (m, 4, 4) float64
        That pose.
    deviation_m, deviation_rad : float
        What it states as its standard deviations: of all but the jumps.
    transform : (k,) int64
        The ticks at which it sends its transform.
    map_from_odom : (k, 4, 4) float64
        The transform, which follows from its latest pose.
    ahead_ns : int
        How far ahead of its sending the transform is stamped.
    """

    t_ns: IntArray
    odom_from_base: FloatArray
    update: IntArray
    map_from_base: FloatArray
    deviation_m: float
    deviation_rad: float
    transform: IntArray
    map_from_odom: FloatArray
    ahead_ns: int


def simulate_belief(
    t_ns: IntArray,
    world_from_base: FloatArray,
    *,
    update_distance_m: float,
    update_angle_deg: float,
    transform_tolerance_s: float,
    odometry: Settings,
    seed: int,
    **error_settings: float,
) -> Belief:
    """Return what wheels and localiser estimate over a drive.

    Parameters
    ----------
    t_ns : (n,) int64
    world_from_base : (n, 4, 4) float64
        True planar poses at these ticks.
    update_distance_m, update_angle_deg : float
        Motion since the localiser's last update that brings the next.
    transform_tolerance_s : float
        AMCL's parameter of that name.
    odometry : dict
        Settings of `integrate_odometry`.
    seed : int
    **error_settings
        As for `draw_pose_errors`.

    Returns
    -------
    Belief
    """
    update = choose_updates(
        world_from_base, distance_m=update_distance_m, angle_rad=np.radians(update_angle_deg)
    )
    errors = draw_pose_errors(t_ns[update] / 1e9, **error_settings, seed=seed)
    map_from_base = add_pose_errors(world_from_base[update], errors)
    odom_from_base = integrate_odometry(world_from_base, **odometry, seed=seed)
    transform = np.arange(0, len(t_ns), _TICKS_PER_TRANSFORM)
    deviation_deg = np.hypot(error_settings["noise_deg"], error_settings["drift_deg"])
    return Belief(
        t_ns=t_ns,
        odom_from_base=odom_from_base,
        update=update,
        map_from_base=map_from_base,
        deviation_m=float(np.hypot(error_settings["noise_m"], error_settings["drift_m"])),
        deviation_rad=float(np.radians(deviation_deg)),
        transform=transform,
        map_from_odom=correction_at(update, map_from_base, odom_from_base, transform),
        ahead_ns=round(transform_tolerance_s * 1e9),
    )


def choose_updates(world_from_base: FloatArray, *, distance_m: float, angle_rad: float) -> IntArray:
    """Return the ticks at which a localiser sends a pose, as AMCL does after enough motion.

    The first and the last tick are always among them.

    Parameters
    ----------
    world_from_base : (n, 4, 4) float64
        True planar poses at the rover's ticks.
    distance_m, angle_rad : float
        Motion since the last update that brings the next.

    Returns
    -------
    (m,) int64
    """
    xy_m = world_from_base[:, :2, 3].tolist()
    yaw_rad = np.unwrap(se3.pose_yaw_rad(world_from_base)).tolist()
    ticks = [0]
    for i in range(1, len(yaw_rad)):
        last = ticks[-1]
        moved_m = np.hypot(xy_m[i][0] - xy_m[last][0], xy_m[i][1] - xy_m[last][1])
        has_turned = abs(yaw_rad[i] - yaw_rad[last]) >= angle_rad
        if moved_m >= distance_m or has_turned or i == len(yaw_rad) - 1:
            ticks.append(i)
    return np.array(ticks)


def draw_pose_errors(
    t_s: ArrayLike,
    *,
    noise_m: float,
    noise_deg: float,
    drift_m: float,
    drift_deg: float,
    drift_time_s: float,
    jumps_per_min: float,
    max_jump_m: float,
    seed: int,
) -> FloatArray:
    """Return a particle filter's errors: white noise, a slow drift, and jumps that decay with it.

    The drift of x, y and heading is an Ornstein-Uhlenbeck process each, sampled exactly. ASSUME all
    three are independent and the same in all directions, and at most one jump falls between two
    updates.

    Parameters
    ----------
    t_s : (m,) float64, increasing
        Moments of the updates.
    noise_m, noise_deg : float
        Standard deviation of the white part: of x and of y, and of the heading.
    drift_m, drift_deg : float
        Stationary standard deviation of the drift.
    drift_time_s : float
        Its correlation time.
    jumps_per_min : float
        Expected number of jumps a minute.
    max_jump_m : float
        A jump's length is even between 0 and this, its direction any.
    seed : int

    Returns
    -------
    (m, 3) float64
        Error of x, y (metres) and heading (radians).
    """
    t_s = np.asarray(t_s, float)
    white = open_stream(seed, RandomStream.LOCALISER_NOISE)
    drift = open_stream(seed, RandomStream.LOCALISER_DRIFT)
    jump = open_stream(seed, RandomStream.LOCALISER_JUMPS)
    drift_scale = np.array([drift_m, drift_m, np.radians(drift_deg)])
    jumps = draw_jumps(np.diff(t_s, prepend=t_s[0]), jumps_per_min, max_jump_m, jump)
    decay = np.exp(-np.diff(t_s) / drift_time_s)
    state = np.empty((len(t_s), 3))
    state[0] = drift_scale * drift.standard_normal(3)
    push = drift_scale * drift.standard_normal((len(decay), 3)) * np.sqrt(1 - decay**2)[:, None]
    for i, share in enumerate(decay, 1):
        state[i] = share * state[i - 1] + push[i - 1] + jumps[i]
    noise_scale = np.array([noise_m, noise_m, np.radians(noise_deg)])
    return state + noise_scale * white.standard_normal((len(t_s), 3))


def draw_jumps(
    gap_s: FloatArray, per_min: float, max_jump_m: float, generator: np.random.Generator
) -> FloatArray:
    """Return the jump (n, 3) at the end of each gap (n,), zero where none falls into it.

    The heading never jumps.
    """
    is_jump = generator.random(len(gap_s)) < -np.expm1(-gap_s * per_min / 60)
    length_m = is_jump * generator.uniform(0, max_jump_m, len(gap_s))
    towards = generator.uniform(0, 2 * np.pi, len(gap_s))
    return np.column_stack([length_m * np.cos(towards), length_m * np.sin(towards), 0 * length_m])


def add_pose_errors(world_from_base: FloatArray, error: FloatArray) -> FloatArray:
    """Return planar poses (m, 4, 4) with errors (m, 3) of x, y and heading added."""
    xy_m = world_from_base[:, :2, 3] + error[:, :2]
    return rover.planar_poses(xy_m, se3.pose_yaw_rad(world_from_base) + error[:, 2])


def integrate_odometry(
    world_from_base: FloatArray, *, scale_share: float, drift_deg_per_m: float, seed: int
) -> FloatArray:
    """Return odom_from_base (n, 4, 4): the motion summed up from its start with a scale error.

    The small errors of turns and steps are constant over the drive, so the odometry drifts.

    Parameters
    ----------
    world_from_base : (n, 4, 4) float64
        True planar poses.
    scale_share : float
        Standard deviation of the scales of turns and of steps, which are drawn once.
    drift_deg_per_m : float
        What the heading turns by, a metre of way: to the left.
    seed : int
    """
    generator = open_stream(seed, RandomStream.ODOMETRY)
    turn_scale, step_scale = 1 + scale_share * generator.standard_normal(2)
    yaw_rad = np.unwrap(se3.pose_yaw_rad(world_from_base))
    step_m = np.diff(world_from_base[:, :2, 3], axis=0)
    way_m = np.concatenate([[0], np.cumsum(np.hypot(*step_m.T))])
    drift_rad = np.radians(drift_deg_per_m) * way_m
    odometry_yaw_rad = turn_scale * (yaw_rad - yaw_rad[0]) + drift_rad
    # a step is measured in the base's frame, and added in the direction the base seems to face
    error_rad = odometry_yaw_rad[:-1] - yaw_rad[:-1]
    step = step_scale * (step_m[:, 0] + 1j * step_m[:, 1]) * np.exp(1j * error_rad)
    path = np.concatenate([[0], np.cumsum(step)])
    return rover.planar_poses(np.column_stack([np.real(path), np.imag(path)]), odometry_yaw_rad)


def correction_at(
    update: IntArray, map_from_base: FloatArray, odom_from_base: FloatArray, tick: IntArray
) -> FloatArray:
    """Return the correction of the odometry that holds at some ticks: the latest update's.

    Parameters
    ----------
    update : (m,) int64, increasing
        Ticks of the updates.
    map_from_base : (m, 4, 4) float64
        The localiser's poses then.
    odom_from_base : (n, 4, 4) float64
        At every tick.
    tick : (k,) int64
        None before the first update.

    Returns
    -------
    map_from_odom : (k, 4, 4) float64
    """
    correction = map_from_base @ se3.invert_pose(odom_from_base[update])
    return correction[np.searchsorted(update, tick, side="right") - 1]
