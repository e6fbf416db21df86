"""Panes by angle, polished floors, mixed pixels, biases and strays, as counted on paper."""

import dataclasses

import numpy as np
import pytest

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import extrusion
from scanplan.lab.simulation import (
    ray_fates,
    raycast,
    scan_rays,
    sensor_errors,
    sensor_models,
    sensors,
    spurious_returns,
)

COMMON = sensors.Turning(rate_hz=10.0, sweep=False, min_range_m=0.2, max_range_m=50.0)
EXACT = sensor_errors.SensorErrors(0.0, np.zeros(1, np.float32), 0.0, np.pi / 2, 1.0, 0.0)
# 0.05 degrees from ray to ray, looking along x
FINE = sensors.make_laser(3601, 180.0, COMMON)


def wall_at(x_m, low_y_m, high_y_m):
    corners = np.array([[x_m, y, z] for y, z in _corners(low_y_m, high_y_m)], float)
    return ("wall", corners[[[0, 1, 2], [0, 2, 3]]])


def _corners(low_y_m, high_y_m):
    return [(low_y_m, -5), (high_y_m, -5), (high_y_m, 5), (low_y_m, 5)]


def returns(mesh, errors, sensor=FINE, at_m=(0, 0, 0), seed=1):
    n = len(sensor.direction)
    rays = scan_rays.ScanRays(np.zeros(n), np.tile(np.array(at_m, float), (n, 1)), sensor.direction)
    scene = scan_rays.Scene(raycast.RayScene(mesh), ())
    return ray_fates.find_returns(rays, scene, sensor, errors, seed, 0)


# an edge straight ahead: 2 m away to the right, 3 m to the left
STEP = extrusion.join_meshes([wall_at(2.0, -40, 0.0), wall_at(3.0, -1, 40)])
ANGLE_DEG = np.degrees(np.arctan2(FINE.direction[:, 0, 1], FINE.direction[:, 0, 0]))
# beyond, walls slant so much that one beam meets depths apart
MET = np.abs(ANGLE_DEG) < 79


def test_mixed_pixels_lie_between_the_two_depths_and_only_within_the_beam():
    true = returns(STEP, EXACT).range_m[MET]
    wide = dataclasses.replace(EXACT, mixed_rad=np.radians(0.999))
    mixed = np.array([returns(STEP, wide, seed=seed).range_m[MET] for seed in range(50)])
    is_mixed = np.abs(mixed - true) > 1e-3
    assert (np.abs(ANGLE_DEG[MET][is_mixed.any(axis=0)]) < 0.5).all()
    assert ((mixed[is_mixed] > 2) & (mixed[is_mixed] < 3.001)).all()
    # nearer to the surface that the middle of the beam meets
    assert np.abs(mixed - true).max() <= 0.501
    # 20 rays have the edge in their beam: of its disc (1 - 1 / 3) / pi lies beyond it in the mean
    assert is_mixed.sum(axis=1).mean() == pytest.approx(20 * 2 / 3 / np.pi, abs=0.8)


def test_only_neighbours_of_an_edge_are_looked_at():
    true = returns(STEP, EXACT).range_m
    (edge,) = np.nonzero(spurious_returns.find_edges(FINE.direction, true, FINE, 0.0))
    inner = np.abs(ANGLE_DEG[edge]) < 79
    assert inner.sum() == 2 and np.abs(ANGLE_DEG[edge][inner]).max() <= 0.05 + 1e-3
    # a beam of 1 degree reaches over 10 rays to either side
    wide = spurious_returns.find_edges(FINE.direction, true, FINE, np.radians(0.999))
    assert (wide & MET).sum() == 20


def test_echoes_far_apart_are_told_apart():
    far = extrusion.join_meshes([wall_at(2.0, -40, 0.0), wall_at(4.0, -1, 40)])
    mixed = returns(far, dataclasses.replace(EXACT, mixed_rad=np.radians(1.0))).range_m
    np.testing.assert_allclose(mixed[MET], returns(far, EXACT).range_m[MET], atol=5e-3)


def test_a_slanted_wall_is_no_edge():
    wall = returns(extrusion.join_meshes([wall_at(2.0, -40, 40)]), EXACT).range_m
    assert not spurious_returns.find_edges(FINE.direction[MET], wall[MET], FINE, 0.1).any()


def test_jittered_rays_fill_the_beam_evenly():
    own = np.tile(np.array([[0.6, 0.0, 0.8]], np.float32), (40_000, 1))
    beside = spurious_returns.jitter_rays(own, 0.02, np.random.default_rng(1))
    angle = np.arccos(np.clip((own * beside).sum(axis=1, dtype=float), -1, 1))
    assert angle.max() <= 0.0101
    # half of a disc lies within 1 / sqrt(2) of its radius
    assert (angle < 0.01 / np.sqrt(2)).mean() == pytest.approx(0.5, abs=0.02)
    assert np.abs((beside - own).mean(axis=0)).max() < 2e-4


