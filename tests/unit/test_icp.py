"""Fitting on corners and rooms whose answer is known, and against Open3D on the same input."""

import numpy as np
import pytest
import small_gicp
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3, twists
from scanplan.registration import icp, planar_icp, prepared_clouds


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


def cloud_of(points, *, planar, voxel_m):
    return prepared_clouds.prepare_cloud(
        prepared_clouds.thin_voxels(points, planar=planar, voxel_m=voxel_m),
        planar=planar,
        reach_m=10 * voxel_m,
    )


def motion(xyz, yaw_deg):
    return se3.pose_matrix(xyz, Rotation.from_euler("z", yaw_deg, degrees=True).as_quat())


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("method", ["gicp", "point_to_plane", "point_to_point"])
def test_a_known_motion_is_found(planar, method):
    rng = np.random.default_rng(1)
    truth = motion([0.08, -0.05, 0.0], 2.0)
    target = cloud_of(box_points(8000, rng, planar=planar), planar=planar, voxel_m=0.05)
    seen = se3.transform_points(se3.invert_pose(truth), box_points(8000, rng, planar=planar))
    source = cloud_of(seen, planar=planar, voxel_m=0.05)
    fit = icp.align_clouds(
        source,
        target,
        np.eye(4),
        icp.IcpSettings(method=method, distances_m=[0.5], max_iterations=60),
    )
    error = se3.invert_pose(truth) @ fit.target_from_source
    assert np.linalg.norm(error[:3, 3]) < (
        0.02 if method == "point_to_point" and not planar else 0.004
    )
    assert abs(np.degrees(se3.pose_yaw_rad(error))) < 0.3
    assert fit.sound and fit.n_unobservable == 0
    assert (
        prepared_clouds.measure_overlap(source, target, fit.target_from_source, distance_m=0.5)[1]
        < 0.1
    )


def test_a_corridor_leaves_the_way_along_it_to_the_start():
    x = np.arange(0, 10, 0.05)
    walls = np.concatenate([np.column_stack([x, 0 * x + y, 0 * x]) for y in (0.0, 2.0)])
    cloud = cloud_of(walls, planar=True, voxel_m=0.05)
    start = motion([0.4, 0.1, 0], 1.0)
    fit = icp.align_clouds(
        cloud, cloud, start, icp.IcpSettings(method="gicp", distances_m=[0.5], max_iterations=30)
    )
    assert abs(fit.target_from_source[1, 3]) < 1e-3
    assert abs(se3.pose_yaw_rad(fit.target_from_source)) < 1e-3
    assert abs(fit.target_from_source[0, 3] - 0.4) < 0.02


@pytest.mark.parametrize(
    ("sure_within_m", "wide_m", "x_m"), [(0.2, 0.4, 0.25), (0.3, 0.4, 0.0), (0.2, 1.6, 0.0)]
)
def test_somebody_who_walks_along_a_corridor_does_not_hold_a_scan(sure_within_m, wide_m, x_m):
    """The rover and what faces it 4 m ahead, a person or a wall, went on by 0.25 m."""
    x = np.arange(0, 6, 0.1)
    walls = [np.column_stack([x, 0 * x + y, 0 * x]) for y in (-1.0, 1.0)]
    y = np.arange(-wide_m / 2, wide_m / 2, 0.05)
    cloud = cloud_of(
        np.concatenate([*walls, np.column_stack([0 * y + 4, y, 0 * y])]), planar=True, voxel_m=0.05
    )
    fit = icp.align_clouds(
        *(cloud, cloud, motion([0.25, 0, 0], 0)),
        icp.IcpSettings(
            method="gicp", distances_m=[0.5, 0.15], max_iterations=30, sure_within_m=sure_within_m
        ),
    )
    assert abs(fit.target_from_source[0, 3] - x_m) < 0.02
    assert fit.n_unobservable == (1 if x_m else 0)


def test_fitness_is_the_share_of_points_with_a_neighbour():
    target = cloud_of([[0, 0, 0], [1, 0, 0], [2, 0, 0]], planar=True, voxel_m=0.01)
    source = cloud_of(
        [[0.05, 0, 0], [1.05, 0, 0], [9, 0, 0], [2.3, 0, 0]], planar=True, voxel_m=0.01
    )
    assert prepared_clouds.measure_overlap(source, target, np.eye(4), distance_m=0.1)[0] == 0.5
    assert prepared_clouds.measure_overlap(source, target, np.eye(4), distance_m=0.4)[0] == 0.75
    assert (
        prepared_clouds.measure_overlap(source, target, motion([100, 0, 0], 0), distance_m=0.4)[0]
        == 0
    )


