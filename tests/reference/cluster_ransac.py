"""Section 3.4 of the thesis, literally.

Normals, projection along them, mean shift, one RANSAC per cluster.
"""

import numpy as np
from sklearn.cluster import MeanShift

from reference.ransac import draw, normal_form, ransac


def lines(xyz, *, reach_deg, max_tilt_deg, bandwidth_m, inlier_m, min_points, rng, max_trials):
    """Return the (normal, offset) in the floor plan of one line per cluster.

    Points relative to the sensor.
    """
    found = walls(
        [(p, n, p[:2]) for p, n in upright(xyz, reach_deg, max_tilt_deg)],
        projection="normal",
        model="line",
        bandwidth_m=bandwidth_m,
        inlier_m=inlier_m,
        min_points=min_points,
        draw_samples=lambda n: draw(n, 2, max_trials, rng),
    )
    return [normal_form(centre, direction) for centre, direction, _ in found]


def upright(xyz, reach_deg, max_tilt_deg):
    """Return the points on vertical surfaces, with their normals in the floor plan."""
    on_wall = []
    for p in xyz:
        normal = surface_normal(p, xyz, reach_deg)
        if normal is not None and abs(normal[2]) <= np.sin(np.deg2rad(max_tilt_deg)):
            on_wall.append((p, normal[:2] / np.linalg.norm(normal[:2])))
    return on_wall


def walls(on_wall, *, projection, model, bandwidth_m, inlier_m, min_points, draw_samples):
    """Return the (centre, axis, points of it) of one model per cluster of projected points.

    `on_wall`: of every point, itself, its normal, and what RANSAC is to see of it.
    """
    projected = [project(p, normal, projection) for p, normal, _ in on_wall]
    labels = MeanShift(bandwidth=bandwidth_m).fit(np.array(projected)).labels_
    found = []
    for label in np.unique(labels):
        cluster = np.array(
            [seen for (_, _, seen), its in zip(on_wall, labels, strict=True) if its == label]
        )
        if len(cluster) < min_points:
            continue
        one = ransac(
            cluster,
            model=model,
            inlier_m=inlier_m,
            min_consensus=min_points,
            samples=draw_samples(len(cluster)),
        )
        if one is not None:
            centre, axis, inliers = one
            found.append((centre, axis, cluster[inliers]))
    return found


def project(p, normal, projection):
    """Along the normal, or along the axis that the normal's largest component is along."""
    if projection == "normal":
        return (p[:2] @ normal) * normal
    return np.array([p[0], 0]) if abs(normal[0]) >= abs(normal[1]) else np.array([0, p[1]])


def surface_normal(point, xyz, reach_deg):
    """Return the direction of least variance around a point, None if that is no surface."""
    radius = np.deg2rad(reach_deg) * np.linalg.norm(point)
    near = xyz[np.linalg.norm(xyz - point, axis=1) <= radius]
    if len(near) < 6:
        return None
    variances, axes = np.linalg.eigh(np.cov(near.T))
    return axes[:, 0] if variances[0] < 0.2 * variances[1] else None
