"""Whether the z of a map is up.

Floors, ceilings and table tops are square to it, walls along it.
"""

from collections.abc import Iterable

import numpy as np

from scanplan.extraction import normals
from scanplan.extraction.segment_limits import DIAGONAL
from scanplan.rays import sensor_frame
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import Array, BoolArray, FloatArray

_NEAR_RAD = np.deg2rad(5)  # what normals of good surfaces scatter by: less is no tilt
_CANDIDATES = 400  # a floor alone is a tenth of all surfaces: dozens of these are its
_SURER = 1.5  # times the surfaces that agree with z: a ramp or a stair in view shall not warn


def sample_scan_ids(scan_ids: list[int], most: int = 10) -> list[int]:
    """Return up to `most` of the scans' ids, spread evenly: enough to see a floor somewhere."""
    places = np.linspace(0, len(scan_ids) - 1, most).round().astype(int)
    return [scan_ids[i] for i in np.unique(places)]


def measure_tilt(
    scans: Iterable[tuple[FloatArray, FloatArray]], reach_deg: float = 3.5
) -> Measured:
    """Return the tilt of a map's z by its surfaces; 0 where too few are seen.

    Parameters
    ----------
    scans : iterable of (xyz_m (n, 3), sensor_xyz_m (3,))
        3-D scans in the map.
    reach_deg : float
        Half-width of a normal's neighbourhood: one and a half times what is between the beams of a
        coarse sensor.
    """
    normal: list[FloatArray] = [np.empty((0, 3))]
    weight: list[Array] = [np.empty(0)]
    for xyz_m, sensor_xyz_m in scans:
        points = sensor_frame.centre_in_order(xyz_m, sensor_xyz_m)
        cells = normals.cut_surface_cells(points, reach_deg=reach_deg)
        has_normal = np.isfinite(cells.normal[:, 0])
        normal.append(cells.normal[has_normal])
        weight.append(cells.count[has_normal])
    up = estimate_up_direction(np.concatenate(normal), np.concatenate(weight))
    tilt_deg = float(np.rad2deg(np.arccos(min(up[2], 1.0))))
    return state_witness("tilt", tilt_deg, up=", ".join(f"{part:.2f}" for part in up))


def estimate_up_direction(normal: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the direction that most surfaces are square to or along.

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
    levels = np.flatnonzero(np.abs(normal[:, 2]) > DIAGONAL)
    upright = _is_square_or_along(np.abs(normal[:, 2]))
    agreeing = _SURER * weight[upright].sum()
    # nothing can be clearly better than what most agree with
    if len(levels) == 0 or not weight.sum() > agreeing:
        return z
    chosen = levels[:: max(1, len(levels) // _CANDIDATES)]
    candidates = normal[chosen] * np.sign(normal[chosen, 2:])
    support = _is_square_or_along(np.abs(candidates @ normal.T)) @ weight
    if not support.max() > agreeing:
        return z
    best = candidates[np.argmax(support)]
    level = np.abs(normal @ best) > np.cos(_NEAR_RAD)
    mean = (normal[level] * np.sign(normal[level] @ best)[:, None]).T @ weight[level]
    return mean / np.linalg.norm(mean)


def _is_square_or_along(cosine: FloatArray) -> BoolArray:
    """Return which surfaces are square to a direction or along it, by normals' cosines with it."""
    return (cosine > np.cos(_NEAR_RAD)) | (cosine < np.sin(_NEAR_RAD))
