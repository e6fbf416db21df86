"""RANSAC that stops by the share of inliers, against the literal algorithm 4 and on paper."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference import ransac as literal
from scanplan.geometry import consensus

CASES = [("line", 2), ("line", 3), ("plane", 3)]


def cloud(seed, dimension, n=60):
    """Points of two lines (in space: also of a plane) and clutter, 1 cm noise."""
    rng = np.random.default_rng(seed)
    along = rng.uniform(-3, 3, (n, 1)) * rng.normal(size=dimension)
    other = rng.uniform(-3, 3, (n // 2, 1)) * rng.normal(size=dimension) + 1.0
    flat = rng.uniform(-2, 2, (n, dimension)) * np.eye(dimension)[-1:]
    points = np.vstack([along, other, flat, rng.uniform(-3, 3, (n // 3, dimension))])
    return points + rng.normal(0, 0.01, points.shape)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(CASES), st.sampled_from([3, 40, 200]))
def test_the_same_consensus_as_the_literal_algorithm_by_the_same_samples(seed, case, max_trials):
    model, dimension = case
    points = cloud(seed, dimension)
    samples = consensus.draw_samples(
        len(points), consensus.MODELS[model], max_trials, np.random.default_rng(seed)
    )
    *_, axis, expected = literal.ransac(
        points, model=model, inlier_m=0.05, min_consensus=2, samples=samples
    )
    found = consensus.find_consensus(
        points,
        model=model,
        inlier_m=0.05,
        max_trials=max_trials,
        rng=np.random.default_rng(seed),
    )
    assert (found.inliers == expected).all()
    assert abs(found.axis @ axis) == pytest.approx(1, abs=1e-9)
    assert 1 <= found.n_trials <= max_trials


@pytest.mark.parametrize(
    ("share", "size", "trials"), [(0.5, 2, 17), (0.5, 3, 35), (0.1, 2, 459), (1.0, 2, 1)]
)
def test_trials_by_the_share_of_inliers(share, size, trials):
    # log 0.01 / log (1 - share^size), rounded up
    assert np.ceil(consensus.trials_needed(share, size)) == trials


@pytest.mark.parametrize(("model", "dimension"), CASES)
def test_one_trial_is_enough_where_all_points_are_inliers(model, dimension):
    points = np.random.default_rng(1).normal(size=(50, consensus.MODELS[model] - 1))
    points = points @ np.array([(1.0, 2, 3), (0, 1, -1)])[: points.shape[1], :dimension]
    found = consensus.find_consensus(
        points, model=model, inlier_m=1e-9, max_trials=500, rng=np.random.default_rng(1)
    )
    assert found.inliers.all() and found.n_trials == 1


def test_a_line_in_space_takes_a_strip_of_a_wall_and_a_plane_all_of_it():
    rng = np.random.default_rng(3)
    wall = np.column_stack(
        [rng.uniform(0, 4, 900), rng.normal(2, 0.01, 900), rng.uniform(0, 2, 900)]
    )
    taken = {
        model: consensus.find_consensus(
            wall, model=model, inlier_m=0.05, max_trials=300, rng=np.random.default_rng(1)
        ).inliers.sum()
        for model in consensus.MODELS
    }
    # a strip of 0.1 m along the diagonal, 4.47 m, is 0.056 of 8 square metres
    assert taken["plane"] == 900
    assert 0.03 * 900 < taken["line"] < 0.08 * 900


@pytest.mark.parametrize(("model", "dimension"), CASES)
@pytest.mark.parametrize("points", [0, 1, 2, "same"])
def test_no_model_through_too_few_points(model, dimension, points):
    xyz_m = np.ones((40, dimension)) if points == "same" else np.eye(3)[:points, :dimension]
    found = consensus.find_consensus(
        xyz_m, model=model, inlier_m=0.1, max_trials=20, rng=np.random.default_rng(1)
    )
    enough = points == 2 and model == "line"
    assert found.inliers.any() == enough and np.isfinite(found.axis).all() == enough


@given(st.integers(2, 12), st.integers(1, 3), st.integers(0, 99))
def test_samples_are_of_different_points(n, size, seed):
    samples = consensus.draw_samples(n, size, 50, np.random.default_rng(seed))
    assert samples.shape == ((50, size) if n >= size else (0, size))
    assert all(len(set(sample)) == size for sample in samples.tolist())
    assert ((samples >= 0) & (samples < n)).all()


def test_every_point_is_drawn_as_often():
    samples = consensus.draw_samples(5, 3, 20_000, np.random.default_rng(1))
    assert np.bincount(samples.ravel()) / 20_000 == pytest.approx(np.full(5, 0.6), abs=0.02)
