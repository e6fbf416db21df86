"""How many returns a scan usually has by elevation: a direction without any is known by what the others have."""

import numpy as np

GRAZING_RAD = np.deg2rad(75)
"""Angle between ray and surface normal from which on returns get lost."""

_SECTORS = 72  # wider than what is between two firings


def count_returns_below(azimuth_rad, xyz_m, rows_per_deg):
    """Count a scan's returns below elevations, per degree of azimuth around which there are any.

    Parameters
    ----------
    azimuth_rad : (n,) float
    xyz_m : (n, 3) float
        Relative to the sensor.
    rows_per_deg : int

    Returns
    -------
    (180 * rows_per_deg + 1,) float64
        Below each elevation from -90 degrees on.
    """
    sector = np.minimum(
        ((azimuth_rad + np.pi) / (2 * np.pi) * _SECTORS).astype(np.int64), _SECTORS - 1
    )
    seen_deg = max(np.count_nonzero(np.bincount(sector)), 1) * 360 / _SECTORS
    elevation_deg = np.rad2deg(np.arctan2(xyz_m[:, 2], np.hypot(xyz_m[:, 0], xyz_m[:, 1])))
    n_rows = 180 * rows_per_deg
    row = np.clip((elevation_deg + 90) * rows_per_deg, 0, n_rows - 1).astype(np.int64)
    return np.concatenate([[0.0], np.cumsum(np.bincount(row, minlength=n_rows))]) / seen_deg
