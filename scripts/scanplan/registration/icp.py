"""Alignment of one scan to another by iterative closest point, in space or in the plane."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import small_gicp

from scanplan.geometry import se3, twists
from scanplan.geometry.tolerances import FACING, SHORTEST_M
from scanplan.registration import planar_icp, point_icp, prepared_clouds
from scanplan.registration.prepared_clouds import PreparedCloud
from scanplan.types import FloatArray

POINT_TO_POINT = "point_to_point"
"""The thesis's method, as Open3D has it: all pairs count, and nothing is held."""
_METHODS = {"gicp": "GICP", "point_to_plane": "PLANE_ICP"}
"""Names of the other methods in space, and what small_gicp calls them."""
_LEAST_TURNED = 0.01  # of the points: fewer are badly known normals at edges
# metres and radians: of a step this small less than half is left to go
_STEP_DONE = 1e-3


@dataclass(frozen=True)
class IcpResult:
    """Outcome of an alignment.

    Attributes
    ----------
    target_from_source : (4, 4) float64
    information : (6, 6) float64
        Inverse covariance of the motion's error as a twist in the source's frame; zero in
        directions that the pairs do not determine.
    n_unobservable : int
        Number of those directions: in them the start was kept.
    sound : bool
        Whether there was anything to align by.
    """

    target_from_source: FloatArray
    information: FloatArray
    n_unobservable: int
    sound: bool


@dataclass(frozen=True, kw_only=True)
class IcpSettings:
    """How two clouds are aligned.

    Attributes
    ----------
    method : {"gicp", "point_to_plane", "point_to_point"}
        In the plane it is point to line, whatever this says.
    distances_m : sequence of float, at least one
        Points farther apart are no pair: first for the rough, then for the fine alignment.
    max_iterations : int
        Of each of these.
    n_points : int, optional
        Point to point pairs about so many of the source's points, evenly chosen; all by default.
    sure_within_m : float
        In the plane, a motion farther than that counts only as far as it does not hang on one thing
        that may have moved, see `planar_icp.leave_out_a_thing`.
    """

    method: str
    distances_m: Sequence[float]
    max_iterations: int
    n_points: int | None = None
    sure_within_m: float = math.inf


def align_clouds(
    source: PreparedCloud,
    target: PreparedCloud,
    target_from_source: FloatArray,
    settings: IcpSettings,
) -> IcpResult:
    """Refine the motion from source to target by iterative closest point (thesis, 3.2.2 and 3.5).

    Directions that the pairs determine far worse than the others (along a corridor) keep the
    start's value, but for point to point.

    Parameters
    ----------
    source, target : PreparedCloud
        Both in space or both in the plane.
    target_from_source : (4, 4) float64
        Where to start.
    """
    if settings.method == POINT_TO_POINT and not target.planar:
        step = prepared_clouds.probe_step(source, settings.n_points)
        return _align_by_points(source.xyz_m[::step], target, target_from_source, settings)
    motion = target_from_source
    information = np.zeros((6, 6))
    finest_m = settings.distances_m[-1]
    for distance_m in settings.distances_m:
        is_fine = distance_m == finest_m
        # a rough alignment needs not arrive
        step_done = _STEP_DONE if is_fine else 2 * _STEP_DONE
        if target.planar:
            most = settings.max_iterations
            aligned = planar_icp.align_planar(source, target, motion, distance_m, most, step_done)
        else:
            if is_fine:
                source = _without_other_sides(source, target, motion, distance_m)
            aligned = _align_spatial(source, target, motion, settings, distance_m, step_done)
        if aligned is None:
            return _unsound(target_from_source)
        motion, information = aligned
    moved_m = np.linalg.norm((motion - target_from_source)[:3, 3])
    if target.planar and moved_m > settings.sure_within_m:
        information = planar_icp.leave_out_a_thing(source, target, motion, finest_m)
    return _keep_unobservable(target_from_source, motion, information, source.reach_m)


