"""Whether turns smear scans whose points carry no times, as surfaces there show.

A sensor that measures all points of a scan at once, or clouds that are free of motion already, lie
on one another in turns as well as elsewhere; what a sensor sees one after the other does not.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from scanplan.geometry import plane_scatter, se3
from scanplan.recordings.motion import pose_kind, time_check
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey_protocol import Survey
from scanplan.types import FloatArray, IntArray

_NEAR_NS = 100_000_000  # a sweep of a tenth of a second lies before its stamp or after it
_CALM_RAD_S = np.radians(5)  # half a degree in a sweep: a wall bends by as much as ranges err
_TURNING_RAD_S = np.radians(10)  # twice that, on average over a window
_FEWEST, _MOST = 3, 8  # windows of either kind
_FEWEST_SCANS = 4  # of a window: one may have no points, and two are off together
_PLACES_A_WINDOW = 200
_SEED = 1  # of the choice of places


def measure_smear_mm(survey: Survey, motion: SensorMotion) -> float:
    """Return by how many millimetres surfaces are thicker in turns than elsewhere.

    NaN where points carry times that are used, poses drift, or too few windows are calm or turning.
    """
    is_moved = survey.sweep_times is not None and motion.time_scale > 0
    if survey.pose_kind != pose_kind.LOCALISER or is_moved:
        return np.nan
    t_ns = survey.stamps()
    turn_rad_s = _turn_rates(t_ns, motion)
    windows = [w for w in time_check.list_windows(t_ns) if len(w) >= _FEWEST_SCANS]
    rates = [float(turn_rad_s[window].mean()) for window in windows]
    order = [i for i in np.argsort(rates, kind="stable").tolist() if np.isfinite(rates[i])]
    calm = [windows[i] for i in order[:_MOST] if rates[i] < _CALM_RAD_S]
    turning = [windows[i] for i in order[-_MOST:] if rates[i] >= _TURNING_RAD_S]
    if min(len(calm), len(turning)) < _FEWEST:
        return np.nan
    as_recorded = replace(motion, time_scale=0.0)
    thick_m, thin_m = (_measure_thickness(survey, w, as_recorded) for w in (turning, calm))
    return 1000 * (thick_m - thin_m)


def _turn_rates(t_ns: IntArray, motion: SensorMotion) -> FloatArray:
    """Return how fast the sensor turned around some times (n,), radians a second; NaN unknown."""
    around = np.column_stack([t_ns - _NEAR_NS, t_ns + _NEAR_NS]).ravel()
    step = motion.steps(around)[::2]
    return se3.turn_between_rad(np.eye(4), step) / (2 * _NEAR_NS / 1e9)


def _measure_thickness(survey: Survey, windows: Sequence[IntArray], motion: SensorMotion) -> float:
    """Return the median scatter across surfaces in windows; NaN if there is nothing to measure."""
    found_m = []
    for spread in map(time_check.spread_scans, windows):
        scans = [time_check.thin_scan(scan) for scan in survey.scans(spread.tolist())]
        filled = [scan for scan in scans if len(scan.xyz_m)]
        xyz_m = time_check.merge_scans(filled, motion) if filled else None
        if xyz_m is None:
            continue
        owners = np.concatenate([np.full(len(scan.xyz_m), scan.scan_id) for scan in filled])
        places = plane_scatter.measure_map_scatter(
            xyz_m, owners, planar=survey.planar, seed=_SEED, most_places=_PLACES_A_WINDOW
        )
        found_m.append(places.median_m)
    return float(np.nanmedian(found_m)) if np.isfinite(found_m).any() else np.nan
