"""Calibration of a sensor's range bias, beam by beam, by how bent flat walls look.

A range that is too long by b puts a point of a wall behind it by b times the cosine of the angle of
incidence: most where the ray meets the wall squarely, less to the sides. So a flat wall looks bent,
and by how much shows b, wherever the scan was taken to be. Both sides of a wall err towards each
other: walls come out thinner by 2 b.

Source: self-calibration of lidars on planes, as of Glennie and Lichti (2010), Static calibration
and analysis of the Velodyne HDL-64E S2 for high accuracy mobile scanning.
"""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import ON_M
from scanplan.stage import workers
from scanplan.types import BoolArray, Columns, FloatArray, IntArray

_MOST_POINTS = 600_000  # more cost time, and make no estimate better
_LEAST_OF_GROUP = 100  # points of one scan at one wall: fewer show no bend
_LEAST_WALLS = 4.0  # of equal weight: one that tells most may itself be bent
_BINS = 16  # parts of a wall whose means show whether it is flat
_MOST_BENT = 3.0  # mean square of these means by noise alone is 1
_BOW_M = 0.0005  # no wall is flatter than that
_PASSES = 3  # what is left of bows hardly changes after two


@dataclass(frozen=True)
class RangeBiasSettings:
    """How wrong ranges may be.

    Attributes
    ----------
    sigma_m : float, >= 0
        Standard deviation of the constant errors of a sensor's beams, before anything is seen; 0
        takes ranges as they are.
    max_incidence_deg : float, above 0, below 90
        Rays that meet a wall at a larger angle to its normal say nothing: their spots are long.
    """

    sigma_m: float
    max_incidence_deg: float


@dataclass(frozen=True, eq=False)
class _Hits:
    """Points at walls; those of one scan at one wall are a group.

    Attributes
    ----------
    group, beam : (n,) int64, from 0
    cosine : (n,) float64
        Of the angle of incidence.
    along_m : (n,) float64
        Where the ray meets the wall: by its direction alone, as a point's own place depends on
        its range.
    offset_m : (n,) float64
        Of the point before the wall.
    """

    group: np.ndarray
    beam: np.ndarray
    cosine: np.ndarray
    along_m: np.ndarray
    offset_m: np.ndarray

    def of(self, chosen: BoolArray) -> "_Hits":
        """Return those that are chosen, (n,) bool, their groups renumbered."""
        parts = (getattr(self, name)[chosen] for name in ("beam", "cosine", "along_m", "offset_m"))
        return _Hits(np.unique(self.group[chosen], return_inverse=True)[1], *parts)

    @property
    def n_groups(self) -> int:
        """How many groups there are."""
        return int(self.group.max(initial=-1)) + 1

    def summed(self, values: FloatArray) -> FloatArray:
        """Return sums of values (n,) by group."""
        return np.bincount(self.group, values, self.n_groups).astype(float)

    def level(self, values: FloatArray) -> FloatArray:
        """Return values (n,) without the best line along the wall of each group."""
        count = self.summed(np.ones(len(values)))
        values = values - (self.summed(values) / count)[self.group]
        along_m = self.along_m - (self.summed(self.along_m) / count)[self.group]
        slope = self.summed(values * along_m) / np.maximum(self.summed(along_m**2), ROUNDING)
        return values - slope[self.group] * along_m


def estimate_range_bias(
    rays: RaySet, segments: Columns, settings: RangeBiasSettings, band_m: float, up: FloatArray
) -> FloatArray:
    """Estimate the constant errors of ranges.

    The offsets of a scan's points before a wall are a line along it, for where the wall is, less
    the error of the beam times the cosine: linear least squares over all scans and walls, errors
    being about 0 within `sigma_m` beforehand. It is made twice, the second time without the walls
    that are not flat: those that are bent otherwise than so.

    Parameters
    ----------
    segments : dict of str to (n,) array
        The columns of `schemas.WALLS`; those of other scans than the rays' say nothing.
    band_m : float
        Points this near to a segment are of it.
    up : (s, 3) float
        The axis of each scan's sensor that its beams are inclined to, in the map frame.

    Returns
    -------
    (181,) float64
        Metres that ranges are too long by, by the beam's elevation in whole degrees from -90; 0
        where not known.
    """
    error_m = np.zeros(181)
    known = np.isin(segments["scan_id"], rays.scan_ids)
    if settings.sigma_m == 0 or not known.any():
        return error_m
    segments = {name: values[known] for name, values in segments.items()}
    hits = _hits(rays, segments, settings, band_m, up)
    hits = hits.of(hits.summed(np.ones(len(hits.group)))[hits.group] >= _LEAST_OF_GROUP)
    beams, beam = np.unique(hits.beam, return_inverse=True)
    if len(beams):
        hits = replace(hits, beam=beam)
        hits = hits.of(_are_flat(hits, _solve(hits, len(beams), settings.sigma_m))[hits.group])
        error_m[beams] = _solve(hits, len(beams), settings.sigma_m)
    return error_m


