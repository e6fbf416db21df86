"""What a growing choice of polygons leaves uncovered of every polygon, brought up to date only where asked."""

import numpy as np
import shapely

from scanplan.selection import overlays

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
    threads : concurrent.futures.Executor, optional
        Threads to overlay on; the results are the same with any number of them.

    Attributes
    ----------
    gain_m2 : (n,) float64
        Upper bound of what each polygon would add to the chosen ones, 0 for the chosen ones themselves.
    exact : (n,) bool
        Whether `gain_m2` is what it would add.
    remaining : (n,) bool
        Whether it has not been chosen.
    """

    def __init__(self, polygons, threads=None):
        self._threads = threads
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
        self.gain_m2 = np.bincount(self._owner, self._area_m2, minlength=len(polygons))

    def refresh(self, some, floor_m2=-np.inf):
        """Bring the gains of some polygons up to date, each until it is exact or known to be below a floor.

        Parameters
        ----------
        some : (m,) int
            Distinct indices.
        floor_m2 : float
        """
        parts = np.concatenate([np.arange(self._first[i], self._first[i + 1]) for i in some])
        place = np.repeat(np.arange(len(some)), self._first[some + 1] - self._first[some])
        pairs = self._by_overlap(np.concatenate([self._pairs(i) for i in some], axis=1))
        later = []
        while True:
            self.gain_m2[some] = np.bincount(place, self._area_m2[parts], minlength=len(some))
            worth = self.gain_m2[self._owner[pairs[0]]] >= floor_m2
            later.append(pairs[:, ~worth])
            if not worth.any():
                break
            pairs = self._subtract(pairs[:, worth])
        self._wait(some, np.concatenate(later, axis=1))

    def choose(self, i):
        """Cover a remaining polygon; return what it added."""
        if not self.exact[i] and self.gain_m2[i] > 0:
            self.refresh(np.array([i]))
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
        self.gain_m2 = np.bincount(self._owner, self._area_m2, minlength=len(self.remaining))

    def _alive(self, i):
        return np.arange(self._first[i], self._first[i + 1])[self._area_m2[self._first[i] : self._first[i + 1]] > 0]

    def _pairs(self, i):
        """Pairs (2, p) of parts of polygon i and chosen parts that are not yet subtracted from them."""
        if not self._new[i]:
            return self._waiting[i]
        parts, chosen = self._alive(i), np.concatenate(self._new[i])
        self._new[i] = []
        left, whole = self._left_box[parts, None], self._whole_box[chosen]
        close = (left[..., 0] < whole[:, 2]) & (left[..., 2] > whole[:, 0])
        close &= (left[..., 1] < whole[:, 3]) & (left[..., 3] > whole[:, 1])
        part, other = close.nonzero()
        return np.concatenate([self._waiting[i], [parts[part], chosen[other]]], axis=1)

    def _wait(self, some, pairs):
        pairs = pairs[:, np.argsort(self._owner[pairs[0]], kind="stable")]
        start, end = np.searchsorted(self._owner[pairs[0]], [some, some + 1])
        self.exact[some] = start == end
        for i, a, b in zip(some, start, end, strict=True):
            self._waiting[i] = pairs[:, a:b]

    def _still_close(self, pairs):
        """Of pairs those whose boxes meet and whose part is not all covered."""
        left, whole = self._left_box[pairs[0]], self._whole_box[pairs[1]]
        close = (left[:, :2] < whole[:, 2:]) & (left[:, 2:] > whole[:, :2])
        return pairs[:, close[:, 0] & close[:, 1] & (self._area_m2[pairs[0]] > 0)]

    def _by_overlap(self, pairs):
        """Pairs by part, the largest overlap of their boxes first; parts that one chosen part covers are done with."""
        pairs = self._still_close(pairs)
        left, whole = self._left_box[pairs[0]], self._whole_box[pairs[1]]
        inside = np.flatnonzero(((left[:, :2] >= whole[:, :2]) & (left[:, 2:] <= whole[:, 2:])).all(axis=1))
        part, chosen = pairs[:, inside]
        self._area_m2[part[shapely.covers(self._whole[chosen], self._left[part])]] = 0.0
        side_m = np.minimum(left[:, 2:], whole[:, 2:]) - np.maximum(left[:, :2], whole[:, :2])
        by_part = np.lexsort((-side_m[:, 0] * side_m[:, 1], pairs[0]))
        return pairs[:, by_part[self._area_m2[pairs[0, by_part]] > 0]]

    def _subtract(self, pairs):
        """Subtract the first chosen part of each part's pairs; return the other pairs that may still meet."""
        is_first = np.ones(pairs.shape[1], bool)
        is_first[1:] = pairs[0, 1:] != pairs[0, :-1]
        part, chosen = pairs[:, is_first]
        meets = shapely.intersects(self._whole[chosen], self._left[part])
        part, chosen = part[meets], chosen[meets]
        left = overlays.difference(self._left[part], self._whole[chosen], self._threads)
        area_m2 = shapely.area(left)
        self._left[part], self._left_box[part] = left, shapely.bounds(left).reshape(-1, 4)
        self._area_m2[part] = np.where(area_m2 > _NO_AREA_M2, area_m2, 0.0)
        return self._still_close(pairs[:, ~is_first])
