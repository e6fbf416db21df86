"""What of a registration cannot be if the recording's units, mounting and clock are right."""

from collections.abc import Sequence

import numpy as np

from scanplan.registration.sequential import ScanResult
from scanplan.types import FloatArray

_LEAST_KEPT = 0.85  # 28 sound surveys, ten of them recorded, keep 0.91 and more
_STILL = 1e-3  # metres, and of a turn radians: less than any localiser's noise
_UNASKED = ("too_few_points", "pose_gap")


def find_standstill(priors: FloatArray, scan_results: Sequence[ScanResult]) -> list[str]:
    """Return whether scans of a sensor that is said to stand still do not fit, as a sentence.

    Parameters
    ----------
    priors : (n, 4, 4) float64
        World from sensor by the recorded poses, NaN without one.
    scan_results : sequence of n sequential.ScanResult
    """
    poses = priors[np.isfinite(priors).all(axis=(1, 2))]
    n_dropped = sum(not r.kept for r in scan_results if r.reason not in _UNASKED)
    if n_dropped == 0 or np.ptp(poses, axis=0).max() > _STILL:
        return []
    return [
        f"all recorded poses are the same, and {n_dropped:,} scans do not fit one another there:"
        " the sensor moved, and its poses (input.pose_topic) do not say so"
    ]


def find_misfit(scan_results: Sequence[ScanResult], *, is_odometry: bool = False) -> list[str]:
    """Return whether most scans do not fit one another at their poses, as a sentence.

    Parameters
    ----------
    scan_results : sequence of sequential.ScanResult
        One per candidate.
    is_odometry : bool
        Whether the poses do not know where the robot is if it is carried.
    """
    asked = [result for result in scan_results if result.reason not in _UNASKED]
    n_kept = sum(result.kept for result in asked)
    # one scan alone may be of a door that closed
    if len(asked) - n_kept <= max(1, (1 - _LEAST_KEPT) * len(asked)):
        return []
    carried = ", or the robot was carried" if is_odometry else ""
    return [
        f"only {n_kept:,} of {len(asked):,} scans fit one another where their poses put them: the"
        " clock of the poses, the mounting (input.base_from_sensor) or the unit of ranges may"
        f" be wrong{carried}"
    ]
