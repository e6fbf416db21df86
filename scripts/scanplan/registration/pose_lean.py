"""Lean of the plane that a sensor was carried in: the sign of a map whose z is not up."""

import numpy as np

from scanplan.types import FloatArray

_WIDE_M = 1.0  # root mean square off a line: of a way along one corridor the plane is not known
_FLAT_SHARE = 0.03  # of that, off the plane: ramps, stairs and hands leave more


def measure_lean_deg(xyz_m: FloatArray) -> float:
    """Return the angle between z and the normal of the plane that a way lies in, degrees.

    NaN of a way that lies in none, or along a line.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Where the sensor was.
    """
    if len(xyz_m) < 3:
        return np.nan
    _, size, axes = np.linalg.svd(xyz_m - xyz_m.mean(axis=0), full_matrices=False)
    _, width_m, height_m = size / np.sqrt(len(xyz_m))
    if width_m < _WIDE_M or height_m > _FLAT_SHARE * width_m:
        return np.nan
    return float(np.degrees(np.arccos(min(abs(axes[2, 2]), 1.0))))