def measure_common_bias(
    rays: RaySet, segments: Columns, max_incidence_deg: float, band_m: float, up: FloatArray
) -> tuple[float, float]:
    """Measure by how much all ranges are too long, whatever a sensor may have.

    Each wall of each scan tells it by its own bend; walls that are not flat otherwise are left out.
    Half of the rest, by how well they tell it, lie between two quartiles.

    Parameters
    ----------
    rays, segments, band_m, up
        See `estimate_range_bias`.
    max_incidence_deg : float
        See `RangeBiasSettings`.

    Returns
    -------
    median_m, sure_m : float
        The median, and how far the quartile nearer to 0 is from it: 0 where 0 lies between them.
        NaN where fewer than four walls tell it, or as many as these of unequal weight.
    """
    settings = RangeBiasSettings(np.inf, max_incidence_deg)
    hits = _hits(rays, segments, settings, band_m, up)
    hits = hits.of(hits.summed(np.ones(len(hits.group)))[hits.group] >= _LEAST_OF_GROUP)
    if hits.n_groups:
        hits = hits.of(_are_flat(hits, np.zeros(int(hits.beam.max()) + 1))[hits.group])
    cosine = hits.level(hits.cosine)
    told = hits.summed(cosine**2)
    if told.sum() ** 2 <= _LEAST_WALLS * (told**2).sum():
        return np.nan, np.nan
    bias_m = -hits.summed(hits.level(hits.offset_m) * cosine) / np.maximum(told, ROUNDING)
    order = np.argsort(bias_m, kind="stable")
    share = np.cumsum(told[order]) / told.sum()
    low_m, median_m, high_m = bias_m[order][np.searchsorted(share, (0.25, 0.5, 0.75))].tolist()
    return median_m, max(low_m, -high_m, 0.0)


def remove_range_bias(
    rays: RaySet, error_m: FloatArray, up: FloatArray, threads: int = 1, *, in_place: bool = False
) -> RaySet:
    """Return rays with ranges shorter by `error_m` (181,), as `estimate_range_bias` returns it.

    Those given are overwritten `in_place`.
    """
    if not error_m.any():
        return rays
    moved = rays.xyz_m if in_place else np.empty_like(rays.xyz_m)

    def move_scan(scan: tuple[slice, FloatArray, FloatArray]) -> None:
        rows, sensor_m, axis = scan
        xyz_m = rays.xyz_m[rows]
        ray_m = xyz_m - sensor_m
        range_m = np.maximum(_length(ray_m), ROUNDING)
        ray_m *= (error_m[_degrees(ray_m @ axis / range_m)] / range_m)[:, None]
        np.subtract(xyz_m, ray_m, out=moved[rows])

    scans = zip(rays.rows, rays.sensors_m, up, strict=True)
    workers.map_in_threads(move_scan, scans, threads)
    return rays.with_points(moved)


def _hits(
    rays: RaySet, segments: Columns, settings: RangeBiasSettings, band_m: float, up: FloatArray
) -> _Hits:
    scan = np.searchsorted(rays.scan_ids, segments["scan_id"])
    first, last = (
        np.column_stack([segments[f"x{i}_m"], segments[f"y{i}_m"]]).astype(float) for i in (0, 1)
    )
    normal = np.column_stack([segments["nx"], segments["ny"]]).astype(float)
    side_m = np.einsum("ij,ij->i", rays.sensors_m[scan, :2] - first, normal)
    end = (last - first) * np.minimum(
        ON_M / np.maximum(np.hypot(*(last - first).T), ROUNDING), 0.5
    )[:, None]
    rows, group = rays.sample_rows_between(np.stack([first + end, last - end]), scan, _MOST_POINTS)
    xyz_m = rays.xyz_m.take(rows, axis=0)
    offset_m = np.einsum("ij,ij->i", xyz_m[:, :2] - first[group], normal[group])
    kept = np.abs(offset_m) <= band_m
    if not rays.planar:
        kept &= (xyz_m[:, 2] >= segments["z_min_m"][group]) & (
            xyz_m[:, 2] <= segments["z_max_m"][group]
        )
    xyz_m, group, offset_m = xyz_m[kept], group[kept], offset_m[kept]
    direction = xyz_m - rays.sensors_m[scan[group]]
    direction /= np.maximum(_length(direction), ROUNDING)[:, None]
    cosine = -np.einsum("ij,ij->i", direction[:, :2], normal[group])
    along = direction[:, 1] * normal[group, 0] - direction[:, 0] * normal[group, 1]
    beam = _degrees(np.einsum("ij,ij->i", direction, up[scan[group]]))
    found = _Hits(
        group, beam, cosine, side_m[group] * along / np.maximum(cosine, ROUNDING), offset_m
    )
    return found.of(cosine >= np.cos(np.radians(settings.max_incidence_deg)))