def test_fitness_agrees_with_open3d():
    import open3d as o3d

    rng = np.random.default_rng(3)
    a, b = box_points(3000, rng), box_points(3000, rng)
    start = motion([0.03, 0.02, 0], 1.0)
    source, target = (cloud_of(points, planar=False, voxel_m=1e-4) for points in (a, b))
    clouds = [o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)) for points in (a, b)]
    theirs = o3d.pipelines.registration.evaluate_registration(*clouds, 0.06, start)
    assert prepared_clouds.measure_overlap(source, target, start, distance_m=0.06)[
        0
    ] == pytest.approx(theirs.fitness, abs=1e-3)


def test_far_apart_there_is_nothing_to_fit():
    cloud = cloud_of(
        box_points(500, np.random.default_rng(0), planar=True), planar=True, voxel_m=0.05
    )
    fit = icp.align_clouds(
        cloud,
        cloud,
        motion([50, 0, 0], 0),
        icp.IcpSettings(method="gicp", distances_m=[0.5], max_iterations=10),
    )
    assert not fit.sound and not fit.information.any()
    np.testing.assert_array_equal(fit.target_from_source, motion([50, 0, 0], 0))


def test_clutter_without_a_line_is_nothing_to_fit():
    points = np.column_stack([np.random.default_rng(5).uniform(0, 40, (60, 2)), np.zeros(60)])
    cloud = cloud_of(points, planar=True, voxel_m=0.1)
    assert not icp.align_clouds(
        cloud,
        cloud,
        np.eye(4),
        icp.IcpSettings(method="gicp", distances_m=[0.5], max_iterations=10),
    ).sound


def test_thinning_keeps_the_mean_of_each_cube():
    points = [[0.01, 0, 0], [0.03, 0, 0], [0.25, 0, 0], [-0.01, 0, 0]]
    thinned = prepared_clouds.thin_voxels(points, planar=False, voxel_m=0.1)
    assert thinned.dtype == np.float32
    np.testing.assert_allclose(
        thinned[np.argsort(thinned[:, 0])], [[-0.01, 0, 0], [0.02, 0, 0], [0.25, 0, 0]]
    )
    assert prepared_clouds.thin_voxels(np.zeros((0, 3)), planar=False, voxel_m=0.1).shape == (0, 3)


def corridor(length_m, *, planar, seed):
    """Two walls 2 m apart, with a floor in space: the same is seen at every place along it."""
    rng = np.random.default_rng(seed)
    x, side = rng.uniform(-length_m, length_m, 20_000), rng.integers(0, 2 if planar else 3, 20_000)
    y = np.choose(side, [-1.0 + 0 * x, 1.0 + 0 * x, rng.uniform(-1, 1, len(x))])
    z = np.choose(side, [rng.uniform(0, 2, len(x))] * 2 + [0 * x]) if not planar else 0 * x
    return np.column_stack([x, y, z - 0.5 * (not planar)]) + rng.normal(0, 0.005, (len(x), 3)) * [
        0,
        1,
        not planar,
    ]


@pytest.mark.parametrize("planar", [False, True])
def test_what_a_corridor_does_not_tell_is_left_to_the_start(planar):
    target, source = (
        cloud_of(corridor(10, planar=planar, seed=seed), planar=planar, voxel_m=0.1)
        for seed in (1, 2)
    )
    start = motion([0.3, 0.08, 0.0], 1.0)
    fit = icp.align_clouds(
        source,
        target,
        start,
        icp.IcpSettings(method="gicp", distances_m=[0.5, 0.15], max_iterations=30),
    )
    assert fit.n_unobservable == 1
    assert np.linalg.norm(fit.information[:3, 0]) < 1e-3 * fit.information[1, 1]
    # along the corridor the start is kept, seen along the direction that was found to be free
    np.testing.assert_allclose(fit.target_from_source[:3, 3], [0.3, 0, 0], atol=0.01)
    assert abs(np.degrees(se3.pose_yaw_rad(fit.target_from_source))) < 0.05


def test_the_information_is_that_of_the_errors():
    """With new noise, the squared error in units of the stated covariance is at most its size."""
    rng, squared = np.random.default_rng(4), []
    for _ in range(12):
        source, target = (
            cloud_of(
                box_points(6000, rng) + rng.normal(0, 0.01, (6000, 3)), planar=False, voxel_m=0.1
            )
            for _ in "ab"
        )
        start = motion([0.03, -0.02, 0.01], 0.5)
        fit = icp.align_clouds(
            source,
            target,
            start,
            icp.IcpSettings(method="gicp", distances_m=[0.5, 0.15], max_iterations=30),
        )
        twist = twists.motion_to_twist(fit.target_from_source)
        squared.append(twist @ fit.information @ twist)
    assert 0.05 < np.median(squared) < 12


