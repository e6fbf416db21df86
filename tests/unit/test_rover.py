"""Drives whose timetable can be written down."""

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation import rover

# 2 m east at 0.5 m/s, a quarter turn left at 45 deg/s, 1 m north
ELL = rover.plan_drive([[0, 0], [2, 0], [2, 1]], speed_m_s=0.5, turn_rate_deg_s=45.0)


def x_y_yaw(driven, *t_s):
    pose = rover.drive_poses(driven, np.array(t_s) * 1e9)
    return np.column_stack([pose[:, :2, 3], se3.pose_yaw_rad(pose)])


def test_timetable_of_an_ell():
    np.testing.assert_allclose(ELL.t_s, [0, 4, 6, 8])
    expected = [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
        [2, 0, np.pi / 4],
        [2, 0.5, np.pi / 2],
        [2, 1, np.pi / 2],
    ]
    np.testing.assert_allclose(x_y_yaw(ELL, 0, 2, 4, 5, 7, 8), expected, atol=1e-12)


def test_rover_stands_before_and_after():
    np.testing.assert_allclose(x_y_yaw(ELL, -1, 9), [[0, 0, 0], [2, 1, np.pi / 2]], atol=1e-12)


@pytest.mark.parametrize(
    ("last", "turn_deg"),
    [([2, 1], 90), ([2, -1], -90), ([4, 0], 0), ([1, 0], 180), ([1, 1], 135), ([1, -1], -135)],
)
def test_rover_turns_the_shorter_way(last, turn_deg):
    driven = rover.plan_drive([[0, 0], [2, 0], last], speed_m_s=1.0, turn_rate_deg_s=60.0)
    assert np.degrees(driven.yaw_rad[-1]) == pytest.approx(turn_deg)
    assert driven.t_s[-1] == pytest.approx(2 + abs(turn_deg) / 60 + np.hypot(last[0] - 2, last[1]))


def test_turning_across_the_cut_of_the_angle_stays_continuous():
    driven = rover.plan_drive(
        [[0, 0], [-1, 0.1], [-2, 0], [-3, 0]], speed_m_s=1.0, turn_rate_deg_s=60.0
    )
    assert np.abs(np.diff(driven.yaw_rad)).max() < 0.25


def test_repeated_waypoints_are_one():
    twice = rover.plan_drive(
        [[0, 0], [2, 0], [2, 0], [2, 1], [2, 1]], speed_m_s=0.5, turn_rate_deg_s=45.0
    )
    np.testing.assert_allclose(twice.t_s, ELL.t_s)


@pytest.mark.parametrize("way", [[[1, 1]], [[1, 1], [1, 1]]])
def test_no_way(way):
    with pytest.raises(ValueError, match="two waypoints"):
        rover.plan_drive(way, speed_m_s=1.0, turn_rate_deg_s=60.0)


def test_scans_run_from_start_to_end_and_ticks_around_them():
    scans, ticks = rover.scan_stamps(ELL, 10.0), rover.tick_stamps(ELL, 100_000_000)
    np.testing.assert_array_equal(scans, np.arange(81) * 100_000_000)
    assert ticks[0] < scans[0] and ticks[-1] >= scans[-1]
    assert not np.isin(scans, ticks).any()


def test_mount_is_level_ahead_and_turned():
    base_from_sensor = rover.mount_sensor(height_m=0.4, forward_m=0.1, yaw_deg=90.0)
    np.testing.assert_allclose(
        se3.transform_points(base_from_sensor, [[1, 0, 0]]), [[0.1, 1, 0.4]], atol=1e-12
    )


@pytest.mark.parametrize("margin_ns", [100_000_000, 95_000_000, 1, 33_333_334])
def test_ticks_reach_as_far_beyond_the_drive_as_asked(margin_ns):
    ticks = rover.tick_stamps(ELL, margin_ns)
    assert -margin_ns - rover.TICK_NS <= ticks[0] <= -margin_ns
    assert 8_000_000_000 + margin_ns <= ticks[-1] < 8_000_000_000 + margin_ns + rover.TICK_NS
    assert (np.diff(ticks) == rover.TICK_NS).all()


def test_trace_is_exact_in_between():
    odd = rover.plan_drive(
        [[0, 0], [2.003, 0], [2.003, 1.007]], speed_m_s=0.73, turn_rate_deg_s=61.0
    )
    trace = rover.trace_stamps(odd, 100_000_000)
    mount = rover.mount_sensor(height_m=0.4, forward_m=0.3, yaw_deg=20.0)
    query = np.sort(np.random.default_rng(1).integers(trace[0], trace[-1], 5000))
    known_m, quat = se3.split_pose(rover.drive_poses(odd, trace) @ mount)
    xyz_m, turn, _, covered = se3.interpolate_poses(trace, known_m, quat, query, max_gap_s=0.011)
    true = rover.drive_poses(odd, query) @ mount
    assert covered.all() and trace[0] <= -100_000_000
    assert np.abs(xyz_m - true[:, :3, 3]).max() < 5e-6
    assert np.abs(se3.pose_matrix(xyz_m, turn)[:, :3, :3] - true[:, :3, :3]).max() < 1e-8
