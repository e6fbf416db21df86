"""Whether the z of a map is up: floors, ceilings and table tops are square to it, walls along it."""

import numpy as np

from scanplan.extraction import normals
from scanplan.rays import sensor_frame

_NEAR_RAD = np.deg2rad(5)  # what normals of good surfaces scatter by
_STEEPEST = np.cos(np.deg2rad(45))  # a map that is tilted more is no case of this
_CANDIDATES = 400  # a floor alone is a tenth of all surfaces: dozens of these are its
_LEAST_TILT_DEG = 7.0  # less is within what `max_tilt_deg` forgives
_SURER = 1.5  # times the surfaces that agree with z: a ramp or a stair in view shall not warn
_SCANS = 10  # enough to see a floor somewhere
_REACH_DEG = 3.5  # as between the beams of a coarse sensor, one and a half times


def sample_scan_ids(scan_ids):
    """Return up to 10 of the scans' ids, spread evenly."""
    return [
        scan_ids[i]
        for i in np.unique(np.linspace(0, len(scan_ids) - 1, _SCANS).round().astype(int))
    ]


def tilt_warning(scans):
    """Say that a map is tilted, if its surfaces tell so.

    Parameters
    ----------
    scans : iterable of (xyz_m (n, 3), sensor_xyz_m (3,))
        3-D scans in the map.

    Returns
    -------
    str
        Empty if z is up, or nothing tells.
    """
    found, weight = [np.empty((0, 3))], [np.empty(0)]
    for xyz_m, sensor_xyz_m in scans:
        cells = normals.cut_surface_cells(
            sensor_frame.centre_on_sensor(xyz_m, sensor_xyz_m), reach_deg=_REACH_DEG
        )
        known = np.isfinite(cells.normal[:, 0])
        found.append(cells.normal[known])
        weight.append(cells.count[known])
    up = estimate_up_direction(np.concatenate(found), np.concatenate(weight))
    tilt_deg = np.rad2deg(np.arccos(min(up[2], 1.0)))
    if tilt_deg < _LEAST_TILT_DEG:
        return ""
    return (
        f"surfaces stand {tilt_deg:.0f} degrees off the map's z (up is {up[0]:.2f}, {up[1]:.2f}, {up[2]:.2f}), so that"
        " walls are missed; give poses in a map whose z is up"
    )


def estimate_up_direction(normal, weight):
    """Find the direction that most surfaces are square to or along.

    Parameters
    ----------
    normal : (n, 3) float
        Unit normals of surfaces, of either sense.
    weight : (n,) float

    Returns
    -------
    (3,) float64
        Unit vector, at most 45 degrees off z; z itself unless another is clearly better.
    """
    z = np.array([0.0, 0.0, 1.0])
    levels = np.flatnonzero(np.abs(normal[:, 2]) > _STEEPEST)
    if len(levels) == 0:
        return z
    chosen = levels[:: max(1, len(levels) // _CANDIDATES)]
    candidates = normal[chosen] * np.sign(normal[chosen, 2:])
    aligned = np.abs(candidates @ normal.T)
    support = ((aligned > np.cos(_NEAR_RAD)) | (aligned < np.sin(_NEAR_RAD))) @ weight
    best = candidates[np.argmax(support)]
    level = np.abs(normal @ best) > np.cos(_NEAR_RAD)
    best = (normal[level] * np.sign(normal[level] @ best)[:, None]).T @ weight[level]
    upright = (np.abs(normal[:, 2]) > np.cos(_NEAR_RAD)) | (
        np.abs(normal[:, 2]) < np.sin(_NEAR_RAD)
    )
    return best / np.linalg.norm(best) if support.max() > _SURER * weight[upright].sum() else z
