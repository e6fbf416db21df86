"""Directions and moments of one turn."""

from dataclasses import replace

import numpy as np
import pytest

from scanplan.errors import StageError
from scanplan.lab.simulation import sensor_models, sensors

COMMON = sensors.Turning(rate_hz=10.0, sweep=True, min_range_m=0.3, max_range_m=100.0)


def test_vlp16_has_its_sixteen_beams_and_turns_clockwise():
    sensor = sensor_models.make_vlp16(4, COMMON)
    np.testing.assert_allclose(np.linalg.norm(sensor.direction, axis=2), 1, rtol=1e-6)
    elevation_deg = np.degrees(np.arcsin(sensor.direction[..., 2]))
    np.testing.assert_allclose(elevation_deg, np.tile(-15 + 2.0 * sensor.ring, (4, 1)), atol=1e-4)
    assert sorted(sensor.ring) == list(range(16))
    np.testing.assert_allclose(
        sensor.direction[1, :, 1], -np.cos(np.radians(elevation_deg[1])), atol=1e-6
    )


def test_a_lidars_stamp_is_its_last_firing():
    np.testing.assert_allclose(
        sensor_models.make_vlp16(4, COMMON).time_s, [-0.075, -0.05, -0.025, 0]
    )
    np.testing.assert_array_equal(
        sensor_models.make_vlp16(4, replace(COMMON, sweep=False)).time_s, 0
    )


def test_a_lidar_of_any_beams():
    sensor = sensors.make_lidar([-30.0, 10.0], 8, COMMON)
    assert sensor.direction.shape == (8, 2, 3) and sensor.increment_rad is None
    np.testing.assert_array_equal(sensor.ring, [0, 1])
    np.testing.assert_allclose(
        sensor.direction[2], [[0, -np.cos(np.pi / 6), -0.5], _left(-90, 10)], atol=1e-6
    )


def _left(azimuth_deg, elevation_deg):
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    level = np.cos(elevation)
    return [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)]


def test_a_laser_scanner_turns_anticlockwise_from_its_first_beam_at_the_stamp():
    sensor = sensors.make_laser(271, 270.0, COMMON)
    assert sensor.increment_rad == pytest.approx(np.radians(1.0))
    np.testing.assert_allclose(
        sensor.direction[[0, 135, 225], 0], [_left(-135, 0), [1, 0, 0], [0, 1, 0]], atol=1e-5
    )
    # a degree takes 1/360 of a turn
    np.testing.assert_allclose(sensor.time_s, np.arange(271) / 3600)


def test_a_whole_turn_has_no_beam_twice():
    sensor = sensors.make_laser(360, 360.0, COMMON)
    np.testing.assert_allclose(
        sensor.direction[[0, 180, 359], 0], [[-1, 0, 0], [1, 0, 0], _left(179, 0)], atol=1e-5
    )
    assert sensor.time_s[-1] == pytest.approx(0.1 * 359 / 360)


@pytest.mark.parametrize(
    ("make", "changes"),
    [
        (lambda c: sensor_models.make_vlp16(0, c), {}),
        (lambda c: sensors.make_lidar([], 8, c), {}),
        (lambda c: sensors.make_laser(1, 270.0, c), {}),
        (lambda c: sensors.make_laser(10, 400.0, c), {}),
        (lambda c: sensor_models.make_vlp16(8, c), {"max_range_m": 0.2}),
        (lambda c: sensor_models.make_vlp16(8, c), {"min_range_m": -1.0}),
        (lambda c: sensor_models.make_vlp16(8, c), {"rate_hz": 0.0}),
    ],
)
def test_no_sensor(make, changes):
    with pytest.raises(ValueError, match="no sensor"):
        make(replace(COMMON, **changes))


@pytest.mark.parametrize(
    ("model", "elevations_deg"), [("lidar", None), ("vlp16", [0.0]), ("laser", [0.0])]
)
def test_elevations_belong_to_a_lidar_alone(model, elevations_deg):
    with pytest.raises(StageError, match="elevations_deg"):
        sensor_models.make_sensor(
            model, COMMON, n_azimuth=8, elevations_deg=elevations_deg, field_deg=270.0
        )


@pytest.mark.parametrize("field_deg", [90.0, 270.0, 359.0, 360.0])
def test_a_laser_knows_its_field(field_deg):
    assert np.degrees(sensors.make_laser(181, field_deg, COMMON).field_rad) == pytest.approx(
        field_deg, abs=1e-3
    )
    assert sensor_models.make_vlp16(8, COMMON).field_rad == 2 * np.pi


def elevations_deg(sensor):
    return np.degrees(np.arcsin(sensor.direction[..., 2]))


def make(model, n_azimuth=900):
    return sensor_models.make_sensor(
        model, COMMON, n_azimuth=n_azimuth, elevations_deg=None, field_deg=270.0
    )


def test_ouster_spreads_64_beams_over_90_degrees():
    beams = elevations_deg(make("ouster64"))[0]
    np.testing.assert_allclose(beams[[0, 63]], [-45, 45], atol=1e-4)
    np.testing.assert_allclose(np.diff(beams), 90 / 63, atol=1e-4)


def test_uneven_beams_crowd_about_the_horizon():
    beams = elevations_deg(make("uneven32"))[0]
    assert len(beams) == 32 and (np.diff(beams) > 0).all()
    np.testing.assert_allclose(beams[[0, 31]], [-25, 15], atol=1e-4)
    assert (np.abs(beams) < 5).sum() == 22 and np.diff(beams).min() == pytest.approx(
        0.333, abs=1e-3
    )


def test_a_rosette_looks_up_never_repeats_and_fills_its_field():
    sensor = make("rosette", 5000)
    turns = [sensors.turn_directions(sensor, turn) for turn in range(3)]
    np.testing.assert_array_equal(turns[0], sensor.direction)
    assert sensor.direction.shape == (5000, 4, 3) and len(sensor.time_s) == 5000
    for direction in turns:
        np.testing.assert_allclose(np.linalg.norm(direction, axis=2), 1, rtol=1e-6)
        height_deg = np.degrees(np.arcsin(direction[..., 2]))
        assert -7.001 < height_deg.min() < -6.9 and 51.9 < height_deg.max() < 52.001
        # evenly up and down: a quarter of the field holds a quarter of the rays
        assert (height_deg < -7 + 59 / 4).mean() == pytest.approx(0.25, abs=0.01)
    assert np.abs(turns[0] - turns[1]).max() > 0.1 and np.abs(turns[1] - turns[2]).max() > 0.1


def test_only_a_rosettes_turns_differ():
    sensor = make("ouster64")
    assert sensors.turn_directions(sensor, 7) is sensor.direction


def test_scans_of_a_rosette_fill_what_one_leaves_out():
    def seen(n_turns):
        rays = np.concatenate([sensors.turn_directions(sensor, turn) for turn in range(n_turns)])
        azimuth, height = np.degrees(
            [np.arctan2(rays[..., 1], rays[..., 0]), np.arcsin(rays[..., 2])]
        )
        cells = np.floor([azimuth.ravel() / 2, height.ravel() / 2]).astype(int)
        return len(np.unique(cells, axis=1).T)

    sensor = make("rosette")
    assert seen(10) > 1.7 * seen(1)
