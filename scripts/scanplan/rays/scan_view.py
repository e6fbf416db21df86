"""The rays of one scan, by azimuth: where they cross the upright plane of a line.

Nothing is known of the sensor but its place: a ray is known by its return, a direction without any by how many the
others of its elevation have.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.rays import usual_returns

ON_M = 0.08
"""Returns no farther from a face are its own: a few times the range noise, and a face's own roughness."""

SKIRTING_M = 0.2
"""Above the floor: lower returns may be the floor's."""

CLEAR_M = 0.03
"""Above a face's edge: the noise of a height."""

_FLOOR_PERCENTILE = 1
_LEAST_M, _LEAST_RAD = 1e-6, 1e-6


@dataclass(frozen=True)
class ScanView:
    """A 3-D scan's returns by azimuth, relative to the sensor.

    Attributes
    ----------
    azimuth_rad : (n,) float64, rising
    xyz_m : (n, 3) float64
    floor_m : float
        Height of the lowest returns.
    usual : (181,) float64
        Returns that a column of 1 degree usually has below an elevation, in steps of 1 degree from -90 on.
    """

    azimuth_rad: np.ndarray
    xyz_m: np.ndarray
    floor_m: float
    usual: np.ndarray


@dataclass(frozen=True)
class PlaneCrossings:
    """Where the rays of some returns cross the upright plane of a line.

    Attributes
    ----------
    at_m, until_m : (k,) float64
        Along the line: where a ray crosses the plane, and until where it is no more than `ON_M` behind it.
    height_m : (k,) float64
        Above the floor, where it crosses the plane.
    behind, before : (k,) bool
        Whether it ends farther than `ON_M` behind the plane, or before it.
    """

    at_m: np.ndarray
    until_m: np.ndarray
    height_m: np.ndarray
    behind: np.ndarray
    before: np.ndarray


def sort_by_azimuth(xyz_m):
    """Sort a scan's points (n, 3), n >= 1, relative to the sensor, for all that looks at it."""
    azimuth_rad = np.arctan2(xyz_m[:, 1], xyz_m[:, 0])
    order = np.argsort(azimuth_rad, kind="stable")
    azimuth_rad, xyz_m = azimuth_rad[order], xyz_m[order]
    return ScanView(
        azimuth_rad,
        xyz_m,
        lowest_height(xyz_m),
        usual_returns.count_returns_below(azimuth_rad, xyz_m, 1),
    )


def lowest_height(xyz_m):
    """Return the height of the lowest returns but a few, of points (n, 3), n >= 1."""
    rank = _FLOOR_PERCENTILE * (len(xyz_m) - 1) // 100
    return np.partition(xyz_m[:, 2], rank)[rank]


def find_plane_crossings(scan, normal, offset_m, stretch_m):
    """Find where rays cross the plane of a line, whether they end before, on or behind it.

    ASSUME no wall is thinner than `ON_M`: where a ray is no farther behind the plane, there is none. Of a doorway at
    grazing incidence rays may show no more than the reveal.

    Parameters
    ----------
    scan : View
    normal : (2,) float
        Towards the sensor.
    offset_m : float
        normal . xy = offset; not positive.
    stretch_m : (2,) float
        The part of the line to look at, measured along (normal y, - normal x) from the foot of the perpendicular.

    Returns
    -------
    Crossings
    """
    away, along, distance_m = -normal, np.array([normal[1], -normal[0]]), max(-offset_m, _LEAST_M)
    start_m, end_m = (
        distance_m * away + stretch_m[0] * along,
        distance_m * away + stretch_m[1] * along,
    )
    at = select_returns_between(scan, start_m, end_m)[0]
    ahead_m, height_m = cross_plane(scan, at, away, distance_m)
    slope = (scan.xyz_m[at, :2] @ along) / np.maximum(ahead_m, _LEAST_M)
    behind, before = ahead_m > distance_m + ON_M, ahead_m < distance_m - ON_M
    at_m = slope * distance_m
    return PlaneCrossings(at_m, at_m + slope * (ON_M * behind), height_m, behind, before)


def face_plane(start_m, end_m):
    """Return the direction from the sensor square onto a face, and how far off its plane is."""
    way = (end_m - start_m) / np.hypot(*(end_m - start_m))
    away = np.array([way[1], -way[0]])
    return away, max(start_m @ away, _LEAST_M)


def select_returns_between(scan, start_m, end_m):
    """Return the returns between two directions, the first of them and the angle to the other."""
    first_rad = np.arctan2(start_m[1], start_m[0])
    span_rad = max((np.arctan2(end_m[1], end_m[0]) - first_rad) % (2 * np.pi), _LEAST_RAD)
    return _between(scan.azimuth_rad, first_rad, first_rad + span_rad), first_rad, span_rad


def cross_plane(scan, at, away, distance_m):
    """Return how far ahead returns are, and at what height above the floor their rays cross the plane."""
    ahead_m = scan.xyz_m[at, :2] @ away
    return ahead_m, scan.xyz_m[at, 2] * (distance_m / np.maximum(ahead_m, _LEAST_M)) - scan.floor_m


def _between(azimuth_rad, first_rad, last_rad):
    """Return the index, a slice if it can be, of sorted azimuths from one direction on to another, maybe beyond pi."""
    begin = np.searchsorted(azimuth_rad, first_rad, "left")
    if last_rad <= np.pi:
        return slice(begin, np.searchsorted(azimuth_rad, last_rad, "right"))
    end = np.searchsorted(azimuth_rad, last_rad - 2 * np.pi, "right")
    return np.concatenate([np.arange(begin, len(azimuth_rad)), np.arange(end)])
