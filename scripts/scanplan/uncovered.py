"""What a growing choice of polygons leaves uncovered of every polygon, brought up to date only where asked."""

import numpy as np
import shapely

from scanplan import overlays

_NO_AREA_M2 = 1e-12


class Uncovered:
    """What the chosen polygons leave of every polygon.

    A polygon is kept as its parts (a scan's separate hulls): small, so that few pairs meet and each overlay is cheap.
    What is left of a part shrinks with every chosen part that is subtracted from it; those not subtracted yet wait in
    a list of pairs. An area with pairs still waiting is too large, never too small.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries, n >= 0
        As for `overlays.near_origin`.

    Attributes
    ----------
    gain_m2 : (n,) float64
        Upper bound of what each polygon would add to the chosen ones, 0 for the chosen ones themselves.
    exact : (n,) bool
        Whether `gain_m2` is what it would add.
    remaining : (n,) bool
        Whether it has not been chosen.
    """

    def __init__(self, polygons):
        polygons = overlays.near_origin(polygons)
        parts, owner = shapely.get_parts(polygons, return_index=True)
        has_area = shapely.area(parts) > 0
        self._whole, self._owner = parts[has_area], owner[has_area]
        self._left, self._area_m2 = self._whole.copy(), shapely.area(self._whole)
        self._whole_box = shapely.bounds(self._whole).reshape(-1, 4)
        self._left_box = self._whole_box.copy()
        self._first = np.searchsorted(self._owner, np.arange(len(polygons) + 1))
        self._box = shapely.box(*shapely.bounds(polygons).reshape(-1, 4).T)
        self._tree = shapely.STRtree(self._box)
        self._new = [[] for _ in polygons]
        self._waiting = [np.zeros((2, 0), int)] * len(polygons)
        self._chosen = []
        self.remaining = np.ones(len(polygons), bool)
        self.exact = self.remaining.copy()
        self._sum_up()

    def refresh(self, some, floor_m2=-np.inf):
        """Bring the gains of some polygons up to date, each until it is exact or known to be below a floor.

        Parameters
        ----------
        some : (m,) int
            Distinct indices.
        floor_m2 : float
        """
        pairs = self._meeting(np.concatenate([self._pairs(i) for i in some], axis=1))
        later = []
        self._sum_up(some)
        while pairs.shape[1]:
            worth = self.gain_m2[self._owner[pairs[0]]] >= floor_m2
            later.append(pairs[:, ~worth])
            pairs = self._subtract(pairs[:, worth])
            self._sum_up(some)
        later = np.concatenate(later, axis=1) if later else pairs
        for i in some:
            self._waiting[i] = later[:, self._owner[later[0]] == i]
            self.exact[i] = self._waiting[i].shape[1] == 0

    def choose(self, i):
        """Cover a remaining polygon; return what it added."""
        if self.gain_m2[i] > 0:
            self.refresh([i])
        gain_m2, parts = self.gain_m2[i], self._alive(i)
        # whole parts, not what is left of them: their few straight edges leave no slivers
        shapely.prepare(self._whole[parts])
        self._chosen.append(parts)
        self.remaining[i] = False
        self.gain_m2[i] = self._area_m2[parts] = 0.0
        near = self._tree.query(self._box[i]) if len(parts) else np.zeros(0, int)
        near = near[self.gain_m2[near] > 0]
        self.exact[near] = False
        for j in near:
            self._new[j].append(parts)
        return gain_m2

    def drop_covered(self):
        """Leave nothing of the parts that the chosen ones cover together: far quicker than one by one.

        Worth its cost each time the number of chosen polygons has doubled.
        """
        union = overlays.union(self._whole[np.concatenate(self._chosen)])
        regions = shapely.get_parts(union)
        shapely.prepare(regions)
        alive = np.flatnonzero(self._area_m2 > 0)
        part, region = shapely.STRtree(regions).query(self._left[alive])
        part = alive[part]
        self._area_m2[part[shapely.covers(regions[region], self._left[part])]] = 0.0
        self._sum_up()

    def _alive(self, i):
        return np.arange(self._first[i], self._first[i + 1])[self._area_m2[self._first[i] : self._first[i + 1]] > 0]

    def _pairs(self, i):
        """Pairs (2, p) of parts of polygon i and chosen parts not yet subtracted from them."""
        pairs, self._waiting[i] = self._waiting[i], np.zeros((2, 0), int)
        if self._new[i]:
            parts, chosen = self._alive(i), np.concatenate(self._new[i])
            self._new[i] = []
            pairs = np.concatenate([pairs, [np.repeat(parts, len(chosen)), np.tile(chosen, len(parts))]], axis=1)
        return pairs

    def _meeting(self, pairs):
        """Of pairs those that meet, by part, the largest overlap of their boxes first; covered parts are done with."""
        left, whole = self._left_box[pairs[0]], self._whole_box[pairs[1]]
        side_m = np.minimum(left[:, 2:], whole[:, 2:]) - np.maximum(left[:, :2], whole[:, :2])
        close = (side_m > 0).all(axis=1) & (self._area_m2[pairs[0]] > 0)
        pairs, overlap_m2 = pairs[:, close], side_m[close].prod(axis=1)
        whole, left = self._whole[pairs[1]], self._left[pairs[0]]
        meets = shapely.intersects(whole, left)
        self._area_m2[pairs[0, shapely.covers(whole, left)]] = 0.0
        meets &= self._area_m2[pairs[0]] > 0
        pairs, overlap_m2 = pairs[:, meets], overlap_m2[meets]
        return pairs[:, np.lexsort((-overlap_m2, pairs[0]))]

    def _subtract(self, pairs):
        """Subtract one chosen part of each part's pairs; return the pairs that remain and meet."""
        is_first = np.diff(pairs[0], prepend=-1) > 0
        part, chosen = pairs[:, is_first]
        left = overlays.difference(self._left[part], self._whole[chosen])
        area_m2 = shapely.area(left)
        self._left[part], self._left_box[part] = left, shapely.bounds(left).reshape(-1, 4)
        self._area_m2[part] = np.where(area_m2 > _NO_AREA_M2, area_m2, 0.0)
        pairs = pairs[:, ~is_first & (self._area_m2[pairs[0]] > 0)]
        return pairs[:, shapely.intersects(self._whole[pairs[1]], self._left[pairs[0]])]

    def _sum_up(self, some=None):
        if some is None:
            self.gain_m2 = np.bincount(self._owner, self._area_m2, minlength=len(self.remaining))
        else:
            for i in some:
                self.gain_m2[i] = self._area_m2[self._first[i] : self._first[i + 1]].sum()
