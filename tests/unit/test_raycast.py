"""Rays in a box of 4 m by 3 m by 2.5 m, where every range is known in closed form."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import simple_rooms as drawn
from scanplan import extrusion, raycast, rover, se3

SIZE_M = np.array([4.0, 3.0, 2.5])
MESH = extrusion.building_mesh(drawn.plan())


def lidar(**changes):
    return raycast.vlp16(**{"n_azimuth": 360, "max_range_m": 100.0, "range_noise_m": 0.0, **changes})


def pose(x_m, y_m, yaw_rad, z_m=0.4):
    return rover.planar_poses([[x_m, y_m]], [yaw_rad], z_m)


def only_scan(mesh, sensor, poses, seed=0):
    (scan,) = raycast.survey(mesh, sensor, poses, seed=seed)
    return scan


def box_range_m(origin_m, direction):
    """Distance to the walls, floor or ceiling of the box: the nearest of the planes that a ray runs towards."""
    gap_m = np.where(direction > 0, SIZE_M - origin_m, origin_m)
    speed = np.abs(direction)
    return np.divide(gap_m, speed, out=np.full_like(speed, np.inf), where=speed > 1e-12).min(axis=1)


def test_vlp16_has_its_sixteen_beams_and_turns_clockwise():
    sensor = lidar(n_azimuth=4)
    np.testing.assert_allclose(np.linalg.norm(sensor.direction, axis=1), 1)
    elevation_deg = np.degrees(np.arcsin(sensor.direction[:, 2]))
    np.testing.assert_allclose(elevation_deg, -15 + 2.0 * sensor.ring)
    assert sorted(sensor.ring[:16]) == list(range(16))
    np.testing.assert_allclose(sensor.direction[16:32, 1], -np.cos(np.radians(elevation_deg[16:32])), atol=1e-12)


@settings(max_examples=30, deadline=None)
@given(st.floats(0.3, 3.7), st.floats(0.3, 2.7), st.floats(0.1, 2.4), st.floats(-7, 7))
def test_every_ray_of_a_closed_box_comes_back_from_the_right_distance(x_m, y_m, z_m, yaw_rad):
    sensor, world_from_sensor = lidar(), pose(x_m, y_m, yaw_rad, z_m)
    scan = only_scan(MESH, sensor, world_from_sensor)
    expected_m = box_range_m(world_from_sensor[0, :3, 3], sensor.direction @ world_from_sensor[0, :3, :3].T)
    assert len(scan.xyz_m) == 16 * 360
    np.testing.assert_allclose(scan.xyz_m, sensor.direction * expected_m[:, None], atol=1e-5)


def test_straight_ahead_on_paper():
    beams = raycast.Lidar(
        np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]), np.arange(4, dtype=np.uint16), 9, 0
    )
    # at (1, 1) facing +y: 2 m to the far wall ahead, 1 m to the left, 1 m behind, 3 m to the right
    scan = only_scan(MESH, beams, pose(1, 1, np.pi / 2))
    np.testing.assert_allclose(scan.xyz_m, [[2, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -3, 0]], atol=1e-6)


def test_nothing_comes_back_beyond_the_range():
    ranges_m = np.linalg.norm(only_scan(MESH, lidar(max_range_m=1.5), pose(1, 1, 0)).xyz_m, axis=1)
    everything_m = np.linalg.norm(only_scan(MESH, lidar(), pose(1, 1, 0)).xyz_m, axis=1)
    assert len(ranges_m) == (everything_m <= 1.5).sum()
    assert ranges_m.max() <= 1.5


def test_an_open_door_lets_rays_out_and_only_there():
    opened = extrusion.building_mesh(drawn.plan(drawn.door(2, -0.1)))
    sensor = lidar(n_azimuth=3600)
    scan = only_scan(opened, sensor, pose(2, 1, 0))
    # out through the reveal, which ends 1.2 m away: |x| < 0.5 there; sill and lintel are out of the beams' reach
    x, y, _ = sensor.direction.T
    out = (y < 0) & (np.abs(x) < -y * 0.5 / 1.2 - 1e-6)
    edge = (y < 0) & ~out & (np.abs(x) < -y * 0.5 / 1.2 + 1e-6)
    came_back = np.zeros(len(out), bool)
    came_back[_rows(sensor, scan)] = True
    np.testing.assert_array_equal(came_back[~edge], ~out[~edge])
    assert 1000 < out.sum() < len(out)


def _rows(sensor, scan):
    """The rays that the points of a scan came back on."""
    unit = scan.xyz_m / np.linalg.norm(scan.xyz_m, axis=1, keepdims=True)
    key = {tuple(np.round(d, 4)): i for i, d in enumerate(sensor.direction)}
    return [key[tuple(d)] for d in np.round(unit.astype(float), 4)]


def test_noise_is_gaussian_along_the_ray_with_the_deviation_asked_for():
    sensor = lidar(n_azimuth=1800)
    true = only_scan(MESH, sensor, pose(1, 1, 0)).xyz_m.astype(float)
    noisy = only_scan(MESH, dataclasses.replace(sensor, range_noise_m=0.02), pose(1, 1, 0)).xyz_m
    error_m = np.einsum("ij,ij->i", noisy - true, sensor.direction)
    assert np.abs(noisy - true - error_m[:, None] * sensor.direction).max() < 1e-5
    # 28,800 samples: the standard error of mean and deviation is 0.12 mm and 0.08 mm
    assert abs(error_m.mean()) < 0.0005
    assert error_m.std() == pytest.approx(0.02, abs=0.0004)


def test_a_scan_does_not_depend_on_how_many_others_are_taken_nor_two_on_the_same_noise():
    sensor, three = lidar(range_noise_m=0.01), np.concatenate([pose(1, 1, 0)] * 3)
    a, b, c = raycast.survey(MESH, sensor, three, seed=3)
    np.testing.assert_array_equal(a.xyz_m, only_scan(MESH, sensor, three[:1], seed=3).xyz_m)
    assert not np.array_equal(a.xyz_m, b.xyz_m) and not np.array_equal(b.xyz_m, c.xyz_m)
    assert not np.array_equal(a.xyz_m, only_scan(MESH, sensor, three[:1], seed=4).xyz_m)


def test_a_building_far_from_the_origin_is_measured_as_exactly():
    moved = dataclasses.replace(MESH, vertices_m=MESH.vertices_m + np.array([500_000.0, 4_000_000.0, 0.0]))
    near = only_scan(MESH, lidar(), pose(1.3, 1.1, 0.3)).xyz_m
    far = only_scan(moved, lidar(), pose(500_001.3, 4_000_001.1, 0.3)).xyz_m
    np.testing.assert_allclose(far, near, atol=1e-5)


def test_intensity_tells_the_surface():
    scan = only_scan(MESH, lidar(), pose(1, 1, 0))
    z_m = se3.transform(pose(1, 1, 0)[0], scan.xyz_m)[:, 2]
    np.testing.assert_array_equal(scan.intensity == 30.0, z_m < 1e-5)


@pytest.mark.parametrize("wrong", [{"n_azimuth": 0}, {"max_range_m": 0}, {"range_noise_m": -1}])
def test_no_sensor(wrong):
    with pytest.raises(ValueError, match="no sensor"):
        lidar(**wrong)
