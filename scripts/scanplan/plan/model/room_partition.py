"""Which cells of ground are one room: two are joined while that makes all of it likelier.

Agglomeration of a graph of regions by what was learned of its merges (Nunez-Iglesias, Kennedy,
Parag, Shi and Chklovskii 2013, Machine learning of hierarchical clustering to segment 2D and 3D
images, PLoS ONE 8 (8)): n log n in the borders of cells.
"""

import heapq
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

import numpy as np
from shapely.geometry import Polygon

from scanplan.geometry import overlays
from scanplan.geometry.ground_cells import GroundCells
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.model.parting_odds import LEAST_M2, weigh_room
from scanplan.plan.tolerances import CORNER_M
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_Known = TypeVar("_Known")


@dataclass(frozen=True, eq=False)
class Region:
    """Cells that are one room, as far as is known.

    Attributes
    ----------
    cells : sequence of Polygon
    area_m2 : float
        Of all its cells.
    is_visited : bool
        Whether the sensor was in one.
    """

    cells: tuple[Polygon, ...]
    area_m2: float
    is_visited: bool

    @cached_property
    def is_wide(self) -> bool:
        """Whether somebody could stand in it anywhere."""
        grown = overlays.buffer_shapes(self.cells, 2 * SHORTEST_M, join_style="mitre")
        inner = overlays.buffer_shapes(overlays.unite_areas(grown), -CORNER_M, quad_segs=8)
        return not inner.is_empty

    @cached_property
    def log_likely(self) -> float:
        """How likely it is a room."""
        is_large = self.area_m2 >= LEAST_M2[self.is_visited]
        return weigh_room(
            self.area_m2, is_visited=self.is_visited, is_one=is_large and self.is_wide
        )

    def join(self, other: "Region") -> "Region":
        """Return the region of the cells of both."""
        joined = Region(
            (*self.cells, *other.cells),
            self.area_m2 + other.area_m2,
            self.is_visited or other.is_visited,
        )
        if any(vars(region).get("is_wide") for region in (self, other)):
            vars(joined)["is_wide"] = True
        return joined


class RegionGraph(Generic[_Known]):
    """Regions by the number of their first cell, and what is known of borders between them.

    Parameters
    ----------
    ground : ground_cells.GroundCells
    of_lines : (l, ...) float64
        What is known of each line: between regions it adds up by the share of it that lies there.
    is_visited : (c,) bool
        Whether the sensor was in each cell.
    """

    def __init__(self, ground: GroundCells, of_lines: Array, is_visited: BoolArray) -> None:
        self.regions = {
            row: Region((cell,), cell.area, bool(was_there))
            for row, (cell, was_there) in enumerate(zip(ground.cells, is_visited, strict=True))
        }
        self.borders: dict[int, dict[int, _Known]] = {row: {} for row in self.regions}
        for pair, line, share in zip(*ground.list_borders(), strict=True):
            one, other = pair.tolist()
            self._add(one, other, share * of_lines[line])

    def list_pairs(self) -> list[tuple[int, int]]:
        """Return the regions beside one another, lesser first."""
        return [(one, other) for one, to in self.borders.items() for other in to if one < other]

    def join(self, one: int, other: int) -> None:
        """Join a region to one."""
        self.regions[one] = self.regions[one].join(self.regions.pop(other))
        for third, known in self.borders.pop(other).items():
            del self.borders[third][other]
            if third != one:
                self._add(one, third, known)

    def _add(self, one: int, other: int, known: Any) -> None:
        before = self.borders[one].get(other)
        both = known if before is None else before + known
        self.borders[one][other] = self.borders[other][one] = both


@dataclass(frozen=True, eq=False)
class JoinedCells:
    """Which cells are one room, and how much likelier that is than the next.

    Attributes
    ----------
    room : (c,) int64
        The first cell of each one's room.
    whole, apart : (c,) float64
        Log odds that no part of its room as large as one is another, and that no room beside it is
        one with it; inf where there is none.
    """

    room: IntArray
    whole: FloatArray
    apart: FloatArray


def join_cells(ground: GroundCells, log_odds: FloatArray, is_visited: BoolArray) -> JoinedCells:
    """Join the cells that are one room.

    Parameters
    ----------
    ground : ground_cells.GroundCells
    log_odds : (l,) float64
        That a line parts rooms, see `parting_odds.weigh_lines`.
    is_visited : (c,) bool
        Whether the sensor was in each cell.

    Returns
    -------
    JoinedCells
    """
    graph: RegionGraph[float] = RegionGraph(ground, log_odds, is_visited)
    regions, room = graph.regions, np.arange(len(ground.cells))
    joins = dict.fromkeys(regions, 0)
    whole, apart = (np.full(len(room), np.inf) for _ in range(2))

    def weigh(one: int, other: int) -> tuple[float, int, int, int, int]:
        """How much likelier two regions are apart, and how often each was joined to."""
        apart = regions[one].log_likely + regions[other].log_likely + graph.borders[one][other]
        together = regions[one].join(regions[other]).log_likely
        return float(apart - together), one, other, joins[one], joins[other]

    queue = [weigh(*pair) for pair in graph.list_pairs()]
    heapq.heapify(queue)
    while queue:
        odds, one, other, *at = heapq.heappop(queue)
        if one not in regions or other not in regions or at != [joins[one], joins[other]]:
            continue
        if odds >= 0:
            apart[[one, other]] = np.minimum(apart[[one, other]], odds)
            continue
        is_room = min(regions[one].area_m2, regions[other].area_m2) >= LEAST_M2[False]
        whole[one] = min(whole[one], whole[other], -odds if is_room else np.inf)
        graph.join(one, other)
        room[room == other] = one
        joins[one] += 1
        for third in graph.borders[one]:
            heapq.heappush(queue, weigh(*sorted((one, third))))
    return JoinedCells(room, whole[room], apart[room])
