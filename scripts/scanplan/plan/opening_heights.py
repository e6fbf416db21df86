"""Heights of an opening above the floor: its sill and its lintel, by returns and rays through."""

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.tolerances import (
    ALONG_SHARE,
    END_M,
    ENOUGH_RAYS,
    LEAST_SCANS,
    LOW_PERCENT,
    NOISE_M,
)
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray

AT_FLOOR_M = 0.3  # lower returns may be of a step or of what lies there
_BEHIND_M = 0.02  # noise of a range
_BEHIND_SHARE = 0.2  # noise leaves fewer so far behind a face, an underside most
_MOST_DOUBT_M = 0.2  # half of it is what a height may be wrong by


def estimate_sill_m(
    observation: FaceObservation, low_m: float, high_m: float, *, below_m: float = np.inf
) -> float:
    """Return the sill of an opening, 0 where it reaches to the floor, NaN where it is not known.

    It is as high as what stands below the opening was seen, lower than rays went through. That is
    wall, or a step that goes on all along: in a doorway rays end on the floor, the front of a step
    ends them above that. How far above the sill the lowest rays went through says nothing more:
    behind glass hardly any comes back.

    Parameters
    ----------
    observation : face_observation.FaceObservation
    low_m, high_m : float
        The opening along the line.
    below_m : float
        Returns that are higher are none of what stands below.
    """
    free_z_m = observation.free_z_m[observation.free_between(low_m, high_m)]
    is_crossed = len(free_z_m) >= ENOUGH_RAYS
    lowest_m = float(np.percentile(free_z_m, LOW_PERCENT)) if is_crossed else np.inf
    below_z_m = _step_z_m(observation, low_m, high_m, lowest_m)
    is_at_floor = lowest_m <= AT_FLOOR_M
    if not is_at_floor:
        wall_z_m = observation.occupied_z_m[observation.occupied_between(low_m, high_m)]
        below_z_m = np.concatenate([below_z_m, wall_z_m[wall_z_m < min(lowest_m, below_m)]])
    if len(below_z_m) < ENOUGH_RAYS:
        return 0.0 if is_at_floor else np.nan
    return robust_highest_m(below_z_m)


def _step_z_m(
    observation: FaceObservation, low_m: float, high_m: float, lowest_m: float
) -> FloatArray:
    """Return the heights of what stands near the floor below the lowest ray, if all along."""
    low = observation.low_between(low_m, high_m)
    raised = (observation.low_z_m[low] > NOISE_M) & (observation.low_z_m[low] < lowest_m)
    share = _filled_share(observation.low_m[low][raised], low_m, high_m)
    return observation.low_z_m[low][raised] if share >= ALONG_SHARE else np.empty(0)


def estimate_lintel_m(
    observation: FaceObservation, low_m: float, high_m: float, free_m: float, least_m: float
) -> float:
    """Return the lintel, NaN where it could be anywhere between rays far apart.

    It lies above the rays that went through and below the wall seen above them. Points at one
    height behind the face are of its underside, and show it; those of a face are as high as the
    beams that met it.

    Parameters
    ----------
    observation : face_observation.FaceObservation
    low_m, high_m : float
        The opening along the line.
    free_m : float
        Up to where rays went through.
    least_m : float
        Points lower than that are none of the wall above it.
    """
    # beside a jamb points are its reveal's
    inner = observation.occupied_between(low_m + END_M, high_m - END_M)
    above = observation.occupied_z_m[inner] > least_m
    above_m, off_m, scan = (
        of[inner][above]
        for of in (observation.occupied_z_m, observation.occupied_off_m, observation.occupied_scan)
    )
    if len(above_m) < FEW:
        return np.nan
    lowest_m = np.percentile(above_m, 5)
    level = np.abs(above_m - lowest_m) <= NOISE_M
    behind = level & (off_m < -_BEHIND_M)
    enough = max(FEW, _BEHIND_SHARE * level.sum())
    if behind.sum() >= enough and len(np.unique(scan[behind])) >= LEAST_SCANS:
        return float(np.median(above_m[level]))
    return (
        float((free_m + lowest_m) / 2) if lowest_m - free_m <= _MOST_DOUBT_M + ROUNDING else np.nan
    )


def robust_highest_m(z_m: FloatArray) -> float:
    """Return the height that not just one or two of heights (n,), n >= 3, reach."""
    return float(np.partition(z_m, -FEW)[-FEW])


def _filled_share(places_m: FloatArray, low_m: float, high_m: float) -> float:
    """Return the share of the columns between two places that hold any of sorted places."""
    inside_m = places_m[np.searchsorted(places_m, low_m) : np.searchsorted(places_m, high_m)]
    columns = max(round((high_m - low_m) / CELL_M), 1)
    return len(np.unique(((inside_m - low_m) / CELL_M).astype(np.int64))) / columns
