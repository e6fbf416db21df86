"""The laser sensors that a survey can name: what their data sheets say of their beams."""

from collections.abc import Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.lab.simulation import sensors

# Velodyne VLP-16 user manual: elevations of its beams, and the beams in the order of firing
_VLP16_ELEVATIONS_DEG = tuple(range(-15, 16, 2))
# of which each of the lower half is followed by its like of the upper half
_VLP16_FIRING_ORDER = tuple(np.arange(16).reshape(2, 8).T.ravel().tolist())
# Ouster OS0 data sheet: 90 degrees from the lowest to the highest of its 64 beams, evenly spaced
OS0_ELEVATIONS_DEG = tuple(np.linspace(-45.0, 45.0, 64).tolist())
# Velodyne VLP-32C user manual: a third of a degree apart about the horizon, farther beyond. ASSUME
# the beams of a column fire in one plane (they are up to 4.2 degrees of azimuth aside)
VLP32C_ELEVATIONS_DEG = (
    *(-25.0, -15.639, -11.31, -8.843, -7.254, -6.148, -5.333, -4.667),
    *(-4.0, -3.667, -3.333, -3.0, -2.667, -2.333, -2.0, -1.667),
    *(-1.333, -1.0, -0.667, -0.333, 0.0, 0.333, 0.667, 1.0),
    *(1.333, 1.667, 2.333, 3.333, 4.667, 7.0, 10.333, 15.0),
)
# Livox Mid-360 user manual: its field of view; its driver states a line of 0 to 3 for each point
_MID360_ELEVATIONS_DEG = (-7.0, 52.0)
_MID360_LINES = 4


def make_vlp16(n_azimuth: int, turning: sensors.Turning) -> sensors.Sensor:
    """Return a Velodyne VLP-16: 16 beams from -15 to +15 degrees; see `sensors.make_lidar`.

    The real sensor fires 1800 columns at 10 Hz.
    """
    return sensors.make_lidar(
        _VLP16_ELEVATIONS_DEG, n_azimuth, turning, firing_order=_VLP16_FIRING_ORDER
    )


def make_sensor(
    model: str,
    turning: sensors.Turning,
    *,
    n_azimuth: int,
    elevations_deg: Sequence[float] | None,
    field_deg: float,
) -> sensors.Sensor:
    """Return the sensor that the config names.

    Parameters
    ----------
    model : {"vlp16", "ouster64", "uneven32", "rosette", "lidar", "laser"}
    n_azimuth : int
        Columns of a turn; the beams of a 2-D scanner.
    elevations_deg : sequence of float or None
        Of a `sensors.make_lidar`; must be None for the others.
    field_deg : float
        Of a `sensors.make_laser`.

    Raises
    ------
    StageError
        If the settings contradict each other.
    """
    if (elevations_deg is None) == (model == "lidar"):
        raise StageError(
            f"simulate.sensor.elevations_deg: is {elevations_deg} with model {model};"
            " list the beams of a lidar, and leave it null for all others"
        )
    if turning.min_range_m >= turning.max_range_m:
        raise StageError(
            f"simulate.sensor: min_range_m {turning.min_range_m:g} is not below max_range_m"
            f" {turning.max_range_m:g}; lower it"
        )
    if model == "laser":
        return sensors.make_laser(n_azimuth, field_deg, turning)
    if model == "rosette":
        level = sensors.make_lidar([0.0] * _MID360_LINES, n_azimuth, turning)
        return sensors.make_rosette(level, _MID360_ELEVATIONS_DEG)
    if model == "vlp16":
        return make_vlp16(n_azimuth, turning)
    beams = {"ouster64": OS0_ELEVATIONS_DEG, "uneven32": VLP32C_ELEVATIONS_DEG}
    chosen = beams[model] if elevations_deg is None else elevations_deg
    return sensors.make_lidar(sorted(chosen), n_azimuth, turning)
