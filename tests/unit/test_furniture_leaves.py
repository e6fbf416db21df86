"""Leaves of doors in the plane: a wall with a door of 0.9 m, and what stands at its jamb."""

import numpy as np
import pytest
from shapely import box

from helpers.observation_making import stretch
from scanplan.plan.furniture import fronts
from scanplan.plan.furniture.leaves import find_leaves, find_traces
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall

JAMBS_M = [[2.0, 0.0], [2.9, 0.0]]
MOST = fronts.FrontLimits(
    max_door_m=1.5, max_thickness_m=0.6, max_depth_m=1.0, ghost_distance_m=0.3
)


def single(*ends, openings=()):
    """A wall of one face that is seen from the left of its way."""
    face = stretch(*ends, planar=True)
    return PlanWall(face.line, face.low_m, face.high_m, np.nan, [face], [], list(openings))


def south():
    """A wall along x from 0 to 5, seen from the north, with a door."""
    bare = single(0, 0, 5, 0)
    low_m, high_m = np.sort(bare.line.along_m(np.array(JAMBS_M)))
    return single(0, 0, 5, 0, openings=[Opening(low_m, high_m, OPEN, 99, np.nan, np.nan, False)])


def leaves(*others):
    return find_leaves([south(), *others], unpaired_m=0.1, max_width_m=1.5)


@pytest.mark.parametrize(
    "tip", [(2.0, 0.9), (1.9, 0.8), (2.6, 0.6)], ids=["square", "wide", "half"]
)
@pytest.mark.parametrize("turned", [False, True], ids=["from within", "from behind"])
def test_what_hangs_at_a_jamb_is_as_long_as_its_door_and_ends_free_is_a_leaf(tip, turned):
    ends = [(2.0, 0.05), tip]
    body = single(*np.ravel(ends[::-1] if turned else ends))
    (leaf,) = leaves(body)
    assert leaf.face is body.left[0]
    np.testing.assert_allclose(np.sort(leaf.way_m, axis=0), JAMBS_M, atol=1e-9)


@pytest.mark.parametrize(
    "ends",
    [
        *[(2.0, 0.0, 2.0, 0.4), (2.0, 0.0, 2.0, 1.3), (1.4, 0.0, 1.4, 0.9)],
        *[(2.9, 0.02, 2.0, 0.02), (1.1, 0.02, 2.0, 0.02), (2.9, -0.2, 2.0, -0.2)],
    ],
    ids=["nib", "wall", "elsewhere", "shut", "of the wall", "niche"],
)
def test_what_is_shorter_or_longer_or_hangs_elsewhere_is_none(ends):
    assert leaves(single(*ends)) == []


def test_a_leaf_hung_on_the_far_side_of_its_wall_is_as_long_as_it_is_from_the_jamb_on():
    body = single(2.0, -0.08, 2.0, 1.05)
    assert body.length_m > 0.9 + 0.2
    assert [leaf.face for leaf in leaves(body)] == body.left


@pytest.mark.parametrize(
    ("ends", "n_traces"),
    [((2.25, 0.1, 2.25, 0.8), 2), ((2.25, 0.8, 2.25, 0.1), 1), ((2.35, 0.1, 2.35, 0.8), 1)],
    ids=["once more", "facing the other way", "too far off"],
)
def test_a_scan_placed_badly_shows_a_leaf_once_more(ends, n_traces):
    body = single(2.0, 0.05, 2.0, 0.9)
    other = single(*ends).left[0]
    faces = [*south().left, *body.left, other]
    assert len(find_traces(leaves(body), faces, ghost_distance_m=0.3)) == n_traces


def test_a_wall_behind_a_leaf_that_ends_at_another_is_no_trace():
    """Of a niche 0.55 m deep, 0.2 m beside the hinge."""
    body = single(2.0, 0.05, 2.0, 0.9)
    side, back = single(2.2, 0.05, 2.2, 0.6), single(2.2, 0.6, 0.5, 0.6)
    faces = [*south().left, *body.left, *side.left, *back.left]
    (leaf,) = [leaf for leaf in leaves(body) if leaf.face is body.left[0]]
    assert find_traces([leaf], faces, ghost_distance_m=0.3) == body.left


def test_a_return_that_ends_at_another_wall_is_no_leaf():
    assert leaves(single(2.0, 0.05, 2.0, 0.9), single(2.0, 0.9, 0.5, 0.9)) == []


@pytest.mark.parametrize(("begin_m", "n_leaves"), [(2.9, 1), (3.6, 0)], ids=["door", "too wide"])
def test_a_door_may_be_where_one_wall_ends_and_another_goes_on(begin_m, n_leaves):
    walls = [single(0, 0, 2, 0), single(begin_m, 0, 6, 0), single(2.0, 0.05, 2.0, 0.9)]
    found = find_leaves(walls, unpaired_m=0.1, max_width_m=1.5)
    assert [leaf.face for leaf in found] == walls[2].left[:n_leaves]


