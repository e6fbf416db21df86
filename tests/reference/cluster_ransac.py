"""Section 3.4 of the thesis, literally.

Normals, projection along them, mean shift, one RANSAC per cluster.
"""

import numpy as np
from sklearn.cluster import MeanShift

from reference.ransac import ransac


def lines(xyz, *, reach_deg, max_tilt_deg, bandwidth_m, inlier_m, min_points, rng, max_trials):
    """Return the (normal, offset) in the floor plan of one line per cluster.

    Points relative to the sensor.
    """
    on_wall, projected = [], []
    for p in xyz:
        normal = surface_normal(p, xyz, reach_deg)
        if normal is None or abs(normal[2]) > np.sin(np.deg2rad(max_tilt_deg)):
            continue
        flat = normal[:2] / np.linalg.norm(normal[:2])
        on_wall.append(p[:2])
        projected.append((p[:2] @ flat) * flat)
    on_wall, projected = np.array(on_wall), np.array(projected)
    labels = MeanShift(bandwidth=bandwidth_m).fit(projected).labels_
    clusters = [on_wall[labels == label] for label in np.unique(labels)]
    found = [
        ransac(cluster, inlier_m=inlier_m, min_consensus=min_points, rng=rng, max_trials=max_trials)
        for cluster in clusters
        if len(cluster) >= min_points
    ]
    return [(normal, offset) for normal, offset, _ in (f for f in found if f is not None)]


def surface_normal(point, xyz, reach_deg):
    """Return the direction of least variance around a point, None if that is no surface."""
    radius = np.deg2rad(reach_deg) * np.linalg.norm(point)
    near = xyz[np.linalg.norm(xyz - point, axis=1) <= radius]
    if len(near) < 6:
        return None
    variances, axes = np.linalg.eigh(np.cov(near.T))
    return axes[:, 0] if variances[0] < 0.2 * variances[1] else None
