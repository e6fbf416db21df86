"""Where the rover believes itself to be: a particle filter's poses, and the motion that its wheels sum up."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry import se3
from scanplan.lab.simulation import rover

# ASSUME wheels and gyro of a small rover: 1 % scale error each, constant over a drive
_ODOMETRY_SCALE_ERROR = 0.01
_WHITE_STREAM, _ODOMETRY_STREAM, _DRIFT_STREAM, _JUMP_STREAM = 1, 2, 7, 8


# laser scans are rarer than wheel ticks, and AMCL sends its transform with each of them
_TICKS_PER_TRANSFORM = 5


@dataclass(frozen=True)
class Belief:
    """What wheels and localiser say over a drive.

    Attributes
    ----------
    t_ns : (n,) int64
        The rover's ticks.
    odom_from_base : (n, 4, 4) float64
        At every tick.
    update : (m,) int64
        The ticks at which the localiser speaks.
    map_from_base : (m, 4, 4) float64
        What it says then.
    deviation_m, deviation_rad : float
        What it states as its standard deviations: of all but the jumps.
    transform : (k,) int64
        The ticks at which it sends its transform.
    map_from_odom : (k, 4, 4) float64
        The transform: what followed from its latest update.
    ahead_ns : int
        How far ahead of its sending the transform is stamped.
    """

    t_ns: np.ndarray
    odom_from_base: np.ndarray
    update: np.ndarray
    map_from_base: np.ndarray
    deviation_m: float
    deviation_rad: float
    transform: np.ndarray
    map_from_odom: np.ndarray
    ahead_ns: int


def simulate_belief(
    t_ns,
    world_from_base,
    *,
    update_distance_m,
    update_angle_deg,
    transform_tolerance_s,
    seed,
    **erring,
):
    """Return what wheels and localiser make of a drive.

    Parameters
    ----------
    t_ns : (n,) int64
    world_from_base : (n, 4, 4) float64
        True planar poses at these ticks.
    update_distance_m, update_angle_deg : float
        Motion since the localiser's last update that brings the next.
    transform_tolerance_s : float
        AMCL's parameter of that name.
    seed : int
    **erring
        As for `draw_pose_errors`.

    Returns
    -------
    Belief
    """
    update = choose_updates(
        world_from_base, distance_m=update_distance_m, angle_rad=np.radians(update_angle_deg)
    )
    map_from_base = add_pose_errors(
        world_from_base[update], draw_pose_errors(t_ns[update] / 1e9, **erring, seed=seed)
    )
    odom_from_base, transform = (
        integrate_odometry(world_from_base, seed=seed),
        np.arange(0, len(t_ns), _TICKS_PER_TRANSFORM),
    )
    return Belief(
        t_ns=t_ns,
        odom_from_base=odom_from_base,
        update=update,
        map_from_base=map_from_base,
        deviation_m=float(np.hypot(erring["noise_m"], erring["drift_m"])),
        deviation_rad=float(np.radians(np.hypot(erring["noise_deg"], erring["drift_deg"]))),
        transform=transform,
        map_from_odom=correction_at(update, map_from_base, odom_from_base, transform),
        ahead_ns=round(transform_tolerance_s * 1e9),
    )


def choose_updates(world_from_base, *, distance_m, angle_rad):
    """Return the ticks at which a localiser speaks: the first, the last, and those after enough motion, as AMCL does.

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
    xy_m, yaw = (
        world_from_base[:, :2, 3].tolist(),
        np.unwrap(se3.pose_yaw_rad(world_from_base)).tolist(),
    )
    ticks = [0]
    for i in range(1, len(yaw)):
        (x_m, y_m), last = xy_m[ticks[-1]], yaw[ticks[-1]]
        moved_m = np.hypot(xy_m[i][0] - x_m, xy_m[i][1] - y_m)
        if moved_m >= distance_m or abs(yaw[i] - last) >= angle_rad or i == len(yaw) - 1:
            ticks.append(i)
    return np.array(ticks)


