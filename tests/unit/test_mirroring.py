"""A box of 4 m by 3 m by 2.5 m with a pane or a mirror across it at x = 3."""

import dataclasses

import numpy as np
import pytest

from helpers import simple_rooms as drawn
from scanplan.lab.buildings import extrusion
from scanplan.lab.simulation import mirroring, ray_fates, raycast, scan_rays, sensor_models, sensors
from scanplan.lab.simulation.people import Person
from scanplan.lab.simulation.sensor_errors import SensorErrors

MESH = extrusion.make_building_mesh(drawn.plan())
SENSOR = sensor_models.make_vlp16(
    360, sensors.Turning(rate_hz=10.0, sweep=False, min_range_m=0.0, max_range_m=100.0)
)
AT_M = np.array([1.0, 1.0, 0.4])
RAYS = scan_rays.ScanRays(np.zeros(360), np.tile(AT_M, (360, 1)), SENSOR.direction)
RAY = SENSOR.direction.reshape(-1, 3).astype(float)
MIRRORING = SensorErrors(
    0.0, np.zeros(16, np.float32), 0.0, np.pi / 2, glass_pass=0.0, glass_drop=0.0, glass_mirror=1.0
)


def across(surface):
    """The box with a surface across it."""
    corners = np.array([[3, 0, 0], [3, 3, 0], [3, 3, 2.5], [3, 0, 2.5]], float)
    return extrusion.extend_mesh(MESH, [(surface, corners[[[0, 1, 2], [0, 2, 3]]])])


def returns(mesh, errors=MIRRORING, people=()):
    scene = scan_rays.Scene(raycast.RayScene(mesh), people)
    return ray_fates.find_returns(RAYS, scene, SENSOR, errors, seed=1, scan_id=0)


def unfolded_m():
    """What the mirror law makes of the box: its image behind the mirror makes it 6 m long."""
    gap_m = np.where(RAY > 0, np.array([6.0, 3.0, 2.5]) - AT_M, AT_M)
    speed = np.abs(RAY)
    ways = np.divide(gap_m, speed, out=np.full_like(speed, np.inf), where=speed > 1e-12)
    return ways.min(axis=1)


def test_a_panes_image_stands_where_the_mirror_law_says():
    hits = returns(across("glass"))
    np.testing.assert_allclose(hits.range_m, unfolded_m(), atol=5e-4)
    behind = hits.range_m * RAY[:, 0] + AT_M[0] > 3.001
    assert behind.sum() > 500


def test_an_image_is_as_bright_and_as_oblique_as_what_is_mirrored():
    hits = returns(across("glass"))
    (square,) = np.flatnonzero(np.abs(RAY - RAY[RAY[:, 0].argmax()]).max(axis=1) < 1e-9)
    assert hits.reflectivity[square] == 80 and hits.cosine[square] == pytest.approx(RAY[square, 0])


def test_a_mirror_sends_nearly_all_on_and_loses_the_rest():
    hits = returns(across("mirror"), dataclasses.replace(MIRRORING, glass_mirror=0.0))
    met = RAY[:, 0] * np.minimum(unfolded_m(), 1e9) + AT_M[0] > 3.001
    lost = np.isinf(hits.range_m)
    assert not lost[~met].any() and lost[met].mean() == pytest.approx(0.05, abs=0.02)
    np.testing.assert_allclose(hits.range_m[~lost], unfolded_m()[~lost], atol=5e-4)


def test_nothing_of_a_mirror_itself_returns():
    hits = returns(across("mirror"))
    ahead = (RAY[:, 0] > 0.99) & (RAY[:, 2] > 0)
    assert (hits.range_m[ahead] > 4).all()


def test_a_person_is_mirrored_too():
    # 0.5 m behind the sensor, 2.3 m of way back from the pane to the nearer side
    person = Person(np.zeros(1), np.array([[0.5, 1.0]]))
    hits = returns(across("glass"), people=[person])
    ahead = np.flatnonzero((RAY[:, 1] == 0) & (RAY[:, 0] > 0) & (np.abs(RAY[:, 2]) < 0.02))
    np.testing.assert_allclose(hits.range_m[ahead] * RAY[ahead, 0], 2.0 + 2.3, atol=5e-4)
    assert (hits.reflectivity[ahead] == 40).all()


def test_a_second_mirror_swallows_the_ray():
    facing = np.array([[0.5, 0, 0], [0.5, 3, 0], [0.5, 3, 2.5], [0.5, 0, 2.5]])
    both = extrusion.extend_mesh(across("mirror"), [("mirror", facing[[[0, 1, 2], [0, 2, 3]]])])
    hits = returns(both)
    is_between = (RAY[:, 0] > 0.96) & (np.abs(RAY[:, 1]) < 0.2) & (RAY[:, 2] > 0)
    assert is_between.sum() > 100 and np.isinf(hits.range_m[is_between]).all()


def test_a_bent_ray_keeps_its_way_along_the_mirror_and_turns_the_rest():
    ray = np.array([5])
    towards = RAYS.direction.reshape(-1, 3)[ray]
    for side in (1.0, -1.0):
        normal = np.array([[side, 0, 0]])
        bent = mirroring.bend_rays(RAYS, ray, np.array([2.0]), normal)
        np.testing.assert_allclose(bent.direction[:, 0], towards * [-1, 1, 1], atol=1e-6)
        np.testing.assert_allclose(bent.origin_m, AT_M + 2 * towards - [[1e-4, 0, 0]], atol=1e-6)
