"""How a sensor errs on known hits."""

import dataclasses

import numpy as np
import pytest

from helpers.exact_sensor import EXACT as EXACT_SETTINGS
from scanplan.lab.simulation import sensor_errors, sensor_models, sensors
from scanplan.lab.simulation.raycast import RayHits

EXACT = sensor_errors.SensorErrors(0.0, np.zeros(16, np.float32), 0.0, np.pi / 2, 1.0, 0.0)
BIASED = sensor_errors.StatedErrors(**{**EXACT_SETTINGS, "bias_m": 0.005})


def test_biases_belong_to_the_beam_and_to_the_specimen():
    sensor = sensor_models.make_vlp16(
        8, sensors.Turning(rate_hz=10.0, sweep=True, min_range_m=0.3, max_range_m=100.0)
    )
    first, again, other = (
        sensor_errors.draw_sensor_errors(sensor, BIASED, seed=s).bias_m for s in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other) and len(np.unique(first)) == 16
    many = [sensor_errors.draw_sensor_errors(sensor, BIASED, seed=s).bias_m for s in range(200)]
    assert np.std(many) == pytest.approx(0.005, rel=0.05)


def flat_hits(angle_deg, n=40_000):
    cosine = np.full(n, np.cos(np.radians(angle_deg)), np.float32)
    return RayHits(np.ones(n, np.float32), cosine, cosine)


@pytest.mark.parametrize(
    ("angle_deg", "share"), [(0, 0), (69.9, 0), (75, 0.25), (80, 0.5), (85, 0.75), (89.99, 1)]
)
def test_the_flatter_the_more_is_lost(angle_deg, share):
    errors = dataclasses.replace(EXACT, grazing_from_rad=np.radians(70))
    lost = np.isnan(
        sensor_errors.drop_grazing(flat_hits(angle_deg), errors, np.random.default_rng(1))
    )
    assert lost.mean() == pytest.approx(share, abs=0.01)


def test_nothing_is_lost_where_loss_starts_at_ninety():
    assert np.isfinite(
        sensor_errors.drop_grazing(flat_hits(90), EXACT, np.random.default_rng(1))
    ).all()


def test_glass_passes_drops_and_returns_in_their_shares():
    n = 60_000
    opaque, pane = (
        RayHits(*np.tile(np.array([[r], [1], [i]], np.float32), n))
        for r, i in ((5.0, 80.0), (2.0, 10.0))
    )
    errors = dataclasses.replace(EXACT, glass_pass=0.7, glass_drop=0.2)
    seen, _ = sensor_errors.pass_glass(opaque, pane, errors, np.random.default_rng(1))
    shares = [(seen.range_m == r).mean() for r in (5.0, np.inf, 2.0)]
    np.testing.assert_allclose(shares, [0.7, 0.2, 0.1], atol=0.01)
    assert (seen.reflectivity[seen.range_m == 2] == 10).all() and (
        seen.reflectivity[seen.range_m == 5] == 80
    ).all()


def test_a_pane_behind_a_wall_does_nothing():
    opaque, pane = (
        RayHits(*np.tile(np.array([[r], [1], [80]], np.float32), 100)) for r in (2.0, 5.0)
    )
    errors = dataclasses.replace(EXACT, glass_pass=0.0, glass_drop=1.0)
    seen, _ = sensor_errors.pass_glass(opaque, pane, errors, np.random.default_rng(1))
    assert (seen.range_m == 2).all()
