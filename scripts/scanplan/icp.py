"""Fitting one scan to another: overlap (fitness) and iterative closest point, in space or in the plane."""

from dataclasses import dataclass

import numpy as np
import small_gicp
from scipy.spatial import cKDTree

from scanplan import se3

METHODS = {"gicp": "GICP", "point_to_plane": "PLANE_ICP", "point_to_point": "ICP"}
_NORMAL_NEIGHBOURS = 6
_STEP_DONE = 1e-5


@dataclass(frozen=True)
class Cloud:
    """A scan made ready for fitting, in its own frame.

    Attributes
    ----------
    xyz_m : (n, 3) float64
        Thinned points; z is 0 in the plane.
    tree : scipy.spatial.cKDTree
        Over x, y, z; in the plane over x, y.
    planar : bool
    features : small_gicp.PointCloud or (n, 2) float64
        Points with covariances; in the plane unit normals, NaN where neighbours form no line.
    """

    xyz_m: np.ndarray
    tree: cKDTree
    planar: bool
    features: object


@dataclass(frozen=True)
class Fit:
    """Outcome of an alignment.

    Attributes
    ----------
    target_from_source : (4, 4) float64
    rmse_m : float
        Root mean square distance of the pairs; infinite where there was nothing to align by.
    """

    target_from_source: np.ndarray
    rmse_m: float


def prepare(xyz_m, *, planar, voxel_m, threads=1):
    """Thin a scan and compute what fitting needs.

    Parameters
    ----------
    xyz_m : (n, 3) float, n >= 1
    planar : bool
        Whether to fit in the plane: x, y and the turn about z.
    voxel_m : float
        Edge of the cubes of which each keeps the mean of its points.
    threads : int
        Cores to use; the result does not depend on it.

    Returns
    -------
    Cloud
    """
    points = np.asarray(xyz_m, float).copy()
    if planar:
        points[:, 2] = 0
    points = thin(points, voxel_m)
    if planar:
        tree = cKDTree(points[:, :2])
        return Cloud(points, tree, True, _normals(points[:, :2], tree, reach_m=10 * voxel_m))
    cloud = small_gicp.PointCloud(points)
    small_gicp.estimate_normals_covariances(cloud, num_neighbors=20, num_threads=threads)
    return Cloud(points, cKDTree(points), False, cloud)


def merge(clouds, target_from_clouds, *, voxel_m, threads=1):
    """Join clouds, each moved by its 4 x 4 matrix, into one.

    In the plane every point keeps the normal that its own scan gave it: in the joined cloud neighbours of two scans a
    registration error apart form no line. In space the covariances are estimated anew, since they gain from density.
    """
    points = np.concatenate([se3.transform(t, c.xyz_m) for c, t in zip(clouds, target_from_clouds, strict=True)])
    if not clouds[0].planar:
        return prepare(points, planar=False, voxel_m=voxel_m, threads=threads)
    normals = [c.features @ t[:2, :2].T for c, t in zip(clouds, target_from_clouds, strict=True)]
    return Cloud(points, cKDTree(points[:, :2]), True, np.concatenate(normals))


def thin(xyz_m, voxel_m):
    """Return the mean of the points in every occupied cube of edge `voxel_m`, (m, 3), in a fixed order."""
    cell = np.floor(np.asarray(xyz_m) / voxel_m).astype(np.int64)
    cell -= cell.min(axis=0)
    extent = cell.max(axis=0) + 1
    key = (cell[:, 0] * extent[1] + cell[:, 1]) * extent[2] + cell[:, 2]
    _, which, count = np.unique(key, return_inverse=True, return_counts=True)
    return np.column_stack([np.bincount(which, axis) for axis in np.asarray(xyz_m, float).T]) / count[:, None]


def fitness(source, target, target_from_source, *, distance_m, threads=1):
    """Return the share of source points that have a target point within `distance_m` (thesis, 3.5)."""
    moved = se3.transform(target_from_source, source.xyz_m)
    distance, _ = target.tree.query(moved[:, : target.tree.m], distance_upper_bound=distance_m, workers=threads)
    return float(np.isfinite(distance).mean())


