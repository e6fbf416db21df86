import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import toy_rooms
from scanplan.extraction import normals


def wall_ahead(distance_m, noise_m=0.0):
    """Return what 16 beams, 2 degrees apart, see of a wall across the x axis."""
    elevation, azimuth = np.deg2rad(np.meshgrid(np.arange(-15, 16, 2), np.arange(-30, 30, 0.2)))
    y, z = np.tan(azimuth.ravel()), np.tan(elevation.ravel()) / np.cos(azimuth.ravel())
    ways = np.column_stack([np.ones(y.size), y, z])
    noise = np.random.default_rng(1).normal(0, noise_m, y.size) / np.linalg.norm(ways, axis=1)
    return ways * (distance_m + noise)[:, None]


def angle_deg(found, expected):
    return np.rad2deg(np.arccos(np.clip(found @ expected, -1, 1)))


@pytest.mark.parametrize("distance_m", [1, 3, 10, 30])
def test_rings_are_spanned_at_every_range(distance_m):
    found = normals.estimate_surface_normals(wall_ahead(distance_m), reach_deg=3.5)
    assert np.isfinite(found).all()
    assert angle_deg(found, np.array([-1.0, 0, 0])).max() < 0.01


@pytest.mark.parametrize("distance_m", [1.5, 3, 10])
def test_error_with_a_centimetre_of_noise(distance_m):
    found = normals.estimate_surface_normals(wall_ahead(distance_m, noise_m=0.01), reach_deg=3.5)
    known = np.isfinite(found[:, 0])
    assert known.mean() > 0.99
    error_deg = angle_deg(found[known], np.array([-1.0, 0, 0]))
    assert np.median(error_deg) < 4.0 / distance_m
    assert np.percentile(error_deg, 95) < 10.0 / distance_m


def test_one_ring_alone_has_no_normal():
    azimuth = np.linspace(-0.5, 0.5, 600)
    ring = np.column_stack([np.full(600, 5.0), 5 * np.tan(azimuth), np.zeros(600)])
    ring += np.random.default_rng(1).normal(0, 0.01, ring.shape)
    known = np.isfinite(normals.estimate_surface_normals(ring, reach_deg=3.5)[:, 0])
    assert known.mean() < 0.15


def test_floor_normals_point_up_to_the_sensor():
    x, y = np.meshgrid(np.arange(-2, 2, 0.03), np.arange(-2, 2, 0.03))
    floor = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, -0.8)])
    floor = floor[np.hypot(*floor[:, :2].T) > 0.8]
    found = normals.estimate_surface_normals(floor, reach_deg=3.5)
    known = np.isfinite(found[:, 0])
    assert known.mean() > 0.9
    assert found[known] == pytest.approx(np.tile([0, 0, 1.0], (known.sum(), 1)), abs=1e-6)


def test_the_turn_closes():
    # a wall behind the sensor, where the azimuth jumps from pi to -pi
    behind = wall_ahead(4) * (-1, 1, 1)
    found = normals.estimate_surface_normals(behind, reach_deg=3.5)
    assert found == pytest.approx(np.tile([1.0, 0, 0], (len(behind), 1)), abs=1e-3)


@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_too_few_points_have_none(n):
    assert np.isnan(normals.estimate_surface_normals(np.ones((n, 3)), reach_deg=3.5)).all()
    assert np.isnan(normals.estimate_outline_normals(np.ones((n, 2)), reach_deg=3.5)).all()


def test_duplicates_have_none():
    assert np.isnan(normals.estimate_surface_normals(np.ones((50, 3)), reach_deg=3.5)).all()
    assert np.isnan(normals.estimate_outline_normals(np.ones((50, 2)), reach_deg=3.5)).all()


def test_planar_normals_of_a_wall_seen_from_head_on_to_grazing():
    azimuth = np.deg2rad(np.arange(-75, 76))
    wall = np.column_stack([np.full(len(azimuth), 2.0), 2 * np.tan(azimuth)])
    found = normals.estimate_outline_normals(wall, reach_deg=3.5)
    assert found == pytest.approx(np.tile([-1.0, 0], (len(wall), 1)), abs=1e-6)


@given(st.floats(-3.1, 3.1))
@settings(max_examples=15, deadline=None)
def test_planar_normals_turn_with_the_points(angle_rad):
    points = (toy_rooms.laser(beams=180) - toy_rooms.SENSOR)[:, :2]
    turn = np.array(
        [[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]]
    )
    found, turned = (
        normals.estimate_outline_normals(p, reach_deg=3.5) for p in (points, points @ turn.T)
    )
    assert turned == pytest.approx(found @ turn.T, abs=1e-6, nan_ok=True)