def _length(vectors_m: FloatArray) -> FloatArray:
    return np.sqrt(np.einsum("ij,ij->i", vectors_m, vectors_m))


def _degrees(sine: FloatArray) -> IntArray:
    """Return elevations in whole degrees from -90."""
    return np.rint(np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0)))).astype(np.int64) + 90


def _solve(hits: _Hits, n_beams: int, sigma_m: float) -> FloatArray:
    """Return the errors (n_beams,) that explain offsets best; 0 without any.

    Generalised least squares: a line along each wall is free, and each wall has a bow of its own
    that looks just like an error that all beams have in common: of `_BOW_M` in the mean of squares,
    or of what is left of bows in the end.
    """
    if hits.n_groups == 0:
        return np.zeros(n_beams)
    offset_m, bow = hits.level(hits.offset_m), hits.level(hits.cosine)
    count = hits.summed(np.ones(len(bow)))
    noise_m2 = max(np.mean(offset_m**2), ROUNDING**2)
    along_m = hits.along_m - (hits.summed(hits.along_m) / count)[hits.group]
    along_m /= np.sqrt(np.maximum(hits.summed(along_m**2), ROUNDING))[hits.group]
    bow /= np.sqrt(np.maximum(hits.summed(bow**2), ROUNDING))[hits.group]
    cell = hits.group * n_beams + hits.beam
    level, tilt, bowed = (
        np.bincount(cell, hits.cosine * values, hits.n_groups * n_beams).reshape(-1, n_beams)
        for values in (1 / np.sqrt(count)[hits.group], along_m, bow)
    )
    straight = (
        np.diag(np.bincount(hits.beam, hits.cosine**2, n_beams)) - level.T @ level - tilt.T @ tilt
    )
    observed_m = -np.bincount(hits.beam, hits.cosine * offset_m, n_beams)
    bow_m = hits.summed(offset_m * bow)
    prior = np.eye(n_beams) * noise_m2 / sigma_m**2
    bow_m2 = _BOW_M**2
    error_m = np.zeros(n_beams)
    for _ in range(_PASSES):
        own = 1 / (1 + noise_m2 / (bow_m2 * count))
        normal = straight - (own[:, None] * bowed).T @ bowed
        right = observed_m + bowed.T @ (own * bow_m)
        error_m = np.linalg.solve(normal + prior, right)
        left_m = bow_m + bowed @ error_m
        bow_m2 = max(_BOW_M**2, float(np.mean((left_m**2 - noise_m2) / count)))
    return error_m


def _are_flat(hits: _Hits, error_m: FloatArray) -> BoolArray:
    """Return which groups look flat once errors of beams, and a common one, are taken out.

    The means of offsets in parts of such a wall differ from 0 by noise alone, in the mean of their
    squares.
    """
    offset_m, cosine = (
        hits.level(hits.offset_m + error_m[hits.beam] * hits.cosine),
        hits.level(hits.cosine),
    )
    common_m = hits.summed(offset_m * cosine) / np.maximum(hits.summed(cosine**2), ROUNDING)
    offset_m -= common_m[hits.group] * cosine
    noise_m2 = np.median(hits.summed(offset_m**2) / hits.summed(hits.cosine**2))
    low_m, high_m = np.full(hits.n_groups, np.inf), np.full(hits.n_groups, -np.inf)
    np.minimum.at(low_m, hits.group, hits.along_m)
    np.maximum.at(high_m, hits.group, hits.along_m)
    share = (hits.along_m - low_m[hits.group]) / np.maximum(high_m - low_m, ROUNDING)[hits.group]
    cell = hits.group * _BINS + np.minimum((share * _BINS).astype(np.int64), _BINS - 1)
    summed, spread = (
        np.bincount(cell, v, hits.n_groups * _BINS) for v in (offset_m, noise_m2 * hits.cosine**2)
    )
    square = (summed**2 / np.maximum(spread, ROUNDING**2)).reshape(-1, _BINS).sum(axis=1)
    return square <= _MOST_BENT * np.maximum((spread.reshape(-1, _BINS) > 0).sum(axis=1) - 3, 1)
