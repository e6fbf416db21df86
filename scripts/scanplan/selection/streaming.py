"""Choose scans while they are recorded: one pass, bounded memory.

Thesis, chapter 6: selection in real time.
"""

import math

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import Polygons, move_near_origin
from scanplan.selection import area_greedy, hulls
from scanplan.selection.survey_scans import SurveyScans
from scanplan.types import IntArray


class StreamingSieves:
    """Up to k polygons of a stream whose union covers much.

    Sieve-Streaming++ (Kazemi, Mitrovic, Zadimoghaddam, Lattanzi and Karbasi 2019, "Submodular
    Streaming in All its Glory"). For each of a ladder of thresholds, (1 + epsilon) apart, a sieve
    takes every polygon that adds at least the threshold to those it holds, until it holds k.
    Thresholds below a 2k-th of what the best sieve covers are given up, those above the largest
    polygon so far not yet needed. The best sieve covers at least 1/2 - epsilon of what any k
    polygons of the stream cover, and no more than O(k / epsilon) polygons are held at any time.

    At the end greedy chooses k of all that is held, and the better of its choice and the best sieve
    is taken: the guarantee stays, and far more is covered in practice.

    Parameters
    ----------
    k : int, >= 1
    epsilon : float, above 0 and below 0.5

    Attributes
    ----------
    most_held : int
        The largest number of polygons held at a time.

    Raises
    ------
    ValueError
        If a parameter is out of its range.
    """

    def __init__(self, k: int, *, epsilon: float) -> None:
        if k < 1 or not 0 < epsilon < 0.5:
            raise ValueError(
                f"k is {k}, must be at least 1; epsilon is {epsilon}, must be above 0 and below 0.5"
            )
        self._k = k
        self._step = math.log1p(epsilon)
        self._largest_m2 = 0.0
        self._covered_m2 = 0.0
        self._sieves: dict[int, _Sieve] = {}
        self._held: dict[int, BaseGeometry] = {}
        self.most_held = 0

    def add(self, index: int, polygon: BaseGeometry) -> None:
        """Show the next polygon of the stream: valid, square metres, with an index of its own."""
        area_m2 = polygon.area
        if area_m2 <= 0:
            return
        self._largest_m2 = max(self._largest_m2, area_m2)
        self._raise_thresholds()
        for exponent, sieve in self._sieves.items():
            threshold_m2 = math.exp(self._step * exponent)
            if (
                area_m2 >= threshold_m2
                and len(sieve.chosen) < self._k
                and sieve.take(index, polygon, threshold_m2)
            ):
                self._held[index] = polygon
                self._covered_m2 = max(self._covered_m2, sieve.covered_m2)
        self._forget()
        self.most_held = max(self.most_held, len(self._held))

    def choose(self) -> list[int]:
        """Return the indices, at most k, of the polygons to take, in greedy order."""
        if not self._held:
            return []
        held = np.array(sorted(self._held))
        by_greedy = area_greedy.order_by_area([self._held[i] for i in held])
        k = min(self._k, len(held))
        best = max(self._sieves.values(), key=lambda sieve: sieve.covered_m2)
        if by_greedy.covered[k - 1] >= best.covered_m2:
            return held[by_greedy.order[:k]].tolist()
        order = area_greedy.order_by_area([self._held[i] for i in best.chosen]).order
        return [best.chosen[i] for i in order]

    def _raise_thresholds(self) -> None:
        lowest_m2 = max(self._covered_m2, self._largest_m2) / (2 * self._k)
        first = math.ceil(math.log(lowest_m2) / self._step)
        last = math.floor(math.log(self._largest_m2) / self._step)
        self._sieves = {e: self._sieves.get(e) or _Sieve() for e in range(first, last + 1)}

    def _forget(self) -> None:
        used = {i for sieve in self._sieves.values() for i in sieve.chosen}
        self._held = {i: polygon for i, polygon in self._held.items() if i in used}


class _Sieve:
    """What one threshold has let through."""

    def __init__(self) -> None:
        self.chosen: list[int] = []
        self.covered_m2 = 0.0
        self._union = shapely.Polygon()

    def take(self, index: int, polygon: BaseGeometry, least_m2: float) -> bool:
        """Take a polygon if it adds enough; return whether it did."""
        added_m2 = overlays.subtract_areas(polygon, self._union).area
        if added_m2 < least_m2:
            return False
        self._union = overlays.unite_areas([self._union, polygon])
        self.chosen.append(index)
        self.covered_m2 += added_m2
        return True


def order_in_one_pass(scans: SurveyScans) -> IntArray:
    """Return scans (n,) by one pass over the hulls of their clusters, with their settings."""
    polygons = hulls.scan_polygons(scans.tables["hulls"])[1]
    return order_streaming(polygons, **scans.streaming)[0]


def order_streaming(
    polygons: Polygons, *, k: int = 60, epsilon: float = 0.1
) -> tuple[IntArray, int]:
    """Order polygons in one pass: first those that `StreamingSieves` chooses, then the others.

    The others stay as they came. What is bounded is what the sieves hold; the polygons themselves
    are all here, to be moved near the origin.

    Parameters
    ----------
    polygons : (n,) sequence of shapely geometries
        As for `area_greedy.order_by_area`.
    k : int, >= 1
        Slots; with as many as there are polygons, all are held and the order is the greedy one.
    epsilon : float, above 0 and below 0.5
        What the guarantee may fall below one half; less holds more.

    Returns
    -------
    order : (n,) int
    most_held : int
        The largest number of polygons held at a time.

    Raises
    ------
    ValueError
        If a parameter is out of its range or the polygons are not usable.
    """
    sieves = StreamingSieves(k, epsilon=epsilon)
    if k >= len(polygons):
        return area_greedy.order_by_area(polygons).order, len(polygons)
    for index, polygon in enumerate(move_near_origin(polygons)):
        sieves.add(index, polygon)
    chosen = sieves.choose()
    rest = np.setdiff1d(np.arange(len(polygons)), chosen)
    return np.concatenate([np.array(chosen, int), rest]), sieves.most_held