def _align_by_points(
    points_m: FloatArray,
    target: PreparedCloud,
    start: FloatArray,
    settings: IcpSettings,
) -> IcpResult:
    motion = start
    information = np.zeros((6, 6))
    for distance_m in settings.distances_m:
        aligned = point_icp.align_points(
            points_m, target.xyz_m, motion, distance_m, settings.max_iterations
        )
        if aligned is None:
            return _unsound(start)
        motion, information = aligned
    return IcpResult(motion, information / planar_icp.PAIR_SIGMA_M**2, 0, sound=True)


def _unsound(start: FloatArray) -> IcpResult:
    return IcpResult(start, np.zeros((6, 6)), n_unobservable=6, sound=False)


def _without_other_sides(
    source: PreparedCloud, target: PreparedCloud, target_from_source: FloatArray, distance_m: float
) -> PreparedCloud:
    """Leave out the points whose nearest neighbour is of a surface that faces the other way.

    They show one side of a wall and the target the other. As pairs they would draw the scans of
    two rooms together and make the wall between too thin: points are farther apart than a partition
    is thick.
    """
    moved_m = se3.transform_points(target_from_source, source.xyz_m)
    index, squared_m2 = target.nearest_points(moved_m)
    turned = source.normal @ target_from_source[:3, :3].T
    cosine = np.einsum("ij,ij->i", turned, target.normal[index])
    is_other_side = (squared_m2 < distance_m**2) & (cosine < -FACING)
    if is_other_side.mean() < _LEAST_TURNED or is_other_side.all():
        return source
    return prepared_clouds.prepare_cloud(source.xyz_m[~is_other_side], planar=False)


def _align_spatial(
    source: PreparedCloud,
    target: PreparedCloud,
    start: FloatArray,
    settings: IcpSettings,
    distance_m: float,
    step_done: float,
) -> tuple[FloatArray, FloatArray] | None:
    """Return motion and information, None without pairs."""
    result = small_gicp.align(
        target.features,
        source.features,
        target.tree,
        init_T_target_source=start,
        registration_type=_METHODS[settings.method],
        max_correspondence_distance=distance_m,
        max_iterations=settings.max_iterations,
        rotation_epsilon=step_done,
        translation_epsilon=step_done,
    )
    if not result.num_inliers:
        return None
    # small_gicp puts the turn before the shift
    order = [3, 4, 5, 0, 1, 2]
    information = np.asarray(result.H)[order][:, order]
    motion = se3.nearest_rigid(np.asarray(result.T_target_source))
    variance_m2 = 1.0 if settings.method == "gicp" else planar_icp.PAIR_SIGMA_M**2
    return motion, information / variance_m2


def _keep_unobservable(
    start: FloatArray, motion: FloatArray, information: FloatArray, reach_m: float
) -> IcpResult:
    """Undo the motion in directions that the pairs do not determine, and drop their information."""
    # a turn counts by the way that the points make in it
    scale = np.repeat([1, 1 / max(reach_m, SHORTEST_M)], 3)
    scales = np.outer(scale, scale)
    value, vector = np.linalg.eigh(information * scales)
    if not value[-1] > 0:
        return _unsound(start)
    is_free = np.diag(information) > 0
    is_observable = value > planar_icp.LEAST_SHARE * value[-1]
    n_unobservable = int(is_free.sum() - is_observable.sum())
    if n_unobservable == 0:
        return IcpResult(motion, information, 0, True)
    projection = vector[:, is_observable] @ vector[:, is_observable].T
    twist = twists.motion_to_twist(se3.invert_pose(start) @ motion)
    observable_twist = scale * (projection @ (twist / scale))
    information = (projection @ (information * scales) @ projection) / scales
    observable_motion = start @ twists.twist_to_motion(observable_twist)
    return IcpResult(observable_motion, information, n_unobservable, True)
