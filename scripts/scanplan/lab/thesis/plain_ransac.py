"""Iterative RANSAC as in the thesis (5.3), and limits to lift for cluster RANSAC (3.4).

The extractors of the workflow cut what these find where its points pause, and the furniture
classifier drops much of it: claims on numbers and times of walls cannot be judged by them.
"""

from dataclasses import replace

import numpy as np

from scanplan.extraction import iterative_ransac, segments
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray

PlainRansacSettings = iterative_ransac.IterativeRansacSettings

LIFTED = {
    "max_gap_m": np.inf,
    "min_length_m": 0.0,
    "min_height_m": 0.0,
    "door_height_m": 100.0,  # no storey is as high
    "corner_m": 0.0,
}
"""Limits that drop and cut nothing: with them `cluster_ransac` finds one wall a cluster."""


def extract_plain(
    scan_id: int, points: FloatArray, scan: RaySet | None, settings: PlainRansacSettings
) -> list[segments.Row]:
    """Find the upright planes of a 3-D scan.

    The plane of most points is found and its points are removed, until too few are left.

    Parameters
    ----------
    scan_id : int
    points : (n, 3) float64
        Relative to the sensor.
    scan : ray_set.RaySet, optional
        Not used: the thesis asks no ray.
    settings : PlainRansacSettings
        Only `inlier_m`, `trials`, `min_points`, `max_planes`, `max_tilt_deg` and `seed` matter. The
        thesis looks for lines and says nothing of floors: planes that are not upright are removed
        and are no walls.

    Returns
    -------
    list of tuple
        One for each plane, as `segments.cut_line` gives them.
    """
    rng = np.random.default_rng([settings.seed, scan_id])
    whole = replace(settings, **LIFTED, min_points_planar=1)
    left_m = points
    least = max(settings.min_points, 3)
    rows = []
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
            plane_m = left_m[inliers]
            across = normal[:2] / np.hypot(*normal[:2])
            offset_m = (plane_m[:, :2] @ across).mean()
            rows += segments.cut_line(across, offset_m, plane_m, whole)
        left_m = left_m[~inliers]
    return rows
