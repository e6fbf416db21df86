"""How many returns a scan usually gets back at an elevation."""

import numpy as np

from scanplan.rays.azimuth_sectors import N_SECTORS, number_sectors
from scanplan.types import FloatArray, IntArray

_ROWS_PER_DEG = 10  # of elevation: beams of a VLP-16 are 2 degrees apart, of dense sensors 0.2
_TILTS = (-5, 0, 5)  # rows: a rover sways by half a degree, which poses in the plane do not show


def count_returns_below(azimuth_rad: FloatArray, xyz_m: FloatArray, up: FloatArray) -> FloatArray:
    """Count a scan's returns below elevations, per degree of azimuth around which there are any.

    Parameters
    ----------
    azimuth_rad : (n,) float
    xyz_m : (n, 3) float
        Relative to the sensor.
    up : (3,) float
        The axis that elevations are counted from the plane across.

    Returns
    -------
    (1801,) float64
        Below each elevation from -90 degrees on, in steps of 0.1 degrees.
    """
    sector = number_sectors(azimuth_rad)
    seen_deg = max(np.count_nonzero(np.bincount(sector)), 1) * 360 / N_SECTORS
    up_m = xyz_m @ up
    level_m = np.sqrt(np.maximum(np.einsum("ij,ij->i", xyz_m, xyz_m) - up_m**2, 0.0))
    elevation_deg = np.rad2deg(np.arctan2(up_m, level_m))
    n_rows = 180 * _ROWS_PER_DEG
    row = np.clip((elevation_deg + 90) * _ROWS_PER_DEG, 0, n_rows - 1).astype(np.int64)
    return np.concatenate([[0.0], np.cumsum(np.bincount(row, minlength=n_rows))]) / seen_deg


def count_below(usual: FloatArray, scan: IntArray, elevation_rad: FloatArray) -> FloatArray:
    """Return how many returns to a degree of azimuth scans usually have below elevations.

    As they may be tilted: a little to one side, not at all, and to the other.

    Parameters
    ----------
    usual : (k, 1801) float64
        See `count_returns_below`, of all scans.
    scan : (s, 1) int
    elevation_rad : (s, n) float64

    Returns
    -------
    (3, s, n) float64
        Straight between the steps.
    """
    at = (np.rad2deg(elevation_rad) + 90) * _ROWS_PER_DEG
    row = at.astype(np.int64)
    share = at - row
    n_rows = usual.shape[1]
    out: list[FloatArray] = []
    for tilt in _TILTS:
        # of all scans one after the other: taking by one number is faster than by two
        tilted = np.clip(row + tilt, 0, n_rows - 2) + n_rows * scan
        below = usual.take(tilted)
        out.append(below + share * (usual.take(tilted + 1) - below))
    return np.array(out)
