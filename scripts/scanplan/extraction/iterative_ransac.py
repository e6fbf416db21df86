"""Wall extraction by RANSAC with removal of inliers (thesis, section 5.3 and algorithm 4)."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import furniture, segments
from scanplan.geometry import ransac
from scanplan.rays import sensor_frame


@dataclass(frozen=True, kw_only=True)
class IterativeRansacSettings(segments.SegmentLimits):
    """How walls are found, beside what a wall segment must be (`segments.SegmentLimits`).

    Attributes
    ----------
    max_tilt_deg : float
        Largest angle between a wall's normal and the horizontal.
    trials : int
        Planes (planar scans: lines) tried in each round.
    max_planes : int
        Largest number of rounds.
    """

    max_tilt_deg: float
    trials: int
    max_planes: int


def extract_iteratively(scan_id, xyz_m, *, sensor_xyz_m, planar, settings):
    """Find the wall segments of one scan.

    Find the plane (planar scans: the line) most points lie on, remove them, and repeat until it holds too few. Upright
    planes are walls, where their points do not pause; floors and ceilings are removed alike.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 3) float
        The scan's points, map frame; their order does not matter.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.
    planar : bool
        Whether all points are in one horizontal plane.
    settings : Settings

    Returns
    -------
    segments.WallSegments

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    points = left = sensor_frame.centre_on_sensor(xyz_m, sensor_xyz_m)
    scan = segments.view_scan(points, planar=planar)
    largest = _largest_line if planar else _largest_plane
    least = max(settings.least_points(planar), 3)
    rng = np.random.default_rng([settings.seed, scan_id])
    rows = []
    for _ in range(settings.max_planes):
        if len(left) < least:
            break
        upright, inliers = largest(left, settings, rng)
        if inliers.sum() < least:
            break
        found = left[inliers]
        if upright and np.hypot(*np.ptp(found[:, :2], axis=0)) >= settings.min_length_m:
            rows += segments.cut_line(
                *ransac.fit_line_tls(found[:, :2]), found, settings, scan=scan
            )
        left = left[~inliers]
    return segments.collect_segments(furniture.keep_walls(rows, scan, settings), sensor_xyz_m)


def find_largest_plane(xyz_m, *, inlier_m, trials, seed):
    """Find the plane most points lie on (thesis, algorithm 4).

    Parameters
    ----------
    xyz_m : (n, 3) float, n >= 3
    inlier_m : float
    trials : int
        All are made: stopping early would depend on the number of cores.
    seed : int

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


def _largest_line(xyz_m, settings, rng):
    inliers = ransac.fit_line_ransac(
        xyz_m[:, :2], inlier_m=settings.inlier_m, trials=settings.trials, rng=rng
    )[2]
    return True, inliers


def _largest_plane(xyz_m, settings, rng):
    seed = int(rng.integers(2**31))
    normal, inliers = find_largest_plane(
        xyz_m, inlier_m=settings.inlier_m, trials=settings.trials, seed=seed
    )
    return abs(normal[2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)), inliers
