import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.ray_making import rays
from scanplan.rays.ray_set import gather_rays

EAST, NORTH, WEST, SOUTH = (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)
ORIGIN = (0, 0, 0)


def test_rays_are_in_order_of_azimuth_scan_by_scan():
    found = rays((ORIGIN, [NORTH, EAST, SOUTH]), ((5, 0, 0), [(5, 3, 0), (9, 0, 0)]))
    assert found.xyz_m.tolist() == [list(SOUTH), list(EAST), list(NORTH), [9, 0, 0], [5, 3, 0]]
    assert np.degrees(found.azimuth_rad) == pytest.approx([-90, 0, 90, 0, 90])
    assert found.scan.tolist() == [0, 0, 0, 1, 1]
    assert found.first.tolist() == [0, 3, 5]
    assert found.rows == [slice(0, 3), slice(3, 5)]


def test_rays_of_one_azimuth_stay_in_the_order_given():
    above = [(2.0, 0.0, z_m) for z_m in (0.3, 0.1, 0.2)]
    found = rays((ORIGIN, [NORTH, *above, (-1, 0, 0.5), SOUTH, (-2, 0, 0.1)]))
    assert found.xyz_m[:, 2].tolist() == [0, 0.3, 0.1, 0.2, 0, 0.5, 0.1]


def test_points_that_are_not_finite_are_left_out():
    scans = [(4, [EAST, (np.nan, 0, 0)]), (7, [(0, np.inf, 0)])]
    found = gather_rays(scans, {4: np.zeros(3), 7: np.zeros(3)}, planar=False)
    assert found.scan_ids.tolist() == [4, 7] and found.first.tolist() == [0, 1, 1]


def test_no_scans_have_no_floor():
    found = gather_rays([], {}, planar=False)
    assert (len(found.xyz_m), len(found.sensors_m)) == (0, 0)
    assert np.isnan(found.floor_z_m)


def test_heights_are_counted_from_the_floor_or_from_a_metre_below_a_plane():
    floor = [(x_m, 1, -0.5) for x_m in range(50)]
    assert gather_rays([(0, floor)], {0: np.zeros(3)}, planar=False).ground_z_m == -0.5
    flat = gather_rays([(0, floor)], {0: np.zeros(3)}, planar=True)
    assert flat.ground_z_m == -1.5 and np.isnan(flat.floor_z_m)


def test_a_floor_that_is_known_is_not_looked_for():
    floor = [(x_m, 1, -0.5) for x_m in range(50)]
    found = gather_rays([(0, floor)], {0: np.zeros(3)}, planar=False, floor_z_m=-0.7)
    assert found.ground_z_m == -0.7


def test_a_sensor_that_looks_upward_has_its_floor_below_the_ceiling_it_sees():
    """From 1 m it sees a table's top at 0.7 m, walls 4 m away, and the ceiling at 2.6 m."""
    at = np.linspace(-0.5, 0.5, 100)
    table = [(1.0, y_m, 0.7) for y_m in at]
    sides = [(4.0, y_m, 0.7 + abs(y_m)) for y_m in at]
    ceiling = [(1.0, y_m, 2.6) for y_m in at]
    looked = {0: np.array([0.0, 0.0, 1.0])}
    found = gather_rays([(0, table + sides + ceiling)], looked, planar=False)
    assert found.floor_z_m == pytest.approx(2.6 - 2.5, abs=0.03)
    # as far away it is met no more steeply than by a lidar that looks level
    far = [(6.0, y_m, z_m) for _, y_m, z_m in ceiling]
    assert gather_rays([(0, table + sides + far)], looked, planar=False).floor_z_m == 0.7


def test_the_way_of_a_ray_is_from_its_own_sensor_and_level():
    found = rays((ORIGIN, [NORTH, EAST]), ((5, 0, 1), [(5, 3, 0)]))
    assert found.level_way_m.tolist() == [[1, 0], [0, 1], [0, 3]]
    assert found.sectors.reach_m.max() == 3


