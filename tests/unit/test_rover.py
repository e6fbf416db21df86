"""Drives whose timetable can be written down, and what the localiser makes of them."""

import numpy as np
import pytest
import shapely

from scanplan import rover, se3
from scanplan.errors import StageError

# 2 m east at 0.5 m/s, a quarter turn left at 45 deg/s, 1 m north
ELL = rover.drive([[0, 0], [2, 0], [2, 1]], speed_m_s=0.5, turn_rate_rad_s=np.pi / 4)
QUIET = {"noise_m": 0.0, "noise_rad": 0.0, "update_distance_m": 0.25, "update_angle_rad": 0.2, "seed": 1}


def x_y_yaw(driven, *t_s):
    pose = rover.poses(driven, np.array(t_s) * 1e9)
    return np.column_stack([pose[:, :2, 3], se3.yaw_rad(pose)])


def test_timetable_of_an_ell():
    np.testing.assert_allclose(ELL.t_s, [0, 4, 6, 8])
    expected = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0, np.pi / 4], [2, 0.5, np.pi / 2], [2, 1, np.pi / 2]]
    np.testing.assert_allclose(x_y_yaw(ELL, 0, 2, 4, 5, 7, 8), expected, atol=1e-12)


def test_rover_stands_before_and_after():
    np.testing.assert_allclose(x_y_yaw(ELL, -1, 9), [[0, 0, 0], [2, 1, np.pi / 2]], atol=1e-12)


@pytest.mark.parametrize(
    ("last", "turn_deg"), [([2, 1], 90), ([2, -1], -90), ([4, 0], 0), ([1, 0], 180), ([1, 1], 135), ([1, -1], -135)]
)
def test_rover_turns_the_shorter_way(last, turn_deg):
    driven = rover.drive([[0, 0], [2, 0], last], speed_m_s=1.0, turn_rate_rad_s=1.0)
    assert np.degrees(driven.yaw_rad[-1]) == pytest.approx(turn_deg)
    assert driven.t_s[-1] == pytest.approx(2 + np.radians(abs(turn_deg)) + np.hypot(last[0] - 2, last[1]))


def test_turning_across_the_cut_of_the_angle_stays_continuous():
    driven = rover.drive([[0, 0], [-1, 0.1], [-2, 0], [-3, 0]], speed_m_s=1.0, turn_rate_rad_s=1.0)
    assert np.abs(np.diff(driven.yaw_rad)).max() < 0.25


def test_repeated_waypoints_are_one():
    twice = rover.drive([[0, 0], [2, 0], [2, 0], [2, 1], [2, 1]], speed_m_s=0.5, turn_rate_rad_s=np.pi / 4)
    np.testing.assert_allclose(twice.t_s, ELL.t_s)


@pytest.mark.parametrize("way", [[[1, 1]], [[1, 1], [1, 1]]])
def test_no_way(way):
    with pytest.raises(ValueError, match="two waypoints"):
        rover.drive(way, speed_m_s=1.0, turn_rate_rad_s=1.0)


def test_scans_run_from_start_to_end_and_ticks_around_them():
    scans, ticks = rover.scan_stamps(ELL, 10.0), rover.tick_stamps(ELL)
    np.testing.assert_array_equal(scans, np.arange(81) * 100_000_000)
    assert ticks[0] < scans[0] and ticks[-1] >= scans[-1]
    assert not np.isin(scans, ticks).any()


FLOOR = shapely.box(0, 0, 6, 4)
PILLAR = shapely.box(2, 1, 3, 2)


def test_a_free_way_passes():
    rover.check_way([[1, 0.5], [5, 0.5], [5, 3]], FLOOR, PILLAR, "plan")


@pytest.mark.parametrize(
    ("way", "reach_m", "message"),
    [
        ([[2.5, 1.5], [5, 0.5]], 0.0, r"plan: waypoint 0 \(2.5, 1.5\) lies inside a wall"),
        ([[1, 0.5], [7, 0.5]], 0.0, r"waypoint 1 \(7, 0.5\) lies outside"),
        ([[1, 1.5], [5, 1.5]], 0.0, r"from waypoint 0 to 1 passes a wall or furniture at 0.00 m"),
        ([[1, 0.8], [5, 0.8]], 0.0, r"at 0.20 m near .* the rover needs 0.23 m"),
        ([[1, 0.5], [5, 0.5]], 0.6, r"at 0.50 m near .* the rover needs 0.60 m"),
    ],
)
def test_a_blocked_way_is_refused(way, reach_m, message):
    with pytest.raises(StageError, match=message):
        rover.check_way(way, FLOOR, PILLAR, "plan", reach_m=reach_m)


def test_localiser_speaks_first_last_and_after_enough_motion():
    ticks = rover.tick_stamps(ELL)
    true = rover.poses(ELL, ticks)
    tick, believed = rover.localise(true, **QUIET)
    np.testing.assert_allclose(believed, true[tick], atol=1e-12)
    assert (tick[0], tick[-1]) == (0, len(ticks) - 1)
    moved = np.linalg.norm(np.diff(true[tick, :2, 3], axis=0), axis=1)
    turned = np.abs(np.diff(se3.yaw_rad(true[tick])))
    # a tick lasts 0.05 s: 0.025 m or 2.25 degrees of overshoot
    assert ((moved[:-1] >= 0.25) | (turned[:-1] >= 0.2)).all()
    assert moved.max() <= 0.25 + 0.025 + 1e-9 and turned.max() <= 0.2 + np.radians(2.25) + 1e-9


def test_localiser_errs_as_much_as_asked():
    true = np.tile(np.eye(4), (20_000, 1, 1))
    true[:, 0, 3] = np.arange(20_000)
    _, believed = rover.localise(true, **{**QUIET, "noise_m": 0.05, "noise_rad": 0.02})
    assert np.std(believed[:, 0, 3] - true[:, 0, 3]) == pytest.approx(0.05, rel=0.03)
    assert np.std(believed[:, 1, 3]) == pytest.approx(0.05, rel=0.03)
    assert np.std(se3.yaw_rad(believed)) == pytest.approx(0.02, rel=0.03)
    np.testing.assert_array_equal(believed[:, 2, 3], 0)


def test_odometry_starts_at_zero_and_drifts_slowly():
    true = rover.poses(ELL, rover.tick_stamps(ELL))
    drifting = rover.odometry(true, seed=5)
    np.testing.assert_allclose(drifting[0], np.eye(4), atol=1e-12)
    off_m = np.linalg.norm(drifting[-1, :2, 3] - true[-1, :2, 3])
    assert 0.001 < off_m < 0.15


def test_odometry_without_error_is_the_motion_from_the_start(monkeypatch):
    monkeypatch.setattr(rover, "_ODOMETRY_SCALE_ERROR", 0.0)
    turned = rover.drive([[1, 1], [1, 3], [2, 3]], speed_m_s=0.5, turn_rate_rad_s=1.0)
    true = rover.poses(turned, rover.tick_stamps(turned))
    np.testing.assert_allclose(rover.odometry(true, seed=5), se3.inverse(true[0]) @ true, atol=1e-9)
