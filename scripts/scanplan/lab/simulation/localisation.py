"""What the rover estimates of its own pose: a localiser's poses, and how odometry is corrected."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from scanplan.geometry import se3
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import rover
from scanplan.lab.simulation.odometry import WheelErrors, integrate_odometry
from scanplan.lab.simulation.slam import track_poses
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
    deviation_m, deviation_rad : (m,) float64
        What it states as its standard deviations: of all but the jumps and what SLAM drifts.
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
    deviation_m: FloatArray
    deviation_rad: FloatArray
    transform: IntArray
    map_from_odom: FloatArray
    ahead_ns: int


@dataclass(frozen=True, kw_only=True)
class LocaliserErrors:
    """What a localiser that knows the map errs by.

    Attributes
    ----------
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
    """

    noise_m: float
    noise_deg: float
    drift_m: float
    drift_deg: float
    drift_time_s: float = 10.0  # ASSUME so long a corridor pulls the same way
    jumps_per_min: float
    max_jump_m: float = 0.3  # ASSUME a jump from one of two like places to the other


@dataclass(frozen=True, kw_only=True)
class Localiser:
    """How a localiser speaks, and what it errs by.

    Attributes
    ----------
    update_distance_m, update_angle_deg : float
        Motion since the last update that brings the next.
    transform_tolerance_s : float
        AMCL's parameter of that name.
    start : dict
        Settings of `draw_start`.
    slam : dict or None
        Settings of `slam.track_poses`; None where the localiser knows the map, as AMCL does.
    """

    update_distance_m: float
    update_angle_deg: float
    transform_tolerance_s: float = 0.1  # as AMCL has it
    errors: LocaliserErrors
    start: Settings
    slam: Settings | None


def simulate_belief(
    t_ns: IntArray,
    world_from_base: FloatArray,
    localiser: Localiser,
    wheels: WheelErrors,
    *,
    sway: FloatArray | None,
    seed: int,
) -> Belief:
    """Return what wheels and localiser estimate over a drive.

    Parameters
    ----------
    t_ns : (n,) int64
    world_from_base : (n, 4, 4) float64
        True planar poses at these ticks.
    sway : (n, 4, 4) float64 or None
        What both know of level_from_base at the ticks: 6-DoF, as odometry of a hand-held device
        by its inertial unit, and the localiser then speaks at every tick. None where they are
        planar, and know nothing of it.
    """
    errors = localiser.errors
    update = np.arange(len(t_ns))
    if sway is None:
        update = choose_updates(
            world_from_base,
            distance_m=localiser.update_distance_m,
            angle_rad=np.radians(localiser.update_angle_deg),
        )
    tracked = world_from_base[update]
    if localiser.slam is not None:
        tracked = track_poses(tracked, **localiser.slam, seed=seed)
        errors = replace(errors, drift_m=0.0, drift_deg=0.0, jumps_per_min=0.0)
    drawn = draw_pose_errors(t_ns[update] / 1e9, errors, seed=seed)
    off = draw_start(world_from_base[update], **localiser.start, seed=seed)
    map_from_base = add_pose_errors(tracked, drawn + off)
    odom_from_base = integrate_odometry(world_from_base, wheels, seed=seed)
    if sway is not None:
        map_from_base = map_from_base @ sway[update]
        odom_from_base = odom_from_base @ sway
    transform = np.arange(0, len(t_ns), _TICKS_PER_TRANSFORM)
    deviation_m = np.hypot(errors.noise_m, errors.drift_m)
    deviation_deg = np.hypot(errors.noise_deg, errors.drift_deg)
    return Belief(
        t_ns=t_ns,
        odom_from_base=odom_from_base,
        update=update,
        map_from_base=map_from_base,
        # a filter whose particles have not gathered yet says so
        deviation_m=np.hypot(deviation_m, np.hypot(off[:, 0], off[:, 1])),
        deviation_rad=np.hypot(np.radians(deviation_deg), off[:, 2]),
        transform=transform,
        map_from_odom=correction_at(update, map_from_base, odom_from_base, transform),
        ahead_ns=round(localiser.transform_tolerance_s * 1e9),
    )


def draw_start(
    world_from_base: FloatArray,
    *,
    start_off_m: float,
    start_off_deg: float,
    converge_m: float,
    seed: int,
) -> FloatArray:
    """Return what a localiser errs by that was told a wrong place at the start.

    ASSUME the error falls off evenly, as half a wave of the cosine, over the way that it needs to
    converge, and is of the full size, in a random direction and to a random side, at the start.

    Parameters
    ----------
    world_from_base : (m, 4, 4) float64
        True planar poses at the updates.
    start_off_m, start_off_deg : float
        Error of position and heading at the start.
    converge_m : float
        Way after which nothing is left of it.

    Returns
    -------
    (m, 3) float64
        Error of x, y (metres) and heading (radians).
    """
    generator = open_stream(seed, RandomStream.START)
    towards = generator.uniform(0, 2 * np.pi)
    side = generator.choice([-1, 1])
    step_m = np.hypot(*np.diff(world_from_base[:, :2, 3], axis=0).T)
    way_m = np.concatenate([[0], np.cumsum(step_m)])
    left = (1 + np.cos(np.pi * np.clip(way_m / converge_m, 0, 1))) / 2
    full = np.array([np.cos(towards), np.sin(towards), side])
    return np.outer(left, full * [start_off_m, start_off_m, np.radians(start_off_deg)])


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


def draw_pose_errors(t_s: ArrayLike, errors: LocaliserErrors, *, seed: int) -> FloatArray:
    """Return a particle filter's errors: white noise, a slow drift, and jumps that decay with it.

    The drift of x, y and heading is an Ornstein-Uhlenbeck process each, sampled exactly. ASSUME all
    three are independent and the same in all directions, and at most one jump falls between two
    updates.

    Parameters
    ----------
    t_s : (m,) float64, increasing
        Moments of the updates.

    Returns
    -------
    (m, 3) float64
        Error of x, y (metres) and heading (radians).
    """
    t_s = np.asarray(t_s, float)
    white = open_stream(seed, RandomStream.LOCALISER_NOISE)
    drift = open_stream(seed, RandomStream.LOCALISER_DRIFT)
    jump = open_stream(seed, RandomStream.LOCALISER_JUMPS)
    drift_scale = np.array([errors.drift_m, errors.drift_m, np.radians(errors.drift_deg)])
    jumps = draw_jumps(np.diff(t_s, prepend=t_s[0]), errors.jumps_per_min, errors.max_jump_m, jump)
    decay = np.exp(-np.diff(t_s) / errors.drift_time_s)
    state = np.empty((len(t_s), 3))
    state[0] = drift_scale * drift.standard_normal(3)
    push = drift_scale * drift.standard_normal((len(decay), 3)) * np.sqrt(1 - decay**2)[:, None]
    for i, share in enumerate(decay, 1):
        state[i] = share * state[i - 1] + push[i - 1] + jumps[i]
    noise_scale = np.array([errors.noise_m, errors.noise_m, np.radians(errors.noise_deg)])
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
