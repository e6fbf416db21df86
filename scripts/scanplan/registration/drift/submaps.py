"""Submaps: what the scans of a few metres of way show in the plane, walls and free floor.

Over so short a way the chain of scans is as good as rigid; together they are recognised where a
single scan is not (Hess et al. 2016, "Real-time loop closure in 2D LIDAR SLAM").
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import se3
from scanplan.registration.prepared_clouds import PreparedCloud, plant_tree
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True)
class Submap:
    """What some scans in a row show, in the level frame of the one in their middle.

    Attributes
    ----------
    row : int
        Of that scan, among all.
    cloud : prepared_clouds.PreparedCloud
        Points on upright surfaces, in the plane.
    sensor_xy_m : (n, 2) float64
        From where each was seen.
    """

    row: int
    cloud: PreparedCloud
    sensor_xy_m: FloatArray


def cut_way(way_m: FloatArray, length_m: float) -> list[IntArray]:
    """Cut scans into runs of about one length of way.

    Parameters
    ----------
    way_m : (n,) float, not falling
        How far the sensor had come.

    Returns
    -------
    list of (k,) int
        Rows, in their order.
    """
    piece = np.floor((way_m - way_m[0]) / length_m).astype(np.int64)
    return np.split(np.arange(len(way_m)), np.flatnonzero(np.diff(piece)) + 1)


def make_submaps(
    pieces: Sequence[IntArray],
    read_clouds: Callable[[IntArray], list[PreparedCloud]],
    world_from_cloud: FloatArray,
) -> list[Submap]:
    """Merge the scans of each piece of the way, but of those that show next to no wall.

    Parameters
    ----------
    pieces : sequence of (k,) int
        Rows of scans.
    read_clouds : callable
        Returns the clouds of some rows.
    world_from_cloud : (n, 4, 4) float64
        Of all scans.
    """
    found = (merge_scans(rows, read_clouds(rows), world_from_cloud[rows]) for rows in pieces)
    return [merged for merged in found if merged is not None]


def merge_scans(
    rows: IntArray, clouds: Sequence[PreparedCloud], world_from_cloud: FloatArray
) -> Submap | None:
    """Merge scans into a submap; None if they show next to no upright surface.

    Parameters
    ----------
    rows : (k,) int
        Of the scans, among all.
    world_from_cloud : (k, 4, 4) float64
    """
    middle = len(rows) // 2
    level = se3.level_frame(world_from_cloud[middle])
    level_from_cloud = se3.invert_pose(level) @ world_from_cloud
    parts = [_slice_scan(cloud, pose) for cloud, pose in zip(clouds, level_from_cloud, strict=True)]
    xy_m, normal, sensor_xy_m = (np.concatenate(part) for part in zip(*parts, strict=True))
    # points within 5 cm are one: half a cell of the comparison
    cell = np.round(xy_m / 0.05).astype(np.int64)
    _, first = np.unique(cell, axis=0, return_index=True)
    # fewer are one piece of wall, which lies on any other
    if len(first) < 30:
        return None
    xy_m = xy_m[first]
    flat_m = np.column_stack([xy_m, np.zeros(len(xy_m))])
    cloud = PreparedCloud(flat_m, plant_tree(xy_m), True, normal[first], None)
    return Submap(int(rows[middle]), cloud, sensor_xy_m[first])


def _slice_scan(
    cloud: PreparedCloud, level_from_cloud: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the points on upright surfaces about the sensor, their normals, and its place."""
    xyz_m = se3.transform_points(level_from_cloud, cloud.xyz_m)
    size = cloud.normal.shape[1]
    normal = cloud.normal @ level_from_cloud[:size, :size].T
    from_sensor_m = xyz_m - level_from_cloud[:3, 3]
    # returns from farther than 12 m lie in other rooms, and far apart
    is_near = np.linalg.norm(from_sensor_m[:, :2], axis=1) < 12.0
    is_wall = is_near & np.isfinite(normal[:, 0])
    if size == 3:
        # 0.6 m above and below the sensor there are few desks and no ceilings; no wall leans by 30
        # degrees
        is_wall &= np.abs(from_sensor_m[:, 2]) < 0.6
        is_wall &= np.abs(normal[:, 2]) < 0.5
    flat = normal[is_wall, :2]
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    sensor_xy_m = np.repeat(level_from_cloud[None, :2, 3], len(flat), axis=0)
    return xyz_m[is_wall, :2], flat, sensor_xy_m