def align(source, target, target_from_source, *, method, distance_m, max_iterations):
    """Refine the motion from source to target by iterative closest point (thesis, 3.2.2 and 3.5).

    Parameters
    ----------
    source, target : Cloud
        Both in space or both in the plane. In the plane the method is point to line (Chen and Medioni 1992 in 2-D)
        with a robust (Cauchy) weight, whatever `method` says.
    target_from_source : (4, 4) float
        Where to start.
    method : {"gicp", "point_to_plane", "point_to_point"}
    distance_m : float
        Points farther apart are no pair.
    max_iterations : int

    Returns
    -------
    Fit
    """
    if target.planar:
        return _align_planar(source, target, target_from_source, distance_m, max_iterations)
    result = small_gicp.align(
        target.features,
        source.features,
        init_T_target_source=target_from_source,
        registration_type=METHODS[method],
        max_correspondence_distance=distance_m,
        max_iterations=max_iterations,
        rotation_epsilon=1e-4,
        translation_epsilon=1e-4,
    )
    motion = np.asarray(result.T_target_source)
    return Fit(motion, _rmse(source, target, motion, distance_m) if result.num_inliers else np.inf)


def _rmse(source, target, motion, distance_m):
    moved = se3.transform(motion, source.xyz_m)[:, : target.tree.m]
    distance, _ = target.tree.query(moved, distance_upper_bound=distance_m)
    near = distance[np.isfinite(distance)]
    return float(np.sqrt(np.mean(near**2))) if len(near) else np.inf


def _align_planar(source, target, start, distance_m, max_iterations):
    motion = np.array(start, float)
    for _ in range(max_iterations):
        step = _planar_step(source.xyz_m[:, :2], target, motion, distance_m)
        if step is None:
            return Fit(motion, np.inf)
        motion = _planar_motion(step, motion[:2, 3]) @ motion
        if np.abs(step).max() < _STEP_DONE:
            break
    return Fit(motion, _rmse(source, target, motion, distance_m))


def _planar_step(source_xy, target, motion, distance_m):
    """Gauss-Newton step (dx, dy, turn about the scan's origin) of the point-to-line error, or None without pairs."""
    moved = source_xy @ motion[:2, :2].T + motion[:2, 3]
    distance, nearest = target.tree.query(moved, distance_upper_bound=distance_m)
    pairs = np.flatnonzero(np.isfinite(distance))
    pairs = pairs[np.isfinite(target.features[nearest[pairs], 0])]
    if len(pairs) < 3:
        return None
    normal, arm = target.features[nearest[pairs]], moved[pairs] - motion[:2, 3]
    residual = np.einsum("ij,ij->i", normal, moved[pairs] - target.xyz_m[nearest[pairs], :2])
    jacobian = np.column_stack([normal, normal[:, 1] * arm[:, 0] - normal[:, 0] * arm[:, 1]])
    # a scale taken from the residuals alone would trust the wall that fits best and let all others slide
    scale = max(1.4826 * np.median(np.abs(residual)), distance_m / 10)
    weighted = jacobian.T / (1 + (residual / scale) ** 2)
    return _solve_observable(weighted @ jacobian, -weighted @ residual, reach_m=np.sqrt(np.mean(arm**2)))


def _solve_observable(information, gradient, reach_m, least_share=1e-3):
    """Solve for the step; directions that the pairs say next to nothing about keep the start's value."""
    scale = np.array([1, 1, 1 / max(reach_m, 1e-3)])
    value, vector = np.linalg.eigh(information * np.outer(scale, scale))
    known = value > least_share * value[-1]
    return scale * (vector[:, known] @ ((vector[:, known].T @ (scale * gradient)) / value[known]))


def _planar_motion(step, centre_xy):
    """4 x 4 motion that turns by step[2] about `centre_xy`, then shifts by step[:2]."""
    cos, sin = np.cos(step[2]), np.sin(step[2])
    motion = np.eye(4)
    motion[:2, :2] = [[cos, -sin], [sin, cos]]
    motion[:2, 3] = centre_xy - motion[:2, :2] @ centre_xy + step[:2]
    return motion


def _normals(xy_m, tree, reach_m):
    """Unit normals from the nearest neighbours; NaN where they are too few, too far or form no line."""
    neighbours = min(_NORMAL_NEIGHBOURS, len(xy_m))
    if neighbours < 3:
        return np.full((len(xy_m), 2), np.nan)
    distance, index = tree.query(xy_m, k=neighbours)
    offset = xy_m[index] - xy_m[index].mean(axis=1, keepdims=True)
    value, vector = np.linalg.eigh(np.einsum("nki,nkj->nij", offset, offset))
    line = (distance[:, -1] < reach_m) & (value[:, 0] < 0.1 * value[:, 1])
    return np.where(line[:, None], vector[:, :, 0], np.nan)
