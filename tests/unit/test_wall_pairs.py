import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import observation_making
from scanplan.plan import wall_pairs
from scanplan.plan.openings import OPEN, Opening

SETTINGS = wall_pairs.PairSettings(
    max_angle_deg=5.0, min_thickness_m=0.04, max_thickness_m=0.6, offset_m=0.05, max_gap_m=2.0
)
DOOR_HEIGHT_M = 1.8


def stretch(*ends, free=()):
    return observation_making.stretch(*ends, free=free, planar=True)


def pair(*drawn):
    return wall_pairs.pair_faces(list(drawn), SETTINGS, door_height_m=DOOR_HEIGHT_M)


def test_opposite_faces_are_a_wall_with_a_thickness():
    (wall,) = pair(stretch(0, 0.2, 4, 0.2), stretch(4, 0, 0, 0))
    assert wall.thickness_m == pytest.approx(0.2)
    assert abs(wall.line.offset_m(np.array([1.0, 0.1]))) == pytest.approx(0)
    assert (len(wall.left), len(wall.right)) == (1, 1)


def test_faces_that_look_at_each_other_are_a_corridor():
    walls = pair(stretch(0, 0, 4, 0), stretch(4, 0.4, 0, 0.4))
    assert [math.isnan(w.thickness_m) for w in walls] == [True, True]


@pytest.mark.parametrize("apart", [0.02, 0.7])
def test_faces_too_near_or_too_far_are_no_wall(apart):
    assert len(pair(stretch(0, apart, 4, apart), stretch(4, 0, 0, 0))) == 2


def test_faces_beside_each_other_but_not_opposite_are_no_wall():
    assert len(pair(stretch(0, 0.2, 4, 0.2), stretch(12, 0, 8, 0))) == 2


def test_a_long_face_and_two_short_ones_behind_it_are_one_wall():
    (wall,) = pair(stretch(0, 0.2, 10, 0.2), stretch(4, 0, 0, 0), stretch(10, 0.01, 6, 0.01))
    assert wall.thickness_m == pytest.approx(0.195, abs=0.002)


@pytest.mark.parametrize(
    ("other", "may_be"),
    [
        ((3.5, 0, 2.5, 0), True),
        ((4.5, 0, 3.5, 0), False),
        ((2.5, 0, 3.5, 0), False),
        ((3.5, 0.17, 2.5, 0.17), False),
        ((3.5, -0.5, 2.5, -0.5), False),
        ((3.5, 0.2, 2.5, -0.1), False),
    ],
    ids=["other_jamb", "too_far_on", "same_side", "too_thin", "too_thick", "turned"],
)
def test_sides_of_one_wall_may_be_seen_at_different_ends_of_it(other, may_be):
    one, other = stretch(0, 0.2, 1, 0.2), stretch(*other)
    assert SETTINGS.may_be_sides(one, other) is may_be
    assert SETTINGS.may_be_sides(other, one) is may_be


def test_a_single_face_goes_on_behind_a_pause():
    (wall,) = pair(stretch(0, 0, 4, 0), stretch(5, 0.01, 9, 0.01))
    assert math.isnan(wall.thickness_m)
    assert len(wall.left) == 2


def test_a_step_is_no_wall_of_one_line():
    assert len(pair(stretch(0, 0, 4, 0), stretch(5, 0.2, 9, 0.2))) == 2


def test_a_side_with_a_step_is_not_forced_on_one_line():
    walls = pair(stretch(0, 0.2, 10, 0.2), stretch(5, 0, 0, 0), stretch(10, -0.2, 5, -0.2))
    assert sorted(len(w.members) for w in walls) == [1, 2]


def test_a_tilted_face_is_another_wall():
    assert len(pair(stretch(0, 0.2, 4, 0.2), stretch(4, 0.05, 0, -0.6))) == 2


def test_rays_through_the_unseen_part_of_a_side_part_it_from_the_other():
    """The back of a cupboard of 0.5 m lies on the wall: its front is no second side of that."""
    front, wall = stretch(1, 0.5, 2, 0.5), stretch(5, 0, 0, 0)
    assert len(pair(front, wall)) == 1
    crossed = 3 * [(along_m, 0.0) for along_m in np.arange(1.2, 3, 0.05)]
    assert len(pair(stretch(1, 0.5, 2, 0.5, free=crossed), wall)) == 2


