"""Where along a line there is wall, by the points at it and the rays through it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.geometry.lines import Line, Span
from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.tolerances import END_M, ENOUGH_RAYS
from scanplan.rays.face_observation import (
    FaceObservation,
    look_beyond,
    observe_face,
)
from scanplan.rays.face_raster import CELL_M, FaceRaster
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.types import BoolArray, FloatArray, IntArray

_REFIT_M = 0.04  # from the median: what points of one face scatter by; others do not pull the line
LEAST_OPEN_COLUMNS = 2
"""A single column may be opened by what points at its edges leave out, or pass beside a way."""

_MOST_TURN_RAD = np.radians(3)  # a line of segments turns by noise alone; more is another face


@dataclass(frozen=True, eq=False)
class FaceInterval(Span):
    """An interval of wall surface: from `low_m` to `high_m` along the line of `observation`."""

    observation: FaceObservation
    low_m: float
    high_m: float

    @property
    def line(self) -> Line:
        """The line it lies on."""
        return self.observation.line

    @cached_property
    def points(self) -> slice:
        """The slice of the points of `observation` that show it."""
        return self.observation.occupied_between(self.low_m, self.high_m)

    @property
    def n_points(self) -> int:
        """How many points show it."""
        return self.points.stop - self.points.start

    @cached_property
    def scans(self) -> IntArray:
        """The scans (k,) that show it, increasing."""
        return np.unique(self.observation.occupied_scan[self.points])

    @property
    def n_scans(self) -> int:
        """How many scans show it."""
        return len(self.scans)


def observe_along(
    rays: RaySet, line: Line, low_m: float, high_m: float, *, band_m: float, reach_m: float
) -> FaceObservation:
    """Refit a line to the points at it, and observe it and what is beyond its ends.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    low_m, high_m : float
        What was extracted of it.
    band_m : float, > 0
        Points this near to it are at it.
    reach_m : float, >= 0
        How far beyond its ends more of it is looked for.
    """
    observation, span_m = _observe_refitted(rays, line, (low_m, high_m), reach_m, band_m)
    if not rays.planar:
        return observation
    # where a wall ends it is asked whether rays go by; what returns there is of other lines
    span_m = span_m + reach_m * np.array([-1, 1])
    return look_beyond(observation, rays, *span_m, band_m=band_m)


def _observe_refitted(
    rays: RaySet, line: Line, own_m: tuple[float, float], reach_m: float, band_m: float
) -> tuple[FaceObservation, FloatArray]:
    """Return what is seen of a refitted line, up to a reach beyond its own ends, and the span."""
    span_m = own_m[0] - reach_m, own_m[1] + reach_m
    near = cast_at_face(rays, line, *own_m, at_m=band_m, occluded_within_m=0.0)
    is_own = near.is_occupied & (near.along_m >= own_m[0]) & (near.along_m <= own_m[1])
    is_own &= near.height_m > SKIRTING_M
    refitted = refit_to_points(line, near.along_m[is_own], -near.behind_m[is_own])
    refitted_m = refitted.along_m(line.at(np.array(span_m)))
    return observe_face(rays, refitted, *refitted_m, band_m=band_m), refitted_m


def refit_to_points(line: Line, along: FloatArray, offset: FloatArray) -> Line:
    """Fit a line to points at it, each 5 cm of it counting about alike; a poor fit changes nothing.

    Parameters
    ----------
    line : lines.Line
    along, offset : (n,) float
        Along the line, and before it, metres.
    """
    for _ in range(2):
        if len(offset):
            is_near = np.abs(offset - np.median(offset)) <= _REFIT_M
            along = along[is_near]
            offset = offset[is_near]
    if len(along) < ENOUGH_RAYS or np.ptp(along) < 2 * END_M:
        middle = np.median(offset) if len(offset) else 0.0
        return Line(line.centre + middle * line.normal, line.normal)
    column = np.floor((along - along.min()) / CELL_M).astype(np.int64)
    count = np.bincount(column)
    weight = (np.minimum(count, ENOUGH_RAYS) / np.maximum(count, 1)).take(column)
    centre_m = np.average(along, weights=weight)
    off_m = np.average(offset, weights=weight)
    slope = (weight * (along - centre_m)) @ (offset - off_m) / (weight @ (along - centre_m) ** 2)
    turn = np.clip(np.arctan(slope), -_MOST_TURN_RAD, _MOST_TURN_RAD)
    normal = np.cos(turn) * line.normal - np.sin(turn) * line.direction
    return Line(line.centre + centre_m * line.direction + off_m * line.normal, normal)


def find_face_intervals(
    observation: FaceObservation,
    *,
    door_height_m: float,
    max_gap_m: float,
    foreign_m: Sequence[tuple[float, float]] = (),
) -> list[FaceInterval]:
    """Find what is wall along a line.

    Columns with points, joined over gaps that no ray went through.

    Parameters
    ----------
    observation : face_observation.FaceObservation
    door_height_m : float, > 0
        What is higher says nothing about a way through.
    max_gap_m : float, >= 0
        Longest gap that is wall all the same where no ray went through.
    foreign_m : sequence of (float, float)
        From where to where other faces cross the line: points there are owned by these, so no
        interval begins or ends there.

    Returns
    -------
    list of FaceInterval
        In order along the line.
    """
    if len(observation.occupied_m) == 0:
        return []
    raster = observation.raster
    is_foreign = _is_within(raster, foreign_m)
    is_solid = raster.is_solid(door_height_m) & ~is_foreign
    is_opened = raster.is_opened(door_height_m)
    intervals = []
    for first, last in _join_columns(is_solid, is_opened, max_gap_m):
        low_m = raster.first_m + CELL_M * first
        high_m = raster.first_m + CELL_M * (last + 1)
        intervals.append(_trim_ends(FaceInterval(observation, float(low_m), float(high_m))))
    return intervals


def _join_columns(
    is_solid: BoolArray, is_opened: BoolArray, max_gap_m: float
) -> list[tuple[int, int]]:
    """Return first and last of solid columns (c,), joined over short gaps that no ray opens."""
    runs: list[tuple[int, int]] = []
    for column in np.flatnonzero(is_solid).tolist():
        if runs:
            first, last = runs[-1]
            is_short = (column - last - 1) * CELL_M <= max_gap_m
            if is_short and is_opened[last + 1 : column].sum() < LEAST_OPEN_COLUMNS:
                runs[-1] = (first, column)
                continue
        runs.append((column, column))
    return runs


def _is_within(raster: FaceRaster, spans_m: Iterable[Sequence[float] | FloatArray]) -> BoolArray:
    """Return which columns (c,) have their middle within any of some spans."""
    middle_m = raster.middle_m
    is_within = np.zeros(len(middle_m), bool)
    for low_m, high_m in spans_m:
        is_within |= (middle_m >= low_m) & (middle_m <= high_m)
    return is_within


def _trim_ends(interval: FaceInterval) -> FaceInterval:
    """Let an interval end where the scans that see its end see it.

    The outermost point of all scans lies beyond the true end: by the noise of a range, by what one
    scan or another is misplaced, and by what that scan sees of a door's reveal. A scan that sees an
    end shows it to half the distance of its points.
    """
    observation = interval.observation
    # a point on the edge of a column is in it, whichever way the edge was rounded
    points = observation.occupied_between(interval.low_m - ROUNDING, interval.high_m + ROUNDING)
    along_m = observation.occupied_m[points]
    scan = observation.occupied_scan[points]
    low_m = -_usual_end_m(-along_m, scan)
    high_m = _usual_end_m(along_m, scan)
    if low_m >= high_m:
        low_m = float(along_m[0])
        high_m = float(along_m[-1])
    return replace(interval, low_m=low_m, high_m=high_m)


def _usual_end_m(along_m: FloatArray, scan: IntArray) -> float:
    """Return the weighted median of the scans' last points near the last of all."""
    near = along_m >= along_m.max() - END_M
    _, index, count = np.unique(scan[near], return_inverse=True, return_counts=True)
    last_m = np.full(len(count), -np.inf)
    np.maximum.at(last_m, index, along_m[near])
    order = np.argsort(last_m, kind="stable")
    return float(last_m[order][np.searchsorted(np.cumsum(count[order]), near.sum() / 2)])
