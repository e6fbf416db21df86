"""How far the rays of scans go, by direction: what need not be looked at, because no ray there comes near."""

from dataclasses import dataclass

import numpy as np

_FANS = 180
_ROUND_M = 1e-6


@dataclass(frozen=True, eq=False)
class AzimuthSectors:
    """The rays of each scan by the two degrees of azimuth that they lie in.

    Attributes
    ----------
    first : (n, 181) int64
        Row that each begins at, and that the last ends before, where the scans' rays are stacked.
    reach_m : (n, 180) float64
        Level length of the longest ray in each; 0 where there is none.
    """

    first: np.ndarray
    reach_m: np.ndarray


def sort_into_sectors(azimuth_rad, xy_m, sensors_m):
    """Sort rays into fans.

    Parameters
    ----------
    azimuth_rad : list of n (k,) float64, increasing, -pi to pi
        Of each scan.
    xy_m : (sum of k, 2) float64
        Where the rays of all scans end, one scan after another.
    sensors_m : (n, 2) float64

    Returns
    -------
    Fans
    """
    n = len(azimuth_rad)
    edges_rad = np.linspace(-np.pi, np.pi, _FANS + 1)[1:-1]
    inner = np.reshape(
        [np.searchsorted(of_scan, edges_rad) for of_scan in azimuth_rad], (n, _FANS - 1)
    )
    count = np.array([len(of_scan) for of_scan in azimuth_rad], np.int64)
    first = (
        np.column_stack([np.zeros(n, np.int64), inner, count]) + (np.cumsum(count) - count)[:, None]
    )
    ways_m = (
        of_scan - at
        for of_scan, at in zip(np.split(xy_m, np.cumsum(count)[:-1]), sensors_m, strict=True)
    )
    square_m2 = np.concatenate(
        [np.empty(0), *(np.einsum("ij,ij->i", way_m, way_m) for way_m in ways_m)]
    )
    reach_m, filled = np.zeros((n, _FANS)), np.diff(first) > 0
    if filled.any():
        reach_m[filled] = np.sqrt(np.maximum.reduceat(square_m2, first[:, :-1][filled]))
    return AzimuthSectors(first.astype(np.int64), reach_m)


def cull_spans(known, low, high, scans, side_m, normal, band_m):
    """Cut spans of rows into those of the fans in which any ray may come as near to a line as a band.

    Along a ray that turns by an angle from the way straight to the line, ``r cos(angle)`` of the distance is gone.

    Parameters
    ----------
    known : Fans
    low, high : (2, k) int
        Rows that the spans of each scan begin at and end before.
    scans : (k,) int
    side_m : (k,) float
        How far their sensors lie from the line, positive on the side of its normal; not 0.
    normal : (2,) float
        The line's unit normal.
    band_m : float

    Returns
    -------
    low, high : (2, m) int
        Likewise, in the same order; empty where high is not above low.
    row : (m,) int
        Which of the k scans each is of.
    """
    straight = -np.sign(side_m)[:, None] * normal
    straight_rad = np.arctan2(straight[:, 1], straight[:, 0])[:, None]
    middle_rad = (np.arange(_FANS) + 0.5) * (2 * np.pi / _FANS) - np.pi
    apart_rad = np.abs((middle_rad - straight_rad + np.pi) % (2 * np.pi) - np.pi)
    straightest = np.cos(np.maximum(apart_rad - np.pi / _FANS, 0))
    gone_m = known.reach_m[scans] * np.maximum(straightest, 0)
    row, fan = np.nonzero(gone_m >= np.abs(side_m)[:, None] - band_m - _ROUND_M)
    first, stop = known.first[scans[row], fan], known.first[scans[row], fan + 1]
    return np.maximum(low[:, row], first), np.minimum(high[:, row], stop), row
