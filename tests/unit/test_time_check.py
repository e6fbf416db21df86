from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3
from scanplan.recordings import clouds
from scanplan.recordings.motion import time_check, trajectory

T_NS, PERIOD_S, N_SCANS = 1_700_000_000_000_000_000, 0.1, 60
BEAM_RAD = np.arange(360) * np.radians(1)
STATED_S = np.arange(360) / 360 * PERIOD_S


def heading_rad(t_s, swing_rad):
    """A sensor in the middle of a room that looks left and right every two seconds."""
    return swing_rad * np.sin(np.pi * t_s)


def motion_of(swing_rad):
    t_s = np.arange(-0.5, N_SCANS * PERIOD_S + 0.5, 0.02)
    quat = Rotation.from_euler("z", heading_rad(t_s, swing_rad)[:, None]).as_quat()
    t_ns = T_NS + np.round(t_s * 1e9).astype(np.int64)
    return trajectory.SensorMotion(
        t_ns, np.zeros((len(t_s), 3)), quat, np.zeros(len(t_s), np.int32)
    )


def scan(scan_id, read, swing_rad, noise_m):
    """What the sensor sees of a room of 6 m by 4 m if `read` makes the true times."""
    stamp_s = scan_id * PERIOD_S
    towards = BEAM_RAD + heading_rad(stamp_s + read(STATED_S), swing_rad)
    with np.errstate(divide="ignore"):
        range_m = np.minimum(3 / np.abs(np.cos(towards)), 2 / np.abs(np.sin(towards)))
    range_m += np.random.default_rng(scan_id).normal(0, noise_m, len(range_m))
    xyz_m = np.column_stack([range_m * np.cos(BEAM_RAD), range_m * np.sin(BEAM_RAD), 0 * range_m])
    return clouds.Scan(scan_id, T_NS + round(stamp_s * 1e9), xyz_m.astype(np.float32), STATED_S, 0)


def survey(read, swing_rad=1.0, noise_m=0.003):
    scans = [scan(i, read, swing_rad, noise_m) for i in range(N_SCANS)]
    return SimpleNamespace(
        sweep_times="s since the stamp",
        planar=True,
        stamps=lambda: np.array([s.t_ns for s in scans]),
        scans=lambda wanted: (s for s in scans if s.scan_id in set(map(int, wanted))),
    )


LAST_S = STATED_S[-1]
WAYS = {
    "as stated": lambda t: t,
    "in reversed order": lambda t: LAST_S - t,
    "with the stamp at the other end": lambda t: t - LAST_S,
    "in reversed order with the stamp at the other end": lambda t: -t,
    "not at all": lambda t: 0 * t,
}


@pytest.mark.parametrize("name", WAYS)
def test_the_true_reading_is_found(name, caplog):
    with caplog.at_level("INFO"):
        found = time_check.check_point_times(survey(WAYS[name]), motion_of(1.0))
    expected = next(r for r in time_check.list_time_readings(0.0, LAST_S) if r.name == name)
    assert (found.time_scale, found.time_shift_s) == pytest.approx(
        (expected.scale, expected.shift_s)
    )
    assert f"times of points are read {name};" in caplog.text


def test_a_sensor_that_does_not_turn_tells_nothing(caplog):
    way = motion_of(0.001)
    with caplog.at_level("INFO"):
        assert time_check.check_point_times(survey(WAYS["not at all"], 0.001), way) is way
    assert "turning changes too little to check" in caplog.text


def test_of_a_small_difference_the_statement_is_believed():
    """The sensor hardly turns and its ranges are rough: readings differ by less than noise."""
    way = motion_of(0.1)
    assert (
        time_check.check_point_times(survey(WAYS["not at all"], 0.1, noise_m=0.04), way).time_scale
        == 1.0
    )


def test_untimed_surveys_are_left_alone():
    way = motion_of(1.0)
    assert time_check.check_point_times(SimpleNamespace(sweep_times=None), way) is way


