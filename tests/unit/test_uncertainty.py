"""How far the poses of scans may shift what they show, on paper."""

import numpy as np
import pytest

from helpers.observation_making import stretch
from scanplan.plan import uncertainty
from scanplan.plan.plan_wall import PlanWall

SENSORS_M = np.array([[1.0, 2.0], [4.0, 2.0]])
X, Y = np.eye(2)


@pytest.mark.parametrize(
    ("variances", "normal", "sigma_m"),
    [
        ((0.02**2, 0.01**2, 0), X, 0.02),
        ((0.02**2, 0.01**2, 0), Y, 0.01),
        ((0.02**2, 0, 0), (X + Y) / 2**0.5, 0.02 / 2**0.5),
        # 5 m before the sensor, along x: a turn shifts it along y alone
        ((0, 0, 0.002**2), X, 0.0),
        ((0, 0, 0.002**2), Y, 0.01),
    ],
)
def test_a_point_is_as_sure_as_its_scan(variances, normal, sigma_m):
    covariance = np.stack([np.diag(variances), np.diag([9.0, 9, 9])])
    placed = uncertainty.place_scans(SENSORS_M, covariance, 0.02)
    found = placed.sigmas_m(np.array([0]), np.array([[6.0, 2.0]]), np.array(normal))
    np.testing.assert_allclose(found, [sigma_m], atol=1e-12)


def test_shift_and_turn_may_cancel_each_other():
    """Off to the left by a centimetre for each that the turn shifts the point to the right."""
    covariance = np.array([[[0, 0, 0], [0, 1e-4, -2e-5], [0, -2e-5, 4e-6]]])
    placed = uncertainty.place_scans(SENSORS_M[:1], covariance, 0.02)
    found = placed.sigmas_m(np.array([0, 0]), np.array([[6.0, 2.0], [-4.0, 2.0]]), Y)
    np.testing.assert_allclose(found, [0, 0.02], atol=1e-9)


@pytest.mark.parametrize("covariance", [None, np.full((2, 3, 3), np.nan)])
def test_where_nothing_is_known_a_scan_is_as_sure_as_usual(covariance):
    placed = uncertainty.place_scans(SENSORS_M, covariance, 0.025)
    points_m = np.array([[9.0, 9.0], [0.0, 0.0]])
    np.testing.assert_allclose(placed.sigmas_m(np.array([0, 1]), points_m, Y), 0.025)


def lone_wall(offsets_m):
    """A wall of 4 m that two scans show, 20 points a metre, each off by as much."""
    along_m = np.linspace(0.025, 3.975, 80)
    points = [(x, 1.0, off_m, scan) for scan, off_m in enumerate(offsets_m) for x in along_m]
    face = stretch(0, 0, 4, 0, points)
    return PlanWall(face.line, 0.0, 4.0, np.nan, [face], [])


def evidence(wall, covariance):
    placed = uncertainty.place_scans(SENSORS_M, np.tile(covariance, (2, 1, 1)), 0.02)
    return uncertainty.estimate_evidence([wall], [np.nan], placed)[0]


def test_a_wall_is_off_with_all_its_scans_and_by_what_each_adds():
    """Scans that share a pose's error do not make each other surer; their own spread does."""
    across = np.diag([0, 0.03**2, 0])
    assert evidence(lone_wall([0, 0]), across).sigma_offset_m == pytest.approx(0.03)
    # two scans 4 cm apart: their mean has the standard deviation of 2 cm by the root of two
    own_m = np.hypot(0.02 / 2**0.5, 0.02 / 160**0.5)
    alone = evidence(lone_wall([-0.02, 0.02]), np.zeros((3, 3)))
    assert alone.sigma_offset_m == pytest.approx(own_m)
    both = evidence(lone_wall([-0.02, 0.02]), across)
    assert both.sigma_offset_m == pytest.approx(np.hypot(0.03, own_m))


def test_a_free_end_is_off_with_its_scans_along_the_wall():
    along = np.diag([0.03**2, 0, 0])
    gap_m = 0.25 / 10  # both scans show five places in the last 0.25 m
    sure = evidence(lone_wall([0, 0]), np.zeros((3, 3))).sigma_end_m
    assert sure == pytest.approx((gap_m, gap_m))
    found = evidence(lone_wall([0, 0]), along).sigma_end_m
    assert found == pytest.approx((np.hypot(gap_m, 0.03),) * 2)
