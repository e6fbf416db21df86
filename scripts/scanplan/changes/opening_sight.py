"""What rays of two surveys show of an opening: whether it is closed, and flush with its wall."""

from dataclasses import dataclass

import numpy as np

from scanplan.changes import ray_cells
from scanplan.changes.scan_plane import are_one_plane
from scanplan.changes.surveys import Survey
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import WAYS
from scanplan.plan.tolerances import END_M
from scanplan.rays.tolerances import FEW, STRAY_SHARE
from scanplan.types import BoolArray, FloatArray

_OPEN = 0.3  # of cells that rays go through: a way, though a leaf stands in the rest
_CLOSED = 0.7  # of cells that rays end at: a wall, or a leaf
_FLUSH_M = 0.02  # a leaf is set back from one side of its wall at least; plaster is not
_FLANK_M = 0.6  # of wall beside an opening


@dataclass(frozen=True, eq=False)
class Opening:
    """An opening in the common frame.

    Attributes
    ----------
    number : int
    kind : str
    line : Line
        From its first end on.
    width_m : float
    half_m : float
        Half of its wall's thickness.
    p_true : float
        How likely its own plan holds it.
    """

    number: int
    kind: str
    line: Line
    width_m: float
    half_m: float
    p_true: float = 1.0

    @property
    def ends_m(self) -> FloatArray:
        """(2, 2) float64."""
        return self.line.at(np.array([0.0, self.width_m]))

    @property
    def held(self) -> float:
        """How likely what becomes of it is of an opening.

        What its own plan holds for none may be beside furniture that was carried.
        """
        return 1.0 if self.p_true >= 1 / 2 else self.p_true


@dataclass(frozen=True)
class Views:
    """What one survey shows of an opening of the other: shares of its cells, and places.

    `is_looked_at` says whether both can be compared there at all.
    """

    is_looked_at: bool
    open_share: float = 0.0
    closed_share: float = 0.0
    n_passing: int = 0
    n_ending: int = 0

    @property
    def is_open(self) -> bool:
        """Whether rays go through."""
        return self.is_looked_at and self.open_share >= _OPEN

    @property
    def is_closed(self) -> bool:
        """Whether rays end there, all over it."""
        return self.is_looked_at and not self.is_open and self.closed_share >= _CLOSED


def look_through(opening: Opening, of: Survey, by: Survey) -> Views:
    """Return what rays of a survey do where those of the other went through an opening."""
    inner_m = (END_M, max(opening.width_m - END_M, END_M + ray_cells.CELL_M))
    own, other = (s.sight.look_at(opening.line, inner_m, opening.half_m) for s in (of, by))
    # of a window a planar scanner sees the wall below, or nothing
    if own.is_flat != other.is_flat and opening.kind not in WAYS:
        return Views(is_looked_at=False)
    is_way = (own.passes > 0) & (own.hits <= STRAY_SHARE * (own.hits + own.passes))
    if own.is_flat or other.is_flat:
        is_way = np.repeat(is_way.any(axis=1, keepdims=True), other.hits.shape[1], axis=1)
    hits = np.where(is_way, other.hits, 0).sum(axis=1)
    passes = np.where(is_way, other.passes, 0).sum(axis=1)
    is_closed = (hits >= FEW) & (passes <= STRAY_SHARE * (hits + passes))
    n_passing, n_ending = (
        len(np.unique(told[is_way[told[:, 0], told[:, 1]], 2]))
        for told in (other.passing, other.ending)
    )
    # what closes it in another plane may be lower than a way, or the wall below a window
    is_closed &= are_one_plane(own.plane, other.plane)
    shares = float(np.mean(passes > hits)), float(np.mean(is_closed))
    return Views(True, *shares, n_passing, n_ending)


def is_wall(closed: Opening, of: Survey, by: Survey) -> bool:
    """Return whether what closes an opening is flush with its wall wherever it was seen."""
    flush = find_flush_sides(closed, of, by)
    return len(flush) > 0 and bool(flush.all())


def find_flush_sides(opening: Opening, of: Survey, by: Survey) -> BoolArray:
    """Return of each side that was seen whether what closes an opening is flush with the wall.

    Beside the opening that counts which is wall to the survey that has the opening: no pane.
    """
    flush: list[bool] = []
    for sign in (1.0, -1.0):
        line = Line(opening.line.centre, sign * opening.line.normal)
        ends_m = np.sort(line.along_m(opening.ends_m))
        span_m = (float(ends_m[0]) - _FLANK_M, float(ends_m[1]) + _FLANK_M)
        reach_m = opening.half_m + _FLANK_M / 2
        off_m = by.sight.place_returns(line, span_m, reach_m)
        middle_m = span_m[0] + (np.arange(len(off_m)) + 0.5) * ray_cells.CELL_M
        is_inner = (middle_m > ends_m[0] + END_M) & (middle_m < ends_m[1] - END_M)
        is_flank = (middle_m < ends_m[0] - END_M) | (middle_m > ends_m[1] + END_M)
        is_flank &= of.sight.look_at(line, span_m, opening.half_m).solid.any(axis=1)
        inner_m, flank_m = (
            off_m[cells][np.isfinite(off_m[cells])] for cells in (is_inner, is_flank)
        )
        # each cell is the median of some returns: one tells where a leaf is, beside furniture
        if len(inner_m) and len(flank_m) >= FEW:
            flush.append(bool(abs(np.median(inner_m) - np.median(flank_m)) <= _FLUSH_M))
    return np.array(flush, bool)