@pytest.mark.parametrize(("first_s", "last_s"), [(0.0, 0.1), (-0.1, 0.0), (-0.2, 0.001)])
def test_readings_cover_the_sweep_that_they_say(first_s, last_s):
    way = {
        r.name: np.sort(r.scale * np.array([first_s, last_s]) + r.shift_s)
        for r in time_check.list_time_readings(first_s, last_s)
    }
    np.testing.assert_allclose(way["as stated"], [first_s, last_s])
    np.testing.assert_allclose(way["in reversed order"], [first_s, last_s])
    other = way["with the stamp at the other end"]
    assert (
        np.ptp(other) == pytest.approx(last_s - first_s)
        and abs(other.mean() + (first_s + last_s) / 2) < 0.003
    )
    np.testing.assert_allclose(
        way["in reversed order with the stamp at the other end"], [-last_s, -first_s]
    )


def test_windows_lie_where_the_turning_changes_and_do_not_overlap():
    t_s = np.arange(0, 60, 0.1)
    turns = np.where((t_s > 20) & (t_s < 24), heading_rad(t_s - 20, 1.0), 0.0)
    quat = Rotation.from_euler("z", turns[:, None]).as_quat()
    t_ns = T_NS + np.round(t_s * 1e9).astype(np.int64)
    found = time_check.choose_turning_windows(
        t_ns, trajectory.SensorMotion(t_ns, np.zeros((len(t_s), 3)), quat, np.zeros(len(t_s), int))
    )
    assert len(found) >= 1 and all(len(w) <= 10 for w in found)
    assert all(w[0] >= 150 and w[-1] < 280 for w in found)
    assert sorted(i for w in found for i in w) == sorted({i for w in found for i in w})


def test_windows_avoid_stamps_that_go_back():
    t_ns = T_NS + (np.arange(100) % 10) * 10**8
    assert time_check.choose_turning_windows(t_ns, motion_of(1.0)) == []


def test_poses_of_scans_agree_with_the_toy():
    np.testing.assert_allclose(
        se3.pose_yaw_rad(motion_of(1.0).at([T_NS + 5 * 10**8])), heading_rad(0.5, 1.0), atol=1e-3
    )


@pytest.mark.parametrize(("n_better", "is_usual"), [(7, False), (8, True)])
def test_a_reading_is_better_only_where_most_windows_say_so(n_better, is_usual):
    """Ten windows of three places each: in some the second reading scatters half as much."""
    groups = [np.array([[0.02] * 3, [0.01 if i < n_better else 0.03] * 3]) for i in range(10)]
    assert time_check._is_usual([*groups, np.empty((2, 0))], 1) == is_usual


@given(st.lists(st.lists(st.integers(1, 9), min_size=3, max_size=3), min_size=1, max_size=10))
def test_no_reading_becomes_usual_after_it_is_settled_that_none_can(medians):
    groups = [np.repeat(np.array(of_group, float)[:, None], 5, axis=1) for of_group in medians]
    settled = [
        n for n in range(1, len(groups) + 1) if time_check._is_settled(groups[:n], len(groups))
    ]
    if settled:
        for n in range(settled[0], len(groups) + 1):
            assert not any(time_check._is_usual(groups[:n], reading) for reading in (1, 2))


def test_groups_are_measured_until_it_is_settled(monkeypatch):
    measured = []

    def measure(group, readings, motion, planar):
        measured.append(group)
        return np.tile(np.arange(1.0, 1 + len(readings))[:, None], 200)

    monkeypatch.setattr(time_check, "_measure_scatters", measure)
    groups = [[scan(i, WAYS["as stated"], 1.0, 0.003)] for i in range(10)]
    best, scatters = time_check.choose_reading(groups, motion_of(1.0), planar=True)
    assert best.name == "as stated" and scatters.startswith("as stated 1000.0 mm")
    # three of ten are more than a quarter
    assert len(measured) == 3
