"""How far the poses of scans may shift what they show, on paper."""

import numpy as np
import pytest

from scanplan.plan import uncertainty

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
