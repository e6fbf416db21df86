"""Wheel odometry: what it makes of a motion that it measures with errors."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry import se3
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation import rover
from scanplan.types import FloatArray

_SLIP_TICKS = 25  # ASSUME wheels slip for half a second


@dataclass(frozen=True)
class WheelErrors:
    """What wheels err by.

    Attributes
    ----------
    scale_share : float
        Standard deviation of the scales of turns and of steps, which are drawn once.
    drift_deg_per_m : float
        What the heading turns by, a metre of way: to the left.
    random_m, random_deg : float
        Standard deviation of the length and of the heading after a metre of way.
    slips_per_m, max_slip_m, max_slip_deg : float
        As for `draw_slips`.
    """

    scale_share: float
    drift_deg_per_m: float
    random_m: float
    random_deg: float
    slips_per_m: float
    max_slip_m: float = 0.2  # ASSUME a door sill, on which wheels turn in vain
    max_slip_deg: float = 5.0  # the same of a turn, to either side


def integrate_odometry(
    world_from_base: FloatArray, errors: WheelErrors, *, seed: int
) -> FloatArray:
    """Return odom_from_base (n, 4, 4): the motion summed up from its start with errors.

    The small errors of scale are constant over the drive; random ones and slips add up. So the
    odometry drifts.

    Parameters
    ----------
    world_from_base : (n, 4, 4) float64
        True planar poses at the rover's ticks.
    """
    generator = open_stream(seed, RandomStream.ODOMETRY)
    turn_scale, step_scale = 1 + errors.scale_share * generator.standard_normal(2)
    yaw_rad = np.unwrap(se3.pose_yaw_rad(world_from_base))
    step_m = np.diff(world_from_base[:, :2, 3], axis=0)
    step_length_m = np.hypot(*step_m.T)
    way_m = np.concatenate([[0], np.cumsum(step_length_m)])
    drift_rad = np.radians(errors.drift_deg_per_m) * way_m
    odometry_yaw_rad = turn_scale * (yaw_rad - yaw_rad[0]) + drift_rad
    extra_m, extra_rad = _draw_walk(step_length_m, errors.random_m, errors.random_deg, seed)
    slip_m, slip_rad = draw_slips(
        step_length_m, errors.slips_per_m, errors.max_slip_m, errors.max_slip_deg, seed
    )
    extra_m, extra_rad = extra_m + slip_m, extra_rad + slip_rad
    if extra_rad.any():
        odometry_yaw_rad[1:] += np.cumsum(extra_rad)
    # a step is measured in the base's frame, and added in the direction the base seems to face
    error_rad = odometry_yaw_rad[:-1] - yaw_rad[:-1]
    step = step_scale * (step_m[:, 0] + 1j * step_m[:, 1]) * np.exp(1j * error_rad)
    if extra_m.any():
        step += extra_m * np.exp(1j * odometry_yaw_rad[:-1])
    path = np.concatenate([[0], np.cumsum(step)])
    return rover.planar_poses(np.column_stack([np.real(path), np.imag(path)]), odometry_yaw_rad)


def draw_slips(
    step_m: FloatArray, per_m: float, max_m: float, max_deg: float, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Return way and turn that wheels count in vain with each step, as they slip now and then.

    A slip lasts some ticks. ASSUME slips come by chance along the way, and lengths and turns up to
    the largest are as likely.

    Parameters
    ----------
    step_m : (n,) float
        True lengths of the steps.
    per_m : float
        Expected number of slips, a metre.
    max_m, max_deg : float
        Most way and turn of one slip; ways are forward, turns to either side.

    Returns
    -------
    slip_m, slip_rad : (n,) float64
    """
    generator = open_stream(seed, RandomStream.SLIP)
    is_slip = generator.random(len(step_m)) < -np.expm1(-per_m * step_m)
    slip_m = is_slip * generator.uniform(0, max_m, len(step_m))
    slip_rad = is_slip * generator.uniform(-1, 1, len(step_m)) * np.radians(max_deg)
    return _spread(slip_m), _spread(slip_rad)


def _spread(slip: FloatArray) -> FloatArray:
    """Return slips (n,) spread evenly over the ticks that follow; the last may not end."""
    return np.convolve(slip, np.full(_SLIP_TICKS, 1 / _SLIP_TICKS))[: len(slip)]


def _draw_walk(
    step_m: FloatArray, random_m: float, random_deg: float, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Return the random part of each step's length (n,) and turn (n,), whose squares add up."""
    generator = open_stream(seed, RandomStream.ODOMETRY_WALK)
    draw = generator.standard_normal((2, len(step_m))) * np.sqrt(step_m)
    return random_m * draw[0], np.radians(random_deg) * draw[1]
