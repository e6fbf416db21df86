"""What each of several surveys shows of a plan of all, and how likely the rest still stands."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.ray_cells import line_between
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import CHANGED, SAME, Change
from scanplan.changes.wall_cells import list_walls
from scanplan.geometry import overlays
from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.rays.tolerances import STRAY_SHARE
from scanplan.types import BoolArray, FloatArray

_SEEN = 0.5  # of what the one that saw most saw of an element: one that saw less did not look at it
_PRIOR = 1 / CHANGED  # elements that `CHANGED` is worth: one change among so many
_NS_PER_DAY = 86_400 * 10**9


@dataclass(frozen=True)
class Contribution:
    """What surveys show of an element.

    Attributes
    ----------
    table : str
        wall, opening or room.
    number : int
        In the plan of all.
    shape : shapely geometry
    shares : tuple of float
        Which part of it each survey saw, the earliest first.
    seen_by : tuple of int
        The surveys that saw it.
    age_days : float
        From then to the latest survey.
    p_stands : float
        How likely it is still as it was then: 1 of what the latest survey saw.
    """

    table: str
    number: int
    shape: BaseGeometry
    shares: tuple[float, ...]
    seen_by: tuple[int, ...]
    age_days: float
    p_stands: float

    @property
    def is_alone(self) -> bool:
        """Whether one survey alone saw it."""
        return len(self.seen_by) == 1

    @property
    def last(self) -> int:
        """The latest survey that saw it."""
        return self.seen_by[-1]

    @property
    def is_stale(self) -> bool:
        """Whether the latest survey did not see it."""
        return self.last < len(self.shares) - 1


def rate_contributions(
    plan: FloorPlan,
    surveys: Sequence[Survey],
    ended_ns: Sequence[int],
    changes: Sequence[Sequence[Change]],
) -> list[Contribution]:
    """Return what surveys show of the walls, openings and rooms of a plan of all.

    What a later survey did not look at is as likely to have changed since as what it did look at.

    Parameters
    ----------
    plan : FloorPlan
        In the common frame.
    surveys : sequence of Survey
        Without rays that later ones have overtaken, the earliest first.
    ended_ns : sequence of int
        When each ended.
    changes : sequence of sequence of Change
        What became of elements from each to the next.
    """
    stay = [{table: 1 - _share_changed(table, of) for table in _TABLES} for of in changes]
    found = []
    for table, list_shares in _TABLES.items():
        for number, shape, shares in list_shares(plan, surveys):
            least = _SEEN * max(shares)
            seen_by = tuple(row for row, share in enumerate(shares) if share >= least)
            age_days = max(ended_ns[-1] - ended_ns[seen_by[-1]], 0) / _NS_PER_DAY
            p_stands = math.prod(of[table] for of in stay[seen_by[-1] :])
            shown = Contribution(table, number, shape, tuple(shares), seen_by, age_days, p_stands)
            found.append(shown)
    return found


def _share_changed(table: str, changes: Sequence[Change]) -> float:
    """Return which share of the elements that two surveys looked at has changed.

    >>> _share_changed("wall", [])
    0.05
    """
    of_table = [change for change in changes if change.table == table]
    n_changed = sum(change.is_change for change in of_table)
    n_same = sum(change.verdict == SAME for change in of_table)
    return (CHANGED * _PRIOR + n_changed) / (_PRIOR + n_changed + n_same)


_Shares = Iterator[tuple[int, BaseGeometry, list[float]]]


def _share_walls(plan: FloorPlan, surveys: Sequence[Survey]) -> _Shares:
    """Yield which part of the length of each wall rays of each survey end at."""
    answered: dict[int, list[BoolArray]] = {}
    for wall in list_walls(Survey(plan, surveys[0].sight, surveys[0].motion)):
        looks = [s.sight.look_at(wall.line, wall.span_m, wall.half_m) for s in surveys]
        ends = [(of.hits > 0) & (of.passes <= STRAY_SHARE * (of.hits + of.passes)) for of in looks]
        answered.setdefault(wall.number, []).append(np.stack([of.any(axis=1) for of in ends]))
    for number, axis in zip(plan.walls["wall"].tolist(), plan.axes, strict=True):
        shares = np.concatenate(answered[number], axis=1).mean(axis=1)
        yield number, axis, shares.tolist()


def _share_openings(plan: FloorPlan, surveys: Sequence[Survey]) -> _Shares:
    """Yield which part of the width of each opening in a wall each survey looked at."""
    lines_m = centrelines_m(plan.openings)
    for row in np.flatnonzero((plan.hosts >= 0) & (line_lengths_m(lines_m) > 0)).tolist():
        line, width_m = line_between(lines_m[row])
        half_m = float(plan.openings["thickness_m"][row]) / 2
        half_m = half_m if math.isfinite(half_m) else 0.0
        looks = [s.sight.look_at(line, (0.0, width_m), half_m) for s in surveys]
        shares = [float((of.hits + of.passes).any(axis=1).mean()) for of in looks]
        yield int(plan.openings["opening"][row]), shapely.LineString(lines_m[row]), shares


def _share_rooms(plan: FloorPlan, surveys: Sequence[Survey]) -> _Shares:
    """Yield over which part of the floor of each room rays of each survey went."""
    for number, area in zip(plan.rooms["room"].tolist(), plan.areas, strict=True):
        yield (
            number,
            area,
            [overlays.intersect_areas(area, s.free).area / area.area for s in surveys],
        )


_TABLES = {"wall": _share_walls, "opening": _share_openings, "room": _share_rooms}


def sum_lengths_m(found: Sequence[Contribution]) -> FloatArray:
    """Return how many metres of wall each survey saw that no other did, and all together last.

    Returns
    -------
    (n + 1,) float64
    """
    walls = [of for of in found if of.table == "wall"]
    n_surveys = len(walls[0].shares) if walls else 0
    sums_m = np.zeros(n_surveys + 1)
    for wall in walls:
        sums_m[wall.last if wall.is_alone else -1] += wall.shape.length
    return sums_m
