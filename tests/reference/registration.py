"""The thesis's algorithm 3, written literally with Open3D, in two readings.

"The previous 5" are the last scans retained, or the last frames. The oracle in tests and the
denominator in benchmarks.
"""

import numpy as np
import open3d as o3d

from scanplan.geometry import se3


def interpolate_linearly(pose_t_ns, pose_xyz_m, scan_t_ns):
    """Step 1: positions linearly interpolated at the scans' stamps."""
    return np.column_stack(
        [np.interp(scan_t_ns, pose_t_ns, axis) for axis in np.asarray(pose_xyz_m, float).T]
    )


def register(
    scans, poses, *, keep_every, distance_m, min_prior_fitness, min_refined_fitness, n_previous=5
):
    """Steps 2 to 6 with the previous scans that were retained: one pass, full clouds.

    Parameters
    ----------
    scans : sequence of (n, 3) float
        Points in the sensor frame.
    poses : sequence of (4, 4) float
        The localiser's world_from_sensor at each scan.
    keep_every, distance_m, min_prior_fitness, min_refined_fitness, n_previous
        The algorithm's numbers.

    Returns
    -------
    dict of int to (4, 4) float
        world_from_sensor of every retained scan, by its index.
    """
    retained = {}
    previous = []
    for index in range(0, len(scans), keep_every):
        placed = _cloud(se3.transform_points(poses[index], scans[index]))
        if previous:
            if _mean_fitness(placed, previous[-n_previous:], distance_m) < min_prior_fitness:
                continue
            result = _align(placed, previous[-1], distance_m)
            placed.transform(result.transformation)
            if _mean_fitness(placed, previous[-n_previous:], distance_m) < min_refined_fitness:
                continue
            retained[index] = result.transformation @ poses[index]
        else:
            retained[index] = np.array(poses[index])
        previous.append(placed)
    return retained


def register_by_frames(
    scans,
    poses,
    *,
    keep_every,
    distance_m,
    icp_distance_m,
    min_prior_fitness,
    min_refined_fitness,
    n_previous=5,
):
    """Steps 2 to 6 with the previous frames, retained or not, in two passes.

    The parameters are those of `register`; pairs of the ICP are nearer than `icp_distance_m`. The
    first frame has none before it and is retained.

    Returns
    -------
    passed : list of int
        The scans that the first pass leaves, by their index.
    retained : dict of int to (4, 4) float
        Those that the second one leaves, and their world_from_sensor.
    """
    chosen = range(0, len(scans), keep_every)
    frames = [_cloud(se3.transform_points(poses[index], scans[index])) for index in chosen]
    passes = [
        row == 0
        or _mean_fitness(frames[row], frames[max(0, row - n_previous) : row], distance_m)
        >= min_prior_fitness
        for row in range(len(frames))
    ]
    retained = {}
    for row, index in enumerate(chosen):
        if not passes[row]:
            continue
        if row == 0:
            retained[index] = np.array(poses[index])
            continue
        result = _align(frames[row], frames[row - 1], icp_distance_m)
        frames[row].transform(result.transformation)
        before = frames[max(0, row - n_previous) : row]
        if _mean_fitness(frames[row], before, distance_m) >= min_refined_fitness:
            retained[index] = result.transformation @ poses[index]
    return [index for index, is_left in zip(chosen, passes, strict=True) if is_left], retained


def _align(source, target, distance_m):
    return o3d.pipelines.registration.registration_icp(
        source,
        target,
        distance_m,
        np.eye(4),
        o3d.pipelines.registration.TransformationEstimationPointToPoint(),
    )


def _mean_fitness(source, targets, distance_m):
    evaluate = o3d.pipelines.registration.evaluate_registration
    return np.mean([evaluate(source, target, distance_m, np.eye(4)).fitness for target in targets])


def _cloud(xyz_m):
    return o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.asarray(xyz_m, float)))
