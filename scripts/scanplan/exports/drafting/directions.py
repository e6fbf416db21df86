"""The main directions of a building, and which of them each wall runs along."""

import numpy as np

from scanplan.types import FloatArray

_QUARTER = np.pi / 2
_SPREAD_RAD = np.radians(1.5)  # walls of one direction are built, and found, this nearly parallel
_MEMBER_RAD = np.radians(5.0)  # three times as far a wall may still be one of them, badly seen
_LEAST_SHARE = 0.15  # of all weight: fewer walls are oblique ones, and no wing of a building
_MOST = 4
"""Main directions: more wings than a building has; each is two, at right angles."""
_STEPS = np.arange(8) * np.pi / 4  # beside along and across, halfway: bays and cut corners


def find_main_directions(angles_rad: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the main directions (k,) of walls, that with most walls first, each in [0, pi / 2).

    Each is the weighted median of walls that run nearly along or across it: a few crooked ones do
    not turn it, and walls that lie in it keep it.

    Parameters
    ----------
    angles_rad, weights : (n,) float
        Of the walls' lines.

    Examples
    --------
    >>> lengths_m = np.array([2.0, 2.0, 2.0, 1.0])
    >>> find_main_directions(np.radians([0.0, 90.5, 180.0, 37.0]), lengths_m).tolist()
    [0.0]
    """
    left = np.asarray(weights, float).copy()
    found: list[float] = []
    while len(found) < _MOST and left.sum() > 0:
        off_rad = _fold(angles_rad[:, None] - angles_rad, _QUARTER)
        support = np.exp(-((off_rad / _SPREAD_RAD) ** 2)) @ left
        # of equally good ones the first
        best = int(np.argmax(np.round(np.where(left > 0, support, -1.0), 9)))
        is_member = (np.abs(off_rad[best]) <= _MEMBER_RAD) & (left > 0)
        if found and left[is_member].sum() < _LEAST_SHARE * weights.sum():
            break
        off = -off_rad[best][is_member]
        middle = float(np.asarray(off)[_median_row(off, left[is_member])])
        found.append(float(np.mod(angles_rad[best] + middle, _QUARTER)))
        left[np.abs(off_rad[best]) <= _MEMBER_RAD] = 0
    return np.array(found)


def find_nearest_directions(angles_rad: FloatArray, mains_rad: FloatArray) -> FloatArray:
    """Return what each wall (n,) is to be turned by to run along, across or halfway to a direction.

    Radians, counter-clockwise; of the nearest direction.
    """
    targets_rad = (mains_rad[:, None] + _STEPS).ravel()
    turns_rad = _fold(targets_rad - angles_rad[:, None], 2 * np.pi)
    nearest = np.abs(turns_rad).argmin(axis=1)
    return turns_rad[np.arange(len(angles_rad)), nearest]


def _median_row(values: FloatArray, weights: FloatArray) -> int:
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return int(order[np.searchsorted(below, below[-1] / 2)])


def _fold(angles_rad: FloatArray, period: float) -> FloatArray:
    """Return angles in the middle of a period around zero."""
    return angles_rad - period * np.round(angles_rad / period)