@pytest.mark.parametrize(("share", "near_m"), [(0.0, 2.0), (0.02, 2.0), (0.3, 2.0)])
def test_strays_have_their_share_and_come_before_the_surface(share, near_m):
    wall = extrusion.join_meshes([wall_at(near_m, -40, 40)])
    true = returns(wall, EXACT)
    rainy = returns(wall, dataclasses.replace(EXACT, stray_share=share))
    is_stray = rainy.range_m != true.range_m
    assert is_stray.mean() == pytest.approx(share, abs=0.02)
    assert (rainy.range_m[is_stray] >= 0.2 - 1e-6).all()
    assert (rainy.range_m[is_stray] <= np.minimum(true.range_m[is_stray], 50)).all()


def test_strays_of_rays_that_meet_nothing_reach_as_far_as_the_sensor():
    hits = raycast.RayHits(*np.full((3, 20_000), np.inf, np.float32))
    lost = dataclasses.replace(hits, range_m=np.full(20_000, np.nan, np.float32))
    for nothing in (hits, lost):
        stray = spurious_returns.scatter_strays(nothing, 1.0, FINE, np.random.default_rng(1))
        assert stray.range_m.min() < 0.5 and 49 < stray.range_m.max() <= 50
        assert stray.range_m.mean() == pytest.approx(25.1, abs=0.5)


def test_dark_surfaces_are_off_by_what_is_missing_to_white():
    hits = raycast.RayHits(
        np.full(3, 2, np.float32), np.ones(3, np.float32), np.array([0, 80, 100], np.float32)
    )
    off = spurious_returns.bias_ranges(hits, dataclasses.replace(EXACT, bias_intensity_m=0.05))
    np.testing.assert_allclose(off.range_m, [2.05, 2.01, 2.0], atol=1e-6)


def test_slanted_surfaces_are_off_as_one_over_the_cosine():
    cosine = np.cos(np.radians([0, 60, 70.5288, 89])).astype(np.float32)
    hits = raycast.RayHits(np.full(4, 2, np.float32), cosine, np.full(4, 100, np.float32))
    off = spurious_returns.bias_ranges(hits, dataclasses.replace(EXACT, bias_incidence_m=0.01))
    # 1 / cos - 1 is 0, 1, 2, and at most 1 / 0.17 - 1
    np.testing.assert_allclose(off.range_m - 2, [0, 0.01, 0.02, 0.01 * (1 / 0.17 - 1)], atol=1e-6)


def test_a_pane_returns_near_square_and_passes_elsewhere():
    pane = ("glass", wall_at(2.0, -40, 40)[1])
    mesh = extrusion.join_meshes([pane, wall_at(3.0, -80, 80)])
    settings = {"glass_pass": 0.28, "glass_drop": 0.08, "glass_mirror": 0.04}
    errors = dataclasses.replace(EXACT, **settings, glass_return_rad=np.radians(8.0))
    range_m = np.array([returns(mesh, errors, seed=seed).range_m for seed in range(60)])
    x_m = range_m * FINE.direction[:, 0, 0]
    is_square = np.abs(ANGLE_DEG) < 7.99
    is_oblique = (np.abs(ANGLE_DEG) > 8.01) & (np.abs(ANGLE_DEG) < 80)
    for chosen, back, passed in ((is_square, 0.60, 0.28), (is_oblique, 0.0, 0.88)):
        assert np.isclose(x_m[:, chosen], 2, atol=1e-3).mean() == pytest.approx(back, abs=0.01)
        assert np.isclose(x_m[:, chosen], 3, atol=1e-3).mean() == pytest.approx(passed, abs=0.01)
        # nothing stands behind the sensor: what is mirrored is lost like what is swallowed
        assert np.isinf(x_m[:, chosen]).mean() == pytest.approx(0.12, abs=0.01)


@pytest.mark.parametrize(
    ("from_deg", "angle_deg", "share"), [(50, 45, 0), (50, 70, 0.5), (90, 80, 0)]
)
def test_a_polished_floor_loses_returns_at_grazing_incidence(from_deg, angle_deg, share):
    mesh = extrusion.make_building_mesh(drawn.plan())
    is_floor = mesh.surface == extrusion.SURFACES.index("floor")
    surface = np.where(is_floor, extrusion.SURFACES.index("polished"), mesh.surface)
    polished = dataclasses.replace(mesh, surface=surface.astype(np.uint8))
    # rays that meet the floor at this angle to its normal, from 0.4 m
    sensor = sensors.make_lidar([angle_deg - 90.0], 2000, COMMON)
    errors = dataclasses.replace(EXACT, polished_from_rad=np.radians(from_deg))
    shares = [
        np.isinf(returns(polished, errors, sensor, at_m=(2.0, 1.5, 0.2), seed=s).range_m).mean()
        for s in range(5)
    ]
    assert np.mean(shares) == pytest.approx(share, abs=0.02)
    assert np.isfinite(returns(mesh, errors, sensor, at_m=(2.0, 1.5, 0.2)).range_m).all()


def test_every_key_at_its_default_changes_no_hit():
    mesh = extrusion.make_building_mesh(drawn.plan())
    sensor = sensor_models.make_vlp16(90, COMMON)
    opaque, _ = raycast.RayScene(mesh).first_hits(
        np.tile([1.0, 1.0, 0.4], (90, 1)), sensor.direction
    )
    hits = returns(mesh, EXACT, sensor, at_m=(1.0, 1.0, 0.4))
    np.testing.assert_array_equal(hits.range_m, opaque.range_m)
