"""A hand that sways about the sensor it holds."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3
from scanplan.lab.simulation import hand_sway, rover

WAY = rover.plan_drive([[0, 0], [4, 0], [4, 3]], speed_m_s=1.0, turn_rate_deg_s=60.0)
MOUNT = rover.mount_sensor(height_m=1.4, forward_m=0.3, yaw_deg=0.0)


def carried(**changes):
    hand = {"sway_m": 0.02, "sway_deg": 3.0, "sway_hz": 1.8, "seed": 1, **changes}
    return rover.carry_in_hand(WAY, MOUNT, **hand)


def test_nothing_sways_on_wheels():
    assert carried(sway_m=0.0, sway_deg=0.0) is WAY


def test_tilts_are_roll_then_pitch_then_yaw():
    angle_rad = np.random.default_rng(1).uniform(-3, 3, (50, 3))
    expected = Rotation.from_euler("xyz", angle_rad).as_matrix()
    np.testing.assert_allclose(hand_sway.tilt_matrices(angle_rad), expected, atol=1e-12)


def test_motions_have_their_deviations():
    swaying = hand_sway.draw_sway(np.zeros(3), sway_m=0.02, sway_deg=3.0, sway_hz=1.8, seed=1)
    poses = hand_sway.sway_poses(swaying, np.arange(0, 600, 0.01) * 1e9)
    np.testing.assert_allclose(poses[:, :3, 3].std(axis=0), 0.02, rtol=0.02)
    angle_deg = Rotation.from_matrix(poses[:, :3, :3]).as_euler("xyz", degrees=True)
    np.testing.assert_allclose(angle_deg.std(axis=0), 3.0, rtol=0.02)
    assert np.abs(angle_deg.mean(axis=0)).max() < 0.05


def test_a_hand_that_only_tilts_leaves_the_sensor_where_it_is():
    t_ns = np.arange(0, 5, 0.1) * 1e9
    level = rover.level_poses(WAY, t_ns) @ MOUNT
    tilted = rover.drive_poses(carried(sway_m=0.0), t_ns) @ MOUNT
    np.testing.assert_allclose(tilted[:, :3, 3], level[:, :3, 3], atol=1e-12)
    assert np.abs(tilted[:, 2, 0]).max() > np.sin(np.radians(2))


def test_a_sine_is_interpolated_as_exactly_as_stated():
    # 0.02 m at 1 Hz: off by 0.02 (2 pi)^2 dt^2 / 8 <= 1e-5 m up to 10.06 ms
    one = np.zeros((6, 1))
    one[2] = 0.02
    rate = np.full((6, 1), 2 * np.pi)
    swaying = hand_sway.Sway(one, rate, np.zeros((6, 1)), np.zeros(3))
    assert hand_sway.longest_step_ns(swaying) == 10_000_000


def test_trace_of_a_hand_is_exact_in_between():
    drive = carried()
    trace = rover.trace_stamps(drive, 100_000_000)
    query = np.sort(np.random.default_rng(1).integers(trace[0], trace[-1], 5000))
    known_m, quat = se3.split_pose(rover.drive_poses(drive, trace) @ MOUNT)
    xyz_m, turn, _, covered = se3.interpolate_poses(trace, known_m, quat, query, max_gap_s=0.011)
    true = rover.drive_poses(drive, query) @ MOUNT
    assert covered.all()
    assert np.abs(xyz_m - true[:, :3, 3]).max() < 1.5e-5
    between = Rotation.from_matrix(true[:, :3, :3]).inv() * Rotation.from_quat(turn)
    assert between.magnitude().max() < 3e-5


def test_a_sensor_upside_down_sees_left_on_its_right_and_one_that_pitches_looks_down():
    hung = rover.mount_sensor(height_m=2, forward_m=0, yaw_deg=0, roll_deg=180, pitch_deg=0)
    np.testing.assert_allclose(
        se3.transform_points(hung, [[1, 2, 0.5]]), [[1, -2, 1.5]], atol=1e-12
    )
    down = rover.mount_sensor(height_m=2, forward_m=0, yaw_deg=90, roll_deg=0, pitch_deg=30)
    np.testing.assert_allclose(
        se3.transform_points(down, [[2, 0, 0]]), [[0, np.sqrt(3), 1]], atol=1e-12
    )


@pytest.mark.parametrize("seed", [1, 2])
def test_sway_is_the_seeds_alone(seed):
    poses = [rover.drive_poses(carried(seed=s), [1e9]) for s in (seed, seed, seed + 1)]
    np.testing.assert_array_equal(poses[0], poses[1])
    assert not np.array_equal(poses[0], poses[2])