def test_what_is_open_for_longer_than_it_is_wall_is_no_door_between_two_walls():
    walls = [single(1.6, 0, 2, 0), single(2.9, 0, 3.3, 0), single(2.0, 0.05, 2.0, 0.9)]
    assert find_leaves(walls, unpaired_m=0.1, max_width_m=1.5) == []
    longer = [single(1.4, 0, 2, 0), *walls[1:]]
    assert len(find_leaves(longer, unpaired_m=0.1, max_width_m=1.5)) == 1


def test_a_leaf_that_is_in_one_line_with_a_cupboard_beyond_its_door_is_taken_off_it():
    """No wall runs on through a door: it was seen as one surface of 1.5 m."""
    body = single(2.0, -0.6, 2.0, 0.9)
    (leaf,) = leaves(body)
    np.testing.assert_allclose(np.sort(leaf.face.ends[:, 1]), [0.05, 0.9], atol=0.06)
    front, rest = sorted(leaf.cut_off(body.left[0]), key=lambda face: -face.ends[:, 1].max())
    assert front is leaf.face and rest.ends[:, 1].max() < 0.06
    assert leaf.cut_off(rest) == [rest]


def test_what_a_leaf_was_seen_in_one_line_with_stays_a_wall():
    walls = [south(), single(2.0, -0.6, 2.0, 0.9)]
    left, _, (leaf,) = fronts.drop_fronts(
        *(
            walls,
            *2 * (box(0, -2, 5, 4),),
            lambda faces: [single(*np.ravel(f.ends)) for f in faces],
        ),
        MOST,
    )
    assert leaf.face.ends[:, 1].max() == pytest.approx(0.9)
    assert sorted(wall.ends[:, 1].max().round(2) for wall in left) == [0.0, 0.05]


def test_a_leaf_may_hang_where_a_cupboard_hides_its_jamb():
    """The wall is not seen from 2 to 2.9, nor beyond it to 3.4: the leaf is as wide as the door."""
    bare = single(0, 0, 5, 0)
    low_m, high_m = np.sort(bare.line.along_m(np.array([[2.0, 0.0], [3.4, 0.0]])))
    wall = single(0, 0, 5, 0, openings=[Opening(low_m, high_m, OPEN, 99, np.nan, np.nan, False)])
    body = single(2.9, 0.05, 2.9, 0.9)
    (leaf,) = find_leaves([wall, body], unpaired_m=0.1, max_width_m=1.5)
    np.testing.assert_allclose(np.sort(leaf.way_m, axis=0), JAMBS_M, atol=0.01)


def test_a_partition_in_a_wide_opening_is_no_leaf_of_half_of_it():
    bare = single(0, 0, 10, 0)
    low_m, high_m = np.sort(bare.line.along_m(np.array([[1.0, 0.0], [9.0, 0.0]])))
    wide = Opening(low_m, high_m, OPEN, 99, np.nan, np.nan, False)
    walls = [single(0, 0, 10, 0, openings=[wide]), single(5.0, 0.05, 5.0, 3.9)]
    assert find_leaves(walls, unpaired_m=0.1, max_width_m=1.5) == []


@pytest.mark.parametrize(
    "others",
    [[(2.9, 0.5, 6, 0.5)], [(2.9, 0.0, 2.9, -3.0)], [(2.9, 0, 6, 0), (2.0, 0.1, 2.9, 0.1)]],
    ids=["beside it", "across", "another wall in the gap"],
)
def test_a_wall_that_ends_where_none_goes_on_has_no_door_beyond_it(others):
    walls = [single(0, 0, 2, 0), single(2.0, 0.15, 2.0, 0.95), *(single(*o) for o in others)]
    assert find_leaves(walls, unpaired_m=0.1, max_width_m=1.5) == []


@pytest.mark.parametrize(("thin", "n_leaves"), [(True, 2), (False, 0)])
def test_a_thin_leaf_may_have_been_seen_where_it_stood_at_another_time(thin, n_leaves):
    """0.25 m beside it, from the other side; what is not seen to be thin may be a pier."""
    sides = [single(2.0, 0.05, 2.0, 0.9), single(2.05, 0.9, 2.05, 0.05)]
    other = single(2.25, 0.9, 2.25, 0.05)
    assert len(leaves(*sides[: 1 + thin], other)) == n_leaves


def test_both_sides_of_a_leaf_are_found_and_taken_off_with_what_was_seen_of_it_at_other_times():
    sides = [single(2.0, 0.05, 2.0, 0.9), single(2.05, 0.9, 2.05, 0.05)]
    traces = [single(2.1, 0.4, 2.1, 0.8)]
    walls = [south(), *sides, *traces]

    def assemble(faces):
        return [wall for wall in walls if any(face in faces for face in wall.members)]

    left, grounds, found = fronts.drop_fronts(walls, *2 * (box(0, 0, 5, 4),), assemble, MOST)
    assert left == walls[:1] and len(found) == len(grounds) == 2
    assert {id(leaf.face) for leaf in found} == {id(side.left[0]) for side in sides}
