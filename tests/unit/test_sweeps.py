"""Turns in a box of 4 m by 3 m by 2.5 m, and how a sensor errs on known ranges."""

import dataclasses

import numpy as np
import pytest

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import extrusion
from scanplan.lab.simulation import raycast, rover, sensor_errors, sensor_models, sensors, sweeps
from scanplan.lab.simulation.people import Person

MESH = extrusion.make_building_mesh(drawn.plan())
EXACT = sensor_errors.SensorErrors(0.0, np.zeros(16, np.float32), 0.0, np.pi / 2, 1.0, 0.0)
# along y = 1 at 1 m/s, facing +x, then a quarter turn at 90 deg/s
DRIVE = rover.plan_drive([[1, 1], [3, 1], [3, 2]], speed_m_s=1.0, turn_rate_deg_s=90.0)
MOUNT = rover.mount_sensor(height_m=0.4, forward_m=0.1, yaw_deg=0.0)


def vlp16(n_azimuth=360, **changes):
    common = {"rate_hz": 10.0, "sweep": True, "min_range_m": 0.0, "max_range_m": 100.0}
    return sensor_models.make_vlp16(n_azimuth, sensors.Turning(**{**common, **changes}))


def survey(sensor=None, errors=EXACT, t_s=(1.0,), people=(), seed=0, mesh=MESH):
    t_ns = np.round(np.array(t_s) * 1e9).astype(np.int64)
    return sweeps.SimulatedSurvey(
        mesh, sensor or vlp16(), errors, DRIVE, MOUNT, tuple(people), t_ns, seed
    )


def only(**given):
    (scan,) = sweeps.simulate_scans(survey(**given))
    return scan


def test_every_column_is_cast_from_where_the_sensor_is_at_its_moment():
    sensor = sensors.make_lidar(
        [0.0], 4, sensors.Turning(rate_hz=10.0, sweep=True, min_range_m=0.0, max_range_m=100.0)
    )
    errors = dataclasses.replace(EXACT, bias_m=np.zeros(1, np.float32))
    # the last column fires at the stamp, the first 75 ms before; forward, right, back, left
    scan = only(sensor=sensor, errors=errors)
    x_m = 2.1 + sensor.time_s
    np.testing.assert_allclose(scan.range_m[:, 0], [4 - x_m[0], 1.0, x_m[2], 2.0], atol=1e-5)
    # 50 ms before the stamp the rover turns: it has turned 45 degrees at 2.5 s
    turning = only(sensor=sensor, errors=errors, t_s=[2.5])
    yaw = np.radians(45 + 90 * sensor.time_s)
    at = np.column_stack([3 + 0.1 * np.cos(yaw), 1 + 0.1 * np.sin(yaw)])
    expected = [(4 - at[0, 0]) / np.cos(yaw[0]), (at[1, 1]) / np.cos(yaw[1])]
    np.testing.assert_allclose(
        turning.range_m[:2, 0],
        np.minimum(expected, [9, (4 - at[1, 0]) / np.sin(yaw[1])]),
        atol=1e-5,
    )


def test_without_sweep_every_column_is_cast_from_the_stamps_pose():
    scan = only(sensor=vlp16(4, sweep=False))
    level = np.cos(np.radians(1))
    np.testing.assert_allclose(scan.range_m[:, 1] * level, [1.9, 1.0, 2.1, 2.0], atol=1e-5)


def test_nothing_comes_back_from_beyond_the_limits():
    all_m = only().range_m
    limited_m = only(sensor=vlp16(min_range_m=1.2, max_range_m=1.5)).range_m
    inside = (all_m >= 1.2) & (all_m <= 1.5)
    np.testing.assert_array_equal(np.isfinite(limited_m), inside)
    np.testing.assert_array_equal(limited_m[inside], all_m[inside])
    assert 0 < inside.sum() < inside.size


def test_noise_has_the_deviation_asked_for():
    true_m = only(sensor=vlp16(1800)).range_m
    error_m = (
        only(sensor=vlp16(1800), errors=dataclasses.replace(EXACT, noise_m=0.02)).range_m - true_m
    )
    # 28,800 samples: the standard error of mean and deviation is 0.12 mm and 0.08 mm
    assert abs(error_m.mean()) < 0.0005
    assert error_m.std() == pytest.approx(0.02, abs=0.0004)
    assert abs(np.corrcoef(error_m[:-1].ravel(), error_m[1:].ravel())[0, 1]) < 0.02


def test_bias_is_one_number_a_beam_in_every_scan():
    bias_m = np.linspace(-0.01, 0.02, 16).astype(np.float32)
    given = {"t_s": (0.5, 1.0, 2.5)}
    true, off = (
        list(sweeps.simulate_scans(survey(errors=e, **given)))
        for e in (EXACT, dataclasses.replace(EXACT, bias_m=bias_m))
    )
    for a, b in zip(true, off, strict=True):
        np.testing.assert_allclose(b.range_m - a.range_m, np.tile(bias_m, (360, 1)), atol=1e-6)


def test_ranges_are_multiples_of_the_quantum():
    steps = only(errors=dataclasses.replace(EXACT, noise_m=0.01, quantum_m=0.002)).range_m / 0.002
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-3)


def test_grazing_returns_are_missing_from_a_scan():
    true = only()
    kept = only(errors=dataclasses.replace(EXACT, grazing_from_rad=np.radians(60))).range_m
    assert np.array_equal(kept[np.isfinite(kept)], true.range_m[np.isfinite(kept)])
    assert 0.01 < np.isnan(kept).mean() < 0.5


def test_a_glazed_room_is_seen_through_its_pane(monkeypatch):
    monkeypatch.setattr(raycast, "SURFACES", ("wall", "floor", "ceiling", "furniture", "glass"))
    all_glass = dataclasses.replace(MESH, surface=np.full_like(MESH.surface, 4))
    assert np.isnan(only(mesh=all_glass).range_m).all()
    back = only(mesh=all_glass, errors=dataclasses.replace(EXACT, glass_pass=0.0))
    np.testing.assert_array_equal(back.range_m, only().range_m)


def test_a_person_hides_the_wall_behind():
    person = Person(np.array([0.0]), np.array([[3.0, 1.0]]))
    alone, hidden = only(), only(people=[person])
    nearer = hidden.range_m < alone.range_m
    np.testing.assert_array_equal(hidden.range_m[~nearer], alone.range_m[~nearer])
    assert nearer[0].any() and not nearer[90:270].any()
    assert (hidden.intensity[nearer] == 40).all()


def test_a_scan_does_not_depend_on_how_many_others_are_taken_nor_two_on_the_same_noise():
    noisy = dataclasses.replace(EXACT, noise_m=0.01, grazing_from_rad=1.2)
    three = {"errors": noisy, "t_s": (-2.0, -1.0, -0.5), "seed": 3}
    a, b, c = (scan.range_m for scan in sweeps.simulate_scans(survey(**three)))
    np.testing.assert_array_equal(a, only(errors=noisy, t_s=[-2.0], seed=3).range_m)
    assert not np.array_equal(a, b, equal_nan=True) and not np.array_equal(b, c, equal_nan=True)
    assert not np.array_equal(a, only(errors=noisy, t_s=[-2.0], seed=4).range_m, equal_nan=True)
