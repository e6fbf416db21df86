"""Laser sensors: the directions and moments of the rays of one turn."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.types import FloatArray, IntArray

# ASSUME some 25 columns a swing: 2 degrees of azimuth at the 5000 columns of a Livox Mid-360. Pi
# makes it irrational, so that the pattern wanders from turn to turn
_COLUMNS_PER_SWING = 8 * np.pi


@dataclass(frozen=True)
class Rosette:
    """How the lines of an upward-looking sensor swing up and down while it turns.

    Attributes
    ----------
    low_rad, high_rad : float
        Between these elevations.
    columns_per_swing : float
        Columns from one lowest point of a line to its next; where it is irrational no turn repeats
        another.
    """

    low_rad: float
    high_rad: float
    columns_per_swing: float


@dataclass(frozen=True)
class Sensor:
    """The directions of one turn, as columns of beams that fire together, in the order of firing.

    Attributes
    ----------
    direction : (c, b, 3) float32
        Unit vectors in the sensor's frame: x forward, z up; of the first turn where each differs
        (`turn_directions`).
    ring : (b,) uint16
        The beam, counted from the lowest.
    time_s : (c,) float64
        When each column fires, after the stamp of the scan: from a turn before it up to 0 for a
        lidar, whose stamp is its last packet's (velodyne driver's default), from 0 on for a 2-D
        scanner, whose stamp is its first beam's (sensor_msgs/LaserScan). 0 throughout where the
        whole turn is taken from one pose.
    period_s : float
        Duration of a turn.
    increment_rad : float or None
        Angle from beam to beam of a 2-D scanner; None for a sensor that gives clouds.
    min_range_m, max_range_m : float
        Nothing comes back from outside.
    rosette : Rosette or None
        Of a sensor whose turns differ.
    """

    direction: FloatArray
    ring: IntArray
    time_s: FloatArray
    period_s: float
    increment_rad: float | None
    min_range_m: float
    max_range_m: float
    rosette: Rosette | None = None

    @property
    def field_rad(self) -> float:
        """Angle of its field of view, half of it to either side of forward."""
        if self.increment_rad is None:
            return 2 * np.pi
        # the last beam of a whole turn is followed by the first
        turn_rad = self.increment_rad * len(self.direction)
        is_whole = np.isclose(turn_rad, 2 * np.pi, rtol=1e-5)
        return 2 * np.pi if is_whole else turn_rad - self.increment_rad


@dataclass(frozen=True)
class Turning:
    """How a sensor turns, and how far it measures.

    Attributes
    ----------
    rate_hz : float
        Turns a second.
    sweep : bool
        Whether the columns fire one after the other; otherwise all at the stamp.
    min_range_m, max_range_m : float
    """

    rate_hz: float
    sweep: bool
    min_range_m: float
    max_range_m: float


def make_lidar(
    elevations_deg: Sequence[float],
    n_azimuth: int,
    turning: Turning,
    *,
    firing_order: Sequence[int] | None = None,
) -> Sensor:
    """Return a spinning lidar that turns clockwise seen from above, starting forward.

    ASSUME all beams start at one point (the VLP-16's sit up to 11 mm higher or lower) and those of
    a column fire at once (within 37 us there).

    Parameters
    ----------
    elevations_deg : sequence of float
        One per beam, ascending.
    n_azimuth : int
        Columns per turn.
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
    elevation_rad = np.radians(np.asarray(elevations_deg, float))
    if n_azimuth < 1 or not len(elevations_deg) or turning.rate_hz <= 0:
        raise ValueError(
            f"{n_azimuth} columns of {len(elevations_deg)} beams at {turning.rate_hz} Hz are no"
            " sensor"
        )
    ring = np.arange(len(elevations_deg)) if firing_order is None else np.asarray(firing_order)
    azimuth = -2 * np.pi * np.arange(n_azimuth) / n_azimuth
    time_s = np.arange(1 - n_azimuth, 1) / n_azimuth / turning.rate_hz
    direction = _directions(azimuth, elevation_rad[ring])
    return _make_sensor(direction, ring, time_s, turning)


def make_laser(n_beams: int, field_deg: float, turning: Turning) -> Sensor:
    """Return a 2-D laser scanner that turns anticlockwise, the middle of its field forward.

    Parameters
    ----------
    field_deg : float
        From the first to the last beam; 360 for a whole turn, whose last beam is followed by the
        first.

    Returns
    -------
    Sensor

    Raises
    ------
    ValueError
        If there are fewer than two beams, no field, or no range between the limits.
    """
    if n_beams < 2 or not 0 < field_deg <= 360 or turning.rate_hz <= 0:
        raise ValueError(
            f"{n_beams} beams over {field_deg} degrees at {turning.rate_hz} Hz are no sensor"
        )
    # float32, as sensor_msgs/LaserScan states it
    increment = float(np.float32(np.radians(field_deg) / (n_beams - (field_deg < 360))))
    angle = float(np.float32(-np.radians(field_deg) / 2)) + increment * np.arange(n_beams)
    time_s = np.arange(n_beams) * increment / (2 * np.pi) / turning.rate_hz
    ring = np.zeros(1, int)
    direction = _directions(angle, np.zeros(1))
    return _make_sensor(direction, ring, time_s, turning, increment)


def make_rosette(level: Sensor, elevations_deg: tuple[float, float]) -> Sensor:
    """Return a lidar whose few lines swing up and down while it turns, never twice the same way.

    Parameters
    ----------
    level : Sensor
        With these lines, all level: their swings are evenly spread in time.
    elevations_deg : (float, float)
        Lowest and highest that a line reaches.
    """
    low_rad, high_rad = np.radians(elevations_deg).tolist()
    swinging = replace(level, rosette=Rosette(low_rad, high_rad, _COLUMNS_PER_SWING))
    return replace(swinging, direction=turn_directions(swinging, 0))


def turn_directions(sensor: Sensor, turn: int) -> FloatArray:
    """Return the directions (c, b, 3) float32 of one turn, counted from 0, as `Sensor.direction`.

    Only those of a rosette differ from turn to turn.
    """
    rosette = sensor.rosette
    if rosette is None:
        return sensor.direction
    n, n_lines = sensor.direction.shape[:2]
    column = np.arange(n) + n * turn
    swing = column[:, None] / rosette.columns_per_swing + np.arange(n_lines) / n_lines
    # up and down evenly: 0 at a swing's begin and end, 1 in its middle
    height = 1 - np.abs(2 * (swing % 1) - 1)
    elevation_rad = rosette.low_rad + (rosette.high_rad - rosette.low_rad) * height
    azimuth_rad = -2 * np.pi * np.arange(n)[:, None] / n
    level = np.cos(elevation_rad)
    ahead = np.cos(azimuth_rad) * level
    left = np.sin(azimuth_rad) * level
    return np.stack([ahead, left, np.sin(elevation_rad)], axis=-1).astype(np.float32)


def _directions(azimuth_rad: FloatArray, elevation_rad: FloatArray) -> FloatArray:
    """Return the unit vectors (c, b, 3) of columns and beams."""
    level = np.cos(elevation_rad)
    ahead = np.outer(np.cos(azimuth_rad), level)
    left = np.outer(np.sin(azimuth_rad), level)
    up = np.broadcast_to(np.sin(elevation_rad), ahead.shape)
    return np.stack([ahead, left, up], axis=-1).astype(np.float32)


def _make_sensor(
    direction: FloatArray,
    ring: IntArray,
    time_s: FloatArray,
    turning: Turning,
    increment_rad: float | None = None,
) -> Sensor:
    if not 0 <= turning.min_range_m < turning.max_range_m:
        raise ValueError(
            f"ranges from {turning.min_range_m} to {turning.max_range_m} m are no sensor's"
        )
    return Sensor(
        direction=direction,
        ring=ring.astype(np.uint16),
        time_s=time_s * turning.sweep,
        period_s=1 / turning.rate_hz,
        increment_rad=increment_rad,
        min_range_m=float(turning.min_range_m),
        max_range_m=float(turning.max_range_m),
    )
