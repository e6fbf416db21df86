"""The scale of a survey by tapes and reference points, and a plan that is multiplied by it."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.plan.survey_scale import PlacedPoints, SurveyScale, fit_scale, state_scale


def points(places_m, scale=1.0, turn_rad=0.7, sigma_m=None):
    inside = np.array(places_m) @ np.array([1, 1j])
    outside = scale * np.exp(1j * turn_rad) * inside + (5e5 + 5.4e6j)
    outside_m = np.column_stack([outside.real, outside.imag])
    return PlacedPoints.of(places_m, outside_m.tolist(), [sigma_m] * len(places_m))


def test_a_scale_is_the_mean_of_ratios_by_their_weight():
    # 2 m and 4 m with equal sigma weigh 4 and 16: (4 * 1.01 + 16 * 1.02) / 20
    scale = fit_scale([(2.0, 2.02, 0.02), (4.0, 4.08, 0.02)])
    # they are (0.01 / 0.0112)**2 = 0.8 apart, no more than their sigmas say
    assert scale.factor == pytest.approx(1.018) and scale.sigma == pytest.approx(0.02 / 20**0.5)


def test_lengths_that_disagree_leave_the_scale_less_sure():
    # ratios 1.00 and 1.02, each known to 0.001: chi2 = 2 * 10**2 over one spare
    scale = fit_scale([(10.0, 10.0, 0.01), (10.0, 10.2, 0.01)])
    assert scale.factor == pytest.approx(1.01)
    assert scale.sigma == pytest.approx(0.001 / 2**0.5 * 200**0.5)
    assert scale.applied == 1.0 and "sigma" in scale.fault


def test_lengths_that_agree_correct_the_plan_and_one_alone_does_not():
    lengths = [(10.0, 10.03, 0.005), (8.0, 8.024, 0.005)]
    assert fit_scale(lengths).applied == pytest.approx(1.003)
    assert fit_scale(lengths[:1]).applied == 1.0 and "tape another" in fit_scale(lengths[:1]).fault
    feet = [(drawn, taped / 0.3048, sigma) for drawn, taped, sigma in lengths]
    assert fit_scale(feet).applied == 1.0 and "metres" in fit_scale(feet).fault
    assert "+0.30 % ± 0.04 % by 2 taped" in state_scale(fit_scale(lengths))


def test_points_are_one_more_measurement_of_the_same_factor():
    # 80 m apart, and each known to 5 mm: what a projection stretches is the larger doubt
    placed = points([(0, 0), (80, 0)], scale=1.004, sigma_m=0.005)
    scale, variance = placed.fit_scale()
    assert scale == pytest.approx(1.004)
    assert variance == pytest.approx(0.005**2 / (2 * 40**2) + 0.001**2)
    # a length that says 1.002 within 0.1 %
    both = fit_scale([(10.0, 10.02, 0.01)], placed)
    by_hand = (1.002 / 0.001**2 + 1.004 / variance) / (1 / 0.001**2 + 1 / variance)
    assert both.factor == pytest.approx(by_hand) and (both.n_lengths, both.n_points) == (1, 2)
    alone = (1 / 0.001**2 + 1 / variance) ** -0.5
    chi2 = ((1.002 - by_hand) / 0.001) ** 2 + (1.004 - by_hand) ** 2 / variance
    assert chi2 > 1 and both.sigma == pytest.approx(alone * chi2**0.5)


def test_two_points_alone_tell_no_scale_and_three_that_agree_do():
    places = [(0, 0), (40, 0), (0, 30)]
    assert fit_scale([], points(places[:2], 1.02, sigma_m=0.01)).applied == 1.0
    assert fit_scale([], points(places, 1.02, sigma_m=0.01)).applied == pytest.approx(1.02)
    assert fit_scale([], points(places, 1.002, sigma_m=0.01)).applied == 1.0  # a projection's
    assert fit_scale([]) is None and fit_scale([], points(places[:1])) is None


def test_points_that_fit_badly_weigh_less():
    placed = points([(0, 0), (40, 0), (0, 30)], sigma_m=0.01)
    good = placed.fit_scale()[1]
    off_m = np.array([[0, 0], [0, 0], [1, 1]])
    moved = PlacedPoints(placed.inside_m, placed.outside_m + off_m, placed.sigma_m)
    assert moved.fit_scale()[1] > 100 * good


@given(
    st.floats(0.96, 1.04),
    st.lists(st.floats(1, 50), min_size=2, max_size=6),
    st.floats(-3, 3),
)
def test_lengths_and_points_without_error_give_the_factor(factor, drawn_m, turn_rad):
    lengths = [(m, factor * m, 0.001) for m in drawn_m]
    found = fit_scale(lengths, points([(0, 0), (9, 2), (3, 8)], factor, turn_rad))
    assert found.factor == pytest.approx(factor, abs=1e-9)


def test_a_plan_is_multiplied_as_a_whole():
    plan = floorplan_making.plan(scale=SurveyScale(1.02, 0.001, 2, 0), floor_z_m=1.0)
    scaled = scale_floorplan(plan)
    for name in ("x0_m", "y1_m", "thickness_m", "z_max_m"):
        np.testing.assert_allclose(scaled.walls[name], 1.02 * plan.walls[name])
    np.testing.assert_allclose(scaled.rooms["area_m2"], 1.02**2 * plan.rooms["area_m2"])
    np.testing.assert_allclose(shapely.area(scaled.areas), 1.02**2 * shapely.area(plan.areas))
    assert scaled.walls["n_scans"].tolist() == plan.walls["n_scans"].tolist()
    assert scaled.floor_z_m == pytest.approx(1.02)
    np.testing.assert_allclose(scaled.faces["nx"], plan.faces["nx"])


def test_a_plan_without_a_significant_scale_stays_itself():
    plan = floorplan_making.plan(scale=SurveyScale(1.001, 0.001, 2, 0))
    assert scale_floorplan(plan) is plan
    assert scale_floorplan(floorplan_making.plan()).scale is None
