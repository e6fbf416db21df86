"""What the rays of a scan tell of a face: which end on it, which pass over it, and which never came back.

Nothing is known of the sensor but its place: a ray is known by its return, a direction without any by how many the
others of its elevation have.
"""

from dataclasses import dataclass

import numpy as np

_COLUMN_RAD = np.deg2rad(1.0)
_N_SECTORS = 72
_SECTOR_RAD = 2 * np.pi / _N_SECTORS  # wider than what is between two firings
_N_ROWS = 180  # elevations, in steps of 1 degree from -90 on
_FLOOR_PERCENTILE = 1
ON_M = 0.08  # from the face: a few times the range noise, and a face's own roughness
BEHIND_M = 0.15  # a return farther behind a face is not its own
CLEAR_M = 0.03  # above a face's edge: the noise of a height
SKIRTING_M = 0.2  # above the floor: lower returns may be the floor's
_STRETCH_M = 0.3  # of a face's length: less may be a return of something else
_GOOD_PART = 0.15  # of a face's length, likewise
_EDGES_M = np.arange(0.4, 2.3, 0.1)  # heights that furniture may end at
_LEAST_M = 1e-6
_EDGE_ON_RAD = np.deg2rad(89.5)
_GRAZING_RAD = np.deg2rad(75)  # from here on returns get lost


@dataclass(frozen=True)
class View:
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
class Crossings:
    """Where the rays of some returns cross the upright plane of a line.

    Attributes
    ----------
    within_m : (2, k) float64
        The stretch along the line in which a ray is in the plane or no more than `ON_M` behind it: least, most.
    height_m : (k,) float64
        Above the floor, where it crosses the plane.
    behind, before : (k,) bool
        Whether it ends farther than `ON_M` behind the plane, or before it.
    """

    within_m: np.ndarray
    height_m: np.ndarray
    behind: np.ndarray
    before: np.ndarray


@dataclass(frozen=True)
class Sight:
    """How the rays meet a face.

    Attributes
    ----------
    top_m : float
        Height above the floor up to which it is seen over a good stretch.
    over : float
        How surely it ends at some height: the share of what rays cross above that height, by length, where they meet
        something behind. 0 where no rays cross above it.
    through : float
        Rays that pass below its top and meet something behind, per ray that meets the face.
    missing : float
        Share of the returns usual within its outline that are none at all; 0 where it is seen at grazing angles only.
    """

    top_m: float
    over: float
    through: float
    missing: float


def view(xyz_m):
    """Sort a scan's points (n, 3), n >= 1, relative to the sensor, for `look`."""
    azimuth_rad = np.arctan2(xyz_m[:, 1], xyz_m[:, 0])
    order = np.argsort(azimuth_rad, kind="stable")
    azimuth_rad, xyz_m = azimuth_rad[order], xyz_m[order]
    return View(azimuth_rad, xyz_m, floor(xyz_m), _usual(azimuth_rad, xyz_m))


def floor(xyz_m):
    """Return the height of the lowest returns but a few, of points (n, 3), n >= 1."""
    rank = _FLOOR_PERCENTILE * (len(xyz_m) - 1) // 100
    return np.partition(xyz_m[:, 2], rank)[rank]


def look(scan, start_m, end_m, low_m, high_m):
    """Tell how a scan's rays meet a face.

    Parameters
    ----------
    scan : View
    start_m, end_m : (2,) float
        The face, the sensor (the origin) to the left of the way.
    low_m, high_m : float
        Heights of its returns, relative to the sensor.

    Returns
    -------
    Sight
    """
    away, distance_m = _plane(start_m, end_m)
    at, first_rad, span_rad = _towards(scan, start_m, end_m)
    ahead_m, height_m = _crossing(scan, at, away, distance_m)
    beyond = ahead_m > distance_m + BEHIND_M
    # at grazing incidence, what is a little behind the plane was met well beyond the face
    slant = ahead_m / np.hypot(scan.xyz_m[at, 0], scan.xyz_m[at, 1])
    on = np.abs(ahead_m - distance_m) <= np.clip(_STRETCH_M * slant, CLEAR_M, ON_M)
    if not on.any():
        return Sight(0.0, 0.0, 0.0, 0.0)
    n_columns = max(1, round(span_rad / _COLUMN_RAD))
    column = ((scan.azimuth_rad[at] - first_rad) % (2 * np.pi) * (n_columns / span_rad)).astype(np.int64)
    column = np.minimum(column, n_columns - 1)
    square_rad = (first_rad - np.arctan2(away[1], away[0]) + np.pi) % (2 * np.pi) - np.pi
    edges_rad = np.clip(square_rad + span_rad / n_columns * np.arange(n_columns + 1), -_EDGE_ON_RAD, _EDGE_ON_RAD)
    length_m = np.diff(distance_m * np.tan(edges_rad))
    met_m, passed_m = _highest(column, height_m, on, n_columns), _highest(column, height_m, beyond, n_columns)
    top_m = _top(met_m, length_m)
    raised = height_m > SKIRTING_M
    through = (beyond & raised & (height_m < top_m)).sum() / max((on & raised).sum(), 1)
    inside = (height_m >= low_m - scan.floor_m) & (height_m <= high_m - scan.floor_m)
    returns = np.bincount(column[inside], minlength=n_columns)
    missing = _missing(scan, returns, edges_rad, distance_m, (low_m, high_m))
    return Sight(top_m, _over(met_m, passed_m, length_m), through, missing)


