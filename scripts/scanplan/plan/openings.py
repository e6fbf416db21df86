"""Gaps of a wall: openings where rays went through, closed where none could, or never seen."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.opening_heights import (
    AT_FLOOR_M,
    estimate_lintel_m,
    estimate_sill_m,
    robust_highest_m,
)
from scanplan.plan.tolerances import END_M, ENOUGH_RAYS, NOISE_M
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.face_raster import CELL_M, SCAN_COLUMN_M
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray

OPEN, CLOSED, UNKNOWN = "open", "closed", "unknown"
GAP = "gap"
"""Kind of an opening of which it is not known what it is."""
_OPEN_SHARE = 0.4  # of the width: furniture hides the rest of a way; half as much below a lintel
_CLOSED_SHARE = 0.1  # of the width: less is noise at the jambs


@dataclass(frozen=True)
class OpeningSettings:
    """What a gap of a wall is.

    Attributes
    ----------
    min_opening_m, max_opening_m : float
        Widths of an opening.
    max_closed_m : float
        A gap up to this length that no ray went through is wall, too.
    max_door_m : float
        A wider opening is a passage.
    door_height_m : float
        Above the floor; what is higher says nothing about a way through.
    """

    min_opening_m: float
    max_opening_m: float
    max_closed_m: float
    max_door_m: float
    door_height_m: float


@dataclass(frozen=True, eq=False)
class Opening:
    """A gap of a wall, from `low_m` to `high_m` along it.

    Attributes
    ----------
    low_m, high_m : float
    state : str
        `OPEN`, `CLOSED` or `UNKNOWN`.
    n_rays : int
        That went through; of windows and in planar scans also those that never came back.
    sill_m, lintel_m : float
        Above the floor; NaN where not seen.
    below_wall : bool
        Whether wall was seen above it, at a height that need not be known.
    kind : str
        `door`, `window`, `glass`, or `GAP`: as long as nothing else is known of it.
    p_kind : float
        Probability of the likeliest kind; NaN as long as none was weighed.
    """

    low_m: float
    high_m: float
    state: str
    n_rays: int
    sill_m: float
    lintel_m: float
    below_wall: bool
    kind: str = GAP
    p_kind: float = math.nan

    @property
    def is_above_wall(self) -> bool:
        """Whether the wall goes on below it."""
        is_hidden = math.isnan(self.sill_m)
        return self.sill_m > AT_FLOOR_M or (self.kind == "window" and is_hidden)

    @property
    def width_m(self) -> float:
        """Width of the gap."""
        return self.high_m - self.low_m

    def type_name(self, max_door_m: float) -> str:
        """Return its kind; that of a door wider than a door is `passage`."""
        return "passage" if self.kind == "door" and self.width_m > max_door_m else self.kind


def classify_gap(
    wall_line: Line,
    low_m: float,
    high_m: float,
    faces: Sequence[FaceObservation],
    settings: OpeningSettings,
    *,
    needs_lintel: bool = False,
) -> Opening:
    """Classify a gap of a wall as open, closed or unknown by what rays show of its faces there.

    Parameters
    ----------
    wall_line : lines.Line
    low_m, high_m : float
        The gap along it.
    faces : list of face_observation.FaceObservation
        Of the wall's sides.
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
    shown = [
        _observe_gap(face, span_m, settings.door_height_m)
        for face, span_m in zip(faces, spans_m, strict=True)
    ]
    shown.sort(key=lambda side: (side.n_rays, side.open_share), reverse=True)
    n_rays, open_share = shown[0].n_rays, shown[0].open_share
    sill_m = _first_known(side.sill_m for side in shown)
    below_wall = any(side.below_wall for side in shown)
    width_m = high_m - low_m
    is_wide = settings.min_opening_m <= width_m <= settings.max_opening_m
    least_share = _OPEN_SHARE / 2 if below_wall else _OPEN_SHARE
    is_open = n_rays >= FEW and open_share >= least_share
    # wall above, some rays through a window, and what is below them hidden: no way through was seen
    is_hidden = below_wall and np.isnan(sill_m)
    is_solid = open_share <= _CLOSED_SHARE or n_rays < FEW
    is_short = width_m <= settings.max_closed_m
    is_known = any(
        face.covers(span_m[0] + END_M, span_m[1] - END_M)
        for face, span_m in zip(faces, spans_m, strict=True)
    )
    state = UNKNOWN
    if is_wide and is_open and (below_wall or not needs_lintel):
        state = OPEN
    elif (is_solid or is_hidden) and is_short and is_known and not needs_lintel:
        state = CLOSED
    lintel_m = _first_known(side.lintel_m for side in shown)
    return Opening(float(low_m), float(high_m), state, n_rays, sill_m, lintel_m, below_wall)


def _crossed_share(face: FaceObservation, low_m: float, high_m: float) -> float:
    """Return on what share of the width more rays of planar scans go through than end there."""
    edges_m = np.linspace(low_m, high_m, max(round((high_m - low_m) / SCAN_COLUMN_M), 1) + 1)
    n_free, n_occupied = (np.histogram(of_m, edges_m)[0] for of_m in (face.free_m, face.occupied_m))
    return float((n_free > n_occupied).mean())


def _first_known(values_m: Iterable[float]) -> float:
    return next((value_m for value_m in values_m if np.isfinite(value_m)), np.nan)


@dataclass(frozen=True, eq=False)
class _GapEvidence:
    """What rays show of a gap on one side of a wall.

    How many went through, on what share of the width, sill, lintel, and whether wall is above.
    """

    n_rays: int = 0
    open_share: float = 0.0
    sill_m: float = math.nan
    lintel_m: float = math.nan
    below_wall: bool = False


def _observe_gap(face: FaceObservation, span_m: FloatArray, door_height_m: float) -> _GapEvidence:
    low_m, high_m = span_m[0] + NOISE_M, span_m[1] - NOISE_M
    if high_m <= low_m:
        return _GapEvidence()
    free = face.free_between(low_m, high_m)
    if face.planar:
        open_share = _crossed_share(face, low_m, high_m)
    else:
        is_crossed = face.raster.is_crossed(door_height_m)
        n_crossed = is_crossed[face.raster.between(low_m, high_m)].sum()
        open_share = min(float(n_crossed / max(round((high_m - low_m) / CELL_M), 1)), 1.0)
    evidence = _GapEvidence(free.stop - free.start, open_share)
    if face.planar or evidence.n_rays < ENOUGH_RAYS:
        return evidence
    free_z_m = face.free_z_m[free]
    occupied_z_m = face.occupied_z_m[face.occupied_between(low_m, high_m)]
    sill_m = estimate_sill_m(face, low_m, high_m)
    free_top_m = robust_highest_m(free_z_m)
    least_m = max(free_top_m, door_height_m)
    if (occupied_z_m > least_m).sum() < ENOUGH_RAYS:
        return replace(evidence, sill_m=sill_m)
    lintel_m = estimate_lintel_m(face, low_m, high_m, free_top_m, least_m)
    return replace(evidence, sill_m=sill_m, lintel_m=lintel_m, below_wall=True)
