"""Pauses of a wall: openings where rays went through, closed where none could, or never seen."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays.face_observation import FaceObservation, RaySettings
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

OPEN, CLOSED, UNKNOWN = "open", "closed", "unknown"
REVEAL_M = 0.1  # how near to their place jambs come out
AT_FLOOR_M = 0.3  # lower returns may be of a step or of what lies there
FEW_RAYS = 3  # one or two may be stray
_OPEN_SHARE = 0.4  # of the width: furniture hides the rest of a way that is used
_OPEN_SHARE_BELOW_LINTEL = 0.2  # a lintel says that there is a way: half as much is enough
_CLOSED_SHARE = 0.1  # of the width: less is noise at the jambs
_LEAST_RAYS = 10  # fewer say nothing of a height or of a way
_EDGE_M = 0.03  # what a jamb's place errs by
_LOW_PERCENTILE = 1  # of the rays through: fewer are stray
_FLOOR_NOISE_M = 0.04  # what noise lifts returns of the floor by
_STEP_COLUMN_M = 0.1  # wider than what is between rays, narrower than what lies about
_STEP_SHARE = 0.7  # of the columns: a step goes on all along, what lies about does not
_DOORSTEP_M = 0.06  # one steps over less
_LEVEL_M = 0.03  # noise of a range seen along 15 degrees, of poses and of beams
_LEVEL_SCANS = 2  # one scan's beam meets a whole wall at one height
_BEHIND_M = 0.02  # noise of a range
_BEHIND_SHARE = 0.2  # noise leaves fewer so far behind a face, an underside most
_MOST_DOUBT_M = 0.2  # half of it is what a height may be wrong by
_ROUND_M = 1e-9  # rounding of a difference of heights


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
    def is_above_wall(self) -> bool:
        """Whether the wall goes on below it: its sill is well above the floor."""
        return self.sill_m > AT_FLOOR_M

    @property
    def width_m(self) -> float:
        """Width of the pause."""
        return self.high_m - self.low_m

    def kind(self, settings: OpeningSettings) -> str:
        """Return `window`, `door` or `passage`: by its sill, then by its width."""
        if self.sill_m > _DOORSTEP_M:
            return "window"
        return "door" if self.width_m <= settings.max_door_m else "passage"


def classify_gap(
    wall_line: Line,
    low_m: float,
    high_m: float,
    faces: Sequence[FaceObservation],
    reading: RaySettings,
    settings: OpeningSettings,
    *,
    needs_lintel: bool = False,
) -> Opening:
    """Classify a pause of a wall as open, closed or unknown by what rays say of its faces there.

    Parameters
    ----------
    wall_line : lines.Line
    low_m, high_m : float
        The pause along it.
    faces : list of face_observation.FaceObservation
        Of the wall's sides.
    reading : face_observation.RaySettings
    settings : OpeningSettings
    needs_lintel : bool
        Whether only what has wall above it is an opening: where no wall follows, anything could be
        beside a wall.

    Returns
    -------
    Opening
        By the face that most rays go through there; what that does not show of sill and lintel is
        taken from the others.
    """
    ends = wall_line.at(np.array([low_m, high_m]))
    spans_m = [np.sort(face.line.along_m(ends)) for face in faces]
    looks = [_look(face, span_m, reading) for face, span_m in zip(faces, spans_m, strict=True)]
    looks.sort(key=lambda look: (look.n_rays, look.open_share), reverse=True)
    n_rays, open_share = looks[0].n_rays, looks[0].open_share
    sill_m = _first_known(look.sill_m for look in looks)
    below_wall = any(look.below_wall for look in looks)
    width_m = high_m - low_m
    is_wide = settings.min_opening_m <= width_m <= settings.max_opening_m
    least_share = _OPEN_SHARE_BELOW_LINTEL if below_wall else _OPEN_SHARE
    is_open = n_rays >= _LEAST_RAYS and open_share >= least_share
    # rays went in and did not come back: through glass, or out of the building
    is_open |= (
        max(_glass_share(face, span_m) for face, span_m in zip(faces, spans_m, strict=True))
        >= _OPEN_SHARE
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
    lintel_m = _first_known(look.lintel_m for look in looks)
    return Opening(float(low_m), float(high_m), state, n_rays, sill_m, lintel_m, below_wall)


def _glass_share(face: FaceObservation, span_m: FloatArray) -> float:
    """Return on what share of the width rays did not come back."""
    inside_m = [min(high_m, span_m[1]) - max(low_m, span_m[0]) for low_m, high_m in face.glass_m]
    return float(sum(max(m, 0.0) for m in inside_m) / (span_m[1] - span_m[0]))


def _first_known(values_m: Iterable[float]) -> float:
    return next((value_m for value_m in values_m if np.isfinite(value_m)), np.nan)


@dataclass(frozen=True, eq=False)
class _Look:
    """What a face shows of a pause.

    Rays through it, on what share of the width, sill, lintel, if wall is above.
    """

    n_rays: int = 0
    open_share: float = 0.0
    sill_m: float = math.nan
    lintel_m: float = math.nan
    below_wall: bool = False


def _look(face: FaceObservation, span_m: FloatArray, reading: RaySettings) -> _Look:
    low_m, high_m = span_m[0] + _EDGE_M, span_m[1] - _EDGE_M
    if high_m <= low_m:
        return _Look()
    free = face.free_between(low_m, high_m)
    is_crossed = face.raster.is_crossed(reading.door_height_m)
    n_crossed = is_crossed[face.raster.between(low_m, high_m)].sum()
    open_share = min(float(n_crossed / max(round((high_m - low_m) / CELL_M), 1)), 1.0)
    n_rays = free.stop - free.start
    if face.planar or n_rays < _LEAST_RAYS:
        return _Look(n_rays, open_share)
    free_z_m = face.free_z_m[free]
    occupied_z_m = face.occupied_z_m[face.occupied_between(low_m, high_m)]
    sill_m = _sill_m(free_z_m, occupied_z_m)
    step_m = _step_m(face, low_m, high_m, float(np.percentile(free_z_m, _LOW_PERCENTILE)))
    sill_m = float(np.fmax(sill_m, step_m)) if step_m > 0 else sill_m
    free_top_m = robust_highest_m(free_z_m)
    least_m = max(free_top_m, reading.door_height_m)
    if (occupied_z_m > least_m).sum() < _LEAST_RAYS:
        return _Look(n_rays, open_share, sill_m)
    lintel_m = estimate_lintel_m(face, low_m, high_m, free_top_m, least_m)
    return _Look(n_rays, open_share, sill_m, lintel_m, True)


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