def draw_pose_errors(
    t_s, *, noise_m, noise_deg, drift_m, drift_deg, drift_time_s, jumps_per_min, max_jump_m, seed
):
    """Return how a particle filter errs: white noise, a slow drift, and jumps that the drift's pull takes back.

    The drift of x, y and heading is an Ornstein-Uhlenbeck process each, sampled exactly. ASSUME all three are
    independent and the same in all directions, and at most one jump falls between two updates.

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
    white, drift, jump = (
        np.random.default_rng([seed, s]) for s in (_WHITE_STREAM, _DRIFT_STREAM, _JUMP_STREAM)
    )
    scale = np.array([drift_m, drift_m, np.radians(drift_deg)])
    step = draw_jumps(np.diff(t_s, prepend=t_s[0]), jumps_per_min, max_jump_m, jump)
    kept = np.exp(-np.diff(t_s) / drift_time_s)
    state = np.empty((len(t_s), 3))
    state[0] = scale * drift.standard_normal(3)
    push = scale * drift.standard_normal((len(kept), 3)) * np.sqrt(1 - kept**2)[:, None]
    for i, share in enumerate(kept, 1):
        state[i] = share * state[i - 1] + push[i - 1] + step[i]
    return state + np.array([noise_m, noise_m, np.radians(noise_deg)]) * white.standard_normal(
        (len(t_s), 3)
    )


def draw_jumps(gap_s, per_min, max_jump_m, generator):
    """Return the jump (n, 3) at the end of each gap (n,), zero where none falls into it; the heading never jumps."""
    there = generator.random(len(gap_s)) < -np.expm1(-gap_s * per_min / 60)
    length_m = there * generator.uniform(0, max_jump_m, len(gap_s))
    towards = generator.uniform(0, 2 * np.pi, len(gap_s))
    return np.column_stack([length_m * np.cos(towards), length_m * np.sin(towards), 0 * length_m])


def add_pose_errors(world_from_base, error):
    """Return planar poses (m, 4, 4) with errors (m, 3) of x, y and heading added."""
    xy_m = world_from_base[:, :2, 3] + error[:, :2]
    return rover.planar_poses(xy_m, se3.pose_yaw_rad(world_from_base) + error[:, 2])


def integrate_odometry(world_from_base, *, seed):
    """Return odom_from_base (n, 4, 4): the motion summed up from its start with a small scale error, so it drifts."""
    scale = 1 + _ODOMETRY_SCALE_ERROR * np.random.default_rng(
        [seed, _ODOMETRY_STREAM]
    ).standard_normal(2)
    yaw = np.unwrap(se3.pose_yaw_rad(world_from_base))
    step_m = np.diff(world_from_base[:, :2, 3], axis=0)
    believed_yaw = scale[0] * (yaw - yaw[0])
    # a step is known in the base's frame, and is added in the direction the base is believed to face
    error = believed_yaw[:-1] - yaw[:-1]
    step_m = scale[1] * (step_m[:, 0] + 1j * step_m[:, 1]) * np.exp(1j * error)
    path_m = np.concatenate([[0], np.cumsum(step_m)])
    return rover.planar_poses(np.column_stack([path_m.real, path_m.imag]), believed_yaw)


def correction_at(update, map_from_base, odom_from_base, tick):
    """Return the correction that holds at some ticks: the latest update's.

    Parameters
    ----------
    update : (m,) int64, increasing
        Ticks of the updates.
    map_from_base : (m, 4, 4) float64
        What the localiser said then.
    odom_from_base : (n, 4, 4) float64
        At every tick.
    tick : (k,) int64
        None before the first update.

    Returns
    -------
    (k, 4, 4) float64
    """
    correction = map_from_base @ se3.invert_pose(odom_from_base[update])
    return correction[np.searchsorted(update, tick, side="right") - 1]
