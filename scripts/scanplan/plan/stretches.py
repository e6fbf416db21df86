"""Where along a line there is wall: told by the points at it and the rays through it."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.plan import rays as sights
from scanplan.plan.faceline import Line
from scanplan.plan.profiles import COLUMN_M, Seen

_LEAST_HEIGHT_M = 0.1
_OVERLOOKED_SHARE = 0.5
_REFIT_M = 0.04
_MOST_TURN_RAD = np.radians(3)
_ROUND_M = 1e-9
_COLUMN_WEIGHT = 10  # points of a column that count: a near scan's are not a hundred times as true


@dataclass(frozen=True, eq=False)
class Stretch:
    """A stretch of wall surface: from `low_m` to `high_m` along the line of `seen`."""

    seen: Seen
    low_m: float
    high_m: float

    @property
    def line(self):
        """The line it lies on."""
        return self.seen.line

    @property
    def length_m(self):
        """Length of the stretch."""
        return self.high_m - self.low_m

    @cached_property
    def ends(self):
        """Start and end, (2, 2) metres."""
        return self.line.at(np.array([self.low_m, self.high_m]))

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


def look_along(rays, line, low_m, high_m, reading):
    """Refit a line to the points at it, and gather what rays tell about it and beyond its ends.

    Parameters
    ----------
    rays : rays.Rays
    line : faceline.Line
    low_m, high_m : float
        What was extracted of it.
    reading : profiles.Reading

    Returns
    -------
    profiles.Seen
    """
    span = low_m - reading.reach_m, high_m + reading.reach_m
    sight = sights.look(rays, line, *span, band_m=reading.band_m)
    own = (line.along_m(sight.hit_xy_m) >= low_m) & (line.along_m(sight.hit_xy_m) <= high_m)
    upright = np.full(len(sight.hit_z_m), True) if rays.planar else sight.hit_z_m > _LEAST_HEIGHT_M
    return _seen(refitted(line, sight.hit_xy_m[own & upright]), sight, upright, reading)


def refitted(line, xy_m):
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
    weight = (np.minimum(count, _COLUMN_WEIGHT) / np.maximum(count, 1))[column]
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
    return Seen(
        line,
        *(hit_m[kept], off_m[kept], sight.hit_z_m[kept], sight.hit_scan[kept]),
        *(pass_m[order], sight.pass_z_m[order], sight.pass_scan[order]),
    )


def find(seen, reading, *, planar, foreign_m=()):
    """Find what is wall along a line: columns with points, joined over pauses that no ray went through.

    Stretches that rays look over along most of their length are furniture, and left out.

    Parameters
    ----------
    seen : profiles.Seen
    reading : profiles.Reading
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
    solid = columns.solid & ~_inside(columns, foreign_m)
    runs = []
    for column in np.flatnonzero(solid):
        if runs:
            pause = slice(runs[-1][1] + 1, column)
            if (pause.stop - pause.start) * COLUMN_M <= reading.max_gap_m and columns.opened[pause].sum() < 2:
                runs[-1][1] = column
                continue
        runs.append([column, column])
    walls = [run for run in runs if columns.overlooked[slice(run[0], run[1] + 1)].mean() < _OVERLOOKED_SHARE]
    places = (columns.first_m + COLUMN_M * np.array([a, b + 1]) for a, b in walls)
    return [_trimmed(Stretch(seen, *map(float, place))) for place in places]


def _inside(columns, intervals_m):
    middle_m = columns.first_m + COLUMN_M * (np.arange(len(columns.solid)) + 0.5)
    inside = np.zeros(len(middle_m), bool)
    for low_m, high_m in intervals_m:
        inside |= (middle_m >= low_m) & (middle_m <= high_m)
    return inside


def _trimmed(stretch):
    """Let a stretch end at its first and last point."""
    # a point on the edge of a column is in it, whichever way the edge was rounded
    points = stretch.seen.hit_m[stretch.seen.hits(stretch.low_m - _ROUND_M, stretch.high_m + _ROUND_M)]
    return replace(stretch, low_m=float(points[0]), high_m=float(points[-1]))
