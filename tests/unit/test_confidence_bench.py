"""The fit of confidence on toy elements, by what is known on paper."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import confidence_bench
from confidence_bench import Judged, Rated
from realistic.floors import Floor

from scanplan.plan import floorplan
from scanplan.validation import confidence

NAN = float("nan")


def floor(kind, right, **features):
    """Return a floor whose tables all have the same elements."""
    known = {name: np.array(values, float) for name, values in features.items()}
    tables = floorplan.NUMBERS
    return Rated(
        Floor(f"{kind}_1", kind, "", "tuning"),
        False,
        dict.fromkeys(tables, known),
        dict.fromkeys(tables, np.array(right, float)),
    )


def rows(right, **features):
    return confidence_bench.join_rows([floor("hall", right, **features)], "walls")


def test_what_says_nothing_of_rightness_is_left_out_and_the_rest_is_their_share():
    right = [1, 1, 1, 0] * 100
    model = confidence_bench.fit(*rows(right, even=[0, 1] * 200, same=[7] * 400))
    assert model["features"] == {}
    assert 1 / (1 + np.exp(-model["intercept"])) == pytest.approx(0.75, abs=0.01)


def test_a_feature_has_the_odds_that_were_counted_and_what_is_not_known_adds_nothing():
    """At 1 nine of ten are right, at 0 one of ten: the odds differ by twice the log of 9."""
    right = [1] * 900 + [0] * 100 + [1] * 100 + [0] * 900
    features, known = rows(right + [1, 0] * 50, seen=[1] * 1000 + [0] * 1000 + [NAN] * 100)
    model = confidence_bench.fit(features, known)
    assert model["features"]["seen"]["weight"] == pytest.approx(2 * np.log(9), rel=0.01)
    assert model["features"]["seen"]["mean"] == pytest.approx(0.5)
    p_true, _ = confidence.weigh_features(features, model)
    np.testing.assert_allclose(p_true[[0, 1000, 2000]], [0.9, 0.1, 0.5], atol=0.01)


def test_no_feature_speaks_against_what_it_is_the_better_for():
    right = [0] * 90 + [1] * 10 + [1] * 90 + [0] * 10
    assert confidence_bench.fit(*rows(right, seen=[1] * 100 + [0] * 100))["features"] == {}


def test_elements_that_no_truth_judges_teach_nothing():
    features, right = rows([1, NAN, 0], seen=[5, 6, 7])
    assert features["seen"].tolist() == [5, 7] and right.tolist() == [1, 0]


def test_the_level_leaves_a_ninth_of_a_hundred_right_ones_and_nothing_is_surer_than_were_right():
    p_true = np.linspace(0, 1, 1000)
    right = np.ones(1000, bool)
    right[-10:] = False
    judged = [Judged(p_true, right, np.zeros(1000, bool))]
    limits = confidence_bench.choose_limits(judged, 40)
    assert limits["level"] == pytest.approx(0.09 * 0.99, abs=0.002)
    assert limits["most"] == 0.9


def test_real_floors_soften_the_odds_where_these_say_too_much():
    """Of what is said to be right at 81 to 1 nine of ten are: half of the log odds is likeliest."""
    model = {"intercept": np.log(81), "features": {"seen": {"mean": 0.0, "weight": 0.0}}}
    models = dict.fromkeys(floorplan.NUMBERS, model)
    real = floor("real", [1] * 90 + [0] * 10, seen=[0] * 100)
    assert set(confidence_bench.choose_tempers([real], models).values()) == {0.5}
    assert set(confidence_bench.choose_tempers([], models).values()) == {1.0}
    softened = confidence_bench.soften_models(models, dict.fromkeys(models, 0.5))
    assert softened["walls"]["intercept"] == pytest.approx(np.log(9), abs=0.01)
