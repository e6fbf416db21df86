"""What a growing choice of polygons leaves uncovered of every polygon, measured where asked."""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.polygons import Polygons, move_near_origin
from scanplan.geometry.tolerances import ROUNDING
from scanplan.selection.union_area.cell_bounds import CellBounds, list_members
from scanplan.selection.union_area.regions import Regions
from scanplan.types import Array, FloatArray, IntArray

_FEW = 6  # chosen parts subtracted from a part one by one; more by their union


class Uncovered:
    """What the chosen polygons leave of every polygon: a `lazy_greedy.Cover` in square metres.

    A polygon is kept as its parts (a scan's separate hulls): each is small, and its difference to
    the union of all that is chosen is one cheap overlay. What is left of a part shrinks, so an area
    measured earlier is too large, never too small; it is still exact unless something was chosen
    whose new area meets the box of what was left.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        As for `polygons.move_near_origin`.

    Attributes
    ----------
    gain : (n,) float64
        Upper bound of what each polygon would add to the chosen ones, 0 for the chosen ones
        themselves.
    exact : (n,) bool
        Whether `gain` is what it would add.
    remaining : (n,) bool
        Whether it has not been chosen.
    """

    def __init__(self, polygons: Polygons) -> None:
        polygons = move_near_origin(polygons)
        parts, owner = shapely.get_parts(polygons, return_index=True)
        has_area = shapely.area(parts) > 0
        self._whole, self._owner = parts[has_area], owner[has_area]
        self._first = np.searchsorted(self._owner, np.arange(len(polygons) + 1))
        self._left = self._whole.copy()
        self._left_box = shapely.bounds(self._whole).reshape(-1, 4)
        self._area_m2 = shapely.area(self._whole)
        self._measured = np.zeros(len(self._whole), bool)
        # how many chosen parts are still to be subtracted from each, and the first few of them
        self._n_new = np.zeros(len(self._whole), int)
        self._new = np.zeros((len(self._whole), _FEW), int)
        self._tree = shapely.STRtree(self._whole)
        self._regions = Regions(self._whole)
        self._cells = CellBounds(self._whole)
        self.remaining = np.ones(len(polygons), bool)
        self.exact = self.remaining.copy()
        self.gain: FloatArray = self._gains(self._owner, len(polygons))

    def refresh(self, some: IntArray, floor: float = -np.inf) -> None:
        """Bring some gains up to date, each until it is exact or known to be below a floor.

        Parameters
        ----------
        some : (m,) int
            Distinct indices.
        floor : float
            Square metres.
        """
        parts = self._stale_parts(some)
        if floor > 0:
            self._bound(parts[~self._measured[parts]])
            self._add_up(some)
            parts = self._stale_parts(some[self.gain[some] >= floor])
        self._measure(parts)
        self._add_up(some)

    def choose(self, i: int) -> float:
        """Cover a remaining polygon; return what it added."""
        if not self.exact[i]:
            self.refresh(np.array([i]))
        gain_m2 = float(self.gain[i])
        parts = np.arange(int(self._first[i]), int(self._first[i + 1]))
        parts = parts[self._area_m2[parts] > 0]
        self.remaining[i] = False
        if len(parts) == 0:
            return 0.0
        new, of = shapely.get_parts(self._left[parts], return_index=True)
        has_area = shapely.area(new) > 0
        new, of = new[has_area], of[has_area]
        # whole parts, not what is left of them: their few straight edges leave no slivers
        self._regions.cover(self._whole[parts], self._left[parts])
        self._cells.cover(new)
        self.gain[i] = 0.0
        self._area_m2[parts] = 0.0
        self._make_stale(shapely.bounds(new).reshape(-1, 4), parts[of])
        return gain_m2

    def tighten(self) -> None:
        """Bring all gains nearer to what they are, by what is far quicker than overlays.

        Worth its cost each time the number of chosen polygons has doubled.
        """
        parts = np.flatnonzero(self._n_new)
        self._drop_covered(parts)
        self._bound(parts[~self._measured[parts] & (self._n_new[parts] > 0)])
        self._add_up(np.arange(len(self.remaining)))

    def _stale_parts(self, some: IntArray) -> IntArray:
        parts = list_members(self._first, some)[1]
        return parts[self._n_new[parts] > 0]

    def _make_stale(self, boxes: FloatArray, parts: IntArray) -> None:
        """Note that what is left may have become less in boxes (m, 4), by chosen parts (m,)."""
        box, part = self._tree.query(shapely.box(*boxes.T))
        new = boxes[box]
        left = self._left_box[part]
        overlap = ((left[:, :2] < new[:, 2:]) & (left[:, 2:] > new[:, :2])).all(axis=1)
        close = overlap & (self._area_m2[part] > 0)
        pairs = np.unique(part[close] * len(self._whole) + parts[box[close]])
        part, chosen = np.divmod(pairs, len(self._whole))
        place = self._n_new[part] + np.arange(len(part)) - np.searchsorted(part, part)
        few = place < _FEW
        self._new[part[few], place[few]] = chosen[few]
        np.maximum.at(self._n_new, part, place + 1)
        self.exact[self._owner[part]] = False

    def _gains(self, place: IntArray, n: int, parts: IntArray | slice = slice(None)) -> FloatArray:
        return np.bincount(place, self._area_m2[parts], minlength=n).astype(float)

    def _add_up(self, some: IntArray) -> None:
        place, parts = list_members(self._first, some)
        self.gain[some] = self._gains(place, len(some), parts)
        self.exact[some] = np.bincount(place, self._n_new[parts], minlength=len(some)) == 0

    def _bound(self, parts: IntArray) -> None:
        self._area_m2[parts] = np.minimum(self._area_m2[parts], self._cells.area_m2(parts))

    def _drop_covered(self, parts: IntArray) -> tuple[IntArray, Array]:
        """Finish the stale parts that are covered; return the others and the region round each."""
        region = self._regions.around(parts)
        covered = shapely.covers(region, self._left[parts])
        self._finish(parts[covered], np.zeros(1))
        return parts[~covered], region[~covered]

    def _measure(self, parts: IntArray) -> None:
        """Subtract what is covered of stale parts."""
        few = self._n_new[parts] <= _FEW
        for i in range(self._n_new[parts[few]].max(initial=0)):
            some = parts[few][self._n_new[parts[few]] > i]
            self._subtract(some, self._whole[self._new[some, i]])
        rest, region = self._drop_covered(parts[~few])
        self._subtract(rest, region)
        parts = np.concatenate([parts[few], rest])
        self._finish(parts, shapely.area(self._left[parts]))

    def _subtract(self, parts: IntArray, others: Array) -> None:
        if len(parts) == 0:
            return
        left = overlays.subtract_areas(self._left[parts], others)
        self._left[parts] = left
        self._left_box[parts] = shapely.bounds(left).reshape(-1, 4)
        self._measured[parts] = True

    def _finish(self, parts: IntArray, area_m2: FloatArray) -> None:
        self._area_m2[parts] = np.where(area_m2 > ROUNDING, area_m2, 0.0)
        self._n_new[parts] = 0
