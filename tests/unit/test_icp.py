"""Fitting on corners and rooms whose answer is known, and against Open3D on the same input."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan import icp, se3


def box_points(n, rng, *, planar=False, size=(4.0, 3.0, 2.5)):
    """Points on the walls (and floor) of a box with one corner at the origin."""
    size = np.array(size)
    points = rng.uniform(0, 1, (n, 3)) * size
    side = rng.integers(0, 4 if planar else 5, n)
    for s, (axis, value) in enumerate([(0, 0), (0, size[0]), (1, 0), (1, size[1]), (2, 0)]):
        points[side == s, axis] = value
    if planar:
        points[:, 2] = 0
    return points


def motion(xyz, yaw_deg):
    return se3.matrix(xyz, Rotation.from_euler("z", yaw_deg, degrees=True).as_quat())


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("method", ["gicp", "point_to_plane", "point_to_point"])
def test_a_known_motion_is_found(planar, method):
    rng = np.random.default_rng(1)
    truth = motion([0.08, -0.05, 0.0], 2.0)
    target = icp.prepare(box_points(8000, rng, planar=planar), planar=planar, voxel_m=0.05)
    seen = se3.transform(se3.inverse(truth), box_points(8000, rng, planar=planar))
    source = icp.prepare(seen, planar=planar, voxel_m=0.05)
    fit = icp.align(source, target, np.eye(4), method=method, distance_m=0.5, max_iterations=60)
    error = se3.inverse(truth) @ fit.target_from_source
    assert np.linalg.norm(error[:3, 3]) < (0.02 if method == "point_to_point" and not planar else 0.004)
    assert abs(np.degrees(se3.yaw_rad(error))) < 0.3
    assert fit.rmse_m < 0.1


def test_a_corridor_leaves_the_way_along_it_to_the_start():
    x = np.arange(0, 10, 0.05)
    walls = np.concatenate([np.column_stack([x, 0 * x + y, 0 * x]) for y in (0.0, 2.0)])
    cloud = icp.prepare(walls, planar=True, voxel_m=0.05)
    start = motion([0.4, 0.1, 0], 1.0)
    fit = icp.align(cloud, cloud, start, method="gicp", distance_m=0.5, max_iterations=30)
    assert abs(fit.target_from_source[1, 3]) < 1e-3
    assert abs(se3.yaw_rad(fit.target_from_source)) < 1e-3
    assert abs(fit.target_from_source[0, 3] - 0.4) < 0.02


def test_fitness_is_the_share_of_points_with_a_neighbour():
    target = icp.prepare([[0, 0, 0], [1, 0, 0], [2, 0, 0]], planar=True, voxel_m=0.01)
    source = icp.prepare([[0.05, 0, 0], [1.05, 0, 0], [9, 0, 0], [2.3, 0, 0]], planar=True, voxel_m=0.01)
    assert icp.fitness(source, target, np.eye(4), distance_m=0.1) == 0.5
    assert icp.fitness(source, target, np.eye(4), distance_m=0.4) == 0.75
    assert icp.fitness(source, target, motion([100, 0, 0], 0), distance_m=0.4) == 0


def test_fitness_agrees_with_open3d():
    import open3d as o3d

    rng = np.random.default_rng(3)
    a, b = box_points(3000, rng), box_points(3000, rng)
    start = motion([0.03, 0.02, 0], 1.0)
    source, target = (icp.prepare(points, planar=False, voxel_m=1e-4) for points in (a, b))
    clouds = [o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)) for points in (a, b)]
    theirs = o3d.pipelines.registration.evaluate_registration(*clouds, 0.06, start)
    assert icp.fitness(source, target, start, distance_m=0.06) == pytest.approx(theirs.fitness, abs=1e-3)


def test_far_apart_there_is_nothing_to_fit():
    cloud = icp.prepare(box_points(500, np.random.default_rng(0), planar=True), planar=True, voxel_m=0.05)
    fit = icp.align(cloud, cloud, motion([50, 0, 0], 0), method="gicp", distance_m=0.5, max_iterations=10)
    assert fit.rmse_m == np.inf


def test_clutter_without_a_line_is_nothing_to_fit():
    points = np.column_stack([np.random.default_rng(5).uniform(0, 40, (60, 2)), np.zeros(60)])
    cloud = icp.prepare(points, planar=True, voxel_m=0.1)
    assert icp.align(cloud, cloud, np.eye(4), method="gicp", distance_m=0.5, max_iterations=10).rmse_m == np.inf


def test_thinning_keeps_the_mean_of_each_cube():
    points = [[0.01, 0, 0], [0.03, 0, 0], [0.25, 0, 0], [-0.01, 0, 0]]
    np.testing.assert_allclose(icp.thin(points, 0.1), [[-0.01, 0, 0], [0.02, 0, 0], [0.25, 0, 0]])


def test_merging_moves_each_cloud():
    single = icp.prepare([[0, 0, 0], [1, 0, 0], [2, 0, 0]], planar=True, voxel_m=0.01)
    both = icp.merge([single, single], [np.eye(4), motion([0, 1, 0], 0)], voxel_m=0.01)
    assert {tuple(p) for p in both.xyz_m[:, :2]} == {(x, y) for x in (0, 1, 2) for y in (0, 1)}