def test_a_part_lies_where_its_own_faces_do_and_is_as_thick():
    """A wall of 0.2 m, and in line with its one side the front of a cupboard across a corridor."""
    (whole,) = pair(stretch(0, 0.2, 4, 0.2), stretch(4, 0, 0, 0), stretch(5.5, 0.24, 9, 0.24))
    front = next(face for face in whole.members if face.ends[:, 0].min() > 5)
    opening = Opening(0.5, 1.0, OPEN, 9, 0.9, 2.1, below_wall=False)
    part = replace(whole, left=[front], right=[], low_m=whole.low_m, openings=[opening])
    found = wall_pairs.refit_wall(part)
    assert math.isnan(found.thickness_m) and (len(found.left), len(found.right)) == (1, 0)
    np.testing.assert_allclose(found.line.offset_m(front.ends), 0, atol=1e-9)
    np.testing.assert_allclose(found.line.normal, [0, 1], atol=1e-9)
    # places along it stay where they were, but for the turn
    low_m, high_m = found.openings[0].low_m, found.openings[0].high_m
    np.testing.assert_allclose(
        np.sort(found.line.at(np.array([low_m, high_m]))[:, 0]),
        np.sort(whole.line.at(np.array([0.5, 1.0]))[:, 0]),
        atol=0.01,
    )


def test_nothing_is_no_wall():
    assert pair() == []


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_every_stretch_is_in_one_wall_and_every_side_is_straight(seed):
    rng = np.random.default_rng(seed)
    y = rng.choice([0.0, 0.1, 0.25, 1.0], 12) + rng.normal(0, 0.02, 12)
    x, length = rng.uniform(0, 8, 12), rng.uniform(0.3, 3, 12)
    ways = rng.choice([-1, 1], 12)
    drawn = [stretch(a, b, a + w * n, b) for a, b, w, n in zip(x, y, ways, length, strict=True)]
    walls = wall_pairs.pair_faces(drawn, SETTINGS, door_height_m=DOOR_HEIGHT_M)
    assert sorted(id(face) for w in walls for face in w.members) == sorted(map(id, drawn))
    for wall in walls:
        for sign, side in ((1, wall.left), (-1, wall.right)):
            for face in side:
                off = wall.line.offset_m(face.ends) - sign * wall.half_m
                assert np.abs(off).max() <= SETTINGS.offset_m + 1e-9
        assert math.isnan(wall.thickness_m) or 0.04 <= wall.thickness_m <= 0.6


def shown(x0, x1, low_m, high_m):
    """Return places along, height, of rays at a surface, 5 cm apart."""
    return [(x, z) for x in np.arange(x0, x1, 0.05) for z in np.arange(low_m, high_m, 0.05)]


def cupboard_front(over, over_m=(1.8, 2.4)):
    """Return the front of cupboards 4 m long, 1.8 m high, which rays pass over on some length."""
    passed = [place for place in shown(0, over, *over_m) for _ in range(3)]
    seen = shown(0.025, 4, 0.025, 1.8)
    return observation_making.stretch(4, -0.4, 0, -0.4, occupied=seen, free=passed)


WALL_SIDE = observation_making.stretch(0, 0.1, 4, 0.1, occupied=shown(0.025, 4, 0.025, 2.6))


@pytest.mark.parametrize(
    ("front", "n_walls"),
    [
        pytest.param(cupboard_front(4.0), 2, id="rays go over all of it"),
        pytest.param(cupboard_front(0.8), 1, id="over a fifth of it, as above a sill"),
        pytest.param(cupboard_front(0.0), 1, id="over none of it"),
        pytest.param(cupboard_front(4.0, (1.8, 1.99)), 1, id="no higher over it than noise"),
    ],
)
def test_what_rays_pass_over_to_a_wall_is_no_side_of_it(front, n_walls):
    assert len(pair(WALL_SIDE, front)) == n_walls


def test_what_is_open_on_both_sides_at_one_height_is_a_wall_with_a_hole():
    def with_window(*ends):
        solid = [place for place in shown(0.025, 4, 0.025, 2.6) if not 0.9 < place[1] < 2.1]
        through = [place for place in shown(0.025, 4, 0.9, 2.1) for _ in range(3)]
        return observation_making.stretch(*ends, occupied=solid, free=through)

    assert len(pair(with_window(0, 0.1, 4, 0.1), with_window(4, -0.1, 0, -0.1))) == 1
