"""Textbook surfaces, each of its kind."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.plan.model import things
from scanplan.plan.model.surface_features import Features
from scanplan.plan.model.thing_densities import IN_PLANE, IN_SPACE
from scanplan.plan.model.things import FURNITURE, LEAF, OUTSIDE, WALL, weigh_things

NAN, INF = math.nan, math.inf
NO_CORNER = np.empty((0, 2), np.int64)


def weigh(found):
    """One surface alone: a building whose shares are those of all."""
    return weigh_things([found])[0]


PARTITION = Features(
    length_m=3.5,
    thickness_m=0.12,
    solid=0.7,
    witnesses=1.0,
    top_m=2.6,
    overlooked=0.0,
    deep=0.0,
    n_inner=2,
    n_outer=0,
    joint_m=0.0,
    hinge_m=INF,
    before_m=INF,
    free=0.0,
    back_m=INF,
    free_back_m=NAN,
    depth_m=INF,
    turned_deg=0.2,
    through_glass=0.0,
    roofed=1.0,
)
ROOM_WALL = replace(PARTITION, thickness_m=INF)
OPEN_LEAF = replace(
    PARTITION,
    length_m=0.85,
    thickness_m=INF,
    solid=1.0,
    top_m=2.0,
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
    top_m=1.5,
    overlooked=0.8,
    deep=0.1,
    n_inner=0,
    n_outer=1,
    joint_m=0.1,
    before_m=0.6,
)
RACK = replace(
    PARTITION,
    length_m=5.0,
    thickness_m=INF,
    solid=1.0,
    top_m=NAN,
    overlooked=NAN,
    n_inner=0,
    n_outer=2,
    free=1.0,
    back_m=NAN,
    free_back_m=0.8,
)
FACADE_ACROSS = replace(
    PARTITION,
    length_m=12.0,
    thickness_m=INF,
    solid=1.0,
    witnesses=0.2,
    n_inner=0,
    joint_m=INF,
    through_glass=1.0,
    roofed=0.0,
)
TEXTBOOK = [
    pytest.param(PARTITION, WALL, id="a partition"),
    pytest.param(ROOM_WALL, WALL, id="a wall of a room, seen from one side"),
    pytest.param(OPEN_LEAF, LEAF, id="an open leaf"),
    pytest.param(CUPBOARD, FURNITURE, id="the front of a cupboard"),
    pytest.param(RACK, FURNITURE, id="the side of a rack that stands free, seen in the plane"),
    pytest.param(FACADE_ACROSS, OUTSIDE, id="the building across the street"),
]


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_each_is_what_it_is(found, kind):
    share = weigh(found)
    assert share.argmax() == kind and share[kind] > 0.7


@pytest.mark.parametrize(("found", "kind"), TEXTBOOK)
def test_what_is_not_known_of_it_says_nothing(found, kind):
    """As of planar scans, which do not see over anything."""
    unknown = weigh(replace(found, overlooked=NAN, top_m=NAN))
    nothing = weigh(replace(found, **dict.fromkeys(things.FEATURES, NAN)))
    assert unknown.argmax() == kind
    np.testing.assert_allclose(nothing, np.array(IN_PLANE.shares) / sum(IN_PLANE.shares))


def test_a_building_without_furniture_has_less_of_it():
    """What may be either is a wall beside fifty walls, and less of one beside fifty cupboards."""
    doubtful = replace(ROOM_WALL, length_m=1.0, n_inner=1, before_m=0.6)
    among_walls = weigh_things([doubtful, *[PARTITION] * 50])[0]
    among_cupboards = weigh_things([doubtful, *[CUPBOARD] * 50])[0]
    assert among_walls[WALL] > weigh(doubtful)[WALL] > among_cupboards[WALL]
    assert weigh_things([]).shape == (0, 4)


FRONT = replace(ROOM_WALL, length_m=1.4, n_inner=1, n_outer=1, before_m=0.5, depth_m=0.45)
"""Of a cupboard that nobody looked over, or of a wall that steps forward."""


@pytest.mark.parametrize("side", [CUPBOARD, PARTITION, OPEN_LEAF])
def test_what_meets_at_an_outer_corner_is_of_one_thing(side):
    """Of a cupboard both are furniture, of a wall or a leaf neither is."""
    alone, met = (
        weigh_things([FRONT, side], corners=c)[0] for c in (NO_CORNER, np.array([[0, 1]]))
    )
    is_furniture = side is CUPBOARD
    assert (met[FURNITURE] > alone[FURNITURE] + 0.1) == is_furniture
    assert (met[FURNITURE] < alone[FURNITURE] / 2) == (not is_furniture)


@given(st.data())
def test_what_sides_in_a_row_say_of_one_another_is_exact(data):
    """Four surfaces, each but the last with the next one: all 256 ways to be, one by one."""
    log_p = [data.draw(st.lists(st.floats(-5, 0), min_size=4, max_size=4)) for _ in range(4)]
    weight = np.array(log_p)
    found = things.agree_at_corners(weight, np.array([[0, 1], [2, 1], [2, 3]]))
    agree = np.log(things.CORNERS)
    whole = sum(weight[i].reshape([-1 if i == j else 1 for j in range(4)]) for i in range(4))
    whole = whole + agree[:, :, None, None] + agree[None, :, :, None] + agree[None, None]
    for i in range(4):
        others = tuple(j for j in range(4) if j != i)
        own = np.logaddexp.reduce(whole, axis=others)
        np.testing.assert_allclose(found[i], own - np.logaddexp.reduce(own), atol=1e-9)


def test_no_corner_changes_nothing():
    assert (weigh_things([FRONT], corners=NO_CORNER) == weigh_things([FRONT])).all()


@pytest.mark.parametrize(
    ("found", "kind", "change"),
    [
        (PARTITION, WALL, {"n_inner": 0}),
        (PARTITION, WALL, {"overlooked": 0.5}),
        (PARTITION, WALL, {"top_m": 1.5}),
        (PARTITION, WALL, {"thickness_m": INF}),
        (PARTITION, WALL, {"through_glass": 0.9}),
        (PARTITION, WALL, {"roofed": 0.0}),
        (PARTITION, WALL, {"before_m": 0.6}),
        (PARTITION, WALL, {"joint_m": INF}),
        (PARTITION, WALL, {"free": 1.0}),
        (RACK, FURNITURE, {"free": 0.0}),
        (RACK, FURNITURE, {"free_back_m": INF}),
        (FRONT, FURNITURE, {"depth_m": INF}),
        (OPEN_LEAF, LEAF, {"hinge_m": 1.5}),
        (OPEN_LEAF, LEAF, {"length_m": 2.0}),
        (OPEN_LEAF, LEAF, {"turned_deg": 0.1}),
        (CUPBOARD, FURNITURE, {"overlooked": 0.0}),
        (CUPBOARD, FURNITURE, {"before_m": INF}),
        (CUPBOARD, FURNITURE, {"n_outer": 0}),
        (FACADE_ACROSS, OUTSIDE, {"witnesses": 1.0}),
        (FACADE_ACROSS, OUTSIDE, {"through_glass": 0.0}),
        (FACADE_ACROSS, OUTSIDE, {"roofed": 1.0}),
    ],
)
def test_what_speaks_against_a_kind_makes_it_less_of_one(found, kind, change):
    assert weigh(found)[kind] > weigh(replace(found, **change))[kind]


@pytest.mark.parametrize("population", [IN_SPACE, IN_PLANE])
def test_shares_of_every_kind_and_feature_are_shares(population):
    assert sum(population.shares) == pytest.approx(1, abs=0.03)
    for density in population.densities.values():
        assert list(density.edges) == sorted(density.edges)
        assert len(density.shares) == len(things.KINDS)
        for of_kind in density.shares:
            assert len(of_kind) == len(density.edges) + 1
            assert min(of_kind) > 0
            assert sum(of_kind) == pytest.approx(1, abs=0.03)


def test_every_feature_tells_in_space_and_no_height_does_in_a_plane():
    assert set(IN_SPACE.densities) == set(things.FEATURES)
    of_heights = {"top_m", "overlooked", "roofed"}
    assert set(IN_PLANE.densities) <= set(things.FEATURES) - of_heights


ANY = st.floats(0) | st.just(NAN)


@given(st.builds(Features, **{field.name: ANY for field in fields(Features)}))
def test_probabilities_of_anything_sum_to_one(found):
    share = weigh(found)
    assert share.shape == (4,) and np.isfinite(share).all() and share.sum() == pytest.approx(1)


def test_a_building_has_a_wall_at_least():
    p = np.array([(0.3, 0.1, 0.6, 0.0), (0.4, 0.0, 0.6, 0.0), (0.2, 0.1, 0.7, 0.0)])
    assert things.choose_kinds(p) == [FURNITURE, WALL, FURNITURE]
    assert things.choose_kinds(p[:0]) == []


def test_ground_without_a_ceiling_is_outside():
    assert things.are_outside(np.array([[0.0, 0.5], [1.0, 3.0]])).tolist() == [
        [True, False],
        [False, False],
    ]
