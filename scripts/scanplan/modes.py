"""Mean shift in two dimensions at a cost nearly linear in the number of points.

K. Fukunaga, L. Hostetler: The estimation of the gradient of a density function, IEEE Trans. Inf. Theory 21 (1975).
"""

import numpy as np
from scipy.spatial import cKDTree

_BINS_PER_BANDWIDTH = 8
_MAX_STEPS = 300
_STILL = 1e-3  # a seed that moves less than this share of the bandwidth has arrived


def mean_shift(xy_m, *, bandwidth_m):
    """Find the modes of a flat kernel's density, and each point's nearest mode.

    The points are gathered in square bins of an eighth of the bandwidth, each a mean and a weight; every bin is a seed.
    A seed moves to the mean of the bins around it by sums over rows of bins. Modes closer than the bandwidth to a
    heavier one are dropped, as scikit-learn does.

    Parameters
    ----------
    xy_m : (n, 2) float
        All finite. Their order does not matter beyond rounding.
    bandwidth_m : float

    Returns
    -------
    labels : (n,) int64
        Index of the nearest mode; -1 where it is farther than the bandwidth.
    modes_m : (k, 2) float64, heaviest first

    Raises
    ------
    ValueError
        If the bandwidth is not positive or a coordinate is not finite.
    """
    xy_m = np.asarray(xy_m, float).reshape(-1, 2)
    if not bandwidth_m > 0 or not np.isfinite(xy_m).all():
        raise ValueError(f"mean shift of finite points with a positive bandwidth, not {bandwidth_m}")
    if len(xy_m) == 0:
        return np.empty(0, np.int64), np.empty((0, 2))
    bins = _Bins(xy_m, bandwidth_m)
    modes = _heaviest_apart(*_climb(bins), bandwidth_m)
    distance, nearest = cKDTree(modes).query(bins.mean)
    return np.where(distance <= bandwidth_m, nearest, -1)[bins.bin_of_point], modes


class _Bins:
    """Weighted bin means, sorted by row (y) and x within it, with running sums along that order."""

    def __init__(self, xy_m, bandwidth_m):
        self.bandwidth, self.size = bandwidth_m, bandwidth_m / _BINS_PER_BANDWIDTH
        self.origin = xy_m.min(axis=0)
        column, row = np.floor((xy_m - self.origin) / self.size).astype(np.int64).T
        _, self.bin_of_point = np.unique(row * (column.max() + 1) + column, return_inverse=True)
        weight = np.bincount(self.bin_of_point).astype(float)
        self.mean = np.column_stack([np.bincount(self.bin_of_point, c) / weight for c in xy_m.T])
        self.sums = np.vstack([np.zeros(3), np.cumsum(np.column_stack([weight, weight[:, None] * self.mean]), axis=0)])
        self.span = self.mean[:, 0].max() - self.origin[0] + 4 * bandwidth_m
        self.n_rows = row.max() + 1
        self.key = self._key(np.floor((self.mean[:, 1] - self.origin[1]) / self.size), self.mean[:, 0])

    def _key(self, row, x):
        return row * self.span + (x - self.origin[0])

    def around(self, xy_m):
        """Return the weight within the bandwidth around each position and the mean of what is there."""
        total = np.zeros((len(xy_m), 3))
        own_row = np.floor((xy_m[:, 1] - self.origin[1]) / self.size)
        for step in range(-_BINS_PER_BANDWIDTH, _BINS_PER_BANDWIDTH + 1):
            row = own_row + step
            rise = (row + 0.5) * self.size + self.origin[1] - xy_m[:, 1] if step else 0.0
            half = np.sqrt(np.maximum(self.bandwidth**2 - rise**2, 0)) * np.ones(len(xy_m))
            first = np.searchsorted(self.key, self._key(row, xy_m[:, 0] - half), "left")
            last = np.searchsorted(self.key, self._key(row, xy_m[:, 0] + half), "right")
            total += np.where((half > 0)[:, None], self.sums[np.maximum(last, first)] - self.sums[first], 0)
        return total[:, 0], total[:, 1:] / np.maximum(total[:, :1], 1)


def _climb(bins):
    """Move every bin's seed to its mode; return the positions reached and the weights there."""
    arrived, grid = [], _STILL * bins.bandwidth
    seeds = bins.mean
    for _ in range(_MAX_STEPS):
        _, moved = bins.around(seeds)
        still = np.linalg.norm(moved - seeds, axis=1) < grid
        arrived.append(moved[still])
        # seeds that have met go on as one
        _, first = np.unique(np.round(moved[~still] / grid), axis=0, return_index=True)
        seeds = moved[~still][first]
        if len(seeds) == 0:
            break
    modes = np.vstack([*arrived, seeds])
    return modes, bins.around(modes)[0]


def _heaviest_apart(modes, weight, bandwidth):
    """Keep, from the heaviest on, the modes that are farther than the bandwidth from all kept ones."""
    order = np.lexsort((modes[:, 1], modes[:, 0], -weight))
    left, kept = modes[order], []
    while len(left):
        kept.append(left[0])
        left = left[np.linalg.norm(left - left[0], axis=1) > bandwidth]
    return np.array(kept)
