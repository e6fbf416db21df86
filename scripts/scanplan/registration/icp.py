"""Fitting one scan to another: overlap (fitness) and iterative closest point, in space or in the plane."""

from dataclasses import dataclass

import numpy as np
import small_gicp
from scipy.spatial import cKDTree

from scanplan.geometry import se3, twists
from scanplan.registration import planar_icp

METHODS = {"gicp": "GICP", "point_to_plane": "PLANE_ICP", "point_to_point": "ICP"}
_COVARIANCE_NEIGHBOURS = 10
# GICP weighs a pair as if it were off by this much along the normal: 1e-3 from each side in its covariances
_PAIR_SIGMA_M = 0.045
_LEAST_SHARE = 0.005
_FACING = 0.5
_LEAST_TURNED = 0.01
# metres and radians: of a step this small less than half is left to go; a rough alignment needs not arrive
_STEP_DONE, _ROUGH_STEP_DONE = 1e-3, 2e-3


@dataclass(frozen=True)
class PreparedCloud:
    """A scan made ready for fitting, in its own frame.

    Attributes
    ----------
    xyz_m : (n, 3) float64
        Thinned points; z is 0 in the plane.
    tree : small_gicp.KdTree or scipy.spatial.cKDTree
        Over x, y, z; in the plane over x, y.
    planar : bool
    normal : (n, 3) or (n, 2) float64
        Unit normals towards the frame's origin, which is where the sensor is; NaN where neighbours form no surface.
    features : small_gicp.PointCloud or None
        The points with covariances; None in the plane.
    """

    xyz_m: np.ndarray
    tree: object
    planar: bool
    normal: np.ndarray
    features: object


@dataclass(frozen=True)
class IcpResult:
    """Outcome of an alignment.

    Attributes
    ----------
    target_from_source : (4, 4) float64
    information : (6, 6) float64
        Inverse covariance of the motion's error as a twist in the source's frame; zero in directions that the pairs
        say nothing about.
    n_unobservable : int
        How many directions those are: in them the start was kept.
    sound : bool
        Whether there was anything to align by.
    """

    target_from_source: np.ndarray
    information: np.ndarray
    n_unobservable: int
    sound: bool


def thin_voxels(xyz_m, *, planar, voxel_m):
    """Return the mean of the points in every occupied cube of edge `voxel_m`, (m, 3) float32, in a fixed order.

    In the plane the points are put to height 0 first.
    """
    points = np.array(xyz_m, np.float64)
    if planar:
        points[:, 2] = 0
    if len(points) == 0:
        return np.zeros((0, 3), np.float32)
    return np.asarray(small_gicp.voxelgrid_sampling(points, voxel_m, 1).points()[:, :3], np.float32)


def prepare_cloud(thinned_m, *, planar, reach_m=1.0):
    """Compute what fitting needs of a thinned scan.

    Parameters
    ----------
    thinned_m : (n, 3) float, n >= 1
    planar : bool
        Whether to fit in the plane: x, y and the turn about z.
    reach_m : float
        Neighbours farther apart than this form no line (planar only).

    Returns
    -------
    Cloud
    """
    points = np.ascontiguousarray(thinned_m, np.float64)
    if planar:
        tree = cKDTree(points[:, :2])
        normal = planar_icp.planar_normals(points[:, :2], tree, reach_m=reach_m)
        return PreparedCloud(points, tree, True, _towards_origin(normal, points[:, :2]), None)
    cloud = small_gicp.PointCloud(points)
    small_gicp.estimate_normals_covariances(
        cloud, num_neighbors=_COVARIANCE_NEIGHBOURS, num_threads=1
    )
    normal = _towards_origin(cloud.normals()[:, :3], points)
    return PreparedCloud(points, small_gicp.KdTree(cloud), False, normal, cloud)


