"""Where along a line there is wall: told by the points at it and the rays through it."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.geometry.lines import Line, Span
from scanplan.rays.face_observation import (
    LEAST_HEIGHT_M,
    FaceObservation,
    RaySettings,
    observe_face,
)
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray

_OVERLOOKED_SHARE = 0.5
_REFIT_M = 0.04
_MOST_TURN_RAD = np.radians(3)
_ROUND_M = 1e-9
_END_M = 0.1
_MOST_LOOKS = 4
_COLUMN_WEIGHT = 10  # points of a column that count: a near scan's are not a hundred times as true


@dataclass(frozen=True, eq=False)
class FaceInterval(Span):
    """A stretch of wall surface: from `low_m` to `high_m` along the line of `seen`."""

    seen: FaceObservation
    low_m: float
    high_m: float

    @property
    def line(self):
        """The line it lies on."""
        return self.seen.line

    @cached_property
    def points(self):
        """The slice of the points of `seen` that show it."""
        return self.seen.occupied_between(self.low_m, self.high_m)

    @property
    def n_points(self):
        """How many points show it."""
        return self.points.stop - self.points.start

    @cached_property
    def top_m(self):
        """Height above the floor up to which it is seen over a good stretch."""
        raster = self.seen.raster
        return raster.seen_top_m(raster.between(self.low_m, self.high_m))

    @property
    def n_scans(self):
        """How many scans show it."""
        return len(np.unique(self.seen.occupied_scan[self.points]))


def observe_along(rays, line, low_m, high_m, reading):
    """Refit a line to the points at it, and gather what rays tell about it and beyond its ends.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    low_m, high_m : float
        What was extracted of it.
    reading : face_observation.RaySettings

    Returns
    -------
    face_observation.FaceObservation
    """
    reach_m = np.full(2, reading.reach_m)
    for _ in range(_MOST_LOOKS):
        seen, span = _look(rays, line, (low_m, high_m), reach_m, reading)
        goes_on = np.array(
            [np.abs(seen.glass_m - end).min(initial=np.inf) < _END_M for end in span]
        )
        if not goes_on.any():
            break
        # a pane is looked at as a whole
        reach_m = np.where(goes_on, 2 * reach_m, reach_m)
    return seen


def _look(
    rays: RaySet, line: Line, own_m: tuple[float, float], reach_m: FloatArray, reading: RaySettings
) -> tuple[FaceObservation, FloatArray]:
    """Return what is seen of a refitted line up to `reach_m` (2,) beyond its own, and the span."""
    span_m = own_m[0] - reach_m[0], own_m[1] + reach_m[1]
    near = cast_at_face(rays, line, *own_m, at_m=reading.band_m, occluded_within_m=0.0)
    is_own = near.is_occupied & (near.along_m >= own_m[0]) & (near.along_m <= own_m[1])
    if not rays.planar:
        is_own &= near.height_m > LEAST_HEIGHT_M
    refitted = refit_to_points(line, near.along_m[is_own], -near.behind_m[is_own])
    span_m = refitted.along_m(line.at(np.array(span_m)))
    return observe_face(rays, refitted, *span_m, band_m=reading.band_m), span_m


def refit_to_points(line: Line, along: FloatArray, offset: FloatArray) -> Line:
    """Fit a line to points at it, each 5 cm of it counting about alike; a poor fit changes nothing.

    Parameters
    ----------
    line : lines.Line
    along, offset : (n,) float
        Along the line, and before it, metres.
    """
    for _ in range(2):
        near = np.abs(offset - np.median(offset)) <= _REFIT_M if len(offset) else np.zeros(0, bool)
        along, offset = along[near], offset[near]
    if len(along) < 10 or np.ptp(along) < 4 * CELL_M:
        middle = np.median(offset) if len(offset) else 0.0
        return Line(line.centre + middle * line.normal, line.normal)
    column = np.floor((along - along.min()) / CELL_M).astype(np.int64)
    count = np.bincount(column)
    weight = (np.minimum(count, _COLUMN_WEIGHT) / np.maximum(count, 1)).take(column)
    centre_m, off_m = np.average(along, weights=weight), np.average(offset, weights=weight)
    slope = (weight * (along - centre_m)) @ (offset - off_m) / (weight @ (along - centre_m) ** 2)
    turn = np.clip(np.arctan(slope), -_MOST_TURN_RAD, _MOST_TURN_RAD)
    normal = np.cos(turn) * line.normal - np.sin(turn) * line.direction
    return Line(line.centre + centre_m * line.direction + off_m * line.normal, normal)


def find_face_intervals(seen, reading, *, foreign_m=()):
    """Find what is wall along a line.

    Columns with points, joined over pauses that no ray went through.

    Panes are no wall; stretches that rays look over along most of their length are furniture, and
    left out.

    Parameters
    ----------
    seen : face_observation.FaceObservation
    reading : face_observation.RaySettings
    foreign_m : sequence of (float, float)
        From where to where other faces cross the line: points there are theirs, so no stretch
        begins or ends there.

    Returns
    -------
    list of Stretch
        In order along the line.
    """
    if len(seen.occupied_m) == 0:
        return []
    raster, door_m = seen.raster, reading.door_height_m
    is_opened = raster.is_opened(door_m)
    is_overlooked = raster.is_overlooked(door_m)
    solid = raster.is_solid(door_m) & ~_inside(raster, [*foreign_m, *seen.glass_m])
    runs = []
    for column in np.flatnonzero(solid):
        if runs:
            pause = slice(runs[-1][1] + 1, column)
            is_short = (pause.stop - pause.start) * CELL_M <= reading.max_gap_m
            if is_short and is_opened[pause].sum() < 2:
                runs[-1][1] = column
                continue
        runs.append([column, column])
    walls = [(a, b + 1) for a, b in runs if is_overlooked[a : b + 1].mean() < _OVERLOOKED_SHARE]
    places = (raster.first_m + CELL_M * np.array(columns) for columns in walls)
    return [_trimmed(FaceInterval(seen, *map(float, place))) for place in places]


def _inside(raster, intervals_m):
    middle_m = raster.middle_m
    inside = np.zeros(len(middle_m), bool)
    for low_m, high_m in intervals_m:
        inside |= (middle_m >= low_m) & (middle_m <= high_m)
    return inside


def _trimmed(stretch):
    """Let an interval end where the scans that see its end see it.

    The outermost point of all scans lies beyond the true end: by the noise of a range, by what one
    scan or another is misplaced, and by what that scan sees of a door's reveal. A scan that sees an
    end shows it to half the distance of its points.
    """
    seen, round_m = stretch.seen, _ROUND_M
    # a point on the edge of a column is in it, whichever way the edge was rounded
    points = seen.occupied_between(stretch.low_m - round_m, stretch.high_m + round_m)
    along_m, scan = seen.occupied_m[points], seen.occupied_scan[points]
    low_m, high_m = -_usual_end_m(-along_m, scan), _usual_end_m(along_m, scan)
    if low_m >= high_m:
        low_m, high_m = along_m[0], along_m[-1]
    return replace(stretch, low_m=float(low_m), high_m=float(high_m))


def _usual_end_m(along_m, scan):
    """Return the weighted median of the scans' last points near the last of all."""
    near = along_m >= along_m.max() - _END_M
    _, index, count = np.unique(scan[near], return_inverse=True, return_counts=True)
    last_m = np.full(len(count), -np.inf)
    np.maximum.at(last_m, index, along_m[near])
    order = np.argsort(last_m, kind="stable")
    return last_m[order][np.searchsorted(np.cumsum(count[order]), near.sum() / 2)]
