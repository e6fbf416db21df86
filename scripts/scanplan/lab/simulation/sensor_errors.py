"""The errors of a laser sensor: range noise and bias, lost grazing rays, panes of glass."""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation.raycast import RayHits
from scanplan.lab.simulation.sensors import Sensor
from scanplan.types import FloatArray


@dataclass(frozen=True)
class SensorErrors:
    """The errors of a sensor.

    Attributes
    ----------
    noise_m : float
        Standard deviation of a range, along the ray, independent from ray to ray.
    bias_m : (b,) float32
        Constant error of each beam.
    quantum_m : float
        Ranges are multiples of it; 0 for any value.
    grazing_from_rad : float
        Angle between ray and surface normal from which returns are lost, with a probability that
        grows linearly from 0 there to 1 along the surface; pi / 2 for no loss.
    glass_pass, glass_drop : float
        Probability that a ray goes through a pane as if it were not there, or never comes back. The
        rest returns from the pane.
    """

    noise_m: float
    bias_m: FloatArray
    quantum_m: float
    grazing_from_rad: float
    glass_pass: float
    glass_drop: float


def draw_sensor_errors(
    sensor: Sensor,
    *,
    noise_m: float,
    bias_m: float,
    quantum_m: float,
    grazing_from_deg: float,
    glass_pass: float,
    glass_drop: float,
    seed: int,
) -> SensorErrors:
    """Return the errors of one specimen of a sensor: its biases are drawn once, by the seed.

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
            f"simulate.errors: glass_pass {glass_pass:g} and glass_drop {glass_drop:g} add up to"
            " more than 1; lower one"
        )
    generator = open_stream(seed, RandomStream.BEAM_BIAS)
    of_beam = generator.standard_normal(len(sensor.ring)) * bias_m
    return SensorErrors(
        noise_m=noise_m,
        bias_m=of_beam[sensor.ring].astype(np.float32),
        quantum_m=quantum_m,
        grazing_from_rad=float(np.radians(grazing_from_deg)),
        glass_pass=glass_pass,
        glass_drop=glass_drop,
    )


def pass_glass(
    opaque: RayHits, pane: RayHits, errors: SensorErrors, generator: np.random.Generator
) -> RayHits:
    """Draw for every ray that comes to a pane whether it passes, is lost, or returns from it.

    ASSUME a ray that passes the first pane in its way passes all behind it: both faces of a pane
    are one decision.

    Parameters
    ----------
    opaque, pane : raycast.RayHits
    errors : SensorErrors
    generator : numpy Generator

    Returns
    -------
    raycast.RayHits
    """
    draw = generator.random(len(opaque.range_m), dtype=np.float32)
    is_before = pane.range_m < opaque.range_m
    is_lost = is_before & (draw < errors.glass_drop)
    is_return = is_before & (draw >= errors.glass_drop + errors.glass_pass)
    range_m = np.where(is_return, pane.range_m, opaque.range_m)
    return RayHits(
        range_m=np.where(is_lost, np.float32(np.inf), range_m),
        cosine=np.where(is_return, pane.cosine, opaque.cosine),
        reflectivity=np.where(is_return, pane.reflectivity, opaque.reflectivity),
    )


def drop_grazing(hits: RayHits, errors: SensorErrors, generator: np.random.Generator) -> FloatArray:
    """Return the ranges (n,) float32 of hits, NaN where the ray grazed the surface and was lost."""
    if errors.grazing_from_rad >= np.pi / 2:
        return hits.range_m
    range_m = hits.range_m.copy()
    is_grazing = (hits.cosine < np.cos(errors.grazing_from_rad)) & np.isfinite(range_m)
    (grazing,) = np.nonzero(is_grazing)
    angle_rad = np.arccos(hits.cosine[grazing])
    chance = (angle_rad - errors.grazing_from_rad) / (np.pi / 2 - errors.grazing_from_rad)
    # drawn for all rays, so that one ray's fate does not hang on how many others graze
    draw = generator.random(len(range_m), dtype=np.float32)
    range_m[grazing[draw[grazing] < chance]] = np.nan
    return range_m


def add_range_errors(
    range_m: FloatArray, errors: SensorErrors, generator: np.random.Generator
) -> FloatArray:
    """Return ranges (c, b) with each beam's bias and noise added, then rounded; NaN stays NaN."""
    measured_m = range_m + errors.bias_m
    if errors.noise_m:
        noise_m = generator.standard_normal(range_m.shape, dtype=np.float32)
        noise_m *= np.float32(errors.noise_m)
        measured_m += noise_m
    if errors.quantum_m:
        quantum_m = np.float32(errors.quantum_m)
        measured_m = np.rint(measured_m / quantum_m) * quantum_m
    return measured_m
