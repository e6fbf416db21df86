"""Where a sensor may stand, and the fewest places from which questions are settled."""

from collections.abc import Sequence

import numpy as np
import shapely

from scanplan.geometry import overlays, roadmap
from scanplan.geometry.roadmap import RoadmapGrid
from scanplan.plan.floorplan import WAYS, FloorPlan
from scanplan.rays.tolerances import STRAY_SHARE
from scanplan.selection import lazy_greedy
from scanplan.types import FloatArray, IntArray
from scanplan.visit.questions import Pieces


def find_ground(plan: FloorPlan, track_m: FloatArray, clearance_m: float) -> RoadmapGrid:
    """Return the free floor that can be reached from where the survey began, as a grid.

    Parameters
    ----------
    track_m : (n, 2) float64, n >= 1
        Where scans were taken, in the order of time, map frame.
    clearance_m : float
        What the sensor keeps from walls, furniture and floor that was not seen.
    """
    cell_m = 0.1  # doors leave a lane of two cells beside the clearance
    floor = overlays.unite_areas(shapely.from_wkb(np.asarray(plan.free["geometry"], object)))
    is_way = np.isin(plan.openings["type"].astype(str), WAYS)
    walls = overlays.subtract_areas(
        overlays.unite_areas(plan.bodies), overlays.unite_areas(plan.gaps[is_way])
    )
    free = overlays.buffer_shapes(overlays.subtract_areas(floor, walls), -clearance_m)
    driven = overlays.unite_areas(
        overlays.buffer_shapes(shapely.points(track_m), clearance_m, quad_segs=8)
    )
    grid = roadmap.make_grid(overlays.unite_each(free, driven), clearance_m, cell_m)
    return roadmap.connected_grid(grid, track_m[0]) if len(grid.xy_m) else grid


def spread_cells(grid: RoadmapGrid, spacing_m: float) -> IntArray:
    """Return one cell of a grid for each square of an edge, those with most space around first."""
    square = np.floor(grid.xy_m / spacing_m).astype(np.int64)
    roomiest = np.lexsort((*grid.xy_m.T, -np.round(grid.near_m, 3)))
    _, first = np.unique(square[roomiest], axis=0, return_index=True)
    return np.asarray(roomiest[np.sort(first)], np.int64)


class SettledQuestions(lazy_greedy.SingleGains):
    """How many questions are seen, parts of them added up.

    Parameters
    ----------
    pieces_of_view : sequence of n (k,) int64
        Which pieces each view sees, increasing.
    """

    def __init__(self, pieces_of_view: Sequence[IntArray], pieces: Pieces) -> None:
        self._pieces_of_view, self._pieces = pieces_of_view, pieces
        self._known = np.zeros(len(pieces.share), bool)
        super().__init__(len(pieces_of_view))

    def measure_gain(self, i: int) -> float:
        """Return how many questions more a view would show, parts of them added up."""
        of_view = self._pieces_of_view[i]
        return float(self._pieces.share[of_view[~self._known[of_view]]].sum())

    def cover(self, i: int) -> None:
        """See what a view sees."""
        self._known[self._pieces_of_view[i]] = True


def choose_views(pieces_of_view: Sequence[IntArray], pieces: Pieces) -> list[int]:
    """Choose the fewest views, greedily, until none shows more than a stray part of a question.

    Of views that show about as much the first is taken.

    Parameters
    ----------
    pieces_of_view : sequence of n (k,) int64
        Which pieces each view sees, increasing.
    """
    if not any(map(len, pieces_of_view)):
        return []
    chosen = lazy_greedy.choose_greedily(SettledQuestions(pieces_of_view, pieces), tie=STRAY_SHARE)
    return [view for view, gain in chosen if gain > STRAY_SHARE]
