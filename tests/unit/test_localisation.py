"""A localiser whose errors have the statistics asked for, on drives followed on paper."""

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation import localisation, odometry, rover

# 2 m east at 0.5 m/s, a quarter turn left at 45 deg/s, 1 m north
ELL = rover.plan_drive([[0, 0], [2, 0], [2, 1]], speed_m_s=0.5, turn_rate_deg_s=45.0)
TICKS = rover.tick_stamps(ELL, 100_000_000)
TRUE = rover.drive_poses(ELL, TICKS)
SURE = {
    "noise_m": 0.0,
    "noise_deg": 0.0,
    "drift_m": 0.0,
    "drift_deg": 0.0,
    "drift_time_s": 20.0,
    "jumps_per_min": 0.0,
    "max_jump_m": 0.3,
}
WHEELS = odometry.WheelErrors(
    scale_share=0.01,
    drift_deg_per_m=0.0,
    random_m=0.0,
    random_deg=0.0,
    slips_per_m=0.0,
    max_slip_m=0.2,
    max_slip_deg=5.0,
)
CONVERGED = {"start_off_m": 0.0, "start_off_deg": 0.0, "converge_m": 5.0}
KNOWING = {"start": CONVERGED, "slam": None, "sway": None}
SPEAKING = {"update_distance_m": 0.25, "update_angle_deg": 11.5, "transform_tolerance_s": 0.1}


def believe(**changes):
    known = {**SURE, **SPEAKING, **KNOWING, **changes}
    errors = localisation.LocaliserErrors(**{key: known.pop(key) for key in SURE})
    sway, seed = known.pop("sway"), known.pop("seed", 1)
    localiser = localisation.Localiser(errors=errors, **known)
    return localisation.simulate_belief(TICKS, TRUE, localiser, WHEELS, sway=sway, seed=seed)


def draw(t_s, seed=1, **changes):
    errors = localisation.LocaliserErrors(**{**SURE, **changes})
    return localisation.draw_pose_errors(t_s, errors, seed=seed)


def test_localiser_speaks_first_last_and_after_enough_motion():
    update = localisation.choose_updates(TRUE, distance_m=0.25, angle_rad=0.2)
    assert (update[0], update[-1]) == (0, len(TICKS) - 1)
    moved = np.linalg.norm(np.diff(TRUE[update, :2, 3], axis=0), axis=1)
    turned = np.abs(np.diff(se3.pose_yaw_rad(TRUE[update])))
    # a tick lasts 0.02 s: 0.01 m or 0.9 degrees of overshoot
    assert ((moved[:-1] >= 0.25) | (turned[:-1] >= 0.2)).all()
    assert moved.max() <= 0.25 + 0.01 + 1e-9 and turned.max() <= 0.2 + np.radians(0.9) + 1e-9


def test_a_sure_localiser_tells_the_truth():
    belief = believe()
    np.testing.assert_allclose(belief.map_from_base, TRUE[belief.update], atol=1e-12)
    assert not belief.deviation_m.any() and not belief.deviation_rad.any()
    assert belief.ahead_ns == 100_000_000


def test_white_noise_has_its_deviation_and_no_memory():
    error = draw(np.arange(20_000.0), noise_m=0.05, noise_deg=1.0)
    np.testing.assert_allclose(error.std(axis=0), [0.05, 0.05, np.radians(1.0)], rtol=0.03)
    assert np.abs(_correlation(error, 1)).max() < 0.03


@pytest.mark.parametrize("gap_s", [1.0, 5.0])
def test_drift_is_an_ornstein_uhlenbeck_process_at_any_spacing(gap_s):
    t_s = gap_s * np.arange(200_000.0)
    error = draw(t_s, drift_m=0.04, drift_deg=0.5)
    np.testing.assert_allclose(error.std(axis=0), [0.04, 0.04, np.radians(0.5)], rtol=0.05)
    for steps in (1, 4):
        np.testing.assert_allclose(
            _correlation(error, steps), np.exp(-steps * gap_s / 20.0), atol=0.02
        )


def test_drift_starts_as_large_as_it_stays():
    first = [draw([0.0, 1.0], drift_m=0.04, seed=seed)[0, 0] for seed in range(400)]
    assert np.std(first) == pytest.approx(0.04, rel=0.15)


