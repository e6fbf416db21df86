"""Ground that lines part, and which of them are left out as they part off too little."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.overlay_steps import Answer, Shapes
from scanplan.geometry.tolerances import SAME_M, SHORTEST_M, SMALLEST_M2
from scanplan.types import Array, BoolArray, FloatArray

FURNITURE_M2 = 3.0  # that furniture stands on, or parts off between it and a wall, at most


def part_enough(
    ground: BaseGeometry,
    lines: Sequence[FloatArray],
    visits_m: FloatArray,
    min_area_m2: float,
    *,
    sliver_m: float,
) -> list[FloatArray]:
    """Return the lines that, all together, part ground into large enough parts.

    A part that is too small goes with one beside it: if nobody was in it, first with another that
    nobody was in. Parts narrower than twice a sliver count for nothing.

    Parameters
    ----------
    lines : sequence of (2, 2) float64
        Across it.
    visits_m : (n, 2) float64
        Places that were visited.
    min_area_m2 : float, >= 0
        No less lies on a visited side, nor less than furniture parts off on another.
    sliver_m : float, > 0
    """
    if not lines:
        return []
    parted = _PartedGround(ground, lines, visits_m, sliver_m)
    length_m = np.array([math.hypot(*(line[1] - line[0])) for line in lines])
    while True:
        is_parting, is_wrong, is_inner = parted.judge(min_area_m2)
        if not is_wrong.any():
            return [line for line, parts in zip(lines, is_parting, strict=True) if parts]
        # one at a time: what is small joins what is behind it, and another line parts both
        inner = is_wrong & is_inner
        longest_m = np.where(inner if inner.any() else is_wrong, length_m, -1.0)
        parted.take_out(int(np.argmax(longest_m)))


class _PartedGround:
    """Ground in pieces, the pieces that no line parts being one part.

    Pieces are what all lines leave, and of each line that was taken out the ground under it: only
    what lies beside that is looked at again.

    Parameters
    ----------
    ground, lines, visits_m, sliver_m
        See `part_enough`.
    """

    def __init__(
        self,
        ground: BaseGeometry,
        lines: Sequence[FloatArray],
        visits_m: FloatArray,
        sliver_m: float,
    ) -> None:
        self._ground, self._sliver_m = ground, sliver_m
        self._cuts = overlays.buffer_shapes([_lengthen(line) for line in lines], SHORTEST_M)
        self._cut_tree = shapely.STRtree(self._cuts)
        self._is_cut = np.ones(len(lines), bool)
        # what lies beside a line, not what is beyond its ends
        across = shapely.linestrings(lines)
        beside = overlays.buffer_shapes(across, 2 * SHORTEST_M, cap_style="flat")
        self._beside_tree = shapely.STRtree(beside)
        self._visit_tree = shapely.STRtree(np.asarray(shapely.points(visits_m)))
        self._pieces: Array = np.empty(0, object)
        self._part = np.empty(0, np.int64)
        self._area_m2 = np.empty(0)
        self._is_visited, self._is_wide = np.empty(0, bool), np.empty(0, bool)
        self._line, self._piece, self._shared_m2 = self._part, self._part, self._area_m2
        cuts = overlays.unite_areas(self._cuts)
        pieces = shapely.get_parts(overlays.subtract_areas(ground, cuts))
        self._add(pieces, self._find_wide(pieces))
        self._piece_tree = shapely.STRtree(pieces)

    def judge(self, min_area_m2: float) -> tuple[BoolArray, BoolArray, BoolArray]:
        """Return which lines part anything, which part off too little, and which nobody passed."""
        n_lines, n_parts = len(self._cuts), len(self._part)
        is_visited, is_wide = np.zeros((2, n_parts), bool)
        is_visited[self._part[self._is_visited]] = True
        is_wide[self._part[self._is_wide]] = True
        area_m2 = np.bincount(self._part, self._area_m2, n_parts)
        is_small = area_m2 < np.where(is_visited, min_area_m2, FURNITURE_M2)
        pair, of_pair = np.unique(
            self._line * n_parts + self._part[self._piece], return_inverse=True
        )
        is_beside = np.bincount(of_pair, self._shared_m2, len(pair)) > SMALLEST_M2
        line, part = np.divmod(pair[is_beside], n_parts)
        n_beside = np.bincount(line, minlength=n_lines)
        n_wide = np.bincount(line, is_wide[part], n_lines)
        n_small = np.bincount(line, is_wide[part] & is_small[part], n_lines)
        is_parting = self._is_cut & (n_beside > 1)
        is_wrong = is_parting & ((n_wide < 2) | (n_small > 0))
        return is_parting, is_wrong, np.bincount(line, is_visited[part], n_lines) == 0

    def take_out(self, line: int) -> None:
        """Join what a line parts."""
        self._is_cut[line] = False
        cut = self._cuts[line]
        # whatever of the joined part is new, or wide for the first time, is as near as this
        reach_m = 3 * self._sliver_m * np.array([-1, -1, 1, 1])
        bounds_m = shapely.bounds(cut) + reach_m
        near = overlays.clip_areas(self._ground, *bounds_m)
        others = self._cut_tree.query(shapely.box(*bounds_m))
        others = overlays.unite_areas(self._cuts[others[self._is_cut[others]]])
        for joined in shapely.get_parts(overlays.subtract_areas(near, others)):
            under = shapely.get_parts(overlays.intersect_areas(joined, cut))
            if len(under):
                self._join(joined, under)

    def _join(self, joined: BaseGeometry, under: Array) -> None:
        """Make one part of all pieces in an area, and of the ground under a line that parted it."""
        first = self._piece_tree.query(joined, predicate="intersects")
        later = self._pieces[len(self._piece_tree) :]
        later = len(self._piece_tree) + np.flatnonzero(shapely.intersects(later, joined))
        near = np.concatenate([first, later])
        shared_m2 = shapely.area(overlays.intersect_areas(self._pieces[near], joined))
        parts = np.unique(self._part[near[shared_m2 > SAME_M * SAME_M]])
        is_joined = np.isin(self._part, parts)
        is_wide = self._is_wide[is_joined].any() or self._find_wide(joined)
        first = len(self._pieces)
        self._part[is_joined] = first
        self._add(under, np.full(len(under), is_wide))
        self._part[first:] = first

    def _find_wide(self, areas: Shapes) -> Answer:
        """Return of each area whether it is wider than two slivers anywhere."""
        return ~shapely.is_empty(overlays.buffer_shapes(areas, -self._sliver_m, quad_segs=8))

    def _add(self, pieces: Array, is_wide: BoolArray) -> None:
        """Add pieces, each a part of its own."""
        first = len(self._pieces)
        visited = np.unique(self._visit_tree.query(pieces, predicate="contains")[0])
        is_visited = np.isin(np.arange(len(pieces)), visited)
        piece, line = self._beside_tree.query(pieces, predicate="intersects")
        shared_m2 = shapely.area(
            overlays.intersect_areas(pieces[piece], self._beside_tree.geometries[line])
        )
        self._pieces = np.concatenate([self._pieces, pieces])
        self._part = np.append(self._part, np.arange(first, len(self._pieces)))
        self._area_m2 = np.concatenate([self._area_m2, shapely.area(pieces)])
        self._is_visited = np.concatenate([self._is_visited, is_visited])
        self._is_wide = np.concatenate([self._is_wide, is_wide])
        self._line = np.concatenate([self._line, line])
        self._piece = np.concatenate([self._piece, first + piece])
        self._shared_m2 = np.concatenate([self._shared_m2, shared_m2])


def _lengthen(line: FloatArray) -> LineString:
    """Return a line that goes on a little beyond both ends."""
    beyond = (line[1] - line[0]) / 10
    return LineString([line[0] - beyond, line[1] + beyond])
