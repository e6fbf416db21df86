"""Wall extraction by RANSAC with removal of inliers (thesis, section 5.3 and algorithm 4)."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import segments
from scanplan.extraction.segment_limits import MAX_TILT_DEG, SegmentLimits, SegmentRow
from scanplan.geometry import ransac
from scanplan.geometry.consensus import MODELS
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray


@dataclass(frozen=True, kw_only=True)
class IterativeRansacSettings(SegmentLimits):
    """How walls are extracted, beside what a wall segment must be (`SegmentLimits`).

    Attributes
    ----------
    max_tilt_deg : float
        Largest angle between a wall's normal and the horizontal.
    trials : int
        Planes (planar scans: lines) tried in each round.
    max_planes : int
        Largest number of rounds.
    """

    max_tilt_deg: float = MAX_TILT_DEG
    trials: int = 200  # a plane of a third of the points is missed once in 1,900 times
    max_planes: int = 20  # a room with its niches has fewer


def extract_iteratively(
    scan_id: int, points: FloatArray, scan: RaySet | None, settings: IterativeRansacSettings
) -> list[SegmentRow]:
    """Extract the wall segments of one scan.

    Find the plane (planar scans: the line) most points lie on, remove them, and repeat until it
    holds too few. Upright planes are walls, where their points do not pause; floors and ceilings
    are removed alike.

    Parameters
    ----------
    scan_id : int
        Random draws depend on it.
    points : (n, 3) float64
        The scan's points relative to its sensor, as `sensor_frame.centre_in_order` returns them.
    scan : ray_set.RaySet, optional
        Its rays; None in the plane.

    Returns
    -------
    list of tuple
        As `segments.cut_line` returns them: walls and furniture alike.
    """
    planar = scan is None
    fit_largest = _fit_largest_line if planar else _fit_largest_plane
    least = max(settings.least_points(planar), MODELS["plane"])
    rng = np.random.default_rng([settings.seed, scan_id])
    rest = points
    rows: list[SegmentRow] = []
    for _ in range(settings.max_planes):
        if len(rest) < least:
            break
        upright, inliers = fit_largest(rest, settings, rng)
        if inliers.sum() < least:
            break
        on_plane = rest[inliers]
        extent_m = np.hypot(*np.ptp(on_plane[:, :2], axis=0))
        if upright and extent_m >= settings.min_length_m:
            normal, offset_m = ransac.fit_line_tls(on_plane[:, :2])
            rows += segments.cut_line(normal, offset_m, on_plane, settings, scan=scan)
        rest = rest[~inliers]
    return rows


def find_largest_plane(
    xyz_m: FloatArray, *, inlier_m: float, trials: int, seed: int
) -> tuple[FloatArray, BoolArray]:
    """Find the plane most points lie on (thesis, algorithm 4).

    Parameters
    ----------
    xyz_m : (n, 3) float, n >= 3
    trials : int
        All are made: stopping early would depend on the number of cores.

    Returns
    -------
    normal : (3,) float64
    inliers : (n,) bool
    """
    import open3d  # 1.3 s, and only this function needs it

    open3d.utility.set_max_threads(1)
    open3d.utility.random.seed(seed)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz_m))
    plane, index = cloud.segment_plane(inlier_m, ransac_n=3, num_iterations=trials, probability=1.0)
    inliers = np.zeros(len(xyz_m), bool)
    inliers[index] = True
    return plane[:3], inliers


def _fit_largest_line(
    xyz_m: FloatArray, settings: IterativeRansacSettings, rng: np.random.Generator
) -> tuple[bool, BoolArray]:
    """Return true, a planar scan's lines being upright, and the points (n,) of the largest."""
    _, _, inliers = ransac.fit_line_ransac(
        xyz_m[:, :2], inlier_m=settings.inlier_m, trials=settings.trials, rng=rng
    )
    return True, inliers


def _fit_largest_plane(
    xyz_m: FloatArray, settings: IterativeRansacSettings, rng: np.random.Generator
) -> tuple[bool, BoolArray]:
    """Return whether the largest plane is upright, and its points (n,)."""
    seed = int(rng.integers(2**31))
    normal, inliers = find_largest_plane(
        xyz_m, inlier_m=settings.inlier_m, trials=settings.trials, seed=seed
    )
    return bool(abs(normal[2]) <= np.sin(np.deg2rad(settings.max_tilt_deg))), inliers
