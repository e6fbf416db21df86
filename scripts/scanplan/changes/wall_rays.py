"""What rays of another survey show of stretches of wall that it has not drawn."""

import math
from dataclasses import dataclass, replace

import numpy as np

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.ray_cells import AT_M, CELL_M, Later
from scanplan.changes.scan_plane import are_one_plane
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import CHANGED, GONE, LIKELY, NOT_SEEN, Change
from scanplan.changes.wall_cells import Wall
from scanplan.geometry.lines import Line
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray

MATCHED, IN_OPENING, PASSED, LOWERED, HIT, UNKNOWN, BEHIND = range(7)
"""What another survey shows of a cell of a wall; `BEHIND` of a stretch that rays end behind."""
_LOWERED = CHANGED / 5  # of walls: the upper part went, as for a hatch
_STANDS = 0.1  # of where a wall went: something else stands there


@dataclass(frozen=True, eq=False)
class Stretch:
    """Cells of a wall that another survey shows alike.

    Attributes
    ----------
    wall : Wall
    cells : slice
    kind : int
        What that shows: `PASSED` and so on.
    weight : float
        How many times as likely that is if it has changed.
    """

    wall: Wall
    cells: slice
    kind: int
    weight: float = 1.0


def weigh_rays(
    of: Stretch,
    surveys: tuple[Survey, Survey],
    later: Later,
    sigma_m: float,
    moved_m: float = math.nan,
) -> Stretch:
    """Return a stretch of a wall of the first survey with what rays of the second show of it.

    Parameters
    ----------
    later : Later
        What the second shows of the cells of the wall.
    sigma_m : float
        What faces of both surveys err by.
    moved_m : float
        How far the rest of the wall has moved to its left; NaN where it has not.
    """
    is_of_it = np.zeros(of.wall.n_cells, bool)
    is_of_it[of.cells] = True
    if of.kind == LOWERED:
        n_over = len(np.unique(later.over[is_of_it[later.over[:, 0]], 2]))
        over = verdicts.weigh_passing(n_over, 0)
        # either has gone with all that was over it: the wall, or its upper part
        lower = _LOWERED * over / (1 - CHANGED) + 1
        return replace(of, weight=over * _weigh_returns(of, surveys[1], sigma_m) / lower)
    n_passing, n_ending = later.count_places(is_of_it)
    if of.kind != PASSED and _lies_behind(of, surveys):
        # they went through its face, all of them
        return replace(of, kind=BEHIND, weight=verdicts.weigh_passing(n_passing + n_ending, 0))
    weight = verdicts.weigh_passing(n_passing, n_ending)
    if of.kind == HIT:
        stands = _weigh_returns(of, surveys[1], sigma_m)
        along = _weigh_moved(of, surveys[1], sigma_m, moved_m)
        weight = max(weight, min(_STANDS * stands, 1.0), along * stands)
    return replace(of, weight=1.0 if of.kind == UNKNOWN else weight)


def tell_rays(of: Stretch, p: float, p_wall: float) -> Change:
    """Return what became of a stretch by how likely it has changed, and is a wall if it has."""
    shape = of.wall.draw(of.cells)
    if of.kind == UNKNOWN:
        return Change("wall", of.wall.number, -1, NOT_SEEN, math.nan, shape)
    # rays tell that it is gone, its plan whether it is a wall
    doubt = doubt_kind(p, p_wall) if p > 1 / 2 and p * p_wall < LIKELY else ""
    if of.kind == LOWERED and p < LIKELY:
        doubt = "what stands there now is lower"
    gone = Change("wall", of.wall.number, -1, GONE, p * p_wall, shape, doubt=doubt)
    return replace(gone, p_furniture=p * (1 - p_wall))


def doubt_kind(p: float, p_wall: float) -> str:
    """Return in words how likely it is a wall that has changed, and how likely furniture."""
    return f"wall {p * p_wall:.2f}, furniture {p * (1 - p_wall):.2f}"


def _weigh_returns(of: Stretch, survey: Survey, sigma_m: float) -> float:
    """Return how many times as likely what stands there now lies so if it is no part of the wall.

    Returns of what is left of a wall lie on its faces, those of furniture anywhere.
    """
    off_m = [np.abs(of_side[np.isfinite(of_side)]) for of_side in _place_returns(of, survey)]
    off_m = [of_side for of_side in off_m if len(of_side) >= FEW]
    if not off_m:
        return 1.0
    return verdicts.weigh_shift(float(np.median(np.concatenate(off_m))), sigma_m, len(off_m))


def _weigh_moved(of: Stretch, survey: Survey, sigma_m: float, moved_m: float) -> float:
    """Return how many times as likely it lies so if it has moved as the rest has, and not anywhere.

    0 where the rest has not.
    """
    left_m, right_m = (of_side[np.isfinite(of_side)] for of_side in _place_returns(of, survey))
    off_m = np.concatenate([left_m, -right_m])
    if math.isnan(moved_m) or len(off_m) < FEW:
        return 0.0
    return verdicts.weigh_along(float(np.median(off_m)) - moved_m, sigma_m)


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
