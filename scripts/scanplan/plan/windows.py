"""Windows above a wall that is seen below them: where rays go through at eye height."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.opening_heights import estimate_lintel_m, estimate_sill_m
from scanplan.plan.opening_kinds import choose_kind, observe_gap, weigh_kinds
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.height_profile import EYE_ROWS, ROWS_M, HeightProfile
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, STRETCH_M
from scanplan.types import FloatArray


def add_windows(
    walls: Sequence[PlanWall],
    rays: RaySet,
    *,
    min_width_m: float,
    band_m: float,
) -> list[PlanWall]:
    """Return walls with what may be windows in them: gaps at eye height that are no other gap's.

    A lidar near the floor sees the wall below a window, so that it is no gap of the wall. Higher up
    rays go through, and come back from what is behind, or, out of the building, never.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    rays : ray_set.RaySet
        Planar scans show no windows.
    min_width_m : float
    band_m : float, > 0
        Returns this near to a face are at it.
    """
    if rays.planar:
        return list(walls)
    return [_with_windows(wall, rays, min_width_m, band_m) for wall in walls]


def _with_windows(wall: PlanWall, rays: RaySet, min_width_m: float, band_m: float) -> PlanWall:
    found = list(wall.openings)
    for seen in wall.lines:
        for span_m in _find_pauses(seen, wall, min_width_m):
            low_m, high_m = _along_wall(wall, seen.line, span_m)
            is_known = any(low_m < gap.high_m and high_m > gap.low_m for gap in found)
            if is_known:
                continue
            profile = observe_gap(wall, low_m, high_m, rays, band_m)
            kind = choose_kind(weigh_kinds(profile, is_outside=True))
            if kind == "window" and profile.open_share >= 1 - profile.open_share:
                window = _measure_window(seen, span_m, profile)
                low_m, high_m = _along_wall(wall, seen.line, (window.low_m, window.high_m))
                found.append(replace(window, low_m=low_m, high_m=high_m))
    return replace(wall, openings=sorted(found, key=lambda gap: gap.low_m))


def _measure_window(
    seen: FaceObservation, span_m: tuple[float, float], profile: HeightProfile
) -> Opening:
    eye_m = float(ROWS_M[EYE_ROWS.start]), float(ROWS_M[EYE_ROWS.stop])
    clear_m = _clear_above_sill(seen, span_m)
    inner_m = clear_m[0] + END_M, clear_m[1] - END_M
    sill_m = estimate_sill_m(seen, *inner_m, below_m=eye_m[0])
    lintel_m = estimate_lintel_m(seen, *clear_m, eye_m[1], eye_m[1])
    n_rays = round(float(profile.n_through.sum()))
    return Opening(*clear_m, OPEN, n_rays, sill_m, lintel_m, bool(np.isfinite(lintel_m)))


def _clear_above_sill(seen: FaceObservation, span_m: tuple[float, float]) -> tuple[float, float]:
    """Return the widest part of a pause at eye height that has no returns down to the sill either.

    Its sides may be hidden at eye height, and be seen below that: the sill is the
    median of stretches.
    """
    eye_m = float(ROWS_M[EYE_ROWS.start])
    edges_m = np.linspace(*span_m, max(round((span_m[1] - span_m[0]) / STRETCH_M), 1) + 1)
    sills_m = np.array([estimate_sill_m(seen, *ends, below_m=eye_m) for ends in pairwise(edges_m)])
    is_seen = np.isfinite(sills_m)
    if not is_seen.any():
        return span_m
    sill_m = np.median(sills_m[is_seen])
    points = seen.occupied_between(*span_m)
    z_m = seen.occupied_z_m[points]
    is_above = (z_m >= sill_m + END_M) & (z_m < ROWS_M[EYE_ROWS.stop])
    beside_m = _not_alone(seen.occupied_m[points][is_above])
    beside_m = np.concatenate([span_m[:1], beside_m, span_m[1:]])
    widest = int(np.diff(beside_m).argmax())
    return float(beside_m[widest]), float(beside_m[widest + 1])


def _find_pauses(
    seen: FaceObservation, wall: PlanWall, min_width_m: float
) -> list[tuple[float, float]]:
    """Return the spans along a face between returns at eye height, of a least width."""
    first_m, last_m = np.sort(seen.line.along_m(wall.ends)).tolist()
    points = seen.occupied_between(first_m, last_m)
    z_m = seen.occupied_z_m[points]
    is_at_eye = (z_m >= ROWS_M[EYE_ROWS.start]) & (z_m < ROWS_M[EYE_ROWS.stop])
    beside_m = _not_alone(seen.occupied_m[points][is_at_eye])
    wide = np.flatnonzero(np.diff(beside_m) >= min_width_m)
    return [(float(beside_m[i]), float(beside_m[i + 1])) for i in wide]


def _not_alone(place_m: FloatArray) -> FloatArray:
    """Return those of sorted places within a column of enough others: one or two are stray."""
    low = np.searchsorted(place_m, place_m - CELL_M / 2, "left")
    high = np.searchsorted(place_m, place_m + CELL_M / 2, "right")
    return place_m[high - low >= FEW]


def _along_wall(wall: PlanWall, line: Line, span_m: tuple[float, float]) -> tuple[float, float]:
    low_m, high_m = np.sort(wall.line.along_m(line.at(np.array(span_m)))).tolist()
    return low_m, high_m
