"""Ray reach by azimuth sector.

A bound that shows which rays cannot come near a line.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

N_SECTORS = 72
"""Of 5 degrees each: wider than what is between two firings of any sensor."""


def number_sectors(azimuth_rad: FloatArray) -> IntArray:
    """Return the sector of each azimuth, -pi to pi.

    >>> number_sectors(np.array([-np.pi, 0.0, np.pi])).tolist()
    [0, 36, 71]
    """
    sector = ((azimuth_rad + np.pi) / (2 * np.pi) * N_SECTORS).astype(np.int64)
    return np.minimum(sector, N_SECTORS - 1)


def middles_rad(sectors: BoolArray) -> FloatArray:
    """Return the azimuths of the middles of some sectors (72,), increasing."""
    return (np.flatnonzero(sectors) + 0.5) * (2 * np.pi / N_SECTORS) - np.pi


@dataclass(frozen=True, eq=False)
class AzimuthSectors:
    """The rays of each scan by the five degrees of azimuth that they lie in.

    Attributes
    ----------
    first : (s, 73) int64
        Row that each sector begins at, and that the last ends before.
    reach_m : (s, 72) float64
        Level length of the longest ray in each; 0 where there is none.
    """

    first: IntArray
    reach_m: FloatArray


def sort_into_sectors(
    first: IntArray, azimuth_rad: FloatArray, way_m: FloatArray
) -> AzimuthSectors:
    """Sort rays into sectors.

    Parameters
    ----------
    first : (s + 1,) int64
        Row that each scan's rays begin at.
    azimuth_rad : (n,) float64
        Increasing within a scan, -pi to pi.
    way_m : (n, 2) float64
        From the sensor to where each ray ends, level.
    """
    edges_rad = np.linspace(-np.pi, np.pi, N_SECTORS + 1)[1:-1]
    scans = list(zip(first[:-1].tolist(), first[1:].tolist(), strict=True))
    inner = [begin + np.searchsorted(azimuth_rad[begin:end], edges_rad) for begin, end in scans]
    inner = np.reshape(inner, (len(scans), N_SECTORS - 1))
    rows = np.column_stack([first[:-1], inner, first[1:]]).astype(np.int64)
    square_m2 = np.einsum("ij,ij->i", way_m, way_m)
    reach_m = np.zeros((len(scans), N_SECTORS))
    filled = np.diff(rows) > 0
    if filled.any():
        reach_m[filled] = np.sqrt(np.maximum.reduceat(square_m2, rows[:, :-1][filled]))
    return AzimuthSectors(rows, reach_m)


def cull_spans(
    sectors: AzimuthSectors,
    low: IntArray,
    high: IntArray,
    scans: IntArray,
    side_m: FloatArray,
    normal: FloatArray,
    at_m: float,
) -> tuple[IntArray, IntArray, IntArray]:
    """Cut spans of rows into those of the sectors in which any ray may come near a line.

    Along a ray that turns by an angle from the way straight to the line, ``r cos(angle)`` of the
    distance is gone.

    Parameters
    ----------
    low, high : (2, k) int
        Rows that the spans of each scan begin at and end before.
    scans : (k,) int
    side_m : (k,) float
        How far their sensors lie from the line, positive on the side of its normal; not 0.
    normal : (2,) float
        The line's unit normal.
    at_m : float
        What is near.

    Returns
    -------
    low, high : (2, m) int
        Likewise, in the same order; empty where high is not above low.
    row : (m,) int
        Which of the k scans each is of.
    """
    straight = -np.sign(side_m)[:, None] * normal
    straight_rad = np.arctan2(straight[:, 1], straight[:, 0])[:, None]
    middle_rad = middles_rad(np.ones(N_SECTORS, bool))
    apart_rad = np.abs((middle_rad - straight_rad + np.pi) % (2 * np.pi) - np.pi)
    straightest = np.cos(np.maximum(apart_rad - np.pi / N_SECTORS, 0))
    gone_m = sectors.reach_m[scans] * np.maximum(straightest, 0)
    row, sector = np.nonzero(gone_m >= np.abs(side_m)[:, None] - at_m - ROUNDING)
    first, stop = sectors.first[scans[row], sector], sectors.first[scans[row], sector + 1]
    return np.maximum(low[:, row], first), np.minimum(high[:, row], stop), row
