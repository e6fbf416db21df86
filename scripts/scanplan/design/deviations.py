"""How what was built differs from its design, element by element, held against tolerances."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.comparison import Comparison
from scanplan.changes.verdicts import ALTERED, GONE, LIKELY, MOVED, NEW, NOT_SEEN, Change
from scanplan.design.drawn_storey import DrawnStorey
from scanplan.design.tolerances import Tolerances, rate_within
from scanplan.geometry import overlays
from scanplan.plan.floorplan import FloorPlan

WITHIN, DEVIATES, UNDECIDED = "within", "deviates", "undecided"
MISSING, ADDITIONAL, OTHER_KIND = "missing", "additional", "kind_differs"
VERDICTS = (WITHIN, DEVIATES, OTHER_KIND, MISSING, ADDITIONAL, UNDECIDED, NOT_SEEN)
"""What may be told of an element of a design, or of one that it lacks."""
FAULTS = (DEVIATES, OTHER_KIND, MISSING, ADDITIONAL)
"""What somebody has to look into."""
_FARTHEST_M = 30.0  # across a room: no limit grows beyond
_BESIDE_M = 0.05  # from a wall's surface: what stands nearer is a lining of it


@dataclass(frozen=True)
class Deviation:
    """What is told of an element.

    Attributes
    ----------
    change : Change
        What became of it since it was designed, in the design's frame: where, by how much.
    guid, name : str
        As the design states them; empty of what it lacks.
    verdict : str
        Of `VERDICTS`.
    p : float
        How likely that is; NaN of what is undecided or was not seen.
    limit_m : float
        The tolerance; NaN where none applies.
    built_m2 : float
        Area of a room as built; NaN of others.
    doubt : str
        What else it may be.
    """

    change: Change
    guid: str
    name: str
    verdict: str
    p: float
    limit_m: float
    built_m2: float
    doubt: str

    @property
    def is_fault(self) -> bool:
        """Whether it is told to differ from the design, and likely does."""
        return self.verdict in FAULTS and self.p >= LIKELY


def rate_deviations(
    compared: Comparison, storey: DrawnStorey, tolerances: Tolerances
) -> list[Deviation]:
    """Return what is told of each element of a design, and of what it lacks.

    Parameters
    ----------
    compared : Comparison
        Of the design, a, with the survey, b.
    storey : DrawnStorey
        What the design was made of.
    """
    return list(_rate_all(compared, storey, tolerances))


def _rate_all(
    compared: Comparison, storey: DrawnStorey, tolerances: Tolerances
) -> Iterator[Deviation]:
    named = {
        "wall": storey.walls,
        "opening": storey.openings,
        "room": storey.spaces,
        "column": storey.columns,
    }
    clear = _Clearances(storey)
    for change in compared.changes:
        # what lies beyond the design was not looked for in it
        if change.number_a < 0 and change.verdict != NEW:
            continue
        of = named[change.table][change.number_a] if change.number_a >= 0 else None
        guid, name = (of.guid, of.name) if of is not None else ("", "")
        nominal_m = clear.measure(change)
        limit_m = math.nan
        if change.table in tolerances.limits_m and of is not None:
            limit_m = tolerances.limit_m(change.table, nominal_m)
        verdict, p, doubt = _judge(change, compared.b.plan, limit_m)
        built_m2 = _built_m2(change, compared.b.plan)
        yield Deviation(change, guid, name, verdict, p, limit_m, built_m2, doubt)


def _judge(change: Change, built: FloorPlan, limit_m: float) -> tuple[str, float, str]:
    """Return verdict, probability and doubt."""
    if change.verdict in (GONE, NEW):
        return {GONE: MISSING, NEW: ADDITIONAL}[change.verdict], change.p, change.doubt
    if change.verdict == NOT_SEEN:
        return NOT_SEEN, math.nan, change.doubt
    if change.number_b >= 0 and change.doubt and change.table == "opening":
        row = int(np.flatnonzero(built.openings["opening"] == change.number_b)[0])
        return OTHER_KIND, float(built.openings["p_kind"][row]), change.doubt
    if change.table == "room":
        verdict = DEVIATES if change.verdict == ALTERED else WITHIN
        return (UNDECIDED, math.nan, change.doubt) if change.doubt else (verdict, change.p, "")
    if not math.isfinite(change.shift_m):
        return UNDECIDED, math.nan, change.doubt or "seen to stand there, but not measured"
    p_within = rate_within(change.shift_m, change.sigma_m, limit_m)
    if p_within >= LIKELY:
        return WITHIN, p_within, change.doubt
    # it has moved if returns or rays say so, too
    p_deviates = (1 - p_within) * change.p
    if change.verdict == MOVED and p_deviates >= LIKELY:
        return DEVIATES, p_deviates, change.doubt
    return UNDECIDED, math.nan, change.doubt or "measured too coarsely to tell"


def _built_m2(change: Change, built: FloorPlan) -> float:
    if change.table != "room" or change.number_b < 0:
        return math.nan
    row = int(np.flatnonzero(built.rooms["room"] == change.number_b)[0])
    return float(built.rooms["area_m2"][row])


class _Clearances:
    """The nominal sizes of elements: what lies between a wall and the next, an opening's width."""

    def __init__(self, storey: DrawnStorey) -> None:
        self._walls = storey.walls
        grounds: Sequence[BaseGeometry] = [
            *(wall.solid.ground for wall in storey.walls),
            *(column.solid.ground for column in storey.columns),
            *(solid.ground for solid in storey.others),
        ]
        self._grounds = np.array(grounds, object)
        self._tree = shapely.STRtree(self._grounds)

    def measure(self, change: Change) -> float:
        """Return the nominal size of what a change is of."""
        if change.table == "opening":
            return change.shape.length
        if change.table != "wall" or change.number_a < 0:
            return self._to_next(change.shape)
        wall = self._walls[change.number_a]
        return min(self._across(change.shape, wall.solid.ground, turn) for turn in (1, -1))

    def _across(self, shape: BaseGeometry, own: BaseGeometry, turn: int) -> float:
        """Return how far the next wall stands off the middle of a line, to one side."""
        ends_m = shapely.get_coordinates(shape)[[0, -1]]
        along = (ends_m[1] - ends_m[0]) / np.hypot(*(ends_m[1] - ends_m[0]))
        normal = turn * np.array([-along[1], along[0]])
        middle_m = ends_m.mean(axis=0)
        feeler = shapely.LineString([middle_m, middle_m + _FARTHEST_M * normal])
        beyond = overlays.subtract_lines(feeler, overlays.buffer_shapes(own, _BESIDE_M))
        met = self._grounds[self._tree.query(beyond, predicate="intersects")]
        begin = shapely.Point(shapely.get_coordinates(beyond)[0])
        far_m = [begin.distance(overlays.intersect_lines(beyond, of)) for of in met]
        # a lining that touches it is passed by
        return min((m + _BESIDE_M for m in far_m if m > 0), default=_FARTHEST_M)

    def _to_next(self, shape: BaseGeometry) -> float:
        others = [of for of in self._grounds if not of.intersects(shape)]
        return min((of.distance(shape) for of in others), default=_FARTHEST_M)
