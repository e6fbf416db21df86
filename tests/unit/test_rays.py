import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.plan import rays
from scanplan.plan.faceline import Line

# the x axis, seen from above (y > 0)
AXIS = Line(np.zeros(2), np.array([0.0, 1.0]))


def one_scan(points, sensor=(0.0, 2.0, 1.0), planar=True):
    return rays.gather([(7, np.array(points, float))], {7: np.array(sensor)}, planar=planar)


def look(found, low=-5, high=5, band=0.05):
    return rays.look(found, AXIS, low, high, band_m=band)


def test_points_at_a_line_are_hits_and_those_behind_it_were_seen_through_it():
    sight = look(one_scan([(1, 0.01, 1), (2, -2, 1), (0, 1, 1)]))
    np.testing.assert_allclose(sight.hit_xy_m, [(1, 0.01)])
    # from (0, 2) to (2, -2): half way
    np.testing.assert_allclose(sight.pass_xy_m, [(1, 0)])
    assert (sight.hit_scan.tolist(), sight.pass_scan.tolist()) == ([0], [0])


def test_a_point_just_behind_a_line_says_nothing():
    sight = look(one_scan([(1, -0.1, 1)]))
    assert (len(sight.hit_xy_m), len(sight.pass_xy_m)) == (0, 0)


def test_the_other_side_hits_nothing_and_passes():
    found = one_scan([(1, 0.01, 1), (0, 2, 1)], sensor=(0, -2, 1))
    sight = look(found)
    assert len(sight.hit_xy_m) == 0
    np.testing.assert_allclose(sight.pass_xy_m, [(0, 0)])


def test_a_sensor_on_the_line_says_nothing():
    assert len(look(one_scan([(1, 0, 1)], sensor=(0, 0.05, 1))).hit_xy_m) == 0


def test_only_rays_towards_the_stretch_count():
    found = one_scan([(-3, 0, 1), (3, 0, 1)])
    np.testing.assert_allclose(look(found, 2, 4).hit_xy_m, [(3, 0)])


def test_the_stretch_may_lie_where_directions_wrap_round():
    line = Line(np.array([-2.0, 0.0]), np.array([1.0, 0.0]))
    found = rays.gather([(0, np.array([(-2, 0.5, 0), (-2, -0.5, 0)], float))], {0: np.zeros(3)}, planar=True)
    assert len(rays.look(found, line, -1, 1, band_m=0.05).hit_xy_m) == 2


def test_heights_are_above_the_floor():
    floor = [(x, y, -0.4) for x in np.linspace(-3, 3, 30) for y in np.linspace(0.5, 3, 20)]
    found = one_scan([*floor, (1, 0, 0.6)], planar=False)
    assert found.floor_z_m == pytest.approx(-0.4)
    np.testing.assert_allclose(look(found).hit_z_m, [1.0])


def test_points_that_are_not_finite_are_left_out():
    assert one_scan([(1, 0, 1), (np.nan, 0, 1)]).n_points == 1


def test_no_points_at_all():
    found = rays.gather([], {}, planar=False)
    assert found.n_points == 0
    assert len(look(found).hit_xy_m) == 0


@given(st.floats(-np.pi, np.pi), st.tuples(st.floats(-50, 50), st.floats(-50, 50)))
def test_neither_place_nor_turn_of_the_map_matters(yaw_rad, shift):
    rng = np.random.default_rng(3)
    xyz_m = rng.uniform((-4, -3, 0), (4, 1, 2), (60, 3))
    turn = np.array([[np.cos(yaw_rad), -np.sin(yaw_rad)], [np.sin(yaw_rad), np.cos(yaw_rad)]])
    sensor = np.array([0.3, 1.7, 1.0])
    placed = [np.column_stack([p[..., :2] @ turn.T + shift, p[..., 2:]]) for p in (xyz_m, sensor[None])]
    there = rays.gather([(0, placed[0])], {0: placed[1][0]}, planar=True)
    line = Line(np.array(shift), turn @ AXIS.normal)
    expected = look(rays.gather([(0, xyz_m)], {0: sensor}, planar=True))
    actual = rays.look(there, line, -5, 5, band_m=0.05)
    assert len(actual.hit_xy_m) == len(expected.hit_xy_m)
    np.testing.assert_allclose(
        np.sort(line.along_m(actual.pass_xy_m)), np.sort(AXIS.along_m(expected.pass_xy_m)), atol=1e-9
    )