def measure_overlap(source, target, target_from_source, *, distance_m, n_probes=None, facing=False):
    """Return fitness, the share of source points with a target point within `distance_m` (thesis, 3.5), and rmse.

    Parameters
    ----------
    source, target : Cloud
    target_from_source : (4, 4) float64
    distance_m : float
    n_probes : int, optional
        About so many of the source's points are asked, evenly chosen; all of them by default.
    facing : bool
        Count a neighbour only if its surface faces the same way: the two sides of a wall are none.

    Returns
    -------
    fitness : float
    rmse_m : float
        Root mean square distance of those points to their neighbours; infinite if there are none.
    """
    step = 1 if n_probes is None else max(1, len(source.xyz_m) // n_probes)
    moved = se3.transform_points(target_from_source, source.xyz_m[::step])
    if target.planar:
        distance, index = target.tree.query(moved[:, :2], distance_upper_bound=distance_m)
    else:
        index, squared = (found[:, 0] for found in target.tree.batch_knn_search(moved, 1))
        distance = np.sqrt(squared)
    near = np.flatnonzero(distance < distance_m)
    if facing:
        size = target.normal.shape[1]
        turned = source.normal[::step][near] @ target_from_source[:size, :size].T
        near = near[
            np.einsum("ij,ij->i", turned, target.normal[index[near].astype(np.int64)]) > _FACING
        ]
    return len(near) / len(moved), float(np.sqrt(np.mean(distance[near] ** 2))) if len(
        near
    ) else np.inf


def align_clouds(source, target, target_from_source, *, method, distances_m, max_iterations):
    """Refine the motion from source to target by iterative closest point (thesis, 3.2.2 and 3.5).

    Directions that the pairs determine far worse than the others (along a corridor) keep the start's value.

    Parameters
    ----------
    source, target : Cloud
        Both in space or both in the plane. In the plane the method is point to line, whatever `method` says.
    target_from_source : (4, 4) float64
        Where to start.
    method : {"gicp", "point_to_plane", "point_to_point"}
    distances_m : sequence of float
        Points farther apart are no pair: first for the rough, then for the fine alignment.
    max_iterations : int
        Of each of these.

    Returns
    -------
    Fit
    """
    step = planar_icp.align_planar if target.planar else _align_spatial
    motion = target_from_source
    for distance_m in distances_m:
        if distance_m == distances_m[-1] and not target.planar:
            source = _one_sided(source, target, motion, distance_m)
        step_done = _STEP_DONE if distance_m == distances_m[-1] else _ROUGH_STEP_DONE
        motion, information = step(
            source, target, motion, method, distance_m, max_iterations, step_done
        )
        if information is None:
            return IcpResult(target_from_source, np.zeros((6, 6)), 6, False)
    return _observable(
        target_from_source, motion, information, np.sqrt(np.mean(source.xyz_m**2) * 3)
    )


def _one_sided(source, target, target_from_source, distance_m):
    """Leave out the points whose nearest neighbour is of a surface that faces the other way.

    They show one side of a wall and the target the other. Taken for the same surface, they draw the scans of two rooms
    together, and what is between these comes out thinner than it is: a partition is thinner than points are apart.
    """
    moved = se3.transform_points(target_from_source, source.xyz_m)
    index, squared = (found[:, 0] for found in target.tree.batch_knn_search(moved, 1))
    facing = np.einsum(
        "ij,ij->i",
        source.normal @ target_from_source[:3, :3].T,
        target.normal[index.astype(np.int64)],
    )
    turned = (squared < distance_m**2) & (facing < -_FACING)
    # a few are badly known normals at edges
    if turned.mean() < _LEAST_TURNED or turned.all():
        return source
    return prepare_cloud(source.xyz_m[~turned], planar=False)


def _align_spatial(source, target, start, method, distance_m, max_iterations, step_done):
    result = small_gicp.align(
        target.features,
        source.features,
        target.tree,
        init_T_target_source=start,
        registration_type=METHODS[method],
        max_correspondence_distance=distance_m,
        max_iterations=max_iterations,
        rotation_epsilon=step_done,
        translation_epsilon=step_done,
    )
    if not result.num_inliers:
        return start, None
    # small_gicp puts the turn before the shift
    information = np.roll(np.roll(np.asarray(result.H), 3, axis=0), 3, axis=1)
    motion = se3.nearest_rigid(np.asarray(result.T_target_source))
    return motion, information if method == "gicp" else information / _PAIR_SIGMA_M**2


def _observable(start, motion, information, reach_m):
    """Undo the motion in directions that the pairs do not determine, and take these out of the information."""
    # a turn counts by the way that the points make in it
    scale = np.repeat([1, 1 / max(reach_m, 1e-3)], 3)
    free = np.diag(information) > 0
    value, vector = np.linalg.eigh(information * np.outer(scale, scale))
    if not value[-1] > 0:
        return IcpResult(start, np.zeros((6, 6)), 6, False)
    known = value > _LEAST_SHARE * value[-1]
    n_unobservable = int(free.sum() - known.sum())
    if n_unobservable == 0:
        return IcpResult(motion, information, 0, True)
    onto_known = vector[:, known] @ vector[:, known].T
    twist = scale * (onto_known @ (twists.motion_to_twist(se3.invert_pose(start) @ motion) / scale))
    information = (onto_known @ (information * np.outer(scale, scale)) @ onto_known) / np.outer(
        scale, scale
    )
    return IcpResult(start @ twists.twist_to_motion(twist), information, n_unobservable, True)


def _towards_origin(normal, points):
    outward = np.einsum("ij,ij->i", normal, points) > 0
    return np.where(outward[:, None], -normal, normal)
