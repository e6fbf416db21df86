"""Pauses of a wall: openings where rays went through, closed where none could, or never seen."""

from dataclasses import dataclass

import numpy as np

from scanplan.rays import face_profile

OPEN, CLOSED, UNKNOWN = "open", "closed", "unknown"
_OPEN_SHARE = 0.4
_OPEN_SHARE_BELOW_LINTEL = 0.2
_CLOSED_SHARE = 0.1
_LEAST_RAYS = 10
_EDGE_M = 0.03
REVEAL_M = 0.1  # jambs are drawn this well
_LOW_PERCENTILE = 1
AT_FLOOR_M = 0.3  # lower, points may be of a step or of what lies there
_FLOOR_NOISE_M = 0.04
_STEP_COLUMN_M = 0.1
_STEP_SHARE = 0.7
_DOORSTEP_M = 0.06
FEW_RAYS = 3  # one or two may be stray
_LEVEL_M = 0.03  # noise of a range seen along 15 degrees, of poses and of beams
_LEVEL_SCANS = 2  # one scan's beam meets a whole wall at one height
_BEHIND_M = 0.02  # noise of a range
_BEHIND_SHARE = 0.2  # noise leaves fewer so far behind a face, an underside most
_MOST_DOUBT_M = 0.2  # half of it is what a height may be wrong by
_ROUND_M = 1e-9


@dataclass(frozen=True)
class OpeningSettings:
    """What a pause of a wall is.

    Attributes
    ----------
    min_opening_m, max_opening_m : float
        Widths of an opening.
    max_closed_m : float
        A pause up to this length that no ray went through is wall, too.
    max_door_m : float
        A wider opening is a passage.
    """

    min_opening_m: float
    max_opening_m: float
    max_closed_m: float
    max_door_m: float


@dataclass(frozen=True, eq=False)
class Opening:
    """A pause of a wall, from `low_m` to `high_m` along it.

    Attributes
    ----------
    low_m, high_m : float
    state : str
        `OPEN`, `CLOSED` or `UNKNOWN`.
    n_rays : int
        That went through.
    sill_m, lintel_m : float
        Above the floor; NaN where not seen.
    below_wall : bool
        Whether wall was seen above it, at a height that need not be known.
    """

    low_m: float
    high_m: float
    state: str
    n_rays: int
    sill_m: float
    lintel_m: float
    below_wall: bool

    @property
    def is_above_wall(self):
        """Whether it is so far above the floor that the wall goes on below it."""
        return self.sill_m > AT_FLOOR_M

    @property
    def width_m(self):
        """Width of the pause."""
        return self.high_m - self.low_m

    def kind(self, settings):
        """Return what kind of opening it is."""
        if self.sill_m > _DOORSTEP_M:
            return "window"
        return "door" if self.width_m <= settings.max_door_m else "passage"


def classify_gap(wall_line, low_m, high_m, lines, reading, settings, *, planar, needs_lintel=False):
    """Tell what a pause of a wall is.

    Parameters
    ----------
    wall_line : lines.Line
    low_m, high_m : float
        The pause along it.
    lines : list of face_profile.FaceObservation
        The lines of the wall's faces.
    reading : face_profile.RaySettings
    settings : GapSettings
    planar : bool
    needs_lintel : bool
        Whether only what has wall above it is an opening: where no wall follows, anything could be beside a wall.

    Returns
    -------
    Gap
        Of the line that most rays crossed there; what that does not tell of sill and lintel is taken from the others.
    """
    ends = wall_line.at(np.array([low_m, high_m]))
    found = [_look(seen, np.sort(seen.line.along_m(ends)), reading, planar) for seen in lines]
    found.sort(key=lambda f: f[:2], reverse=True)
    (n_rays, open_share), (sill_m, lintel_m) = (
        found[0][:2],
        (_first_known(f[i] for f in found) for i in (2, 3)),
    )
    below_wall = any(f[4] for f in found)
    width_m = high_m - low_m
    is_wide = settings.min_opening_m <= width_m <= settings.max_opening_m
    least_share = _OPEN_SHARE_BELOW_LINTEL if below_wall else _OPEN_SHARE
    is_open = n_rays >= _LEAST_RAYS and open_share >= least_share
    # rays went in and did not come back: through glass, or out of the building
    is_open |= (
        max(_lost_share(seen, np.sort(seen.line.along_m(ends))) for seen in lines) >= _OPEN_SHARE
    )
    # wall above, some rays through a window, and what is below them hidden: no way through was seen
    behind_things = below_wall and np.isnan(sill_m)
    if is_wide and is_open and (below_wall or not needs_lintel):
        state = OPEN
    elif (
        (open_share <= _CLOSED_SHARE or behind_things)
        and width_m <= settings.max_closed_m
        and not needs_lintel
    ):
        state = CLOSED
    else:
        state = UNKNOWN
    return Opening(float(low_m), float(high_m), state, n_rays, sill_m, lintel_m, below_wall)


