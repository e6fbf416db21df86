"""Scans aligned to others that are in place, and what that says of the motion between them."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration import icp

_SMALLEST_SHARE = 0.1


@dataclass(frozen=True)
class PlacedScan:
    """A prepared scan and where it is.

    Attributes
    ----------
    scan_id : int
    cloud : icp.PreparedCloud
    world_from_cloud : (4, 4) float64
    """

    scan_id: int
    cloud: icp.PreparedCloud
    world_from_cloud: np.ndarray


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
        Share of the source's points that lie on a surface of the target facing the same way, and how far from it.
    fit : icp.IcpResult
        Between their clouds' frames: the sensors', in a planar survey the levelled ones.
    """

    source: int
    target: int
    kind: str
    fitness: float
    rmse_m: float
    fit: icp.IcpResult


def refine_scan(scan, targets, settings):
    """Align a scan to others that are in place and weigh the outcomes, and the localiser's pose, by their information.

    Parameters
    ----------
    scan : Placed
        Where the localiser says.
    targets : sequence of Placed
        The best first.
    settings : sequential.SequentialSettings

    Returns
    -------
    Placed or None
        None if it fits none of them, or only far from where it was.
    list of Edge
    """
    estimate, edges = scan.world_from_cloud, []
    information = settings.localiser_information(scan.world_from_cloud)
    for target in targets:
        # the first alignment leaves little for the others to do
        distances_m = settings.icp_distances_m[-1:] if edges else settings.icp_distances_m
        edge = measure_constraint(
            PlacedScan(scan.scan_id, scan.cloud, estimate),
            target,
            "sequence",
            distances_m,
            settings,
        )
        if edge is None:
            continue
        measured = target.world_from_cloud @ edge.fit.target_from_source
        twist = twists.motion_to_twist(se3.invert_pose(estimate) @ measured)
        information = information + edge.fit.information
        estimate = se3.nearest_rigid(
            estimate
            @ twists.twist_to_motion(np.linalg.solve(information, edge.fit.information @ twist))
        )
        edges.append(edge)
    shift_m, turn_deg = _size(se3.invert_pose(scan.world_from_cloud) @ estimate)
    if not edges or shift_m > settings.max_correction_m or turn_deg > settings.max_correction_deg:
        return None, []
    return PlacedScan(scan.scan_id, scan.cloud, estimate), edges


def comparable_scans(scan, previous, settings):
    """Return those of the previous scans that can be expected to show what a scan shows: near, and not turned away.

    The last one always is among them.

    Parameters
    ----------
    scan : Placed
        Where the localiser says.
    previous : sequence of Placed
        Their order is kept.
    settings : sequential.SequentialSettings

    Returns
    -------
    list of Placed
    """
    sizes = [
        _size(se3.invert_pose(other.world_from_cloud) @ scan.world_from_cloud) for other in previous
    ]
    near = [
        m <= settings.previous_apart_m and deg <= settings.previous_turn_deg for m, deg in sizes
    ]
    near[-1] = True
    return [other for other, is_near in zip(previous, near, strict=True) if is_near]


def measure_constraint(source, target, kind, distances_m, settings):
    """Measure the motion between two scans that are about in place: Edge, or None without a sound alignment.

    Parameters
    ----------
    source, target : Placed
    kind : str
    distances_m : sequence of float
        See `icp.align_clouds`.
    settings : sequential.SequentialSettings
    """
    start = se3.invert_pose(target.world_from_cloud) @ source.world_from_cloud
    fit = icp.align_clouds(
        source.cloud,
        target.cloud,
        start,
        method=settings.icp_method,
        distances_m=distances_m,
        max_iterations=settings.icp_max_iterations,
    )
    shift_m, turn_deg = _size(se3.invert_pose(start) @ fit.target_from_source)
    if (
        not fit.sound
        or shift_m > settings.max_correction_m
        or turn_deg > settings.max_correction_deg
    ):
        return None
    place = PlacedScan(
        source.scan_id, source.cloud, target.world_from_cloud @ fit.target_from_source
    )
    found = measure_facing_overlap(place, target, distances_m[-1], settings)
    return PoseConstraint(source.scan_id, target.scan_id, kind, *found, fit)


def measure_facing_overlap(source, target, distance_m, settings):
    """Return fitness and rmse of a scan on another where only surfaces that face the same way are the same."""
    motion = se3.invert_pose(target.world_from_cloud) @ source.world_from_cloud
    limits = {"distance_m": distance_m, "n_probes": settings.fitness_points}
    return icp.measure_overlap(source.cloud, target.cloud, motion, **limits, facing=True)


def thin_scan(xyz_m, level_from_sensor, planar, settings):
    """Return the points (m, 3) float32 of a scan that fitting uses, in the cloud's frame.

    In a small room, or in a camera's narrow view, the usual cubes are too few: then smaller ones are taken.
    """
    moved = se3.transform_points(level_from_sensor, xyz_m) if planar else xyz_m
    voxel_m = settings.voxel_planar_m if planar else settings.voxel_m
    found = icp.thin_voxels(moved, planar=planar, voxel_m=voxel_m)
    if planar or len(found) >= settings.voxels:
        return found
    # on surfaces the number of cubes goes with the inverse square of their edge
    share = max(np.sqrt(len(found) / settings.voxels), _SMALLEST_SHARE)
    return icp.thin_voxels(moved, planar=False, voxel_m=share * voxel_m)


def neighbour_reach_m(settings):
    """Return how far apart the neighbours on one line may be, in a planar survey."""
    return 10 * settings.voxel_planar_m


def level_pose(world_from_sensor):
    """Return level_from_sensor: a pose without its place and heading, which a planar survey's scans are levelled by."""
    heading = se3.pose_yaw_rad(world_from_sensor)
    cos, sin = np.cos(heading), np.sin(heading)
    world_from_level = np.eye(4)
    world_from_level[:2, :2] = [[cos, -sin], [sin, cos]]
    world_from_level[:2, 3] = world_from_sensor[:2, 3]
    return se3.invert_pose(world_from_level) @ world_from_sensor


def measure_scan_overlap(source, target, settings):
    """Return fitness and rmse of a scan on another, both where they are put (thesis, 3.5)."""
    motion = se3.invert_pose(target.world_from_cloud) @ source.world_from_cloud
    limits = {"distance_m": settings.fitness_distance_m, "n_probes": settings.fitness_points}
    return icp.measure_overlap(source.cloud, target.cloud, motion, **limits)


def _size(motion):
    """Length in metres and angle in degrees of a 4 x 4 motion."""
    twist = twists.motion_to_twist(motion)
    return float(np.linalg.norm(twist[:3])), float(np.degrees(np.linalg.norm(twist[3:])))
