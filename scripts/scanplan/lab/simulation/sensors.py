"""Laser sensors: which way they look during one turn, when, and how well they measure."""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError

_VLP16_ELEVATIONS_DEG = tuple(range(-15, 16, 2))
_VLP16_FIRING_ORDER = (0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15)
_BIAS_STREAM = 3


@dataclass(frozen=True)
class Sensor:
    """The directions of one turn, as columns of beams that fire together, in the order of firing.

    Attributes
    ----------
    direction : (c, b, 3) float32
        Unit vectors in the sensor's frame: x forward, z up.
    ring : (b,) uint16
        The beam, counted from the lowest.
    time_s : (c,) float64
        When each column fires, after the stamp of the scan: from a turn before it up to 0 for a lidar, whose stamp is
        its last packet's (velodyne driver's default), from 0 on for a 2-D scanner, whose stamp is its first beam's
        (sensor_msgs/LaserScan). 0 throughout where the whole turn is taken from one pose.
    period_s : float
        Duration of a turn.
    increment_rad : float or None
        Angle from beam to beam of a 2-D scanner; None for a sensor that gives clouds.
    min_range_m, max_range_m : float
        Nothing comes back from outside.
    """

    direction: np.ndarray
    ring: np.ndarray
    time_s: np.ndarray
    period_s: float
    increment_rad: float | None
    min_range_m: float
    max_range_m: float

    @property
    def field_rad(self):
        """How far around forward it sees, half of it to either side."""
        if self.increment_rad is None:
            return 2 * np.pi
        # the last beam of a whole turn is followed by the first
        turn = self.increment_rad * len(self.direction)
        return 2 * np.pi if np.isclose(turn, 2 * np.pi, rtol=1e-5) else turn - self.increment_rad


@dataclass(frozen=True)
class SensorErrors:
    """How a sensor errs.

    Attributes
    ----------
    noise_m : float
        Standard deviation of a range, along the ray, independent from ray to ray.
    bias_m : (b,) float32
        Constant error of each beam.
    quantum_m : float
        Ranges are multiples of it; 0 for any value.
    grazing_from_rad : float
        Angle between ray and surface normal from which returns are lost, with a probability that grows linearly
        from 0 there to 1 along the surface; pi / 2 for no loss.
    glass_pass, glass_drop : float
        Probability that a ray goes through a pane as if it were not there, or never comes back. The rest returns
        from the pane.
    """

    noise_m: float
    bias_m: np.ndarray
    quantum_m: float
    grazing_from_rad: float
    glass_pass: float
    glass_drop: float


def make_vlp16(n_azimuth, **common):
    """Return a Velodyne VLP-16: 16 beams from -15 to +15 degrees; see `make_lidar`.

    Source: Velodyne VLP-16 user manual, laser IDs and elevation angles. The real sensor fires 1800 columns at 10 Hz.
    """
    return make_lidar(_VLP16_ELEVATIONS_DEG, n_azimuth, firing_order=_VLP16_FIRING_ORDER, **common)


def make_lidar(
    elevations_deg, n_azimuth, *, rate_hz, sweep, min_range_m, max_range_m, firing_order=None
):
    """Return a spinning lidar that turns clockwise seen from above, starting forward.

    ASSUME all beams start at one point (the VLP-16's sit up to 11 mm higher or lower) and those of a column fire at
    once (within 37 us there).

    Parameters
    ----------
    elevations_deg : sequence of float
        One per beam, ascending.
    n_azimuth : int
        Columns per turn.
    rate_hz : float
        Turns a second.
    sweep : bool
        Whether the columns fire one after the other; otherwise all at the stamp.
    min_range_m, max_range_m : float
    firing_order : sequence of int, optional
        The beams of a column in the order of their points; ascending by default.

    Returns
    -------
    Sensor

    Raises
    ------
    ValueError
        If there is no beam or column, or no range between the limits.
    """
    elevations_deg = np.asarray(elevations_deg, float)
    if n_azimuth < 1 or not len(elevations_deg) or rate_hz <= 0:
        raise ValueError(
            f"{n_azimuth} columns of {len(elevations_deg)} beams at {rate_hz} Hz are no sensor"
        )
    ring = np.arange(len(elevations_deg)) if firing_order is None else np.asarray(firing_order)
    azimuth = -2 * np.pi * np.arange(n_azimuth) / n_azimuth
    time_s = np.arange(1 - n_azimuth, 1) / n_azimuth / rate_hz
    direction = _directions(azimuth, np.radians(elevations_deg)[ring])
    return _sensor(direction, ring, time_s * sweep, rate_hz, None, min_range_m, max_range_m)


