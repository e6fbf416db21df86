"""Textbook surfaces, each of its kind."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.plan.model import things
from scanplan.plan.model.surface_features import Features
from scanplan.plan.model.things import FURNITURE, LEAF, OUTSIDE, WALL, weigh_things

NAN, INF = math.nan, math.inf
PARTITION = Features(
    length_m=3.5,
    thickness_m=0.12,
    solid=0.7,
    witnesses=1.0,
    overlooked=0.0,
    deep=0.0,
    n_inner=2,
    end_m=0.0,
    hinge_m=INF,
    before_m=INF,
    back_m=INF,
    turned_deg=0.2,
    through_glass=0.0,
)
ROOM_WALL = replace(PARTITION, thickness_m=INF)
OPEN_LEAF = replace(
    PARTITION,
    length_m=0.85,
    thickness_m=INF,
    solid=1.0,
    overlooked=0.9,
    deep=0.03,
    n_inner=1,
    hinge_m=0.07,
    turned_deg=8.0,
)
CUPBOARD = replace(
    PARTITION,
    length_m=0.9,
    thickness_m=INF,
    solid=1.0,
    overlooked=0.8,
    deep=0.1,
    n_inner=0,
    end_m=0.1,
    before_m=0.6,
)
FACADE_ACROSS = replace(
    PARTITION,
    length_m=12.0,
    thickness_m=INF,
    solid=1.0,
    witnesses=0.2,
    n_inner=0,
    end_m=INF,
    through_glass=1.0,
)
TEXTBOOK = [
    pytest.param(PARTITION, WALL, id="a partition"),
    pytest.param(ROOM_WALL, WALL, id="a wall of a room, seen from one side"),
    pytest.param(OPEN_LEAF, LEAF, id="an open leaf"),
    pytest.param(CUPBOARD, FURNITURE, id="the front of a cupboard"),
    pytest.param(FACADE_ACROSS, OUTSIDE, id="the building across the street"),
]


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_each_is_what_it_is(found, kind):
    share = weigh_things(found)
    assert share.argmax() == kind and share[kind] > 0.7


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_what_is_not_known_of_it_says_nothing(found, kind):
    """As of planar scans, which do not see over anything."""
    unknown = weigh_things(replace(found, overlooked=NAN))
    nothing = weigh_things(replace(found, **dict.fromkeys(things.DENSITIES, NAN)))
    assert unknown.argmax() == kind
    np.testing.assert_allclose(nothing, np.array(things.SHARES) / sum(things.SHARES))


@pytest.mark.parametrize(
    ("found", "kind", "change"),
    [
        (PARTITION, WALL, {"n_inner": 0}),
        (PARTITION, WALL, {"overlooked": 0.5}),
        (PARTITION, WALL, {"thickness_m": INF}),
        (PARTITION, WALL, {"through_glass": 0.9}),
        (PARTITION, WALL, {"before_m": 0.6}),
        (PARTITION, WALL, {"end_m": INF}),
        (OPEN_LEAF, LEAF, {"hinge_m": 1.5}),
        (OPEN_LEAF, LEAF, {"length_m": 2.0}),
        (OPEN_LEAF, LEAF, {"turned_deg": 0.1}),
        (CUPBOARD, FURNITURE, {"overlooked": 0.0}),
        (CUPBOARD, FURNITURE, {"before_m": INF}),
        (FACADE_ACROSS, OUTSIDE, {"witnesses": 1.0}),
        (FACADE_ACROSS, OUTSIDE, {"through_glass": 0.0}),
    ],
)
def test_what_speaks_against_a_kind_makes_it_less_of_one(found, kind, change):
    assert weigh_things(found)[kind] > weigh_things(replace(found, **change))[kind]


def test_shares_of_every_kind_and_feature_are_shares():
    assert sum(things.SHARES) == pytest.approx(1)
    assert set(things.DENSITIES) == {field.name for field in fields(Features)}
    for density in things.DENSITIES.values():
        assert list(density.edges) == sorted(density.edges)
        assert len(density.shares) == len(things.KINDS)
        for of_kind in density.shares:
            assert len(of_kind) == len(density.edges) + 1
            assert min(of_kind) > 0
            assert sum(of_kind) == pytest.approx(1, abs=0.03)


ANY = st.floats(0) | st.just(NAN)


@given(st.builds(Features, **{field.name: ANY for field in fields(Features)}))
def test_probabilities_of_anything_sum_to_one(found):
    share = weigh_things(found)
    assert share.shape == (4,) and np.isfinite(share).all() and share.sum() == pytest.approx(1)
