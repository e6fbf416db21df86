"""Point-to-point ICP as the thesis has it (3.2.2 and 3.5): Open3D's, on points alone."""

import numpy as np

from scanplan.geometry import se3
from scanplan.types import FloatArray


def align_points(
    source_m: FloatArray,
    target_m: FloatArray,
    start: FloatArray,
    distance_m: float,
    max_iterations: int,
) -> tuple[FloatArray, FloatArray] | None:
    """Refine a motion by the points' nearest neighbours.

    Parameters
    ----------
    source_m : (n, 3) float64
    target_m : (m, 3) float64
    start : (4, 4) float64
        target_from_source.
    distance_m : float
        Points farther apart are no pair.

    Returns
    -------
    motion : (4, 4) float64
    information : (6, 6) float64
        Inverse covariance of its error as a twist in the source's frame, of pairs that are 1 m off.
    None instead of both without pairs.
    """
    import open3d  # 1.3 s, and only this method needs it

    # with more threads sums are added up in any order, and their last bits differ
    open3d.utility.set_max_threads(1)
    registration = open3d.pipelines.registration
    source, target = (
        open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        for points in (source_m, target_m)
    )
    result = registration.registration_icp(
        source,
        target,
        distance_m,
        start,
        registration.TransformationEstimationPointToPoint(),
        registration.ICPConvergenceCriteria(max_iteration=max_iterations),
    )
    pairs = np.asarray(result.correspondence_set)
    if len(pairs) == 0:
        return None
    return se3.nearest_rigid(result.transformation), _point_information(source_m[pairs[:, 0]])


def _point_information(xyz_m: FloatArray) -> FloatArray:
    """Return the sum of J' J over points (n, 3) that a twist moves by J = [1, -[p]]."""
    n_points = len(xyz_m)
    x, y, z = xyz_m.sum(axis=0)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    second = xyz_m.T @ xyz_m
    turning = np.trace(second) * np.eye(3) - second
    return np.block([[n_points * np.eye(3), -cross], [cross, turning]])