def _lost_share(seen, span_m):
    """Return on what share of the width rays did not come back."""
    inside_m = [min(high_m, span_m[1]) - max(low_m, span_m[0]) for low_m, high_m in seen.panes_m]
    return sum(max(m, 0.0) for m in inside_m) / (span_m[1] - span_m[0])


def _first_known(values_m):
    return next((value_m for value_m in values_m if np.isfinite(value_m)), np.nan)


def _look(seen, span_m, reading, planar):
    """Return how many rays crossed, on what share of the width, heights of sill and lintel, if there is wall above."""
    low_m, high_m = span_m[0] + _EDGE_M, span_m[1] - _EDGE_M
    if high_m <= low_m:
        return 0, 0.0, np.nan, np.nan, False
    passes = seen.passes(low_m, high_m)
    columns = seen.columns(reading, planar=planar)
    crossed = columns.crossed[columns.between(low_m, high_m)]
    open_share = float(crossed.sum() / max(round((high_m - low_m) / face_profile.COLUMN_M), 1))
    n_rays = passes.stop - passes.start
    if planar or n_rays < _LEAST_RAYS:
        return n_rays, min(open_share, 1.0), np.nan, np.nan, False
    pass_z_m, hit_z_m = seen.pass_z_m[passes], seen.hit_z_m[seen.hits(low_m, high_m)]
    sill_m = _sill_m(pass_z_m, hit_z_m)
    step_m = _step_m(seen, low_m, high_m, float(np.percentile(pass_z_m, _LOW_PERCENTILE)))
    sill_m = float(np.fmax(sill_m, step_m)) if step_m > 0 else sill_m
    free_m = robust_highest_m(pass_z_m)
    least_m = max(free_m, reading.door_height_m)
    if (hit_z_m > least_m).sum() < _LEAST_RAYS:
        return n_rays, min(open_share, 1.0), sill_m, np.nan, False
    return (
        n_rays,
        min(open_share, 1.0),
        sill_m,
        estimate_lintel_m(seen, low_m, high_m, free_m, least_m),
        True,
    )


def _step_m(seen, low_m, high_m, lowest_m):
    """Return the height of what stands in the way near the floor all along, below the lowest ray through; 0 if nothing.

    In a doorway rays end on the floor; a sill's front ends them above that.
    """
    feet = seen.feet(low_m, high_m)
    raised = (seen.foot_z_m[feet] > _FLOOR_NOISE_M) & (seen.foot_z_m[feet] < lowest_m)
    width = int((high_m - low_m) / _STEP_COLUMN_M)
    column = ((seen.foot_m[feet][raised] - low_m) / _STEP_COLUMN_M).astype(np.int64)
    if len(column) < _LEAST_RAYS or len(np.unique(column)) < _STEP_SHARE * width:
        return 0.0
    return (float(np.percentile(seen.foot_z_m[feet][raised], 95)) + lowest_m) / 2


def _sill_m(pass_z_m, hit_z_m):
    """Return the sill: between the rays that went through and the wall seen below them."""
    low_m = np.percentile(pass_z_m, _LOW_PERCENTILE)
    if low_m <= AT_FLOOR_M:
        return 0.0
    below_m = hit_z_m[hit_z_m < low_m]
    return (
        float((np.percentile(below_m, 95) + low_m) / 2) if len(below_m) >= _LEAST_RAYS else np.nan
    )


def estimate_lintel_m(seen, low_m, high_m, free_m, least_m):
    """Return the lintel, NaN where it could be anywhere between rays far apart.

    It lies above the rays that went through and below the wall seen above them. Points at one height behind the face
    are of its underside, and show it; those of a face are as high as the beams that met it.

    Parameters
    ----------
    seen : face_profile.FaceObservation
    low_m, high_m : float
        The opening along the line.
    free_m : float
        Up to where rays went through.
    least_m : float
        Points lower than that are none of the wall above it.
    """
    # beside a jamb points are its reveal's
    inner = seen.hits(low_m + REVEAL_M, high_m - REVEAL_M)
    above = seen.hit_z_m[inner] > least_m
    above_m, off_m, scan = (
        of[inner][above] for of in (seen.hit_z_m, seen.hit_off_m, seen.hit_scan)
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


def robust_highest_m(z_m):
    """Return the height that not just one or two of heights (n,), n >= 3, reach."""
    return float(np.partition(z_m, -FEW_RAYS)[-FEW_RAYS])
