"""Where the plan's origin lies of surveys in coordinates of a country."""

import numpy as np

from scanplan.stage import log
from scanplan.types import FloatArray

_FARTHEST_M = 8000.0  # from the origin: beyond it single precision leaves less than a millimetre
_ROUND_M = 100.0  # an origin is moved by whole steps, which people can add


def find_origin(where: str, xyz_m: FloatArray) -> FloatArray:
    """Return the place (3,) in a file's coordinates that is the plan's origin, and say it.

    It is the file's own where all is near to that, and else a whole hundred of metres near the
    first place.

    Parameters
    ----------
    where : str
        The files.
    xyz_m : (n, 3) float64
        Where the sensor was, finite.
    """
    farthest_m = np.abs(xyz_m).max()
    if farthest_m < _FARTHEST_M:
        return np.zeros(3)
    origin_m = np.append(np.round(xyz_m[0, :2] / _ROUND_M) * _ROUND_M, 0.0)
    log.log_warning(
        f"{where}: coordinates of up to {farthest_m:,.0f} m: the plan's origin is"
        f" x {origin_m[0]:.0f}, y {origin_m[1]:.0f} of the file"
    )
    return origin_m
