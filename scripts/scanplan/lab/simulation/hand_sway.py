"""How a hand that walks sways: small motions in all six directions, about the sensor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.types import FloatArray

# a body rocks from side to side with every other step, and rises with each; ASSUME their shares,
# with the foot's impact at twice the steps' rate
_RATES = np.array([0.5, 1.0, 2.0])
_SHARES = np.array([0.6, 0.75, 0.28])
STEPS_HZ = 1.8  # of people (Pachi and Ji 2005)
_RATE_SPREAD = 0.1  # ASSUME hands are no clockwork: each motion has a rate of its own, so far off
_EXACT = 1e-5  # metres and radians that poses in between may be off: a tenth of a mm at 10 m
_MILLISECOND_NS = 1_000_000


@dataclass(frozen=True)
class Sway:
    """Sums of oscillations, one for each of x, y, z (metres), roll, pitch, yaw (radians).

    Attributes
    ----------
    amplitude : (6, k) float64
    rate_rad_s : (6, k) float64
    phase_rad : (6, k) float64
    pivot_m : (3,) float64
        About which it turns, base frame.
    """

    amplitude: FloatArray
    rate_rad_s: FloatArray
    phase_rad: FloatArray
    pivot_m: FloatArray


def draw_sway(
    pivot_m: FloatArray, *, sway_m: float, sway_deg: float, sway_hz: float = STEPS_HZ, seed: int
) -> Sway:
    """Return the sway of one walk.

    ASSUME all six motions are independent, and go on while the walker turns or stands.

    Parameters
    ----------
    pivot_m : (3,) float64
        The sensor's place, base frame.
    sway_m, sway_deg : float
        Standard deviation over time of each direction's displacement, and of each angle.
    sway_hz : float
        Steps a second.

    Returns
    -------
    Sway
    """
    generator = open_stream(seed, RandomStream.SWAY)
    deviation = np.repeat([sway_m, np.radians(sway_deg)], 3)
    share = _SHARES / np.linalg.norm(_SHARES)
    shape = (6, len(_RATES))
    spread = generator.uniform(1 - _RATE_SPREAD, 1 + _RATE_SPREAD, shape)
    return Sway(
        # a sine's standard deviation is its amplitude by the root of two
        amplitude=np.sqrt(2) * np.outer(deviation, share),
        rate_rad_s=2 * np.pi * sway_hz * _RATES * spread,
        phase_rad=generator.uniform(0, 2 * np.pi, shape),
        pivot_m=np.array(pivot_m, float),
    )


def sway_poses(swaying: Sway, t_ns: ArrayLike) -> FloatArray:
    """Return level_from_base (n, 4, 4), how a base sways about its level pose at some moments."""
    t_s = np.asarray(t_ns, float)[:, None, None] / 1e9
    wave = np.sin(swaying.rate_rad_s * t_s + swaying.phase_rad)
    moved = np.einsum("nak,ak->na", wave, swaying.amplitude)
    poses = np.tile(np.eye(4), (len(moved), 1, 1))
    poses[:, :3, :3] = tilt_matrices(moved[:, 3:])
    poses[:, :3, 3] = moved[:, :3] + swaying.pivot_m - poses[:, :3, :3] @ swaying.pivot_m
    return poses


def longest_step_ns(swaying: Sway) -> int:
    """Return how far apart poses may be to be interpolated exactly: a whole number of ms.

    Between poses dt apart a motion of acceleration a is a dt^2 / 8 off a straight line.
    """
    acceleration = (swaying.amplitude * swaying.rate_rad_s**2).sum(axis=1).max()
    step_s = np.sqrt(8 * _EXACT / acceleration)
    return max(int(step_s * 1e9) // _MILLISECOND_NS, 1) * _MILLISECOND_NS


def tilt_matrices(angle_rad: FloatArray) -> FloatArray:
    """Return the rotations (n, 3, 3) of roll, then pitch, then yaw (n, 3), about fixed x, y, z."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(angle_rad).T, np.sin(angle_rad).T
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