def test_the_two_sides_of_a_wall_are_not_the_same_surface():
    """Rooms on either side of a wall 0.1 m thick: near each other, and facing away."""
    rng = np.random.default_rng(7)
    wall = np.column_stack([np.zeros(4000), rng.uniform(-2, 2, 4000), rng.uniform(-1, 1, 4000)])
    here, there = (
        cloud_of(wall + np.array([x, 0, 0]), planar=False, voxel_m=0.1) for x in (1.0, -1.0)
    )
    there_from_here = motion([-2.1, 0, 0], 0)
    assert prepared_clouds.measure_overlap(here, there, there_from_here, distance_m=0.2)[0] == 1
    assert prepared_clouds.measure_overlap(
        here, there, there_from_here, distance_m=0.2, facing=True
    ) == (
        0.0,
        np.inf,
    )
    assert (
        prepared_clouds.measure_overlap(here, here, np.eye(4), distance_m=0.2, facing=True)[0] == 1
    )


def test_few_probes_tell_the_fitness_of_all():
    rng = np.random.default_rng(2)
    source, target = (cloud_of(box_points(8000, rng), planar=False, voxel_m=0.1) for _ in "ab")
    limits = {"distance_m": 0.2}
    aside = motion([0.4, 0, 0], 0)
    every, some = (
        prepared_clouds.measure_overlap(source, target, aside, **limits, n_probes=n)[0]
        for n in (None, 500)
    )
    assert every == pytest.approx(some, abs=0.04) and 0.2 < every < 0.95


@pytest.mark.parametrize("value", [0.0, -1.0])
def test_pairs_that_tell_of_no_direction_are_no_sound_fit(value):
    start = motion([0.1, 0, 0], 3)
    fit = icp._keep_unobservable(start, np.eye(4), value * np.eye(6), 1.0)
    assert not fit.sound and fit.n_unobservable == 6 and not fit.information.any()
    np.testing.assert_array_equal(fit.target_from_source, start)


@pytest.mark.parametrize("planar", [False, True])
def test_the_two_sides_of_a_partition_are_not_drawn_together(planar):
    rng = np.random.default_rng(3)

    # in the plane, as in space, fewer points on the ends than on the partition
    end_m = 0.4 if planar else 1.5

    def plane(n, low, high):
        return rng.uniform(low, high, (n, 3))

    def seen_from(sensor_x_m, face_x_m):
        """Two rooms, and one side of the partition between them beside a wide door."""
        shared = [
            *(plane(1500, (-4, y, 0), (4, y, 2.5)) for y in (-1.5, 1.5)),
            plane(1500, (-4, -1.5, 0), (4, 1.5, 0)),  # the floor, which planar scans do not see
            *(plane(150, (x, -end_m, 0), (x, end_m, 2.5)) for x in (-4, 4)),
        ]
        points = np.concatenate([*shared, plane(1200, (face_x_m, -1.5, 0), (face_x_m, 0.5, 2.5))])
        if planar:
            points = points[points[:, 2] > 0]
        return cloud_of(points - (sensor_x_m, 0, 1), planar=planar, voxel_m=0.2)

    source, target = seen_from(2, 0.1), seen_from(-2, 0.0)
    truth = motion([4.0, 0, 0], 0.0)
    distances_m = [0.5, 0.15] if planar else [0.15]
    fit = icp.align_clouds(
        source,
        target,
        truth,
        icp.IcpSettings(method="gicp", distances_m=distances_m, max_iterations=30),
    )
    assert np.linalg.norm(fit.target_from_source[:3, 3] - truth[:3, 3]) < 0.015


@given(
    points=st.lists(st.tuples(*[st.floats(-20, 20, width=32)] * 3), min_size=1, max_size=40),
    voxel_m=st.sampled_from([0.1, 0.25, 3.0]),
)
def test_voxels_are_those_of_small_gicp(points, voxel_m):
    xyz_m = np.array(points)
    found = prepared_clouds.thin_voxels(xyz_m, planar=False, voxel_m=voxel_m)
    theirs = small_gicp.voxelgrid_sampling(xyz_m, voxel_m, 1).points()[:, :3]
    np.testing.assert_allclose(found, theirs, rtol=1e-6, atol=1e-5)


def test_voxels_far_apart_need_no_table():
    xyz_m = np.array([[-500.0, -500, -10], [500, 500, 10], [500, 500, 10.02]])
    found = prepared_clouds.thin_voxels(xyz_m, planar=False, voxel_m=0.1)
    np.testing.assert_allclose(found, [[-500, -500, -10], [500, 500, 10.01]], atol=1e-3)


@pytest.mark.parametrize("order", ["C", "F"])
def test_thinning_in_the_plane_leaves_the_points_as_they_are(order):
    xyz_m = np.array(np.random.default_rng(1).random((5, 3)), order=order)
    given = xyz_m.copy()
    prepared_clouds.thin_voxels(xyz_m, planar=True, voxel_m=0.1)
    np.testing.assert_array_equal(xyz_m, given)


@given(st.lists(st.floats(0, 1e3), min_size=1, max_size=30))
def test_medians_are_numpys_to_the_bit(values):
    assert planar_icp._median(np.array(values)) == np.median(values)
