"""Heights of an opening above the floor: its sill and its lintel, by returns and rays through."""

import numpy as np

from scanplan.rays.face_observation import FaceObservation
from scanplan.types import FloatArray

REVEAL_M = 0.1  # how near to their place jambs come out
AT_FLOOR_M = 0.3  # lower returns may be of a step or of what lies there
FEW_RAYS = 3  # one or two may be stray
_LOW_PERCENTILE = 1  # of the rays through: fewer are stray
_FLOOR_NOISE_M = 0.04  # what noise lifts returns of the floor by
_STEP_COLUMN_M = 0.1  # wider than what is between rays, narrower than what lies about
_STEP_SHARE = 0.7  # of the columns: a step goes on all along, what lies about does not
_LEVEL_M = 0.03  # noise of a range seen along 15 degrees, of poses and of beams
_LEVEL_SCANS = 2  # one scan's beam meets a whole wall at one height
_BEHIND_M = 0.02  # noise of a range
_BEHIND_SHARE = 0.2  # noise leaves fewer so far behind a face, an underside most
_MOST_DOUBT_M = 0.2  # half of it is what a height may be wrong by
_ROUND_M = 1e-9  # rounding of a difference of heights
_LEAST_RAYS = 10  # fewer say nothing of a height


def estimate_gap_sill_m(seen: FaceObservation, low_m: float, high_m: float) -> float:
    """Return the sill of a gap, NaN if it is not known."""
    free_z_m = seen.free_z_m[seen.free_between(low_m, high_m)]
    occupied_z_m = seen.occupied_z_m[seen.occupied_between(low_m, high_m)]
    sill_m = _sill_m(free_z_m, occupied_z_m)
    step_m = _step_m(seen, low_m, high_m, float(np.percentile(free_z_m, _LOW_PERCENTILE)))
    return float(np.fmax(sill_m, step_m)) if step_m > 0 else sill_m


def _step_m(seen: FaceObservation, low_m: float, high_m: float, lowest_m: float) -> float:
    """Return the height of what stands all along near the floor below the lowest ray.

    0 if nothing.

    In a doorway rays end on the floor; a sill's front ends them above that.
    """
    low = seen.low_between(low_m, high_m)
    raised = (seen.low_z_m[low] > _FLOOR_NOISE_M) & (seen.low_z_m[low] < lowest_m)
    width = int((high_m - low_m) / _STEP_COLUMN_M)
    column = ((seen.low_m[low][raised] - low_m) / _STEP_COLUMN_M).astype(np.int64)
    if len(column) < _LEAST_RAYS or len(np.unique(column)) < _STEP_SHARE * width:
        return 0.0
    return (float(np.percentile(seen.low_z_m[low][raised], 95)) + lowest_m) / 2


def _sill_m(free_z_m: FloatArray, occupied_z_m: FloatArray) -> float:
    """Return the sill: between the rays that went through and the wall seen below them."""
    low_m = np.percentile(free_z_m, _LOW_PERCENTILE)
    if low_m <= AT_FLOOR_M:
        return 0.0
    below_m = occupied_z_m[occupied_z_m < low_m]
    return (
        float((np.percentile(below_m, 95) + low_m) / 2) if len(below_m) >= _LEAST_RAYS else np.nan
    )


def estimate_lintel_m(
    seen: FaceObservation, low_m: float, high_m: float, free_m: float, least_m: float
) -> float:
    """Return the lintel, NaN where it could be anywhere between rays far apart.

    It lies above the rays that went through and below the wall seen above them. Points at one
    height behind the face are of its underside, and show it; those of a face are as high as the
    beams that met it.

    Parameters
    ----------
    seen : face_observation.FaceObservation
    low_m, high_m : float
        The opening along the line.
    free_m : float
        Up to where rays went through.
    least_m : float
        Points lower than that are none of the wall above it.
    """
    # beside a jamb points are its reveal's
    inner = seen.occupied_between(low_m + REVEAL_M, high_m - REVEAL_M)
    above = seen.occupied_z_m[inner] > least_m
    above_m, off_m, scan = (
        of[inner][above] for of in (seen.occupied_z_m, seen.occupied_off_m, seen.occupied_scan)
    )
    if len(above_m) < FEW_RAYS:
        return np.nan
    lowest_m = np.percentile(above_m, 5)
    level = np.abs(above_m - lowest_m) <= _LEVEL_M
    behind = level & (off_m < -_BEHIND_M)
    enough = max(FEW_RAYS, _BEHIND_SHARE * level.sum())
    if behind.sum() >= enough and len(np.unique(scan[behind])) >= _LEVEL_SCANS:
        return float(np.median(above_m[level]))
    return (
        float((free_m + lowest_m) / 2) if lowest_m - free_m <= _MOST_DOUBT_M + _ROUND_M else np.nan
    )


def robust_highest_m(z_m: FloatArray) -> float:
    """Return the height that not just one or two of heights (n,), n >= 3, reach."""
    return float(np.partition(z_m, -FEW_RAYS)[-FEW_RAYS])
