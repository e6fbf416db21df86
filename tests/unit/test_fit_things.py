"""Densities of toy surfaces, counted on paper."""

import ast
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import fit_things

from scanplan.plan.model import things
from scanplan.plan.model.thing_densities import IN_SPACE

NAN = float("nan")


def surfaces(kinds, **values):
    """Return surfaces of which nothing is known but the features that are named."""
    features = np.full((len(kinds), len(things.FEATURES)), NAN)
    for name, of_each in values.items():
        features[:, things.FEATURES.index(name)] = of_each
    corners = np.zeros((len(things.KINDS),) * 2, np.int64)
    return fit_things.Surfaces(features, np.array(kinds), np.ones(len(kinds)), corners)


LEARNT = surfaces([things.WALL] * 6 + [things.LEAF] * 2, n_inner=[2, 2, 2, 2, 1, 0, 0, 0])


def fit(learnt=LEARNT):
    return fit_things.fit(learnt, IN_SPACE)


def test_kinds_have_their_shares_and_one_more_each():
    np.testing.assert_allclose(fit_things.count_shares(LEARNT), np.array([7, 3, 1, 1]) / 12)


def test_ranges_have_the_shares_that_were_counted_and_a_little_of_all():
    """Of eight three end at no corner, one at one, four at two; eleven with one more of each.

    Each kind has two of all besides its own: a wall one, one and four of six.
    """
    usual = np.array([4, 2, 5]) / 11
    found = np.array(fit().densities["n_inner"].shares)
    np.testing.assert_allclose(found[things.WALL], (np.array([1, 1, 4]) + 2 * usual) / 8)
    np.testing.assert_allclose(found[things.LEAF], (np.array([2, 0, 0]) + 2 * usual) / 4)
    np.testing.assert_allclose(found[things.OUTSIDE], usual)


def test_kinds_that_meet_more_often_than_by_chance_attract_each_other():
    """Eight corners of walls and as many of furniture, two of both: by chance nine of each."""
    corners = np.zeros((4, 4), np.int64)
    walls_and_furniture = np.ix_([things.WALL, things.FURNITURE], [things.WALL, things.FURNITURE])
    corners[walls_and_furniture] = [[16, 2], [2, 16]]
    found = fit_things.fit_corners(corners)
    by_chance = 36 * (19 / 40) ** 2
    np.testing.assert_allclose(
        found[walls_and_furniture], (np.array([[16, 2], [2, 16]]) + 2) / (by_chance + 2)
    )
    np.testing.assert_allclose(found[things.LEAF, things.OUTSIDE], 1, atol=0.05)


def test_what_was_never_seen_leaves_all_ranges_alike():
    np.testing.assert_allclose(fit().densities["overlooked"].shares, 1 / 3)


def test_surfaces_are_what_they_are_likeliest_to_be():
    """With no corner a leaf is likelier three times: enough for as many, not for a seventh."""
    asked = surfaces([things.WALL] * 3, n_inner=[2, 0, NAN])
    likely = things.weigh_features(asked.features, fit())
    shares = np.array([0.7, 0.1, 0.1, 0.1])
    assert things.weigh_kinds(likely, shares, 1.0).argmax(axis=1).tolist() == [things.WALL] * 3
    alike = things.weigh_kinds(likely, np.full(4, 0.25), 1.0)
    assert alike.argmax(axis=1)[:2].tolist() == [things.WALL, things.LEAF]
    np.testing.assert_allclose(np.exp(alike).sum(axis=1), 1)


def test_where_no_answer_counts_shares_are_all_that_is_known():
    shares = np.array([0.7, 0.1, 0.1, 0.1])
    asked = surfaces([0], n_inner=[0])
    likely = things.weigh_features(asked.features, fit())
    np.testing.assert_allclose(np.exp(things.weigh_kinds(likely, shares, 0.0)), [shares])


def test_the_table_reads_as_that_of_the_package():
    """What was fitted is set in by hand: it is Python, and has a share for all ranges."""
    text = fit_things.format_population(fit())
    head, rest = text.split("densities=")
    shares = ast.literal_eval(head.split("shares=")[1].strip().rstrip(","))
    np.testing.assert_allclose(shares, np.array([7, 3, 1, 1]) / 12, atol=0.005)
    # what is called in the text is a pair to read
    read = ast.literal_eval(rest.removesuffix(",\n)").replace("Density(", "("))
    assert list(read) == list(IN_SPACE.densities)
    for name, (edges, of_kinds) in read.items():
        assert edges == IN_SPACE.densities[name].edges
        assert np.shape(of_kinds) == (len(things.KINDS), len(edges) + 1)
        assert np.min(of_kinds) >= 0.005
