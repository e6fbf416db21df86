"""What rays of another survey show of stretches of wall that it has not drawn."""

import math
from dataclasses import dataclass, replace

import numpy as np

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.ray_cells import AT_M, CELL_M, Later
from scanplan.changes.scan_plane import are_one_plane
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import CHANGED, GONE, LIKELY, NOT_SEEN, SAME, Change
from scanplan.changes.wall_cells import Wall
from scanplan.geometry.lines import Line
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray

MATCHED, IN_OPENING, PASSED, LOWERED, HIT, UNKNOWN, BEHIND = range(7)
"""What another survey shows of a cell of a wall; `BEHIND` of a stretch that rays end behind."""
_REMOVED = 0.5  # of walls that rays go over now: of others the upper part went, as for a hatch
_REST = 1 - CHANGED  # likewise where more of the wall is gone: parts of a wall rarely stay, either


@dataclass(frozen=True, eq=False)
class Stretch:
    """Cells of a wall that another survey shows alike.

    Attributes
    ----------
    wall : Wall
    cells : slice
    kind : int
        What that shows: `PASSED` and so on.
    p_wall : float
        How likely it is a wall, if it has changed.
    is_rest : bool
        Whether more of the wall than this is gone.
    """

    wall: Wall
    cells: slice
    kind: int
    p_wall: float
    is_rest: bool


def judge_rays(of: Stretch, surveys: tuple[Survey, Survey], later: Later, sigma_m: float) -> Change:
    """Return what became of a stretch of a wall of the first survey by rays of the second.

    Parameters
    ----------
    later : Later
        What the second shows of the cells of the wall.
    sigma_m : float
        What faces of both surveys err by.
    """
    is_of_it = np.zeros(of.wall.n_cells, bool)
    is_of_it[of.cells] = True
    if of.kind == LOWERED:
        n_over = len(np.unique(later.over[is_of_it[later.over[:, 0]], 2]))
        p = verdicts.rate_places(n_over, 0) * _rate_removed(of, surveys[1], sigma_m)
        return _tell_gone(of, p, "what stands there now is lower")
    kind = of.kind
    n_passing, n_ending = later.count_places(is_of_it)
    if kind != PASSED and _lies_behind(of, surveys):
        # they went through its face, all of them
        kind, n_passing, n_ending = BEHIND, n_passing + n_ending, 0
    p = verdicts.rate_places(n_passing, n_ending)
    if kind in (PASSED, BEHIND, MATCHED) and p > 0.5:
        return _tell_gone(of, p)
    same = Change("wall", of.wall.number, -1, SAME, 1 - p, of.wall.draw(of.cells))
    return same if kind in (HIT, BEHIND) else replace(same, verdict=NOT_SEEN, p=math.nan)


def _tell_gone(of: Stretch, p: float, doubt: str = "") -> Change:
    """Return that a stretch is gone: rays tell that, its plan whether it is a wall."""
    p_wall = p * of.p_wall
    if p >= LIKELY or not doubt:
        doubt = "" if p_wall >= LIKELY else doubt_kind(p, of.p_wall)
    gone = Change("wall", of.wall.number, -1, GONE, p_wall, of.wall.draw(of.cells), doubt=doubt)
    return replace(gone, p_furniture=p - p_wall)


def doubt_kind(p: float, p_wall: float) -> str:
    """Return in words how likely it is a wall that has changed, and how likely furniture."""
    return f"wall {p * p_wall:.2f}, furniture {p * (1 - p_wall):.2f}"


def _rate_removed(of: Stretch, survey: Survey, sigma_m: float) -> float:
    """Return how likely what stands lower now is no part of the wall.

    Returns of what is left of a wall lie on its faces, those of furniture anywhere.
    """
    off_m = [np.abs(of_side[np.isfinite(of_side)]) for of_side in _place_returns(of, survey)]
    off_m = [of_side for of_side in off_m if len(of_side) >= FEW]
    usual = _REST if of.is_rest else _REMOVED
    if not off_m:
        return usual
    apart_m = float(np.median(np.concatenate(off_m)))
    return verdicts.rate_shift(apart_m, sigma_m, len(off_m), usual=usual)


def _lies_behind(of: Stretch, surveys: tuple[Survey, Survey]) -> bool:
    """Return whether what rays of a second survey end at is not what those of the first ended at.

    From where both look it lies farther behind than poses, ranges and two maps err by.
    """
    if not are_one_plane(*(s.sight.plane for s in surveys)):
        return False
    first_m, second_m = (np.concatenate(_place_returns(of, survey)) for survey in surveys)
    # what the first ended at beside its faces was not the wall either
    first_m = np.where(np.abs(first_m) <= AT_M, first_m, np.nan)
    return ray_cells.measure_shift(first_m, second_m) < -AT_M


def _place_returns(of: Stretch, survey: Survey) -> list[FloatArray]:
    """Return how far returns lie before either face, (c, r) each; see `ray_cells`."""
    wall, cells = of.wall, of.cells
    found = []
    for side in (1, -1):
        normal = side * wall.line.normal
        face = Line(wall.line.centre + wall.half_m * normal, normal)
        span_m = sorted((side * cells.start * CELL_M, side * cells.stop * CELL_M))
        reach_m = 2 * (wall.half_m + AT_M)
        found.append(survey.sight.place_returns(face, (span_m[0], span_m[1]), reach_m))
    return found
