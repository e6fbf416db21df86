"""What the rays of a scan tell of a face: which end on it, which pass over it, and which never came back."""

from dataclasses import dataclass

import numpy as np

from scanplan.rays import scan_view, usual_returns

_COLUMN_RAD = np.deg2rad(1.0)
BEHIND_M = 0.15  # a return farther behind a face is not its own
_STRETCH_M = 0.3  # of a face's length: less may be a return of something else
_GOOD_PART = 0.15  # of a face's length, likewise
_EDGES_M = np.arange(0.4, 2.3, 0.1)  # heights that furniture may end at
_EDGE_ON_RAD = np.deg2rad(89.5)
_LEAST_M = 1e-6


@dataclass(frozen=True)
class FaceSight:
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


def observe_face(scan, start_m, end_m, low_m, high_m):
    """Tell how a scan's rays meet a face.

    Parameters
    ----------
    scan : scan_view.ScanView
    start_m, end_m : (2,) float
        The face, the sensor (the origin) to the left of the way.
    low_m, high_m : float
        Heights of its returns, relative to the sensor.

    Returns
    -------
    Sight
    """
    away, distance_m = scan_view.face_plane(start_m, end_m)
    at, first_rad, span_rad = scan_view.select_returns_between(scan, start_m, end_m)
    ahead_m, height_m = scan_view.cross_plane(scan, at, away, distance_m)
    beyond = ahead_m > distance_m + BEHIND_M
    # at grazing incidence, what is a little behind the plane was met well beyond the face
    slant = ahead_m / np.maximum(np.hypot(scan.xyz_m[at, 0], scan.xyz_m[at, 1]), _LEAST_M)
    on = np.abs(ahead_m - distance_m) <= np.clip(
        _STRETCH_M * slant, scan_view.CLEAR_M, scan_view.ON_M
    )
    if not on.any():
        return FaceSight(0.0, 0.0, 0.0, 0.0)
    n_columns = max(1, round(span_rad / _COLUMN_RAD))
    column = ((scan.azimuth_rad[at] - first_rad) % (2 * np.pi) * (n_columns / span_rad)).astype(
        np.int64
    )
    column = np.minimum(column, n_columns - 1)
    square_rad = (first_rad - np.arctan2(away[1], away[0]) + np.pi) % (2 * np.pi) - np.pi
    edges_rad = np.clip(
        square_rad + span_rad / n_columns * np.arange(n_columns + 1), -_EDGE_ON_RAD, _EDGE_ON_RAD
    )
    length_m = np.diff(distance_m * np.tan(edges_rad))
    met_m, passed_m = (
        _highest(column, height_m, on, n_columns),
        _highest(column, height_m, beyond, n_columns),
    )
    top_m = _top(met_m, length_m)
    raised = height_m > scan_view.SKIRTING_M
    through = (beyond & raised & (height_m < top_m)).sum() / max((on & raised).sum(), 1)
    inside = (height_m >= low_m - scan.floor_m) & (height_m <= high_m - scan.floor_m)
    returns = np.bincount(column[inside], minlength=n_columns)
    missing = _missing(scan, returns, edges_rad, distance_m, (low_m, high_m))
    return FaceSight(top_m, _over(met_m, passed_m, length_m), through, missing)


def gap_leads_on(scan, start_m, end_m, depth_m):
    """Tell whether a gap in a wall leads on, as a door does, and not into a niche or between two cabinets.

    Parameters
    ----------
    scan : scan_view.ScanView
    start_m, end_m : (2,) float
        The gap, the sensor to the left of the way.
    depth_m : float
        A niche is no deeper.

    Returns
    -------
    bool
        Whether a good part of the rays through it get deeper; true if there are none.
    """
    away, distance_m = scan_view.face_plane(start_m, end_m)
    at, _, _ = scan_view.select_returns_between(scan, start_m, end_m)
    ahead_m, height_m = scan_view.cross_plane(scan, at, away, distance_m)
    behind_m = (ahead_m - distance_m)[
        (height_m > scan_view.SKIRTING_M) & (ahead_m > distance_m + BEHIND_M)
    ]
    return not len(behind_m) or np.mean(behind_m > depth_m) > _GOOD_PART


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
    free = (passed_m > _EDGES_M[:, None] + scan_view.CLEAR_M) & ~met & np.isfinite(met_m)
    met, free = met @ length_m, free @ length_m
    enough = free >= max(_STRETCH_M, _GOOD_PART * length_m.sum())
    return np.max(free[enough] / (free + met)[enough], initial=0.0)


def _missing(scan, returns, edges_rad, distance_m, heights_m):
    """Return the share of the usual returns between two heights that are not there, by columns (n,) of returns."""
    middle_rad = (edges_rad[1:] + edges_rad[:-1]) / 2
    seen = np.abs(middle_rad) < usual_returns.GRAZING_RAD
    elevation_deg = (
        np.rad2deg(np.arctan2(np.array(heights_m)[:, None] * np.cos(middle_rad), distance_m)) + 90
    )
    low, high = np.interp(elevation_deg, np.arange(len(scan.usual)), scan.usual)
    usual = ((high - low) * np.diff(edges_rad) / _COLUMN_RAD)[seen].sum()
    return max(0.0, 1 - returns[seen].sum() / usual) if usual > 0 else 0.0
