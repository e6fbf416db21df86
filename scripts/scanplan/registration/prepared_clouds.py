"""Scans prepared for registration: voxel means, normals, a search tree; and how far two overlap."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import small_gicp

from scanplan.geometry import se3
from scanplan.geometry.occupied_cells import number_occupied
from scanplan.geometry.tolerances import FACING
from scanplan.store.scan_cache import ScanCache
from scanplan.types import FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import KDTree

NEIGHBOURS = 10  # of a spatial normal: few see noise, many smooth edges away
_LINE_NEIGHBOURS = 6  # of a planar normal; fewer, as a line needs fewer than a surface
_MOST_LINE_SPREAD = 0.1  # across to along, squared: 18 degrees, rounder neighbourhoods are corners


@dataclass(frozen=True)
class PreparedCloud:
    """A scan prepared for registration, in its own frame.

    Attributes
    ----------
    xyz_m : (n, 3) float64
        Thinned points; z is 0 in the plane.
    tree : small_gicp.KdTree or scipy.spatial.KDTree
        Over x, y, z; in the plane over x, y.
    planar : bool
    normal : (n, 3) or (n, 2) float64
        Unit normals towards the frame's origin, which is where the sensor is; NaN where neighbours
        form no surface.
    features : small_gicp.PointCloud or None
        The points with covariances; None in the plane.
    """

    xyz_m: FloatArray
    tree: "small_gicp.KdTree | KDTree"
    planar: bool
    normal: FloatArray
    features: small_gicp.PointCloud | None

    @cached_property
    def reach_m(self) -> float:
        """Root of the mean square distance of the points from the sensor."""
        return float(np.sqrt(np.mean(self.xyz_m**2) * 3))

    def nearest_points(self, xyz_m: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the rows (k,) of the nearest points to those of (k, 3), and the squared distances.

        In space only.
        """
        index, squared_m2 = self.tree.batch_knn_search(xyz_m, 1)
        return index[:, 0].astype(np.int64), squared_m2[:, 0]


@dataclass(frozen=True)
class PreparedScans:
    """Scans of a cache, prepared when they are asked for.

    Attributes
    ----------
    thinned : scan_cache.ScanCache
        The points that `prepare_cloud` takes.
    planar : bool
    reach_m : float
        See `prepare_cloud`.
    rows : (n,) int, optional
        Which of the cache; by default all.
    """

    thinned: ScanCache
    planar: bool
    reach_m: float
    rows: IntArray | None = None

    def take(self, rows: IntArray) -> "PreparedScans":
        """Return those of some rows (k,), which then count from 0."""
        return replace(self, rows=rows if self.rows is None else self.rows[rows])

    def __call__(self, rows: IntArray) -> list[PreparedCloud]:
        """Return the clouds of some rows (k,)."""
        of_cache = rows if self.rows is None else self.rows[rows]
        return [
            prepare_cloud(xyz_m, planar=self.planar, reach_m=self.reach_m)
            for xyz_m in self.thinned.part(of_cache.tolist())
        ]


def thin_voxels(xyz_m: FloatArray, *, planar: bool, voxel_m: float) -> FloatArray:
    """Return the mean (m, 3) float32 of the points in every occupied voxel, in a fixed order.

    In the plane the points are put to height 0 first.

    Parameters
    ----------
    xyz_m : (n, 3) float
    voxel_m : float
        Edge of a voxel, metres.
    """
    axes = np.array(np.transpose(xyz_m), np.float64, order="C")
    if axes.shape[1] == 0:
        return np.zeros((0, 3), np.float32)
    if planar:
        axes[2] = 0
    voxel = np.floor(axes * (1 / voxel_m)).astype(np.int64)
    x, y, z = voxel - voxel.min(axis=1)[:, None]
    row, layer = int(x.max()) + 1, int(y.max()) + 1
    key = (z * layer + y) * row + x
    occupied, of_point = number_occupied(key, (int(z.max()) + 1) * layer * row)
    # small_gicp's own sorts the points: two to four times as long, in the same order
    sums_m = np.array([np.bincount(of_point, axis, len(occupied)) for axis in axes])
    return (sums_m / np.bincount(of_point)).T.astype(np.float32)


def prepare_cloud(thinned_m: FloatArray, *, planar: bool, reach_m: float = 1.0) -> PreparedCloud:
    """Compute normals and the search tree of a thinned scan.

    Parameters
    ----------
    thinned_m : (n, 3) float, n >= 1
    planar : bool
        Whether to register in the plane: x, y and the turn about z.
    reach_m : float
        Neighbours farther apart than this, metres, form no line (planar only).
    """
    points = np.ascontiguousarray(thinned_m, np.float64)
    if planar:
        xy_m = points[:, :2]
        tree = plant_tree(xy_m)
        normal = _towards_origin(estimate_planar_normals(xy_m, tree, reach_m=reach_m), xy_m)
        return PreparedCloud(points, tree, True, normal, None)
    cloud = small_gicp.PointCloud(points)
    space_tree = small_gicp.KdTree(cloud)
    small_gicp.estimate_normals_covariances(cloud, space_tree, NEIGHBOURS)
    normal = _towards_origin(cloud.normals()[:, :3], points)
    return PreparedCloud(points, space_tree, False, normal, cloud)


