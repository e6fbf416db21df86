"""Where along a line there is wall: told by the points at it and the rays through it."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.geometry.lines import Line, Span
from scanplan.rays import missing_returns, ray_set
from scanplan.rays.face_profile import COLUMN_M, FaceObservation

_LEAST_HEIGHT_M = 0.1
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
        return self.seen.hits(self.low_m, self.high_m)

    @property
    def n_points(self):
        """How many points show it."""
        return self.points.stop - self.points.start

    @property
    def n_scans(self):
        """How many scans show it."""
        return len(np.unique(self.seen.hit_scan[self.points]))


def observe_along(rays, line, low_m, high_m, reading):
    """Refit a line to the points at it, and gather what rays tell about it and beyond its ends.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    low_m, high_m : float
        What was extracted of it.
    reading : face_profile.RaySettings

    Returns
    -------
    face_profile.FaceObservation
    """
    reach_m = np.full(2, reading.reach_m)
    for _ in range(_MOST_LOOKS):
        seen, span = _look(rays, line, (low_m, high_m), reach_m, reading)
        goes_on = np.array(
            [np.abs(seen.panes_m - end).min(initial=np.inf) < _END_M for end in span]
        )
        if not goes_on.any():
            break
        # a pane is looked at as a whole
        reach_m = np.where(goes_on, 2 * reach_m, reach_m)
    return seen


def _look(rays, line, own_m, reach_m, reading):
    """Return what is seen of a line, `reach_m` (2,) beyond what was extracted, and from where to where."""
    span = own_m[0] - reach_m[0], own_m[1] + reach_m[1]
    sight = ray_set.observe_line(rays, line, *span, band_m=reading.band_m)
    own = (line.along_m(sight.hit_xy_m) >= own_m[0]) & (line.along_m(sight.hit_xy_m) <= own_m[1])
    upright = np.full(len(sight.hit_z_m), True) if rays.planar else sight.hit_z_m > _LEAST_HEIGHT_M
    seen = _seen(refit_to_points(line, sight.hit_xy_m[own & upright]), sight, upright, reading)
    span = seen.line.along_m(line.at(np.array(span)))
    return seen if rays.planar else replace(
        seen, panes_m=missing_returns.find_missing_returns(rays, seen.line, *span)
    ), span


def refit_to_points(line, xy_m):
    """Fit a line to the points (n, 2) at it, each 5 cm of it counting about alike; a poor fit changes nothing."""
    along, offset = line.along_m(xy_m), line.offset_m(xy_m)
    for _ in range(2):
        near = np.abs(offset - np.median(offset)) <= _REFIT_M if len(offset) else np.zeros(0, bool)
        along, offset = along[near], offset[near]
    if len(along) < 10 or np.ptp(along) < 4 * COLUMN_M:
        middle = np.median(offset) if len(offset) else 0.0
        return Line(line.centre + middle * line.normal, line.normal)
    column = np.floor((along - along.min()) / COLUMN_M).astype(np.int64)
    count = np.bincount(column)
    weight = (np.minimum(count, _COLUMN_WEIGHT) / np.maximum(count, 1)).take(column)
    centre_m, off_m = np.average(along, weights=weight), np.average(offset, weights=weight)
    slope = (weight * (along - centre_m)) @ (offset - off_m) / (weight @ (along - centre_m) ** 2)
    turn = np.clip(np.arctan(slope), -_MOST_TURN_RAD, _MOST_TURN_RAD)
    normal = np.cos(turn) * line.normal - np.sin(turn) * line.direction
    return Line(line.centre + centre_m * line.direction + off_m * line.normal, normal)


def _seen(line, sight, upright, reading):
    off_m = line.offset_m(sight.hit_xy_m)
    hit_m = line.along_m(sight.hit_xy_m)
    kept = np.flatnonzero(upright & (np.abs(off_m) <= reading.band_m))
    kept = kept[np.argsort(hit_m[kept], kind="stable")]
    pass_m = line.along_m(sight.pass_xy_m)
    order = np.argsort(pass_m, kind="stable")
    feet = np.flatnonzero(~upright & (np.abs(off_m) <= reading.band_m))
    feet = feet[np.argsort(hit_m[feet], kind="stable")]
    return FaceObservation(
        line,
        *(hit_m[kept], off_m[kept], sight.hit_z_m[kept], sight.hit_scan[kept]),
        *(pass_m[order], sight.pass_z_m[order], sight.pass_scan[order]),
        *(hit_m[feet], sight.hit_z_m[feet]),
    )


def find_face_intervals(seen, reading, *, planar, foreign_m=()):
    """Find what is wall along a line: columns with points, joined over pauses that no ray went through.

    Panes are no wall; stretches that rays look over along most of their length are furniture, and left out.

    Parameters
    ----------
    seen : face_profile.FaceObservation
    reading : face_profile.RaySettings
    planar : bool
    foreign_m : sequence of (float, float)
        From where to where other faces cross the line: points there are theirs, so no stretch begins or ends there.

    Returns
    -------
    list of Stretch
        In order along the line.
    """
    if len(seen.hit_m) == 0:
        return []
    columns = seen.columns(reading, planar=planar)
    solid = columns.solid & ~_inside(columns, [*foreign_m, *seen.panes_m])
    runs = []
    for column in np.flatnonzero(solid):
        if runs:
            pause = slice(runs[-1][1] + 1, column)
            if (pause.stop - pause.start) * COLUMN_M <= reading.max_gap_m and columns.opened[
                pause
            ].sum() < 2:
                runs[-1][1] = column
                continue
        runs.append([column, column])
    walls = [
        run
        for run in runs
        if columns.overlooked[slice(run[0], run[1] + 1)].mean() < _OVERLOOKED_SHARE
    ]
    places = (columns.first_m + COLUMN_M * np.array([a, b + 1]) for a, b in walls)
    return [_trimmed(FaceInterval(seen, *map(float, place))) for place in places]


def _inside(columns, intervals_m):
    middle_m = columns.first_m + COLUMN_M * (np.arange(len(columns.solid)) + 0.5)
    inside = np.zeros(len(middle_m), bool)
    for low_m, high_m in intervals_m:
        inside |= (middle_m >= low_m) & (middle_m <= high_m)
    return inside


def _trimmed(stretch):
    """Let a stretch end where scans see it end, half of the points near there being of scans that see no further.

    The outermost point of all scans lies beyond the true end: by the noise of a range, by what one scan or another is
    misplaced, and by what that scan sees of a door's reveal. A scan that sees an end shows it to half the distance of
    its points.
    """
    seen, round_m = stretch.seen, _ROUND_M
    # a point on the edge of a column is in it, whichever way the edge was rounded
    points = seen.hits(stretch.low_m - round_m, stretch.high_m + round_m)
    along_m, scan = seen.hit_m[points], seen.hit_scan[points]
    low_m, high_m = -_usual_end_m(-along_m, scan), _usual_end_m(along_m, scan)
    if low_m >= high_m:
        low_m, high_m = along_m[0], along_m[-1]
    return replace(stretch, low_m=float(low_m), high_m=float(high_m))


def _usual_end_m(along_m, scan):
    """Return the weighted median of the last points (n,) of the scans that have any near the last of all."""
    near = along_m >= along_m.max() - _END_M
    _, index, count = np.unique(scan[near], return_inverse=True, return_counts=True)
    last_m = np.full(len(count), -np.inf)
    np.maximum.at(last_m, index, along_m[near])
    order = np.argsort(last_m, kind="stable")
    return last_m[order][np.searchsorted(np.cumsum(count[order]), near.sum() / 2)]
