"""Wheel odometry that errs as asked, on drives followed on paper."""

from dataclasses import replace

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation import odometry, rover

ELL = rover.plan_drive([[0, 0], [2, 0], [2, 1]], speed_m_s=0.5, turn_rate_deg_s=45.0)
TRUE = rover.drive_poses(ELL, rover.tick_stamps(ELL, 100_000_000))
EXACT = odometry.WheelErrors(
    scale_share=0.0,
    drift_deg_per_m=0.0,
    random_m=0.0,
    random_deg=0.0,
    slips_per_m=0.0,
    max_slip_m=0.0,
    max_slip_deg=0.0,
)
# 4 m east in steps of a centimetre
STRAIGHT = rover.planar_poses(np.outer(np.linspace(0, 4, 401), [1, 0]), np.zeros(401))


def test_odometry_starts_at_zero_and_drifts_slowly():
    drifting = odometry.integrate_odometry(TRUE, replace(EXACT, scale_share=0.01), seed=5)
    np.testing.assert_allclose(drifting[0], np.eye(4), atol=1e-12)
    off_m = np.linalg.norm(drifting[-1, :2, 3] - TRUE[-1, :2, 3])
    assert 0.001 < off_m < 0.15


def test_heading_of_odometry_drifts_with_the_way():
    straight = rover.planar_poses([[0, 0], [1, 0], [2, 0], [4, 0]], np.zeros(4))
    drifting = odometry.integrate_odometry(straight, replace(EXACT, drift_deg_per_m=0.5), seed=1)
    np.testing.assert_allclose(np.degrees(se3.pose_yaw_rad(drifting)), [0, 0.5, 1, 2], atol=1e-9)


def test_odometry_without_error_is_the_motion_from_the_start():
    turned = rover.plan_drive([[1, 1], [1, 3], [2, 3]], speed_m_s=0.5, turn_rate_deg_s=60.0)
    true = rover.drive_poses(turned, rover.tick_stamps(turned, 100_000_000))
    np.testing.assert_allclose(
        odometry.integrate_odometry(true, EXACT, seed=5),
        se3.invert_pose(true[0]) @ true,
        atol=1e-9,
    )


def test_random_errors_grow_with_the_root_of_the_way():
    random = replace(EXACT, random_m=0.02, random_deg=1.0)
    ends = [odometry.integrate_odometry(STRAIGHT, random, seed=seed)[-1] for seed in range(400)]
    # 4 m of way: twice what it is after one
    yaw_deg = np.degrees(se3.pose_yaw_rad(np.array(ends)))
    assert yaw_deg.std() == pytest.approx(2.0, rel=0.1)
    assert np.array(ends)[:, 0, 3].std() == pytest.approx(0.04, rel=0.1)


def test_slips_add_way_and_turn_that_nobody_made_at_their_rate():
    step_m = np.full(100_000, 0.01)
    slip_m, slip_rad = odometry.draw_slips(step_m, 0.5, 0.2, 6.0, seed=1)
    # 1 km of way has 500 slips of 0.1 m and, to either side, 3 degrees in the mean
    assert slip_m.sum() == pytest.approx(50.0, rel=0.15)
    assert (slip_m >= -1e-12).all() and abs(np.degrees(slip_rad.sum())) < 300
    first = np.flatnonzero(slip_m > 1e-9)[0]
    np.testing.assert_allclose(slip_m[first : first + 3], slip_m[first])


def test_wheels_do_not_slip_while_they_stand():
    slip_m, slip_rad = odometry.draw_slips(np.zeros(1000), 10.0, 0.2, 6.0, seed=1)
    assert not slip_m.any() and not slip_rad.any()


def test_a_slip_lengthens_the_way_ahead():
    slipping = replace(EXACT, slips_per_m=1.0, max_slip_m=0.2)
    ends_m = [odometry.integrate_odometry(STRAIGHT, slipping, seed=s)[-1, :2, 3] for s in range(9)]
    assert all(x >= 4 - 1e-9 and abs(y) < 1e-9 for x, y in ends_m)
    assert max(x for x, _ in ends_m) > 4.1
