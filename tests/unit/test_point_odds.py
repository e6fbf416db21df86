"""A reference point that lies elsewhere than the others lay it is named, and no sound one is."""

import numpy as np
import pytest

from scanplan.plan.corrections.point_odds import MOST_SIGMAS, find_off_checks, find_outliers
from scanplan.plan.survey_scale import PlacedPoints

PLACES = np.array([(0, 0), (12, 1), (3, 9), (11, 8), (6, 4)], float)
SIGMA_M = 0.01


def placed(off_m=(), places=PLACES, sigma_m=SIGMA_M):
    """Points that a quarter turn and a shift lay onto one another, but for what some are off by."""
    turned = places @ np.array([(0, 1), (-1, 0)]) + (500_000, 5_400_000)
    for row, by_m in dict(off_m).items():
        turned[row] += by_m
    return PlacedPoints.of(places, turned, [sigma_m] * len(places))


@pytest.mark.parametrize("row", range(5))
def test_the_one_point_that_is_off_is_named(row):
    (found,) = find_outliers(placed({row: (0.2, 0)}))
    assert (found.row, found.n_others) == (row, 4)
    assert found.off_m == pytest.approx(0.2) and found.sigmas > 8


def test_two_that_are_off_are_both_named():
    points = placed({0: (0.0, 0.3), 3: (0.5, 0)})
    assert {found.row for found in find_outliers(points)} == {0, 3}


def test_what_a_point_may_be_off_by_is_its_own_error_and_that_of_where_others_lay_it():
    """In the middle of four that lie around it: 1 cm of its own, and a half of that of theirs."""
    places = np.array([(-5, 0), (5, 0), (0, -5), (0, 5), (0, 0)], float)
    limit_m = MOST_SIGMAS * SIGMA_M * np.sqrt(1 + 1 / 4)
    assert not find_outliers(placed({4: (0.99 * limit_m, 0)}, places))
    (found,) = find_outliers(placed({4: (1.01 * limit_m, 0)}, places))
    assert found.row == 4


def test_what_a_hand_and_a_projection_do_is_no_fault():
    rng = np.random.default_rng(1)
    grid = PLACES * 0.9996
    n_named = 0
    for _ in range(20):
        points = PlacedPoints.of(PLACES, grid + rng.normal(0, 0.1, PLACES.shape), [None] * 5)
        n_named += len(find_outliers(points))
    assert n_named <= 1
    # two beside one another hardly tell the direction to a third
    near = np.array([(0.0, 0.0), (1.0, 0.0), (20.0, 0.0)])
    n_named = 0
    for _ in range(100):
        points = PlacedPoints.of(near, near + rng.normal(0, 0.1, near.shape), [None] * 3)
        n_named += len(find_outliers(points))
    assert n_named <= 3
    far = 100 * PLACES
    assert not find_outliers(PlacedPoints.of(far, 0.9996 * far, [SIGMA_M] * 5))


def test_of_two_points_none_is_named():
    assert not find_outliers(placed({0: (0.4, 0)}, PLACES[:2]))


def test_a_check_point_beyond_the_limit_is_named():
    checks = placed({1: (0, 0.2)}, PLACES + 1)
    (found,) = find_off_checks(placed(), checks)
    assert (found.row, found.n_others) == (1, 5)
    assert found.off_m == pytest.approx(0.2)


def test_points_of_a_map_that_is_too_small_agree_at_its_scale():
    points = PlacedPoints.of(PLACES, 1.02 * PLACES, [SIGMA_M] * 5)
    assert find_outliers(points) and not find_outliers(points, 1.02)
