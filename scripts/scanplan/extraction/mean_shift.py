"""Mean shift in two dimensions at a cost nearly linear in the number of points.

K. Fukunaga, L. Hostetler: The estimation of the gradient of a density function, IEEE Trans. Inf.
Theory 21 (1975).
"""

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import FloatArray, IntArray

_BINS_PER_BANDWIDTH = 8  # means of bins move a mode by far less than the bandwidth
_MAX_STEPS = 300  # bounds the time of seeds that creep
_ROWS = np.arange(-_BINS_PER_BANDWIDTH, _BINS_PER_BANDWIDTH + 1)[:, None]
_STILL = 1e-2  # a seed that moves less than this share of the bandwidth has arrived


def mean_shift(
    xy_m: FloatArray, *, bandwidth_m: float, weight: FloatArray | IntArray | None = None
) -> tuple[IntArray, FloatArray]:
    """Find the modes of a flat kernel's density, and each point's nearest mode.

    The points are gathered in square bins of an eighth of the bandwidth, each a mean and a weight;
    one of every square of a quarter is a seed. A seed moves to the mean of the bins around it by
    sums over rows of bins. Modes closer than the bandwidth to a heavier one are dropped, as
    scikit-learn does.

    Parameters
    ----------
    xy_m : (n, 2) float
        All finite. Their order does not matter beyond rounding.
    weight : (n,) float, optional
        As how many points each counts.

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
        raise ValueError(
            f"mean shift of finite points with a positive bandwidth, not {bandwidth_m}"
        )
    if len(xy_m) == 0:
        return np.empty(0, np.int64), np.empty((0, 2))
    point_weight = np.ones(len(xy_m)) if weight is None else np.asarray(weight, float)
    bins = _Bins(xy_m, point_weight, bandwidth_m)
    modes_m, mode_weight = _climb(bins)
    modes_m = _select_modes(modes_m, mode_weight, bandwidth_m)
    distance_m, nearest = _find_nearest(bins.mean, modes_m)
    return np.where(distance_m <= bandwidth_m, nearest, -1)[bins.bin_of_point], modes_m


def _find_nearest(xy_m: FloatArray, modes_m: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return distance and number of the mode nearest to each place (n, 2)."""
    distance_m = np.full(len(xy_m), np.inf)
    nearest = np.zeros(len(xy_m), np.int64)
    # modes are few: scipy's trees take longer to import
    for number, mode_m in enumerate(modes_m):
        apart_m = np.hypot(*(xy_m - mode_m).T)
        is_nearer = apart_m < distance_m
        distance_m[is_nearer] = apart_m[is_nearer]
        nearest[is_nearer] = number
    return distance_m, nearest


class _Bins:
    """Weighted bin means, sorted by row (y) and x within it, with running sums along that order."""

    def __init__(self, xy_m: FloatArray, point_weight: FloatArray, bandwidth_m: float) -> None:
        self.bandwidth = bandwidth_m
        self.size = bandwidth_m / _BINS_PER_BANDWIDTH
        self.origin = xy_m.min(axis=0)
        column, row = np.floor((xy_m - self.origin) / self.size).astype(np.int64).T
        _, self.bin_of_point = np.unique(row * (column.max() + 1) + column, return_inverse=True)
        weight = np.bincount(self.bin_of_point, point_weight)
        self.mean = np.column_stack(
            [np.bincount(self.bin_of_point, c * point_weight) / weight for c in xy_m.T]
        )
        moments = np.column_stack([weight, weight[:, None] * self.mean])
        self.sums = np.vstack([np.zeros(3), np.cumsum(moments, axis=0)])
        self.span = self.mean[:, 0].max() - self.origin[0] + 4 * bandwidth_m
        self.n_rows = row.max() + 1
        bin_row = np.floor((self.mean[:, 1] - self.origin[1]) / self.size)
        self.key = self._key(bin_row, self.mean[:, 0])

    def _key(self, row: FloatArray, x: FloatArray) -> FloatArray:
        """Return a number for each row and x that rises in the order of the bins."""
        return row * self.span + (x - self.origin[0])

    def around(self, xy_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return weight and mean of what is within the bandwidth around each position."""
        row = np.floor((xy_m[:, 1] - self.origin[1]) / self.size) + _ROWS
        rise = np.where(_ROWS == 0, 0.0, (row + 0.5) * self.size + self.origin[1] - xy_m[:, 1])
        half = np.sqrt(np.maximum(self.bandwidth**2 - rise**2, 0))
        first = np.searchsorted(self.key, self._key(row, xy_m[:, 0] - half), "left")
        last = np.searchsorted(self.key, self._key(row, xy_m[:, 0] + half), "right")
        last = np.where(half > 0, np.maximum(last, first), first)
        total = (self.sums.take(last, axis=0) - self.sums.take(first, axis=0)).sum(axis=0)
        return total[:, 0], total[:, 1:] / np.maximum(total[:, :1], ROUNDING)

    def seeds(self) -> FloatArray:
        """Return the mean of the first bin in every square of a quarter of the bandwidth."""
        square = np.floor((self.mean - self.origin) / (2 * self.size))
        return self.mean[_first_of_each(square)]


def _climb(bins: _Bins) -> tuple[FloatArray, FloatArray]:
    """Return the modes (k, 2) that seeds move to, and the weights (k,) there."""
    grid = _STILL * bins.bandwidth
    modes = []
    seeds = bins.seeds()
    for _ in range(_MAX_STEPS):
        _, moved = bins.around(seeds)
        still = np.hypot(*(moved - seeds).T) < grid
        modes.append(moved[still])
        # seeds that have met go on as one
        moved = moved[~still]
        seeds = moved[_first_of_each(np.round(moved / grid))]
        if len(seeds) == 0:
            break
    reached = np.vstack([*modes, seeds])
    weight, _ = bins.around(reached)
    return reached, weight


def _first_of_each(whole: FloatArray) -> IntArray:
    """Return the index of the first of each distinct row of two whole numbers."""
    column, row = (whole - whole.min(axis=0, initial=np.inf)).T if len(whole) else whole.T
    return np.unique(row * (column.max(initial=0) + 1) + column, return_index=True)[1]


def _select_modes(modes: FloatArray, weight: FloatArray, bandwidth_m: float) -> FloatArray:
    """Return, heaviest first, the modes farther than the bandwidth from all heavier ones."""
    rest = modes[np.lexsort((modes[:, 1], modes[:, 0], -weight))]
    heaviest = []
    while len(rest):
        heaviest.append(rest[0])
        rest = rest[np.linalg.norm(rest - rest[0], axis=1) > bandwidth_m]
    return np.array(heaviest)
