"""Shares of rays with intervals that count neighbouring rays as what they are: nearly one.

Rays of one scan see the same furniture, err by the same pose and meet the same wall; so do scans
taken at one place. The rays of a place are a cluster: the variance of a share is that of a ratio of
clusters' totals, and the interval that of so many independent rays as have this variance, fewer
where few places tell it.

Sources: Cochran (1977), Sampling techniques, section 3.12 (ratio of clusters' totals); Kish (1965),
Survey sampling, section 8.2 (effective size); Korn and Graubard (1998), Confidence intervals for
proportions with small expected number of positive counts estimated from survey data (its degrees of
freedom); Wilson (1927), Probable inference, the law of
succession, and statistical inference (interval of a share).
"""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

SIGMAS = NormalDist().inv_cdf(0.975)
"""Standard deviations to either side that hold 95 of 100 cases, of intervals and tolerances."""


@dataclass(frozen=True, eq=False)
class Shares:
    """Shares of groups of rays, (g,) each.

    Attributes
    ----------
    n_places : int64
    share, low, high : float64
        With the bounds of its interval; NaN where fewer than two places tell.
    """

    n_places: IntArray
    share: FloatArray
    low: FloatArray
    high: FloatArray


def estimate_shares(group: IntArray, place: IntArray, is_good: BoolArray, n_groups: int) -> Shares:
    """Return the share of good ones in each group.

    Parameters
    ----------
    group, place : (n,) int, >= 0
    is_good : (n,) bool
    """
    counts = _count_by_place(group, place, is_good, n_groups)
    n, n_good, m = counts.summed(counts.size), counts.summed(counts.good), counts.n_places
    is_told = m > 1
    share = np.full(n_groups, np.nan)
    np.divide(n_good, n, out=share, where=is_told)
    apart = counts.good - np.nan_to_num(share)[counts.group] * counts.size
    variance = np.zeros(n_groups)
    np.divide(counts.summed(apart**2), n**2, out=variance, where=is_told)
    low, high = _bounds(share, variance, m, n)
    return Shares(m, share, low, high)


def average_shares(
    group: IntArray, place: IntArray, is_good: BoolArray, weight: FloatArray
) -> Shares:
    """Return the mean share of groups that two places or more tell of, by weights (g,): one row.

    Parameters
    ----------
    group, place : (n,) int, >= 0
    is_good : (n,) bool
    weight : (g,) float, >= 0
    """
    counts = _count_by_place(group, place, is_good, len(weight))
    n, n_good = counts.summed(counts.size), counts.summed(counts.good)
    weight = np.where(counts.n_places > 1, weight, 0.0)
    if weight.sum() == 0:
        unknown = np.full(1, np.nan)
        return Shares(np.zeros(1, np.int64), unknown, unknown, unknown)
    weight = weight / weight.sum()
    each = n_good / np.maximum(n, 1)
    share = weight @ each
    # what each place adds to the error of the mean, by its error in each group
    apart = (counts.good - each[counts.group] * counts.size) / np.maximum(n, 1)[counts.group]
    told = counts.place[weight[counts.group] > 0]
    of_place = np.asarray(np.bincount(counts.place, weight[counts.group] * apart), float)
    n_told = np.full(1, n[weight > 0].sum())
    m = np.full(1, len(np.unique(told)))
    mean, square = np.full(1, share), np.full(1, np.sum(of_place**2))
    return Shares(m, mean, *_bounds(mean, square, m, n_told))


@dataclass(frozen=True, eq=False)
class _Counts:
    """Rays, and good ones, of each group at each place that has any, (c,)."""

    group: IntArray
    place: IntArray
    size: IntArray
    good: FloatArray | IntArray
    n_groups: int

    @property
    def n_places(self) -> IntArray:
        """How many places tell of each group."""
        return np.bincount(self.group, minlength=self.n_groups)

    def summed(self, values: FloatArray | IntArray) -> FloatArray:
        """Return sums of values (c,) by group."""
        return np.asarray(np.bincount(self.group, values, self.n_groups), float)


def _count_by_place(group: IntArray, place: IntArray, is_good: BoolArray, n_groups: int) -> _Counts:
    n_places = int(place.max(initial=0)) + 1
    cell, which = np.unique(group.astype(np.int64) * n_places + place, return_inverse=True)
    size = np.bincount(which, minlength=len(cell))
    good = np.bincount(which, is_good, len(cell))
    return _Counts(cell // n_places, cell % n_places, size, good, n_groups)


def number_places(sensors_m: FloatArray, place_m: float) -> IntArray:
    """Return the place (s,) that each of some scans (s, 2) was taken at, numbered from 0.

    Places are squares, the first at the least x and y.
    """
    if len(sensors_m) == 0:
        return np.empty(0, np.int64)
    cells = np.floor((sensors_m - sensors_m.min(axis=0)) / place_m).astype(np.int64)
    return np.unique(cells, axis=0, return_inverse=True)[1].ravel()


def _bounds(
    share: FloatArray, square: FloatArray, m: IntArray, n: FloatArray | IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return intervals of shares (g,) that m (g,) places tell by n (g,) rays.

    `square` is the sum of squares of what each place adds to the share's error.
    """
    from scipy import special  # 0.2 s, and what reads intervals does not need it

    variance = m / np.maximum(m - 1, 1) * square
    # where places do not differ, as if all were good, each counts as one ray
    effective = np.where(m > 0, m, np.nan).astype(float)
    differ = variance > ROUNDING**2
    of_sample = np.divide(share * (1 - share), variance, out=effective.copy(), where=differ)
    spread = SIGMAS / special.stdtrit(np.maximum(m - 1, 1), 0.975)
    effective[differ] = (np.minimum(of_sample, n) * spread**2)[differ]
    # Wilson's interval of so many independent rays
    ratio = SIGMAS**2 / effective
    middle = (share + ratio / 2) / (1 + ratio)
    half = SIGMAS * np.sqrt(share * (1 - share) / effective + ratio / (4 * effective)) / (1 + ratio)
    # rounding apart, the share is between them
    return np.clip(middle - half, 0.0, share), np.clip(middle + half, share, 1.0)