def test_jumps_come_at_their_rate_to_their_length_in_every_direction():
    jump = localisation.draw_jumps(np.full(60_000, 0.5), 2.0, 0.3, np.random.default_rng(1))
    length_m = np.hypot(jump[:, 0], jump[:, 1])
    # 30,000 s are 500 minutes
    assert (length_m > 0).sum() == pytest.approx(1000, rel=0.1)
    assert 0.29 < length_m.max() <= 0.3
    assert length_m[length_m > 0].mean() == pytest.approx(0.15, rel=0.05)
    assert np.abs(jump[length_m > 0].mean(axis=0)).max() < 0.02
    assert not jump[:, 2].any()


def test_a_jump_decays_with_the_drifts_time(monkeypatch):
    monkeypatch.setattr(
        localisation, "draw_jumps", lambda gap_s, *_: np.eye(3)[[1, 0, 1]] * [[0], [0.3], [0]]
    )
    error = draw([0.0, 1.0, 11.0])
    np.testing.assert_allclose(error[:, 0], [0, 0.3, 0.3 * np.exp(-0.5)], atol=1e-12)


def test_stated_deviation_is_that_of_noise_and_drift():
    belief = believe(noise_m=0.03, drift_m=0.04, noise_deg=0.6, drift_deg=0.8)
    np.testing.assert_allclose(belief.deviation_m, 0.05)
    np.testing.assert_allclose(belief.deviation_rad, np.radians(1.0))


def test_transform_holds_what_the_last_update_said():
    belief = believe(noise_m=0.05, jumps_per_min=60.0)
    assert belief.transform[0] == 0 and (np.diff(belief.transform) == 5).all()
    for tick, map_from_odom in zip(belief.transform, belief.map_from_odom, strict=True):
        last = np.flatnonzero(belief.update <= tick)[-1]
        told = map_from_odom @ belief.odom_from_base[belief.update[last]]
        np.testing.assert_allclose(told, belief.map_from_base[last], atol=1e-12)


def test_a_wrong_start_fades_over_its_way():
    line = rover.planar_poses([[0, 0], [1, 0], [2, 0], [4, 0], [6, 0]], np.zeros(5))
    off = localisation.draw_start(line, start_off_m=2.0, start_off_deg=30.0, converge_m=4.0, seed=1)
    off_m = np.hypot(off[:, 0], off[:, 1])
    # half a wave of the cosine over 4 m
    half = (1 + np.sqrt(0.5)) / 2
    np.testing.assert_allclose(off_m, [2, 2 * half, 1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(np.degrees(np.abs(off[:, 2])), [30, 30 * half, 15, 0, 0], atol=1e-9)


def test_a_localiser_says_that_it_has_not_converged():
    start = {"start_off_m": 1.0, "start_off_deg": 10.0, "converge_m": 1.0}
    belief = believe(start=start)
    off_m = np.linalg.norm((belief.map_from_base - TRUE[belief.update])[:, :2, 3], axis=1)
    np.testing.assert_allclose(belief.deviation_m, off_m, atol=1e-9)
    assert off_m[0] == pytest.approx(1.0) and off_m[-1] < 1e-9


def test_slam_has_no_drift_of_a_particle_filter():
    walk = {"walk_m": 0.0, "walk_deg": 0.0, "loop_late_m": 1.0}
    belief = believe(slam=walk, drift_m=0.5, drift_deg=5.0, jumps_per_min=60.0)
    np.testing.assert_allclose(belief.map_from_base, TRUE[belief.update], atol=1e-9)


def test_sway_that_is_known_is_in_both_poses_and_not_in_the_correction():
    sway = np.tile(np.eye(4), (len(TRUE), 1, 1))
    sway[:, 2, 3] = 0.03 * np.sin(np.arange(len(TRUE)))
    belief, level = believe(sway=sway), believe()
    np.testing.assert_array_equal(belief.update, np.arange(len(TICKS)))
    np.testing.assert_allclose(belief.map_from_base, TRUE @ sway, atol=1e-12)
    np.testing.assert_allclose(belief.odom_from_base, level.odom_from_base @ sway, atol=1e-12)
    # the map lies level in the odometry's frame: all sway is between that and the base
    np.testing.assert_allclose(
        belief.map_from_odom[:, :3, 2], np.tile([0, 0, 1], (len(belief.transform), 1)), atol=1e-12
    )
    np.testing.assert_allclose(belief.map_from_odom[:, 2, 3], 0, atol=1e-12)


def _correlation(error, steps):
    return (error[:-steps] * error[steps:]).mean(axis=0)[:2] / error.var(axis=0)[:2]
