"""A drive through a hall, with a localiser's errors: scans, poses and the true poses."""

import numpy as np
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3


def pose(x, y, yaw_deg):
    return se3.pose_matrix([x, y, 0.4], Rotation.from_euler("z", yaw_deg, degrees=True).as_quat())


def hall(rng, planar):
    """Points of a 6 m by 4 m hall with a pillar, in the map."""
    outline = np.array([[0, 0], [6, 0], [6, 4], [0, 4], [0, 0]])
    pillar = np.array([[2, 1.5], [2.4, 1.5], [2.4, 1.9], [2, 1.9], [2, 1.5]])
    edges = np.concatenate([np.stack([p[:-1], p[1:]], 1) for p in (outline, pillar)])
    share = rng.uniform(size=(600, 1, 1))
    xy = (edges[:, 0] * (1 - share) + edges[:, 1] * share).reshape(-1, 2)
    z = np.full(len(xy), 0.4) if planar else rng.uniform(0, 2.5, len(xy))
    points = np.column_stack([xy, z])
    if not planar:
        floor = np.column_stack([rng.uniform(0, 6, 3000), rng.uniform(0, 4, 3000), np.zeros(3000)])
        points = np.concatenate([points, floor])
    return points + rng.normal(0, 0.005, points.shape) * [1, 1, not planar]


def drive(n, *, planar, noise_m=0.04, noise_deg=1.0, seed=0):
    """Scans in the sensor frame, localiser's poses, true poses."""
    rng = np.random.default_rng(seed)
    true = [pose(1 + 0.1 * i, 2.8, 3 * i) for i in range(n)]
    priors = [
        se3.pose_matrix(
            t[:3, 3] + [*rng.normal(0, noise_m, 2), 0], Rotation.from_matrix(t[:3, :3]).as_quat()
        )
        @ pose(0, 0, rng.normal(0, noise_deg))
        @ se3.invert_pose(pose(0, 0, 0))
        for t in true
    ]
    priors[0] = true[0]
    scans = [se3.transform_points(se3.invert_pose(t), hall(rng, planar)) for t in true]
    return scans, priors, true