def crossings(scan, normal, offset_m, stretch_m):
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
    start_m, end_m = distance_m * away + stretch_m[0] * along, distance_m * away + stretch_m[1] * along
    at = _towards(scan, start_m, end_m)[0]
    ahead_m, height_m = _crossing(scan, at, away, distance_m)
    slope = (scan.xyz_m[at, :2] @ along) / np.maximum(ahead_m, _LEAST_M)
    behind, before = ahead_m > distance_m + ON_M, ahead_m < distance_m - ON_M
    at_m = slope * distance_m
    deep_m = at_m + slope * (ON_M * behind)
    return Crossings(np.stack([np.minimum(at_m, deep_m), np.maximum(at_m, deep_m)]), height_m, behind, before)


def leads_on(scan, start_m, end_m, depth_m):
    """Tell whether a gap in a wall leads on, as a door does, and not into a niche or between two cabinets.

    Parameters
    ----------
    scan : View
    start_m, end_m : (2,) float
        The gap, the sensor to the left of the way.
    depth_m : float
        A niche is no deeper.

    Returns
    -------
    bool
        Whether a good part of the rays through it get deeper; true if there are none.
    """
    away, distance_m = _plane(start_m, end_m)
    at, _, _ = _towards(scan, start_m, end_m)
    ahead_m, height_m = _crossing(scan, at, away, distance_m)
    behind_m = (ahead_m - distance_m)[(height_m > SKIRTING_M) & (ahead_m > distance_m + BEHIND_M)]
    return not len(behind_m) or np.mean(behind_m > depth_m) > _GOOD_PART


def _plane(start_m, end_m):
    """Return the direction from the sensor square onto a face, and how far off its plane is."""
    way = (end_m - start_m) / np.hypot(*(end_m - start_m))
    away = np.array([way[1], -way[0]])
    return away, max(start_m @ away, _LEAST_M)


def _towards(scan, start_m, end_m):
    """Return the returns between two directions, the first of them and the angle to the other."""
    first_rad = np.arctan2(start_m[1], start_m[0])
    span_rad = max((np.arctan2(end_m[1], end_m[0]) - first_rad) % (2 * np.pi), 1e-6)
    return _between(scan.azimuth_rad, first_rad, first_rad + span_rad), first_rad, span_rad


def _crossing(scan, at, away, distance_m):
    """Return how far ahead returns are, and at what height above the floor their rays cross the plane."""
    ahead_m = scan.xyz_m[at, :2] @ away
    return ahead_m, scan.xyz_m[at, 2] * (distance_m / np.maximum(ahead_m, _LEAST_M)) - scan.floor_m


def _highest(column, height_m, chosen, n_columns):
    """Return the highest of the chosen heights in each column; minus infinity where there is none."""
    highest_m = np.full(n_columns, -np.inf)
    np.maximum.at(highest_m, column[chosen], height_m[chosen])
    return highest_m


def _top(met_m, length_m):
    """Return the height up to which a face is seen over `_STRETCH_M` of its length and in two columns, or anywhere."""
    order = np.argsort(-met_m, kind="stable")
    order = order[np.isfinite(met_m[order])]
    enough = np.searchsorted(np.cumsum(length_m[order]), _STRETCH_M)
    # the return of something else at an end may be all that a column has, which is long where it is seen at grazing
    return met_m[order[min(max(enough, 1), len(order) - 1)]]


def _over(met_m, passed_m, length_m):
    """Return how surely a face ends at some height: the share, by length, of what rays cross above it that is free.

    Of all heights at which a good part of the face is free, the one that divides best.
    """
    met = met_m > _EDGES_M[:, None]
    free = (passed_m > _EDGES_M[:, None] + CLEAR_M) & ~met & np.isfinite(met_m)
    met, free = met @ length_m, free @ length_m
    enough = free >= max(_STRETCH_M, _GOOD_PART * length_m.sum())
    return np.max(free[enough] / (free + met)[enough], initial=0.0)


def _missing(scan, returns, edges_rad, distance_m, heights_m):
    """Return the share of the usual returns between two heights that are not there, by columns (n,) of returns."""
    middle_rad = (edges_rad[1:] + edges_rad[:-1]) / 2
    seen = np.abs(middle_rad) < _GRAZING_RAD
    elevation_deg = np.rad2deg(np.arctan2(np.array(heights_m)[:, None] * np.cos(middle_rad), distance_m)) + 90
    low, high = np.interp(elevation_deg, np.arange(_N_ROWS + 1), scan.usual)
    usual = ((high - low) * np.diff(edges_rad) / _COLUMN_RAD)[seen].sum()
    return max(0.0, 1 - returns[seen].sum() / usual) if usual > 0 else 0.0


def _usual(azimuth_rad, xyz_m):
    """Return the running sums of returns by elevation, per degree of azimuth around which there are any."""
    sector = np.minimum(((azimuth_rad + np.pi) / _SECTOR_RAD).astype(np.int64), _N_SECTORS - 1)
    seen_deg = np.count_nonzero(np.bincount(sector)) * np.rad2deg(_SECTOR_RAD)
    elevation_rad = np.arctan2(xyz_m[:, 2], np.hypot(xyz_m[:, 0], xyz_m[:, 1]))
    row = np.clip(np.rad2deg(elevation_rad) + _N_ROWS / 2, 0, _N_ROWS - 1).astype(np.int64)
    return np.concatenate([[0], np.cumsum(np.bincount(row, minlength=_N_ROWS))]) / seen_deg


def _between(azimuth_rad, first_rad, last_rad):
    """Return the index, a slice if it can be, of sorted azimuths from one direction on to another, maybe beyond pi."""
    begin = np.searchsorted(azimuth_rad, first_rad, "left")
    if last_rad <= np.pi:
        return slice(begin, np.searchsorted(azimuth_rad, last_rad, "right"))
    end = np.searchsorted(azimuth_rad, last_rad - 2 * np.pi, "right")
    return np.concatenate([np.arange(begin, len(azimuth_rad)), np.arange(end)])
