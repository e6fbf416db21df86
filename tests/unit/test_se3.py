"""Rigid motions and interpolation on poses worked out on paper."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from scanplan.geometry import se3

SECOND = 1_000_000_000
T_NS = np.array([0, 1, 2, 10]) * SECOND
XYZ = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [9, 2, 0]], float)
QUAT = Rotation.from_euler("z", [[0], [90], [90], [180]], degrees=True).as_quat()


def interpolate(query_s, **options):
    query_ns = (np.atleast_1d(query_s) * SECOND).astype(np.int64)
    return se3.interpolate_poses(T_NS, XYZ, QUAT, query_ns, **{"max_gap_s": 2.0, **options})


def test_halfway_is_half_the_way_and_half_the_turn():
    xyz, quat, gap_s, covered = interpolate(0.5)
    np.testing.assert_allclose(xyz, [[0.5, 0, 0]])
    np.testing.assert_allclose(Rotation.from_quat(quat).as_euler("zyx", degrees=True)[:, 0], [45])
    assert covered.all() and gap_s[0] == 1.0


def test_stamps_give_their_own_poses():
    xyz, _, gap_s, covered = interpolate([0, 1, 2, 10])
    np.testing.assert_array_equal(xyz, XYZ)
    assert covered.all() and (gap_s == 0).all()


def test_nothing_is_extrapolated_and_long_gaps_are_not_bridged():
    xyz, quat, gap_s, covered = interpolate([-0.1, 5, 10.1])
    assert not covered.any() and np.isnan(xyz).all() and np.isnan(quat).all()
    np.testing.assert_array_equal(gap_s, [np.inf, 8, np.inf])
    assert interpolate(5, max_gap_s=8.0)[3].all()


def test_the_sign_of_a_quaternion_does_not_matter():
    flipped = QUAT * [[1], [-1], [1], [-1]]
    a = se3.interpolate_poses(T_NS, XYZ, QUAT, [SECOND // 3], max_gap_s=2)
    b = se3.interpolate_poses(T_NS, XYZ, flipped, [SECOND // 3], max_gap_s=2)
    np.testing.assert_allclose(a[1], b[1], atol=1e-12)


def test_a_single_pose_covers_its_own_stamp_only():
    xyz, quat, _, covered = se3.interpolate_poses([5], XYZ[:1], QUAT[:1], [4, 5, 6], max_gap_s=9)
    assert covered.tolist() == [False, True, False]
    np.testing.assert_allclose(quat[1], [0, 0, 0, 1])
    np.testing.assert_allclose(xyz[1], [0, 0, 0])


@pytest.mark.parametrize("stamps", [[], [1, 1], [2, 1]])
def test_stamps_that_do_not_increase_are_a_wrong_call(stamps):
    with pytest.raises(ValueError, match="increasing"):
        se3.interpolate_poses(stamps, XYZ[: len(stamps)], QUAT[: len(stamps)], [1], max_gap_s=1)


@given(
    st.lists(st.floats(-50, 50), min_size=3, max_size=3),
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
)
def test_a_motion_and_its_inverse_cancel(xyz, turn):
    quat = Rotation.from_rotvec(turn).as_quat(canonical=True)
    pose = se3.pose_matrix(xyz, quat)
    np.testing.assert_allclose(pose @ se3.invert_pose(pose), np.eye(4), atol=1e-12)
    back_xyz, back_quat = se3.split_pose(pose)
    np.testing.assert_allclose(back_xyz, xyz)
    np.testing.assert_allclose(np.abs(back_quat @ quat), 1, atol=1e-12)
    np.testing.assert_allclose(se3.transform_points(pose, [[0, 0, 0]]), [xyz], atol=1e-12)


@pytest.mark.parametrize("angle_deg", [0.0, 30.0, 170.0, 180.0])
def test_the_turn_between_poses_is_the_angle_of_one_seen_from_the_other(angle_deg):
    one = se3.pose_matrix([1, 2, 3], Rotation.from_euler("x", 40, degrees=True).as_quat())
    turn = Rotation.from_euler("z", angle_deg, degrees=True).as_quat()
    other = one @ se3.pose_matrix([7, 0, 0], turn)
    assert np.degrees(se3.turn_between_rad(one, other)) == pytest.approx(angle_deg, abs=1e-5)


def test_a_nearly_rigid_matrix_becomes_rigid():
    pose = se3.pose_matrix([1, 2, 3], Rotation.from_euler("z", 30, degrees=True).as_quat())
    np.testing.assert_allclose(
        se3.nearest_rigid(pose * [[1.001], [1.001], [1.001], [1]])[:3, :3], pose[:3, :3], atol=1e-9
    )


def test_yaw_is_the_heading():
    pose = se3.pose_matrix([0, 0, 0], Rotation.from_euler("z", 120, degrees=True).as_quat())
    np.testing.assert_allclose(np.degrees(se3.pose_yaw_rad(pose)), 120)


def test_unknown_poses_stay_unknown():
    pose = se3.pose_matrix(np.full((2, 3), np.nan), QUAT[:2])
    assert np.isnan(pose[:, :3]).all()
    assert all(np.isnan(part).all() for part in se3.split_pose(pose))


@pytest.mark.parametrize("error", [0.0, 1e-15, 1e-11, 1e-8, 1e-2])
def test_the_nearest_rotation_is_that_of_the_singular_values(error):
    rng = np.random.default_rng(3)
    pose = np.eye(4)
    pose[:3, :3] = Rotation.random(rng=rng).as_matrix() + error * rng.normal(size=(3, 3))
    left, _, right = np.linalg.svd(pose[:3, :3])
    np.testing.assert_allclose(se3.nearest_rigid(pose)[:3, :3], left @ right, atol=1e-14)


def test_a_reflection_becomes_a_rotation():
    turn = se3.nearest_rigid(np.diag([1.0, 1.0, -1.0, 1.0]))[:3, :3]
    assert np.linalg.det(turn) == pytest.approx(1)


def test_turns_are_interpolated_as_by_scipy():
    rng = np.random.default_rng(4)
    quat = Rotation.random(20, rng=rng).as_quat() * rng.choice([-1, 1], (20, 1))
    quat[7] = -quat[6]
    t_ns = np.arange(20) * 10**9
    query_ns = np.sort(rng.integers(0, t_ns[-1], 200))
    found = se3.interpolate_poses(t_ns, np.zeros((20, 3)), quat, query_ns, max_gap_s=2)[1]
    expected = Slerp(t_ns / 1e9, Rotation.from_quat(quat))(query_ns / 1e9).as_quat(canonical=True)
    np.testing.assert_allclose(found, expected, atol=1e-9)
