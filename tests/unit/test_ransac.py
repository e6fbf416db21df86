import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scanplan.geometry import ransac

ANGLE = st.floats(-3.1, 3.1)
SHIFT = st.floats(-50, 50)


def rng():
    return np.random.default_rng(5)


def test_least_squares_through_points_on_paper():
    normal, offset_m = ransac.fit_line_tls([(0, 2), (1, 2.1), (2, 1.9), (3, 2.0)])
    # covariance xx 5, xy -0.1, yy 0.02: slope tan(0.5 atan2(-0.2, 4.98))
    slope_rad = 0.5 * np.arctan2(-0.2, 4.98)
    assert normal == pytest.approx([-np.sin(slope_rad), np.cos(slope_rad)])
    assert offset_m == pytest.approx(normal @ [1.5, 2.0])


@pytest.mark.parametrize("points", [[(3, -1), (3, 4), (3, 9)], [(-3, 0), (-3, 1)]])
def test_upright_lines_have_an_outward_normal(points):
    normal, offset_m = ransac.fit_line_tls(points)
    assert offset_m == pytest.approx(3)
    assert normal == pytest.approx([np.sign(points[0][0]), 0], abs=1e-12)


@pytest.mark.parametrize("points", [np.empty((0, 2)), [(1, 2)], [(1, 2), (1, 2)]])
def test_no_line_without_two_distinct_points(points):
    with pytest.raises(ValueError, match="two distinct"):
        ransac.fit_line_tls(points)
    normal, offset_m, inliers = ransac.fit_line_ransac(points, inlier_m=0.1, trials=10, rng=rng())
    assert np.isnan(normal).all()
    assert np.isnan(offset_m)
    assert not inliers.any()


@given(ANGLE, SHIFT, SHIFT)
@settings(max_examples=30, deadline=None)
def test_fit_moves_with_the_points(angle_rad, x, y):
    points = np.random.default_rng(1).normal(size=(30, 2)) * (4, 0.05)
    turn = np.array(
        [[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]]
    )
    normal, offset_m = ransac.fit_line_tls(points)
    moved_normal, moved_offset_m = ransac.fit_line_tls(points @ turn.T + (x, y))
    expected = turn @ normal
    assert abs(expected @ moved_normal) == pytest.approx(1)
    distance = (points @ turn.T + (x, y)) @ moved_normal - moved_offset_m
    assert np.abs(distance) == pytest.approx(np.abs(points @ normal - offset_m), abs=1e-6)


def test_ransac_finds_the_line_among_outliers_and_fits_its_inliers():
    draw = np.random.default_rng(2)
    line = np.column_stack([draw.uniform(-3, 3, 120), 1.5 + draw.normal(0, 0.01, 120)])
    clutter = draw.uniform(-3, 3, (180, 2)) - np.array([0, 3.2])
    normal, offset_m, inliers = ransac.fit_line_ransac(
        np.vstack([line, clutter]), inlier_m=0.05, trials=64, rng=rng()
    )
    assert normal == pytest.approx([0, 1], abs=0.003)
    assert offset_m == pytest.approx(1.5, abs=0.003)
    assert inliers[:120].all()
    assert inliers.sum() == 120
    assert (normal, offset_m) == (
        pytest.approx(ransac.fit_line_tls(line)[0]),
        pytest.approx(ransac.fit_line_tls(line)[1]),
    )


def test_ransac_on_more_points_than_are_scored():
    draw = np.random.default_rng(3)
    points = np.column_stack(
        [
            draw.uniform(-3, 3, 20_000),
            np.r_[draw.normal(2, 0.01, 6000), draw.uniform(-8, 1, 14_000)],
        ]
    )
    _, offset_m, inliers = ransac.fit_line_ransac(points, inlier_m=0.04, trials=64, rng=rng())
    assert offset_m == pytest.approx(2, abs=0.002)
    assert inliers.sum() > 5990


def test_ransac_depends_on_the_generator_alone():
    points = np.random.default_rng(4).normal(size=(200, 2))
    first, second = (
        ransac.fit_line_ransac(points, inlier_m=0.1, trials=20, rng=rng()) for _ in range(2)
    )
    assert (first[0] == second[0]).all()
    assert first[1] == second[1]


def test_pairs_are_never_twice_the_same_point():
    points = np.array([(0.0, 1.0), (2.0, 1.0)])
    normal, offset_m, inliers = ransac.fit_line_ransac(points, inlier_m=0.01, trials=1, rng=rng())
    assert normal == pytest.approx([0, 1])
    assert offset_m == pytest.approx(1)
    assert inliers.all()


def test_a_line_through_one_place_alone_stays():
    normal, offset_m, inliers = ransac.refit_line(
        np.tile([2.0, 3.0], (4, 1)), np.array([0.0, 1.0]), 3.0, inlier_m=0.1
    )
    assert normal.tolist() == [0, 1] and offset_m == 3 and inliers.all()
