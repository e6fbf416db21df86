"""The errors of a laser sensor, and those of its ranges: noise, bias, lost rays, panes."""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry.tolerances import ROUNDING
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.lab.simulation.raycast import RayHits
from scanplan.lab.simulation.sensors import Sensor
from scanplan.types import BoolArray, FloatArray, IntArray


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
    glass_mirror : float
        Probability that it goes on along the mirror direction instead.
    glass_return_rad : float
        Largest angle between ray and pane's normal at which the pane returns; what would return at
        a larger one goes through. pi / 2 where it returns at any.
    polished_from_rad : float
        As `grazing_from_rad`, of polished surfaces.
    bias_intensity_m : float
        Error of the range of a black surface against that of a white one.
    bias_incidence_m : float
        Error of a range at 60 degrees between ray and surface normal against that at 0.
    mixed_rad : float
        Width of the beam, within which surfaces at two depths mix; 0 for a beam without width.
    stray_share : float
        Share of rays that return from anywhere.
    """

    noise_m: float
    bias_m: FloatArray
    quantum_m: float
    grazing_from_rad: float
    glass_pass: float
    glass_drop: float
    glass_mirror: float = 0.0
    glass_return_rad: float = np.pi / 2
    polished_from_rad: float = np.pi / 2
    bias_intensity_m: float = 0.0
    bias_incidence_m: float = 0.0
    mixed_rad: float = 0.0
    stray_share: float = 0.0


@dataclass(frozen=True, kw_only=True)
class StatedErrors:
    """The errors of a kind of sensor, as the section `simulate.errors` of the settings states them.

    Fields as in `SensorErrors`, but for angles in degrees and

    Attributes
    ----------
    bias_m : float
        Standard deviation of the beams' biases.

    Raises
    ------
    StageError
        If the probabilities of glass add up to more than 1.
    """

    noise_m: float
    bias_m: float = 0.005  # ASSUME millimetres, as calibrations of such sensors find
    quantum_m: float = 0.002  # of a Velodyne
    grazing_from_deg: float = 80.0  # ASSUME returns fade over the last 10 degrees
    glass_pass: float
    glass_drop: float
    glass_return_deg: float
    glass_mirror: float
    polished_from_deg: float
    bias_intensity_m: float
    bias_incidence_m: float
    mixed_deg: float
    stray_share: float

    def __post_init__(self) -> None:
        """Refuse what cannot be."""
        # shares such as .28, .68 and .04 add up to 1 and a rounding error
        if self.glass_pass + self.glass_drop + self.glass_mirror > 1 + ROUNDING:
            raise StageError(
                f"simulate.errors: glass_pass {self.glass_pass:g}, glass_drop {self.glass_drop:g}"
                f" and glass_mirror {self.glass_mirror:g} add up to more than 1; lower one"
            )


def draw_sensor_errors(sensor: Sensor, stated: StatedErrors, *, seed: int) -> SensorErrors:
    """Return the errors of one specimen of a sensor: its biases are drawn once, by the seed."""
    generator = open_stream(seed, RandomStream.BEAM_BIAS)
    of_beam = generator.standard_normal(len(sensor.ring)) * stated.bias_m
    return SensorErrors(
        noise_m=stated.noise_m,
        bias_m=of_beam[sensor.ring].astype(np.float32),
        quantum_m=stated.quantum_m,
        grazing_from_rad=float(np.radians(stated.grazing_from_deg)),
        glass_pass=stated.glass_pass,
        glass_drop=stated.glass_drop,
        glass_mirror=stated.glass_mirror,
        glass_return_rad=float(np.radians(stated.glass_return_deg)),
        polished_from_rad=float(np.radians(stated.polished_from_deg)),
        bias_intensity_m=stated.bias_intensity_m,
        bias_incidence_m=stated.bias_incidence_m,
        mixed_rad=float(np.radians(stated.mixed_deg)),
        stray_share=stated.stray_share,
    )


def pass_glass(
    opaque: RayHits, pane: RayHits, errors: SensorErrors, generator: np.random.Generator
) -> tuple[RayHits, BoolArray]:
    """Draw for every ray that comes to a pane whether it passes, is lost, mirrored or returns.

    That a pane returns within few degrees of square alone is from Foster et al., "VisAGGE: Visible
    angle grid for glass environments", ICRA 2013. ASSUME that what is lost or mirrored is the same
    share at any angle, and that a ray that passes the first pane in its way passes all behind it:
    both faces of a pane are one decision.

    Returns
    -------
    hits : raycast.RayHits
    is_mirrored : (n,) bool
        Rays that go on from the pane along the mirror direction; their hits are the pane's.
    """
    draw = generator.random(len(opaque.range_m), dtype=np.float32)
    is_before = pane.range_m < opaque.range_m
    is_lost = is_before & (draw < errors.glass_drop)
    beyond = errors.glass_drop + errors.glass_pass
    is_mirrored = is_before & (draw >= beyond) & (draw < beyond + errors.glass_mirror)
    is_return = is_before & (draw >= beyond + errors.glass_mirror)
    if errors.glass_return_rad < np.pi / 2:
        is_return &= pane.cosine >= np.float32(np.cos(errors.glass_return_rad))
    ends_here = is_return | is_mirrored
    range_m = np.where(ends_here, pane.range_m, opaque.range_m)
    hits = RayHits(
        range_m=np.where(is_lost, np.float32(np.inf), range_m),
        cosine=np.where(ends_here, pane.cosine, opaque.cosine),
        reflectivity=np.where(ends_here, pane.reflectivity, opaque.reflectivity),
    )
    return hits, is_mirrored


def drop_grazing(hits: RayHits, errors: SensorErrors, generator: np.random.Generator) -> FloatArray:
    """Return the ranges (n,) float32 of hits, NaN where the ray grazed the surface and was lost."""
    if errors.grazing_from_rad >= np.pi / 2:
        return hits.range_m
    range_m = hits.range_m.copy()
    range_m[find_grazing(hits, errors.grazing_from_rad, generator)] = np.nan
    return range_m


def drop_polished(
    hits: RayHits, is_polished: BoolArray, errors: SensorErrors, generator: np.random.Generator
) -> RayHits:
    """Return hits without those of polished surfaces (n,) that the ray grazed: infinite range.

    A polished surface sends what meets it obliquely on, and hardly any of it back. ASSUME the loss
    grows linearly, as any surface's; what is sent on returns nothing.
    """
    lost = find_grazing(hits, errors.polished_from_rad, generator)
    range_m = hits.range_m.copy()
    range_m[lost[is_polished[lost]]] = np.inf
    return replace(hits, range_m=range_m)


def find_grazing(hits: RayHits, from_rad: float, generator: np.random.Generator) -> IntArray:
    """Return the rays that are lost as they graze, with a chance from 0 at an angle to 1 at 90."""
    is_grazing = (hits.cosine < np.cos(from_rad)) & np.isfinite(hits.range_m)
    (grazing,) = np.nonzero(is_grazing)
    angle_rad = np.arccos(hits.cosine[grazing])
    chance = (angle_rad - from_rad) / (np.pi / 2 - from_rad)
    # drawn for all rays, so that one ray's fate does not hang on how many others graze
    draw = generator.random(len(hits.range_m), dtype=np.float32)
    return grazing[draw[grazing] < chance]


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
