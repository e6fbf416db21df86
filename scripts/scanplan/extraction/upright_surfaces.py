"""Upright surfaces that one scan shows, in pieces: without saying which of them are one wall."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import normals
from scanplan.geometry.intervals import number_within
from scanplan.geometry.moments import means_and_covariances
from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class UprightSurfaces:
    """Pieces of upright surfaces.

    Attributes
    ----------
    xy_m : (n, 2) float
        Where each piece is, relative to the sensor.
    normal : (n, 2) float
        Horizontal unit normals.
    n_points : (n,) float, above 0
        Returns that show each.
    z_m, half_height_m : (n,) float
        Relative to the sensor: the middle of each, and half of how high it is; 0 of planar scans.
    """

    xy_m: FloatArray
    normal: FloatArray
    n_points: FloatArray
    z_m: FloatArray
    half_height_m: FloatArray


def find_in_the_plane(xy_m: FloatArray, *, reach_deg: float) -> UprightSurfaces:
    """Return the surfaces that a planar scan shows, each return a piece.

    Parameters
    ----------
    xy_m : (n, 2) float
        Relative to the sensor.
    reach_deg : float
        See `normals.estimate_outline_normals`.
    """
    normal = normals.estimate_outline_normals(xy_m, reach_deg=reach_deg)
    upright = np.flatnonzero(np.isfinite(normal[:, 0]))
    level = np.zeros(len(upright))
    return UprightSurfaces(xy_m[upright], normal[upright], np.ones(len(upright)), level, level)


def find_in_space(
    xyz_m: FloatArray, *, reach_deg: float, max_tilt_deg: float, max_length_m: float
) -> UprightSurfaces:
    """Return the surfaces that a scan in space shows.

    The returns of a cell of equal angle (`normals.cut_surface_cells`) count as spread evenly about
    their mean, as far as they scatter: single returns would show the same, and take twice the time.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Relative to the sensor, axes of the map (z up).
    reach_deg : float
        See `normals.cut_surface_cells`.
    max_tilt_deg : float
        Largest angle between a surface's normal and the horizontal.
    max_length_m : float
        Of a piece; longer ones are parted.
    """
    moments, normal = normals.fit_surface_cells(xyz_m, reach_deg=reach_deg)
    upright = np.flatnonzero(np.abs(normal[:, 2]) <= np.sin(np.deg2rad(max_tilt_deg)))
    moments, normal = moments.take(upright, axis=1), normal.take(upright, axis=0)
    facing = normal[:, :2] / np.hypot(normal[:, 0], normal[:, 1])[:, None]
    mean_m, covariance = means_and_covariances(moments)
    along = np.stack([-facing[:, 1], facing[:, 0]])
    spread_m2 = (
        along[0] ** 2 * covariance[0, 0]
        + 2 * along[0] * along[1] * covariance[0, 1]
        + along[1] ** 2 * covariance[1, 1]
    )
    half_m, half_height_m = _half_extent(spread_m2), _half_extent(covariance[2, 2])
    n_parts = np.maximum(np.ceil(2 * half_m / max_length_m), 1).astype(np.int64)
    whole = np.repeat(np.arange(len(n_parts)), n_parts)
    part = number_within(n_parts)
    shift_m = ((2 * part + 1) / n_parts.take(whole) - 1) * half_m.take(whole)
    return UprightSurfaces(
        xy_m=(mean_m[:2].take(whole, axis=1) + shift_m * along.take(whole, axis=1)).T,
        normal=facing.take(whole, axis=0),
        n_points=(moments[0] / n_parts).take(whole),
        z_m=mean_m[2].take(whole),
        half_height_m=half_height_m.take(whole),
    )


def _half_extent(variance: FloatArray) -> FloatArray:
    """Return how far what is spread evenly, with a variance, reaches to either side of its mean."""
    return np.sqrt(3 * np.maximum(variance, 0))