def between(found, one, other, scans=(0,)):
    """Return the points of rays that go between two directions."""
    ends = np.array([[one], [other]], float)
    low, high = found.rows_between(ends, np.array(scans))
    return found.gather_rows(low, high, np.array(scans))


def test_rays_between_two_ends_are_those_of_the_shorter_way_round():
    found = rays((ORIGIN, [EAST, NORTH, WEST, SOUTH]))
    assert between(found, (1, -0.5), (0.5, 1))[0].tolist() == [list(EAST)]
    assert between(found, (0.5, 1), (1, -0.5))[0].tolist() == [list(EAST)]
    # both ends themselves, on the way over west
    behind = between(found, (0, 1), (-0.1, -1))[0]
    assert sorted(behind.tolist()) == sorted([list(NORTH), list(WEST)])


def test_of_two_scans_each_looks_from_its_own_place():
    found = rays((ORIGIN, [(1, 1, 0)]), ((2, 0, 0), [(1, 1, 0), (3, 1, 0)]))
    points, scan = between(found, (0.9, 1), (1.1, 1), scans=(0, 1))
    assert points.tolist() == [[1, 1, 0], [1, 1, 0]] and scan.tolist() == [0, 1]


def test_rays_may_end_elsewhere():
    found = rays((ORIGIN, [EAST, NORTH]))
    longer = found.with_points(2 * found.xyz_m)
    assert longer.xyz_m.tolist() == [[2, 0, 0], [0, 2, 0]]
    assert longer.sectors.reach_m.max() == pytest.approx(2 * found.sectors.reach_m.max())


@given(st.integers(0, 10_000), st.integers(1, 50))
@settings(max_examples=40, deadline=None)
def test_a_sample_is_of_those_rays_and_no_larger_than_asked(seed, most):
    rng = np.random.default_rng(seed)
    scans = [(s, s + rng.normal(0, 3, (60, 3))) for s in rng.uniform(-3, 3, (3, 3))]
    found, numbers = rays(*scans), np.arange(3)
    ends = rng.uniform(-4, 4, (2, 3, 2))
    low, high = found.rows_between(ends, numbers)
    rows, pair = found.sample_rows_between(ends, numbers, most)
    assert len(rows) <= most and (found.scan[rows] == pair).all()
    every = {i for a, b in zip(low.ravel(), high.ravel(), strict=True) for i in range(a, b)}
    assert set(rows.tolist()) <= every and len(set(rows.tolist())) == len(rows)
    rows, _ = found.sample_rows_between(ends, numbers, 10_000)
    assert set(rows.tolist()) == every
    points, scan = found.gather_rows(low, high, numbers)
    assert sorted(points.tolist()) == sorted(found.xyz_m[sorted(every)].tolist())
    assert np.bincount(scan, minlength=3).sum() == len(every)


@settings(max_examples=200)
@given(st.integers(0, 10**6))
def test_no_ray_that_ends_in_a_box_is_missed_from_wherever_it_comes(seed):
    rng = np.random.default_rng(seed)
    low_m, size_m = rng.uniform(-2, 2, 2), rng.uniform(0.01, 3, 2)
    sensors_m = rng.uniform(-3, 3, (4, 3))
    found = rays(*[(sensor_m, rng.uniform(-4, 4, (60, 3))) for sensor_m in sensors_m])
    xyz_m, scan = found.gather_towards(low_m, low_m + size_m)

    def ends_in_it(ends_m):
        return ((ends_m[:, :2] > low_m) & (ends_m[:, :2] < low_m + size_m)).all(axis=1)

    assert ends_in_it(xyz_m).sum() == ends_in_it(found.xyz_m).sum()
    of_ray = dict(zip(map(tuple, found.xyz_m), found.scan.tolist(), strict=True))
    assert [of_ray[tuple(end_m)] for end_m in xyz_m] == scan.tolist()
    assert len(set(map(tuple, xyz_m))) == len(xyz_m)