def make_laser(n_beams, field_deg, *, rate_hz, sweep, min_range_m, max_range_m):
    """Return a 2-D laser scanner, its mirror turning anticlockwise, the middle of its field forward.

    Parameters
    ----------
    n_beams : int
    field_deg : float
        From the first to the last beam; 360 for a whole turn, whose last beam is followed by the first.
    rate_hz, sweep, min_range_m, max_range_m
        As for `make_lidar`.

    Returns
    -------
    Sensor

    Raises
    ------
    ValueError
        If there are fewer than two beams, no field, or no range between the limits.
    """
    if n_beams < 2 or not 0 < field_deg <= 360 or rate_hz <= 0:
        raise ValueError(f"{n_beams} beams over {field_deg} degrees at {rate_hz} Hz are no sensor")
    # float32, as sensor_msgs/LaserScan states it
    increment = float(np.float32(np.radians(field_deg) / (n_beams - (field_deg < 360))))
    angle = float(np.float32(-np.radians(field_deg) / 2)) + increment * np.arange(n_beams)
    time_s = np.arange(n_beams) * increment / (2 * np.pi) / rate_hz
    direction, ring = _directions(angle, np.zeros(1)), np.zeros(1)
    return _sensor(direction, ring, time_s * sweep, rate_hz, increment, min_range_m, max_range_m)


def make_sensor(model, *, n_azimuth, elevations_deg, field_deg, **common):
    """Return the sensor that the config names.

    Parameters
    ----------
    model : {"vlp16", "lidar", "laser"}
    n_azimuth : int
        Columns of a turn; the beams of a 2-D scanner.
    elevations_deg : sequence of float or None
        Of a `make_lidar`; must be None for the others.
    field_deg : float
        Of a `make_laser`.
    **common
        `rate_hz`, `sweep`, `min_range_m`, `max_range_m`.

    Raises
    ------
    StageError
        If the settings contradict each other.
    """
    if (elevations_deg is None) == (model == "lidar"):
        raise StageError(
            f"simulate.sensor.elevations_deg: is {elevations_deg} with model {model};"
            " list the beams of a lidar, and leave it null for vlp16 and laser"
        )
    if common["min_range_m"] >= common["max_range_m"]:
        raise StageError(
            f"simulate.sensor: min_range_m {common['min_range_m']:g} is not below max_range_m"
            f" {common['max_range_m']:g}; lower it"
        )
    if model == "laser":
        return make_laser(n_azimuth, field_deg, **common)
    return (
        make_vlp16(n_azimuth, **common)
        if model == "vlp16"
        else make_lidar(sorted(elevations_deg), n_azimuth, **common)
    )


def draw_sensor_errors(
    sensor, *, noise_m, bias_m, quantum_m, grazing_from_deg, glass_pass, glass_drop, seed
):
    """Return how one specimen of a sensor errs: its biases are drawn once, by the seed.

    Parameters
    ----------
    sensor : Sensor
    bias_m : float
        Standard deviation of the beams' biases.
    grazing_from_deg : float
    noise_m, quantum_m, glass_pass, glass_drop
        As in `SensorErrors`.
    seed : int

    Raises
    ------
    StageError
        If the probabilities of glass add up to more than 1.
    """
    if glass_pass + glass_drop > 1:
        raise StageError(
            f"simulate.errors: glass_pass {glass_pass:g} and glass_drop {glass_drop:g} add up to more than 1; lower one"
        )
    of_beam = np.random.default_rng([seed, _BIAS_STREAM]).standard_normal(len(sensor.ring)) * bias_m
    bias = of_beam[sensor.ring].astype(np.float32)
    return SensorErrors(
        noise_m, bias, quantum_m, float(np.radians(grazing_from_deg)), glass_pass, glass_drop
    )


def _directions(azimuth_rad, elevation_rad):
    """Unit vectors (c, b, 3) of columns and beams."""
    level, up = np.cos(elevation_rad), np.sin(elevation_rad)
    ahead, left = (np.outer(part, level) for part in (np.cos(azimuth_rad), np.sin(azimuth_rad)))
    return np.stack([ahead, left, np.broadcast_to(up, ahead.shape)], axis=-1).astype(np.float32)


def _sensor(direction, ring, time_s, rate_hz, increment_rad, min_range_m, max_range_m):
    if not 0 <= min_range_m < max_range_m:
        raise ValueError(f"ranges from {min_range_m} to {max_range_m} m are no sensor's")
    ranges = float(min_range_m), float(max_range_m)
    return Sensor(direction, ring.astype(np.uint16), time_s, 1 / rate_hz, increment_rad, *ranges)
