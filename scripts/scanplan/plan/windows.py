"""Windows of walls: where rays went through above a sill that was seen.

A lidar near the floor sees the wall below a window, so the window is no gap of the wall. Higher
up no ray ends at it: rays go through, and come back from what is behind, or, out of the building,
never.
"""

from dataclasses import replace

import numpy as np

from scanplan.plan.opening_heights import AT_FLOOR_M, estimate_lintel_m, estimate_sill_m
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ALONG_SHARE, END_M, LEAST_SCANS
from scanplan.rays.face_observation import FaceObservation, count_sent, filled_share
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW
from scanplan.types import BoolArray, FloatArray

_WINDOW_BAND_M = (1.25, 1.7)  # sills are lower, lintels are higher
_SILL_SHARE = 0.3  # desks hide much of the wall below; in a doorway there is none


def add_windows(
    walls: list[PlanWall], rays: RaySet, *, min_width_m: float, band_m: float
) -> list[PlanWall]:
    """Return walls with their windows.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    rays : ray_set.RaySet
        Planar scans show no windows.
    min_width_m : float
    band_m : float, > 0
        Returns this near to a face are at it.

    Returns
    -------
    list of plan_wall.PlanWall
    """
    if rays.planar:
        return list(walls)
    return [_with_windows(wall, rays, min_width_m, band_m) for wall in walls]


def _with_windows(wall: PlanWall, rays: RaySet, min_width_m: float, band_m: float) -> PlanWall:
    lines = wall.lines
    found = list(wall.openings)
    for seen in lines:
        first_m, last_m = np.sort(seen.line.along_m(wall.ends)).tolist()
        for window in find_windows(
            rays, seen, first_m, last_m, min_width_m=min_width_m, band_m=band_m
        ):
            ends = seen.line.at(np.array([window.low_m, window.high_m]))
            low_m, high_m = np.sort(wall.line.along_m(ends)).tolist()
            is_known = any(low_m < gap.high_m and high_m > gap.low_m for gap in found)
            if not is_known and not any(_is_wall(other, ends) for other in lines):
                found.append(replace(window, low_m=low_m, high_m=high_m))
    return replace(wall, openings=sorted(found, key=lambda gap: gap.low_m))


def _is_wall(seen: FaceObservation, ends: FloatArray) -> bool:
    """Return whether a line shows wall above a sill between two ends: a screen or a mirror."""
    low_m, high_m = np.sort(seen.line.along_m(ends))
    points = seen.occupied_between(low_m, high_m)
    is_in_band = _is_in_window_band(seen.occupied_z_m[points])
    share = filled_share(seen.occupied_m[points][is_in_band], low_m, high_m)
    return share > 1 - share


def _is_in_window_band(z_m: FloatArray) -> BoolArray:
    return (z_m >= _WINDOW_BAND_M[0]) & (z_m < _WINDOW_BAND_M[1])


def find_windows(
    rays: RaySet,
    seen: FaceObservation,
    low_m: float,
    high_m: float,
    min_width_m: float,
    band_m: float,
) -> list[Opening]:
    """Find the windows along a line.

    Gaps between the points in the window band, with wall beside and below them.

    Rays must have been sent to nearly all of a gap, nothing before it in their way, and hardly
    one may have ended in it, as in a niche: where no ray is to be expected, or things hide the
    wall, nothing is known.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of scans in space.
    seen : face_observation.FaceObservation
    low_m, high_m : float
        The stretch of the line that is wall.
    min_width_m : float
    band_m : float, > 0
        Returns this near to a face are at it.

    Returns
    -------
    list of openings.Opening
        In order along the line.
    """
    points = seen.occupied_between(low_m, high_m)
    place_m, z_m = seen.occupied_m[points], seen.occupied_z_m[points]
    beside_m = _not_alone(place_m[_is_in_window_band(z_m)])
    spans_m = np.column_stack([beside_m[:-1], beside_m[1:]])
    spans_m = spans_m[np.diff(spans_m, axis=1)[:, 0] >= min_width_m]
    windows = (_classify_gap(rays, seen, low, high, band_m) for low, high in spans_m.tolist())
    return [window for window in windows if window is not None]


def _not_alone(place_m: FloatArray) -> FloatArray:
    """Return those of sorted places within a column of enough others: one or two are stray."""
    low = np.searchsorted(place_m, place_m - CELL_M / 2, "left")
    high = np.searchsorted(place_m, place_m + CELL_M / 2, "right")
    return place_m[high - low >= FEW]


def _classify_gap(
    rays: RaySet, seen: FaceObservation, low_m: float, high_m: float, band_m: float
) -> Opening | None:
    """Return what is between two places of a line as a window, None if it is none."""
    inner_m = low_m + END_M, high_m - END_M
    inner = seen.occupied_between(*inner_m)
    is_below = seen.occupied_z_m[inner] < _WINDOW_BAND_M[0]
    if filled_share(seen.occupied_m[inner][is_below], *inner_m) < _SILL_SHARE:
        return None
    sill_m = estimate_sill_m(seen, *inner_m, below_m=_WINDOW_BAND_M[0])
    if not sill_m > AT_FLOOR_M:
        return None
    count = max(int((high_m - low_m) / CELL_M), 1)
    sent = count_sent(rays, seen.line, low_m, count, _WINDOW_BAND_M, band_m)
    reached, _, in_wall = sent.reached(least_scans=LEAST_SCANS)
    shown = np.isfinite(reached)
    n_reached, n_in_wall = reached[shown].sum(), in_wall[shown].sum()
    # reveals and panes send some back, a niche all
    if shown.mean() < ALONG_SHARE or n_in_wall > n_reached - n_in_wall:
        return None
    n_rays = int(n_reached - n_in_wall)
    lintel_m = estimate_lintel_m(seen, low_m, high_m, _WINDOW_BAND_M[1], _WINDOW_BAND_M[1])
    return Opening(low_m, high_m, OPEN, n_rays, sill_m, lintel_m, bool(np.isfinite(lintel_m)))
