"""Rays in a box of 4 m by 3 m by 2.5 m, where every range is known in closed form."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import extrusion
from scanplan.lab.simulation import raycast, rover, sensor_models, sensors

SIZE_M = np.array([4.0, 3.0, 2.5])
MESH = extrusion.make_building_mesh(drawn.plan())
DIRECTION = sensor_models.make_vlp16(
    360, sensors.Turning(rate_hz=10.0, sweep=False, min_range_m=0.0, max_range_m=100.0)
).direction


def cast(mesh, xyz_m, yaw_rad=0.0, direction=DIRECTION):
    """Cast all columns from one place, turned by a heading: opaque hits, panes, rays in the map."""
    turned = direction @ rover.planar_poses([[0, 0]], [yaw_rad])[0, :3, :3].T.astype(np.float32)
    opaque, pane = raycast.RayScene(mesh).first_hits(np.tile(xyz_m, (len(turned), 1)), turned)
    return opaque, pane, turned.reshape(-1, 3).astype(float)


def box_range_m(origin_m, direction):
    """Distance to walls, floor or ceiling of the box: all planes that a ray runs towards."""
    gap_m = np.where(direction > 0, SIZE_M - origin_m, origin_m)
    speed = np.abs(direction)
    return np.divide(gap_m, speed, out=np.full_like(speed, np.inf), where=speed > 1e-12)


@settings(max_examples=30, deadline=None)
@given(st.floats(0.3, 3.7), st.floats(0.3, 2.7), st.floats(0.1, 2.4), st.floats(-7, 7))
def test_every_ray_of_a_closed_box_comes_back_from_the_right_distance(x_m, y_m, z_m, yaw_rad):
    hits, pane, ray = cast(MESH, [x_m, y_m, z_m], yaw_rad)
    expected_m = box_range_m(np.array([x_m, y_m, z_m]), ray)
    np.testing.assert_allclose(hits.range_m, expected_m.min(axis=1), atol=1e-5, rtol=1e-6)
    assert pane is None


def test_cosine_is_that_of_the_surface_hit():
    hits, _, ray = cast(MESH, [1.0, 1.0, 0.4], 0.3)
    expected_m = box_range_m(np.array([1.0, 1.0, 0.4]), ray)
    nearest, second = np.sort(expected_m, axis=1)[:, :2].T
    clear = second - nearest > 1e-4
    along = np.abs(ray)[np.arange(len(ray)), expected_m.argmin(axis=1)]
    np.testing.assert_allclose(hits.cosine[clear], along[clear], atol=1e-5)


def test_an_open_door_lets_rays_out_and_only_there():
    opened = extrusion.make_building_mesh(drawn.plan(drawn.door(2, -0.1)))
    hits, _, ray = cast(opened, [2.0, 1.0, 0.4])
    # out through the reveal, which ends 1.2 m away: |x| < 0.5 there; no beam reaches sill or lintel
    x, y, _ = ray.T
    out = (y < 0) & (np.abs(x) < -y * 0.5 / 1.2 - 1e-6)
    edge = (y < 0) & ~out & (np.abs(x) < -y * 0.5 / 1.2 + 1e-6)
    np.testing.assert_array_equal(np.isinf(hits.range_m)[~edge], out[~edge])
    assert 300 < out.sum() < len(out)


def test_a_building_far_from_the_origin_is_measured_as_exactly():
    far = np.array([500_000.0, 4_000_000.0, 0.0])
    moved = dataclasses.replace(MESH, vertices_m=MESH.vertices_m + far)
    here, there = (
        cast(mesh, at + np.array([1.3, 1.1, 0.4]), 0.3)[0]
        for mesh, at in ((MESH, 0 * far), (moved, far))
    )
    np.testing.assert_allclose(there.range_m, here.range_m, atol=1e-5)


def test_reflectivity_tells_the_surface():
    hits, _, ray = cast(MESH, [1.0, 1.0, 0.4])
    z_m = 0.4 + hits.range_m * ray[:, 2]
    np.testing.assert_array_equal(hits.reflectivity == 30.0, z_m < 1e-5)


@pytest.fixture
def glazed(monkeypatch):
    """The box with a pane across it at x = 3."""
    monkeypatch.setattr(raycast, "SURFACES", ("wall", "floor", "ceiling", "furniture", "glass"))
    corners = [[3, 0, 0], [3, 3, 0], [3, 3, 2.5], [3, 0, 2.5]]
    n = len(MESH.vertices_m)
    return extrusion.Mesh(
        np.vstack([MESH.vertices_m, corners]),
        np.vstack([MESH.triangles, [[n, n + 1, n + 2], [n, n + 2, n + 3]]]).astype(np.int32),
        np.append(MESH.surface, [4, 4]).astype(np.uint8),
    )


def test_panes_are_found_apart_from_what_is_behind(glazed):
    opaque, pane, ray = cast(glazed, [1.0, 1.0, 0.4])
    np.testing.assert_allclose(
        opaque.range_m, box_range_m(np.array([1.0, 1.0, 0.4]), ray).min(axis=1), atol=1e-5
    )
    ahead = pane.range_m < opaque.range_m
    np.testing.assert_allclose(pane.range_m[ahead] * ray[ahead, 0], 2.0, atol=1e-5)
    assert ahead.sum() > 500 and (pane.reflectivity[ahead] == 10.0).all()
    assert not ahead[ray[:, 0] < 0].any()


def test_nothing_but_glass(glazed):
    chosen = glazed.surface == 4
    bare = dataclasses.replace(
        glazed, triangles=glazed.triangles[chosen], surface=glazed.surface[chosen]
    )
    opaque, pane, _ = cast(bare, [1.0, 1.0, 0.4])
    assert np.isinf(opaque.range_m).all() and np.isfinite(pane.range_m).any()
