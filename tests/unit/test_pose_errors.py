import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3
from scanplan.lab.evaluation import pose_errors
from scanplan.lab.simulation import rover


def test_known_errors():
    truth = rover.planar_poses([[0, 0], [1, 2]], [0.0, 0.5], 0.4)
    estimate = rover.planar_poses([[0.3, 0.4], [1, 2]], [0.0, 0.5 + np.radians(2)], 0.4)
    distance_m, angle_deg = pose_errors.pose_errors(estimate, truth)
    np.testing.assert_allclose(distance_m, [0.5, 0], atol=1e-12)
    np.testing.assert_allclose(angle_deg, [0, 2], atol=1e-6)


@pytest.mark.parametrize("line", [False, True])
def test_a_rigid_motion_is_found_and_taken_out(line):
    rng = np.random.default_rng(1)
    xy = rng.uniform(-5, 5, (20, 2)) * ((1, 0) if line else (1, 1))
    truth = rover.planar_poses(xy, rng.uniform(-3, 3, 20), 0.4)
    motion = np.eye(4)
    motion[:3, :3] = Rotation.from_euler("z", 2.9).as_matrix()
    motion[:3, 3] = (3, -1, 0.2)
    found = pose_errors.fit_alignment((se3.invert_pose(motion) @ truth)[:, :3, 3], truth[:, :3, 3])
    np.testing.assert_allclose(found, motion, atol=1e-9)
    np.testing.assert_allclose(
        pose_errors.pose_errors(found @ se3.invert_pose(motion) @ truth, truth), 0, atol=1e-5
    )


def test_no_other_motion_is_better():
    rng = np.random.default_rng(2)
    truth = rng.uniform(-5, 5, (15, 3))
    estimate = truth + rng.normal(0, 0.3, truth.shape)
    best = pose_errors.fit_alignment(estimate, truth)
    left = np.sum((se3.transform_points(best, estimate) - truth) ** 2)
    for yaw in (-0.01, 0.01):
        turn = np.eye(4)
        turn[:3, :3] = Rotation.from_euler("z", yaw).as_matrix() @ best[:3, :3]
        turn[:3, 3] = truth.mean(axis=0) - turn[:3, :3] @ estimate.mean(axis=0)
        assert np.sum((se3.transform_points(turn, estimate) - truth) ** 2) > left


def test_one_position_is_shifted_without_a_turn():
    found = pose_errors.fit_alignment(np.array([[1.0, 2, 3]]), np.array([[2.0, 2, 3]]))
    np.testing.assert_allclose(found[:3, :3], np.eye(3))
    np.testing.assert_allclose(found[:3, 3], [1, 0, 0])
