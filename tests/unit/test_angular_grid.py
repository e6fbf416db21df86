import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.recordings.stations.angular_grid import STEP_DEG, AngularGrid

RNG = np.random.default_rng(1)
DIRECTIONS = RNG.normal(size=(4000, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


def thin(*blocks):
    grid = AngularGrid()
    for xyz_m in blocks:
        grid.add(xyz_m)
    return grid


@given(cuts=st.lists(st.integers(0, 4000), max_size=5))
def test_what_is_kept_does_not_depend_on_how_points_come(cuts):
    points = DIRECTIONS * RNG.uniform(1, 5, (4000, 1))
    whole = thin(points)
    parts = thin(*np.split(points, sorted(cuts)))
    np.testing.assert_array_equal(parts.xyz_m, whole.xyz_m)
    assert parts.share_behind == whole.share_behind


def test_points_that_are_kept_are_some_of_those_given_a_step_apart_at_least_in_the_mean():
    dense = np.repeat(DIRECTIONS[:200], 50, axis=0)
    dense = dense + RNG.normal(0, 1e-4, dense.shape)
    kept = thin(3 * dense).xyz_m
    given_points = {tuple(row) for row in (3 * dense).astype(np.float32).tolist()}
    assert {tuple(row) for row in kept.tolist()} <= given_points
    # a spot of 0.01 degrees lies in four cells at most
    assert 200 <= len(kept) <= 4 * 200


def test_a_whole_sphere_has_as_many_points_as_cells_of_the_step():
    beams = RNG.normal(size=(3_000_000, 3))
    n_kept = len(thin(beams).xyz_m)
    assert n_kept == pytest.approx(4 * np.pi / np.radians(STEP_DEG) ** 2, rel=0.02)


def test_the_point_nearest_to_the_centre_of_its_cell_is_kept():
    step = np.radians(STEP_DEG)
    azimuth = np.array([0.1, 0.45, 0.52, 0.9]) * step  # of a cell that begins at 0
    elevation = np.full(4, 0.5 * step)
    level = np.cos(elevation)
    points = np.column_stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])
    np.testing.assert_allclose(thin(points).xyz_m, points[[2]], atol=1e-6)


def test_what_is_no_point_is_none():
    grid = thin(np.array([[0.0, 0, 0], [np.nan, 1, 1], [np.inf, 0, 0], [1, 0, 0]]))
    np.testing.assert_allclose(grid.xyz_m, [[1, 0, 0]])
    assert grid.n_points == 1
    assert AngularGrid().share_behind == 0


def test_directions_with_points_behind_others_are_counted():
    near, far = DIRECTIONS[:100] * 2.0, DIRECTIONS[:50] * 4.0
    assert thin(near, far).share_behind == pytest.approx(0.5, abs=0.02)
    assert thin(near, DIRECTIONS[:50] * 2.2).share_behind == 0
