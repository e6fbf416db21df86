"""Spacing of beams, and the field of view of planar scanners."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray, IntArray

# ASSUME wider gaps than this are the end of a sensor's field, or openings that nothing came back
# from
_WIDEST_RAD = np.radians(10)


@dataclass(frozen=True, eq=False)
class PlanarBeams:
    """Where planar scans look, how densely, and how far.

    Attributes
    ----------
    begin_rad, wide_rad : (s,) float64
        Azimuth that each scan's field of view begins at, and how far it goes on from there. Its
        end is the widest gap between returns, unless some scan shows that the sensor looks all
        around.
    per_deg : (s,) float64
        Beams to a degree of azimuth.
    reach_m : float
        As far as returns came from in any scan, but for a few that may be stray: of what is farther
        it is not known whether it would return any.
    """

    begin_rad: FloatArray
    wide_rad: FloatArray
    per_deg: FloatArray
    reach_m: float

    def per_deg_at(
        self, scans: IntArray, azimuth_rad: FloatArray, distance_m: FloatArray
    ) -> FloatArray:
        """Return how many beams scans (s,) send to a degree around places (s, n).

        0 where a scan does not look, or that are too far.
        """
        begin_rad, wide_rad, per_deg = (
            values[scans, None] for values in (self.begin_rad, self.wide_rad, self.per_deg)
        )
        is_seen = (azimuth_rad - begin_rad) % (2 * np.pi) <= wide_rad
        return np.where(is_seen & (distance_m <= self.reach_m), per_deg, 0.0)


def observe_beams(scans: Iterable[tuple[FloatArray, FloatArray, FloatArray]]) -> PlanarBeams:
    """Return the field, spacing and reach of a planar sensor's beams.

    Parameters
    ----------
    scans : iterable of ((n,) float, (n, 3) float, (k,) float)
        Azimuths of each scan's returns, increasing, -pi to pi, and the ways to them from its
        sensor; and azimuths towards which it looked, too, though no return is given.
    """
    fields = []
    ranges_m = [np.zeros(FEW)]
    for azimuth_rad, way_m, further_rad in scans:
        spacing_rad = column_spacing_rad(azimuth_rad, way_m)
        if spacing_rad <= 0:
            fields.append((0.0, 0.0, 0.0))
            continue
        looked_rad = np.sort(np.concatenate([azimuth_rad, further_rad]))
        steps_rad = np.diff(looked_rad, append=looked_rad[:1] + 2 * np.pi)
        widest = int(steps_rad.argmax())
        begin_rad = looked_rad[(widest + 1) % len(looked_rad)]
        fields.append((begin_rad, 2 * np.pi - steps_rad[widest], 1 / np.rad2deg(spacing_rad)))
        ranges_m.append(np.hypot(way_m[:, 0], way_m[:, 1]))
    begin_rad, wide_rad, per_deg = np.array(fields, float).reshape(-1, 3).T
    if wide_rad.max(initial=0.0) >= 2 * np.pi - _WIDEST_RAD:
        wide_rad = np.where(per_deg > 0, 2 * np.pi, 0.0)
    reach_m = float(np.partition(np.concatenate(ranges_m), -FEW)[-FEW])
    return PlanarBeams(begin_rad, wide_rad, per_deg, reach_m)


def column_spacing_rad(azimuth_rad: FloatArray, way_m: FloatArray) -> float:
    """Return the angle between a scan's columns of rays: those of one beam, one after the other.

    Of the rays within the degree of elevation that most of them lie in, half of the directions
    between them lie in gaps up to this. Those of all beams together say nothing of it: they stand
    one above the other, or beams fire in turns and rays lie anywhere from one column to the next.

    Parameters
    ----------
    azimuth_rad : (n,) float64, increasing
    way_m : (n, 3) float64
        From the sensor to where each ray ends.

    Returns
    -------
    float
        0 where there are no two directions.
    """
    if not len(azimuth_rad):
        return 0.0
    elevation_rad = np.arctan2(way_m[:, 2], np.hypot(way_m[:, 0], way_m[:, 1]))
    # rounded, so that what is level is of one degree
    degree = np.rint(np.degrees(elevation_rad)).astype(np.int64)
    degree -= degree.min()
    steps_rad = np.sort(np.diff(azimuth_rad[degree == np.bincount(degree).argmax()]))
    steps_rad = steps_rad[steps_rad <= _WIDEST_RAD]
    turned_rad = np.cumsum(steps_rad)
    return (
        float(steps_rad[np.searchsorted(turned_rad, turned_rad[-1] / 2)]) if len(steps_rad) else 0.0
    )
