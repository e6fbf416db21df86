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

import numpy as np
from scipy import special

from scanplan.rays.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

SIGMAS = float(special.ndtri(0.975))
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
    n_groups : int
    """
    n_places = int(place.max(initial=-1)) + 1
    cell, which = np.unique(group.astype(np.int64) * max(n_places, 1) + place, return_inverse=True)
    group_of = cell // max(n_places, 1)
    size = np.bincount(which, minlength=len(cell))
    good = np.bincount(which, is_good, len(cell))
    n = np.bincount(group_of, size, n_groups)
    n_good = np.bincount(group_of, good, n_groups)
    m = np.bincount(group_of, minlength=n_groups)
    is_told = m > 1
    share = np.full(n_groups, np.nan)
    np.divide(n_good, n, out=share, where=is_told)
    square = np.bincount(group_of, (good - np.nan_to_num(share)[group_of] * size) ** 2, n_groups)
    variance = np.zeros(n_groups)
    np.divide(m / np.maximum(m - 1, 1) * square, n**2, out=variance, where=is_told)
    # where places do not differ, as if all were good, each counts as one ray
    effective = m.astype(float)
    differ = variance > ROUNDING**2
    of_sample = np.divide(share * (1 - share), variance, out=effective.copy(), where=differ)
    spread = SIGMAS / special.stdtrit(np.maximum(m - 1, 1), 0.975)
    effective[differ] = (np.minimum(of_sample, n) * spread**2)[differ]
    low, high = _wilson_bounds(share, effective)
    return Shares(m, share, low, high)


def number_places(sensors_m: FloatArray, place_m: float) -> IntArray:
    """Return the place (s,) that each of some scans (s, 2) was taken at, numbered from 0.

    Places are squares, the first at the least x and y.
    """
    if len(sensors_m) == 0:
        return np.empty(0, np.int64)
    cells = np.floor((sensors_m - sensors_m.min(axis=0)) / place_m).astype(np.int64)
    return np.unique(cells, axis=0, return_inverse=True)[1].ravel()


def _wilson_bounds(share: FloatArray, n: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Wilson's interval of shares (g,) of n (g,) independent trials."""
    n = np.where(n > 0, n, np.nan)
    square = SIGMAS**2 / n
    middle = (share + square / 2) / (1 + square)
    half = SIGMAS * np.sqrt(share * (1 - share) / n + square / (4 * n)) / (1 + square)
    # rounding apart, the share is between them
    return np.clip(middle - half, 0.0, share), np.clip(middle + half, share, 1.0)
