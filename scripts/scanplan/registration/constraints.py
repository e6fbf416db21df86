"""Pose-graph constraints: the motion between two scans, measured by aligning one to the other."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.registration import icp, prepared_clouds
from scanplan.registration.registration_settings import SequentialSettings
from scanplan.types import FloatArray

_LINE_REACH_VOXELS = 10  # neighbours on a wall seen from the side are this many voxels apart


@dataclass(frozen=True)
class PlacedScan:
    """A prepared scan and its pose.

    Attributes
    ----------
    scan_id : int
    cloud : prepared_clouds.PreparedCloud
    world_from_cloud : (4, 4) float64
    """

    scan_id: int
    cloud: prepared_clouds.PreparedCloud
    world_from_cloud: FloatArray


@dataclass(frozen=True)
class PoseConstraint:
    """A measured motion between two scans.

    Attributes
    ----------
    source, target : int
        Their scan_ids.
    kind : str
        `sequence` (a scan and one of its predecessors) or `loop`.
    fitness, rmse_m : float
        Share of the source's points that lie on a surface of the target facing the same way, and
        their root mean square distance from it.
    fit : icp.IcpResult
        Between their clouds' frames: the sensors', in a planar survey the levelled ones.
    """

    source: int
    target: int
    kind: str
    fitness: float
    rmse_m: float
    fit: icp.IcpResult


def refine_scan(
    scan: PlacedScan, targets: Sequence[PlacedScan], settings: SequentialSettings
) -> tuple[PlacedScan | None, list[PoseConstraint]]:
    """Align a scan to placed ones; fuse the results and the localiser's pose by their information.

    Parameters
    ----------
    scan : PlacedScan
        At the localiser's pose.
    targets : sequence of PlacedScan
        The best first.

    Returns
    -------
    PlacedScan or None
        None if it aligns to none of them, or only far from where it was.
    list of PoseConstraint
    """
    estimate = scan.world_from_cloud
    information = settings.localiser_information(scan.world_from_cloud)
    constraints: list[PoseConstraint] = []
    for target in targets:
        # the first alignment leaves little for the others to do
        distances_m = settings.icp_distances_m[-1:] if constraints else settings.icp_distances_m
        moved = PlacedScan(scan.scan_id, scan.cloud, estimate)
        constraint = measure_constraint(moved, target, "sequence", distances_m, settings)
        if constraint is None:
            continue
        information = information + constraint.fit.information
        estimate = _fuse(estimate, target, constraint.fit, information)
        constraints.append(constraint)
    correction = se3.invert_pose(scan.world_from_cloud) @ estimate
    if not constraints or _is_large(correction, settings):
        return None, []
    return PlacedScan(scan.scan_id, scan.cloud, estimate), constraints


def _fuse(
    estimate: FloatArray, target: PlacedScan, fit: icp.IcpResult, information: FloatArray
) -> FloatArray:
    """Return an estimated pose moved towards a measured one; `information` is that of both."""
    measured = target.world_from_cloud @ fit.target_from_source
    twist = twists.motion_to_twist(se3.invert_pose(estimate) @ measured)
    step = np.linalg.solve(information, fit.information @ twist)
    return se3.nearest_rigid(estimate @ twists.twist_to_motion(step))


def comparable_scans(
    scan: PlacedScan, previous: Sequence[PlacedScan], settings: SequentialSettings
) -> list[PlacedScan]:
    """Return the previous scans with an overlapping view: near, and not turned away.

    The last one is always among them.

    Parameters
    ----------
    scan : PlacedScan
        At the localiser's pose.
    previous : sequence of PlacedScan, at least one
        Their order is kept.
    """

    def is_near(other: PlacedScan) -> bool:
        apart = se3.invert_pose(other.world_from_cloud) @ scan.world_from_cloud
        distance_m, turn_deg = _size(apart)
        return distance_m <= settings.previous_apart_m and turn_deg <= settings.previous_turn_deg

    *others, last = previous
    return [*filter(is_near, others), last]


def measure_constraint(
    source: PlacedScan,
    target: PlacedScan,
    kind: str,
    distances_m: Sequence[float],
    settings: SequentialSettings,
) -> PoseConstraint | None:
    """Measure the motion between two scans that are about in place; None without a sound alignment.

    In the plane it counts for less where few points lie on surfaces that face the same way, and for
    nothing where none does: the few that two scans through a door share may be paired with other
    walls than theirs, all of them as far off.

    Parameters
    ----------
    kind : str
        See `PoseConstraint`.
    distances_m : sequence of float
        See `icp.align_clouds`.
    """
    start = relative_pose(source, target)
    fit = icp.align_clouds(
        source.cloud,
        target.cloud,
        start,
        icp.IcpSettings(
            method=settings.icp_method,
            distances_m=distances_m,
            max_iterations=settings.icp_max_iterations,
            sure_within_m=settings.fitness_distance_m,
        ),
    )
    correction = se3.invert_pose(start) @ fit.target_from_source
    if not fit.sound or _is_large(correction, settings):
        return None
    world_from_source = target.world_from_cloud @ fit.target_from_source
    aligned = PlacedScan(source.scan_id, source.cloud, world_from_source)
    fitness, rmse_m = measure_facing_overlap(aligned, target, distances_m[-1], settings)
    if target.cloud.planar and fitness < settings.min_facing_fitness:
        if fitness == 0:
            return None
        lacking = 1 - fitness / settings.min_facing_fitness
        error_m = lacking * distances_m[-1]
        fit = replace(fit, information=_with_error(fit.information, error_m, source.cloud.reach_m))
    return PoseConstraint(source.scan_id, target.scan_id, kind, fitness, rmse_m, fit)


def _with_error(information: FloatArray, error_m: float, reach_m: float) -> FloatArray:
    """Return the information (6, 6) of a motion that may also be off by an error, or turned by it.

    The turn is the one by which points so far from the sensor are off by as much.
    """
    error = np.repeat([error_m, error_m / max(reach_m, SHORTEST_M)], 3)
    return np.asarray(information @ np.linalg.inv(np.eye(6) + error[:, None] ** 2 * information))


def measure_facing_overlap(
    source: PlacedScan, target: PlacedScan, distance_m: float, settings: SequentialSettings
) -> tuple[float, float]:
    """Return fitness and rmse of a scan on another, of surfaces that face the same way."""
    return prepared_clouds.measure_overlap(
        source.cloud,
        target.cloud,
        relative_pose(source, target),
        distance_m=distance_m,
        n_probes=settings.fitness_points,
        facing=True,
    )


def measure_scan_overlap(
    source: PlacedScan, target: PlacedScan, settings: SequentialSettings
) -> tuple[float, float]:
    """Return fitness and rmse of a scan on another, both at their poses (thesis, 3.5)."""
    return prepared_clouds.measure_overlap(
        source.cloud,
        target.cloud,
        relative_pose(source, target),
        distance_m=settings.fitness_distance_m,
        n_probes=settings.fitness_points,
    )


def thin_scan(
    xyz_m: FloatArray, level_from_sensor: FloatArray, planar: bool, settings: SequentialSettings
) -> FloatArray:
    """Return the points (m, 3) float32 of a scan that registration uses, in the cloud's frame.

    In a small room, or in a camera's narrow view, the usual voxels are too few: then they are
    smaller.
    """
    if planar:
        levelled_m = se3.transform_points(level_from_sensor, xyz_m)
        return prepared_clouds.thin_voxels(levelled_m, planar=True, voxel_m=settings.voxel_planar_m)
    thinned_m = prepared_clouds.thin_voxels(xyz_m, planar=False, voxel_m=settings.voxel_m)
    if len(thinned_m) >= settings.voxels:
        return thinned_m
    # on surfaces the number of voxels goes with the inverse square of their edge
    share = np.sqrt(len(thinned_m) / settings.voxels)
    return prepared_clouds.thin_voxels(xyz_m, planar=False, voxel_m=share * settings.voxel_m)


def neighbour_reach_m(settings: SequentialSettings) -> float:
    """Return how far apart neighbours on one line may be in a planar survey, metres."""
    return _LINE_REACH_VOXELS * settings.voxel_planar_m


def place_scan(
    scan_id: int,
    thinned_m: FloatArray,
    world_from_sensor: FloatArray,
    level_from_sensor: FloatArray,
    *,
    planar: bool,
    settings: SequentialSettings,
) -> PlacedScan:
    """Prepare the points (m, 3) that `thin_scan` returned, with the pose that they have."""
    reach_m = neighbour_reach_m(settings)
    cloud = prepared_clouds.prepare_cloud(thinned_m, planar=planar, reach_m=reach_m)
    return PlacedScan(scan_id, cloud, world_from_sensor @ se3.invert_pose(level_from_sensor))


def level_pose(world_from_sensor: FloatArray, *, planar: bool) -> FloatArray:
    """Return level_from_sensor (4, 4): the frame of a scan's cloud.

    Scans of a planar survey are levelled: it is the pose without its position x, y and its heading.
    Others stay as the sensor has them.
    """
    if not planar:
        return np.eye(4)
    heading = se3.pose_yaw_rad(world_from_sensor)
    cos = np.cos(heading)
    sin = np.sin(heading)
    world_from_level = np.eye(4)
    world_from_level[:2, :2] = [[cos, -sin], [sin, cos]]
    world_from_level[:2, 3] = world_from_sensor[:2, 3]
    return se3.invert_pose(world_from_level) @ world_from_sensor


def relative_pose(source: PlacedScan, target: PlacedScan) -> FloatArray:
    """Return target_from_source (4, 4) of two scans as they are placed."""
    return se3.invert_pose(target.world_from_cloud) @ source.world_from_cloud


def _is_large(correction: FloatArray, settings: SequentialSettings) -> bool:
    """Return whether a motion is larger than an alignment may correct."""
    shift_m, turn_deg = _size(correction)
    return shift_m > settings.max_correction_m or turn_deg > settings.max_correction_deg


def _size(motion: FloatArray) -> tuple[float, float]:
    """Return length in metres and angle in degrees of a 4 x 4 motion."""
    twist = twists.motion_to_twist(motion)
    return float(np.linalg.norm(twist[:3])), float(np.degrees(np.linalg.norm(twist[3:])))
