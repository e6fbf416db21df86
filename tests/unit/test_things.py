"""Textbook surfaces, each of its kind."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.plan.model.surface_features import Features
from scanplan.plan.model.things import FURNITURE, LEAF, OUTSIDE, THINGS, WALL, weigh_things

NAN, INF = math.nan, math.inf
PARTITION = Features(
    length_m=3.5,
    thickness_m=0.12,
    top_m=NAN,
    overlooked=0.0,
    n_inner=2,
    n_outer=0,
    hinge_m=INF,
    fits_door_m=INF,
    behind_m=INF,
    through_glass=0.0,
)
ROOM_WALL = replace(PARTITION, thickness_m=NAN)
OPEN_LEAF = Features(
    length_m=0.85,
    thickness_m=NAN,
    top_m=2.1,
    overlooked=0.9,
    n_inner=1,
    n_outer=0,
    hinge_m=0.05,
    fits_door_m=-0.05,
    behind_m=INF,
    through_glass=0.0,
)
CUPBOARD = Features(
    length_m=0.9,
    thickness_m=NAN,
    top_m=NAN,
    overlooked=0.8,
    n_inner=0,
    n_outer=2,
    hinge_m=1.5,
    fits_door_m=0.1,
    behind_m=0.6,
    through_glass=0.0,
)
FACADE_ACROSS = Features(
    length_m=12.0,
    thickness_m=NAN,
    top_m=NAN,
    overlooked=0.0,
    n_inner=0,
    n_outer=0,
    hinge_m=INF,
    fits_door_m=INF,
    behind_m=INF,
    through_glass=1.0,
)
TEXTBOOK = [
    pytest.param(PARTITION, WALL, id="a partition"),
    pytest.param(ROOM_WALL, WALL, id="a wall of a room, seen from one side"),
    pytest.param(OPEN_LEAF, LEAF, id="an open leaf"),
    pytest.param(CUPBOARD, FURNITURE, id="the front of a cupboard"),
    pytest.param(FACADE_ACROSS, OUTSIDE, id="the building across the street"),
]


def weigh(found, *, planar=False):
    return weigh_things(found, planar=planar)


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_each_is_what_it_is(found, kind):
    share = weigh(found)
    assert share.argmax() == kind and share[kind] > 0.8


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_in_the_plane_nothing_is_a_leaf_or_furniture(found, kind):
    share = weigh(found, planar=True)
    assert share[LEAF] == share[FURNITURE] == 0
    assert share.sum() == pytest.approx(1)


def test_a_leaf_that_hangs_nowhere_is_less_of_one():
    assert weigh(OPEN_LEAF)[LEAF] > weigh(replace(OPEN_LEAF, hinge_m=1.0))[LEAF]
    assert weigh(OPEN_LEAF)[LEAF] > weigh(replace(OPEN_LEAF, fits_door_m=0.5))[LEAF]


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        (WALL, {"n_inner": 0}),
        (WALL, {"n_outer": 1}),
        (WALL, {"overlooked": 0.5}),
        (WALL, {"thickness_m": NAN}),
        (WALL, {"through_glass": 0.9}),
        (WALL, {"behind_m": 0.6}),
    ],
)
def test_what_speaks_against_a_wall_makes_it_less_of_one(kind, change):
    assert weigh(PARTITION)[kind] > weigh(replace(PARTITION, **change))[kind]


def test_little_that_is_overlooked_is_noise():
    assert (weigh(PARTITION) == weigh(replace(PARTITION, overlooked=0.2))).all()


def test_of_every_kind_shares_are_shares():
    assert sum(thing.share for thing in THINGS) == pytest.approx(1)
    for thing in THINGS:
        assert sum(thing.inner) == pytest.approx(1)
        answers = (thing.outer, thing.overlooked, thing.door_high, thing.hung)
        for p in (*answers, thing.before, thing.through_glass, thing.thick):
            assert 0 < p < 1


@given(
    st.builds(
        Features,
        length_m=st.floats(0, 100),
        thickness_m=st.just(NAN) | st.floats(0, 1),
        top_m=st.just(NAN) | st.floats(0, 4),
        overlooked=st.floats(0, 1),
        n_inner=st.integers(0, 2),
        n_outer=st.integers(0, 2),
        hinge_m=st.floats(0) | st.just(INF),
        fits_door_m=st.floats(-2, 50) | st.just(INF),
        behind_m=st.floats(0, 2) | st.just(INF),
        through_glass=st.floats(0, 1),
    ),
    st.booleans(),
)
def test_probabilities_of_anything_sum_to_one(found, planar):
    share = weigh(found, planar=planar)
    assert share.shape == (4,) and np.isfinite(share).all() and share.sum() == pytest.approx(1)
