"""Where a way leads across a line."""

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.types import FloatArray

_STEP_M = 1.5  # between two places farther apart the way is not known


def find_passages(line: Line, track_m: FloatArray) -> FloatArray:
    """Return where along a line (p,) a way crosses it at 30 degrees, or steeper.

    Parameters
    ----------
    track_m : (k, 2) float64
        One place after the other.
    """
    along_m, off_m = line.along_m(track_m), line.offset_m(track_m)
    step_m, gone_m = np.diff(off_m), np.diff(along_m)
    length_m = np.hypot(step_m, gone_m)
    is_across = (off_m[:-1] * off_m[1:] < 0) & (length_m <= _STEP_M)
    row = np.flatnonzero(is_across & (2 * np.abs(step_m) >= length_m))
    return along_m[row] - off_m[row] / step_m[row] * gone_m[row]
