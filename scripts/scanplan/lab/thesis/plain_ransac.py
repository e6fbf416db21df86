"""Both extractors as the thesis describes them (3.4, 5.3), with nothing of ours: no furniture, no gaps, no lengths.

The extractors of the workflow cut what these find where its points pause, and drop much of it: they cannot tell about
claims on numbers and times of walls.
"""

import numpy as np

from scanplan.extraction import iterative_ransac

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
"""Limits of ours that drop nothing and cut nothing: with them `cluster_ransac` finds one wall a cluster."""


def extract_plain(scan_id, xyz_m, *, settings, **_):
    """Find the upright planes of a 3-D scan: that of most points, whose points are removed, until too few are left.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 3) float
    settings : Settings
        Only `inlier_m`, `trials`, `min_points`, `max_planes`, `max_tilt_deg` and `seed` matter. The thesis looks for
        lines and says nothing of floors: planes that are not upright are removed and are no walls.

    Returns
    -------
    list of (2,) float64
        Direction of each plane across the floor: the horizontal part of its normal.
    """
    rng = np.random.default_rng([settings.seed, scan_id])
    left, least, found = np.asarray(xyz_m, float), max(settings.min_points, 3), []
    for _ in range(settings.max_planes):
        if len(left) < least:
            break
        seed = int(rng.integers(2**31))
        normal, inliers = iterative_ransac.find_largest_plane(
            left, inlier_m=settings.inlier_m, trials=settings.trials, seed=seed
        )
        if inliers.sum() < least:
            break
        if abs(normal[2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)):
            found.append(normal[:2])
        left = left[~inliers]
    return found
