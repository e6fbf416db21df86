"""What of two surveys is drawn where: walls, openings and furniture as areas, by their verdicts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
import shapely.affinity
from shapely.geometry.base import BaseGeometry

from scanplan.changes.comparison import Comparison
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import MOVED, NOT_SEEN, Change
from scanplan.geometry import overlays

_ACROSS_M = 0.7  # from a wall's line: it holds all of its thickness
_LEAST_M = 0.05  # half of the thickness of an opening's or a thin wall's area, to be seen
_GRID_M = 1e-4  # of corners: a tenth of a millimetre


@dataclass(frozen=True)
class DrawnChange:
    """A change with what is drawn of it.

    Attributes
    ----------
    change : Change
    before, after : shapely geometry
        The area that it covered, and covers; empty where it did, or does, not.
    """

    change: Change
    before: BaseGeometry
    after: BaseGeometry


def list_drawn(compared: Comparison, tables: Sequence[str]) -> Iterator[DrawnChange]:
    """Yield what changed or swung, maybe or likely, and what was not seen, with areas.

    Of furniture, which is carried about, only what likely did.
    """
    for change in compared.changes:
        is_drawn = change.is_told or change.verdict == NOT_SEEN
        is_drawn |= change.is_doubtful and change.table != "furniture"
        if change.table in tables and is_drawn:
            survey = compared.a if change.number_a >= 0 else compared.b
            area = _cover(change, survey)
            is_of_a = change.number_a >= 0
            before = area if is_of_a else shapely.Polygon()
            after = shapely.Polygon() if is_of_a else area
            if change.verdict == MOVED and change.table != "opening":
                after = shapely.affinity.translate(area, *change.moved_m)
            elif change.verdict == MOVED:
                after = _cover_opening(change.number_b, compared.b)
            yield DrawnChange(change, before, after)


def draw_unchanged(compared: Comparison, drawn: Sequence[DrawnChange]) -> BaseGeometry:
    """Return the earlier survey's walls without openings, what has changed and what is not seen."""
    plan = compared.a.plan
    bodies = overlays.unite_areas(plan.bodies, grid=_GRID_M)
    taken = [*plan.gaps]
    for of in drawn:
        taken += [part for part in (of.before, of.after) if not part.is_empty]
    return overlays.subtract_areas(bodies, overlays.unite_areas(taken), grid=_GRID_M)


def _cover(change: Change, survey: Survey) -> BaseGeometry:
    """Return the area of a change: that of the wall's body beside its stretch."""
    number = change.number_a if change.number_a >= 0 else change.number_b
    if change.table == "wall":
        row = int(np.flatnonzero(survey.plan.walls["wall"] == number)[0])
        beside = overlays.buffer_shapes(change.shape, _ACROSS_M, cap_style="flat")
        body = overlays.intersect_areas(survey.place(survey.plan.bodies[row]), beside)
        return body if not body.is_empty else _widen(change.shape, _LEAST_M)
    if change.table == "opening":
        return _cover_opening(number, survey)
    return change.shape


def _cover_opening(number: int, survey: Survey) -> BaseGeometry:
    row = int(np.flatnonzero(survey.plan.openings["opening"] == number)[0])
    return survey.place(survey.plan.gaps[row])


def _widen(line: BaseGeometry, half_m: float) -> BaseGeometry:
    return overlays.buffer_shapes(line, half_m, cap_style="flat")
