"""How likely a line across free floor parts rooms, and how likely ground is a room.

Weights are of a logistic regression on merges of cells (`room_partition`) against the true rooms
of the tuning half's planar floors (`tests/benchmarks/fit_partings.py`): those in space have few
rooms that no wall parts, and are unlike public maps in what their robots drive through. They were
fitted when more racks were drawn as walls; those of plans since part the same floors no better.
"""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray

WEIGHTS = (-3.59, 0.41, 0.09, 1.25, -3.95, 0.96, 4.53, 1.89, 1.38, 3.33)
"""Of what `LineMeasures.list_terms` lists."""
AREA, UNVISITED = 0.6, -1.43
"""What the log density of a room's area counts, and that nobody was in it. By merges, which are of
small cells mostly, the area would count 0.05, by itself 1: with 0.6 rooms of the tuning half are
about as right, and a quarter fewer pieces are none."""
LEAST_ODDS = -3.0
"""Log odds of a line that is looked at: of a hundred less likely ones five part anything."""
_AREA_M2 = (16.4, 0.85)
"""Of a room: the median, and the deviation of the logarithm, of the tuning half's 400 rooms; of
170 rooms of public maps they are 18 m2 and 0.84."""
LEAST_M2 = {True: 1.0, False: 3.0}
"""Of a room that was visited, or not: what furniture stands on, or hides, is none."""
_NONE = -30.0
"""Log odds of less."""
_RATIO = (0.3, 4.0)
"""Between which ground beside a line is so much wider or deeper: more says no more."""
HIDDEN_SHARE = 0.5
"""Of a line, that furniture hides: of more it is not known what is there."""
_STUB_M = 0.25
"""A wall at a line's end is longer."""


@dataclass(frozen=True, eq=False)
class LineMeasures:
    """What is weighed of lines across free floor, lesser first of either side or end.

    Attributes
    ----------
    length_m : (l,) float64
    beside : (l, 2) float64
        How many times as wide as it floor is on either side, along it.
    deep : (l, 2) float64
        Likewise as wide and as deep.
    on_m : (l, 2) float64
        How long a wall is that goes on in its line, at either end.
    hidden : (l,) float64
        What share of it furniture hides.
    """

    length_m: FloatArray
    beside: FloatArray
    deep: FloatArray
    on_m: FloatArray
    hidden: FloatArray

    def list_terms(self) -> FloatArray:
        """Return what is weighed (l, 10)."""
        wider = np.log(np.clip(self.beside, 1, [_RATIO[1], 1.5 * _RATIO[1]]))
        deeper = np.log(np.clip(self.deep, *_RATIO))
        on = np.minimum(self.on_m / self.length_m[:, None], 1.5)
        is_on = self.on_m.min(axis=1, keepdims=True) > _STUB_M
        is_hidden = self.hidden[:, None] > HIDDEN_SHARE
        one = np.ones((len(on), 1))
        length = np.log(self.length_m)[:, None]
        return np.concatenate(
            [one, length, wider, on, is_on.astype(float), deeper, is_hidden.astype(float)], axis=1
        )


def weigh_lines(measures: LineMeasures) -> FloatArray:
    """Return the log odds (l,) that lines part rooms, and do not lie in one."""
    return measures.list_terms() @ np.array(WEIGHTS)


def list_room_terms(area_m2: float, *, is_visited: bool) -> tuple[float, float]:
    """Return the log density of a room's area, and whether nobody was in it."""
    median_m2, sigma = _AREA_M2
    off = math.log(area_m2 / median_m2) / sigma
    return -(off**2) / 2 - math.log(sigma * math.sqrt(2 * math.pi)), float(not is_visited)


def weigh_room(area_m2: float, *, is_visited: bool, is_one: bool) -> float:
    """Return how likely ground is a room, log; `is_one` says that somebody can stand in it."""
    of_area, unvisited = list_room_terms(area_m2, is_visited=is_visited)
    return AREA * of_area + UNVISITED * unvisited + (0.0 if is_one else _NONE)
