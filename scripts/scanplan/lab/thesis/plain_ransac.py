"""Both extractors as the thesis describes them (3.4, 5.3): no furniture, no gaps, no lengths.

The extractors of the workflow cut what these find where its points pause, and drop much of it:
claims on numbers and times of walls cannot be judged by them.
"""

from typing import Any

import numpy as np

from scanplan.extraction import iterative_ransac
from scanplan.types import FloatArray

PlainRansacSettings = iterative_ransac.IterativeRansacSettings

_ANY = (
    "max_gap_m",
    "door_height_m",
    "max_rmse_m",
    "hang_height_m",
    "over_share",
    "through_share",
    "missing_share",
)
_SMALL = (
    "min_length_m",
    "min_height_m",
    "furniture_depth_m",
    "furniture_length_m",
    "stub_length_m",
)
LIFTED = {
    **dict.fromkeys(_ANY, np.inf),
    **dict.fromkeys(("wall_height_m", "furniture_height_m"), -np.inf),
    **dict.fromkeys((*_SMALL, "door_width_m", "corner_m"), 0.0),
}
"""Limits that drop and cut nothing: with them `cluster_ransac` finds one wall a cluster."""


def extract_plain(
    scan_id: int, xyz_m: FloatArray, *, settings: PlainRansacSettings, **_unused: Any
) -> list[FloatArray]:
    """Find the upright planes of a 3-D scan.

    The plane of most points is found and its points are removed, until too few are left.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 3) float
    settings : PlainRansacSettings
        Only `inlier_m`, `trials`, `min_points`, `max_planes`, `max_tilt_deg` and `seed` matter. The
        thesis looks for lines and says nothing of floors: planes that are not upright are removed
        and are no walls.

    Returns
    -------
    list of (2,) float64
        Direction of each plane across the floor: the horizontal part of its normal.
    """
    rng = np.random.default_rng([settings.seed, scan_id])
    left_m = np.asarray(xyz_m, float)
    least = max(settings.min_points, 3)
    directions = []
    for _ in range(settings.max_planes):
        if len(left_m) < least:
            break
        seed = int(rng.integers(2**31))
        normal, inliers = iterative_ransac.find_largest_plane(
            left_m, inlier_m=settings.inlier_m, trials=settings.trials, seed=seed
        )
        if inliers.sum() < least:
            break
        if abs(normal[2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)):
            directions.append(normal[:2])
        left_m = left_m[~inliers]
    return directions