def plant_tree(xy_m: FloatArray) -> "KDTree":
    """Return the search tree of points (n, 2) in the plane."""
    # 0.3 s, and scans in space do not need it; the class that wraps it doubles the time of a query
    from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue]  # compiled

    return cKDTree(xy_m)


def estimate_planar_normals(xy_m: FloatArray, tree: "KDTree", *, reach_m: float) -> FloatArray:
    """Return unit normals (n, 2) from the nearest neighbours.

    They are NaN where neighbours are too few or too far, or form no line.

    Parameters
    ----------
    xy_m : (n, 2) float
    tree : scipy.spatial.KDTree
        Over them.
    reach_m : float
        A point whose neighbours lie farther away, metres, has no normal.
    """
    if len(xy_m) < _LINE_NEIGHBOURS:
        return np.full((len(xy_m), 2), np.nan)
    distance_m, index = tree.query(xy_m, k=_LINE_NEIGHBOURS)
    near_m = xy_m[index]
    x_m, y_m = (near_m - near_m.mean(axis=1, keepdims=True)).transpose(2, 0, 1)
    # of two by two numbers: LAPACK's takes five times as long
    total, difference = ((x_m**2 + sign * y_m**2).sum(axis=1) for sign in (1, -1))
    twice_shared = 2 * (x_m * y_m).sum(axis=1)
    apart = np.hypot(difference, twice_shared)
    is_line = (distance_m[:, -1] < reach_m) & (total - apart < _MOST_LINE_SPREAD * (total + apart))
    along_rad = np.arctan2(twice_shared, difference) / 2
    normal = np.column_stack([-np.sin(along_rad), np.cos(along_rad)])
    return np.where(is_line[:, None], normal, np.nan)


def measure_overlap(
    source: PreparedCloud,
    target: PreparedCloud,
    target_from_source: FloatArray,
    *,
    distance_m: float,
    n_probes: int | None = None,
    facing: bool = False,
) -> tuple[float, float]:
    """Measure how far two scans overlap (thesis, 3.5).

    Parameters
    ----------
    target_from_source : (4, 4) float64
    distance_m : float
        Metres. A source point with a target point nearer than this has a neighbour.
    n_probes : int, optional
        About so many of the source's points are looked at, evenly chosen; all of them by default.
    facing : bool
        Whether a neighbour counts only if its surface faces the same way: the two sides of a wall
        are not one.

    Returns
    -------
    fitness : float
        Share of the source's points with a neighbour.
    rmse_m : float
        Root mean square distance of those points to their neighbours; infinite if there are none.
    """
    step = probe_step(source, n_probes)
    index, apart_m = _nearest_probes(source, target, target_from_source, step, distance_m)
    near = np.flatnonzero(apart_m < distance_m)
    if facing:
        size = target.normal.shape[1]
        turned = source.normal[::step][near] @ target_from_source[:size, :size].T
        cosine = np.einsum("ij,ij->i", turned, target.normal[index[near]])
        near = near[cosine > FACING]
    rmse_m = float(np.sqrt(np.mean(apart_m[near] ** 2))) if len(near) else np.inf
    return len(near) / len(apart_m), rmse_m


def measure_distances(
    source: PreparedCloud,
    target: PreparedCloud,
    target_from_source: FloatArray,
    *,
    n_probes: int | None = None,
) -> FloatArray:
    """Return how far (n,) the points that fitness asks are from the target's nearest, metres.

    The parameters are those of `measure_overlap`.
    """
    step = probe_step(source, n_probes)
    return _nearest_probes(source, target, target_from_source, step)[1]


def probe_step(source: PreparedCloud, n_probes: int | None) -> int:
    """Return n: every n-th point is asked, so that they are about so many."""
    return 1 if n_probes is None else max(1, len(source.xyz_m) // n_probes)


def _nearest_probes(
    source: PreparedCloud,
    target: PreparedCloud,
    target_from_source: FloatArray,
    step: int,
    reach_m: float = np.inf,
) -> tuple[IntArray, FloatArray]:
    """Return row and distance of the target's point nearest to every `step`-th of the source's.

    In the plane those farther than `reach_m` are not looked for: their distance is infinite.
    """
    moved_m = se3.transform_points(target_from_source, source.xyz_m[::step])
    if target.planar:
        apart_m, index = target.tree.query(moved_m[:, :2], distance_upper_bound=reach_m)
        return index, apart_m
    index, squared_m2 = target.nearest_points(moved_m)
    return index, np.sqrt(squared_m2)


def _towards_origin(normal: FloatArray, points: FloatArray) -> FloatArray:
    outward = np.einsum("ij,ij->i", normal, points) > 0
    return np.where(outward[:, None], -normal, normal)
