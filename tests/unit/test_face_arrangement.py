"""Faces seen from above, each from the left of the way from its start to its end."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.ray_making import turned
from scanplan.plan.faces.face_arrangement import Faces, stand_before

DEPTH_M, DOOR_M = 1.0, 1.5


def faces(*ends, line=None):
    """Return faces from (x0, y0) to (x1, y1), each on a line of its own by default."""
    ends_m = np.array(ends, float).reshape(-1, 2, 2)
    way = ends_m[:, 1] - ends_m[:, 0]
    way /= np.hypot(*way.T)[:, None]
    number = np.arange(len(ends_m)) if line is None else np.array(line)
    normal = np.column_stack([-way[:, 1], way[:, 0]])
    return Faces(ends_m, normal, number)


def before(found, chosen=None):
    chosen = np.ones(len(found), bool) if chosen is None else np.array(chosen)
    pairs = stand_before(found, chosen, depth_m=DEPTH_M, door_m=DOOR_M)
    return [tuple(pair) for pair in np.argwhere(pairs).tolist()]


# seen from the north; the wall goes on to the left of the cabinet
WALL, CABINET = (-3, 0, 2, 0), (2, 0.5, 4, 0.5)


class TestPlaces:
    def test_lengths_and_distances(self):
        found = faces(WALL, CABINET, line=[7, 7])
        assert found.length_m.tolist() == [5, 2]
        assert found.line_length_m.tolist() == [7, 7]
        assert found.middle_m.tolist() == [[-0.5, 0], [3, 0.5]]
        # the cabinet's middle is 0.5 m before the wall, the wall's as far behind the cabinet
        assert found.forward_m.tolist() == [[0, -0.5], [0.5, 0]]
        assert found.along_m(1, np.array([(2.0, 9.0), (4.0, 0.0)])).tolist() == [-1, 1]
        assert found.is_parallel.all()

    def test_how_far_faces_are_apart_along_each_other(self):
        found = faces((0, 0, 2, 0), (3, 5, 4, 5), (1, 1, 1.5, 1))
        # those side by side overlap: by as much as one has to move to be beside the other
        assert found.apart_m.tolist() == [[-2, 1, -1], [1, -1, 1.5], [-1, 1.5, -0.5]]

    def test_faces_seen_from_the_other_side_or_across_are_not_parallel(self):
        found = faces((0, 0, 2, 0), (2, 0, 0, 0), (0, 0, 0, 2))
        assert found.is_parallel.tolist() == np.eye(3, dtype=bool).tolist()


class TestStandBefore:
    def test_a_cabinet_before_the_wall_that_is_seen_beside_it(self):
        assert before(faces(WALL, CABINET)) == [(1, 0)]
        assert before(faces(WALL, CABINET), [True, False]) == []

    @pytest.mark.parametrize(
        ("thing", "why"),
        [
            ((2, 0.1, 4, 0.1), "nearer than noise"),
            ((2, 1.1, 4, 1.1), "deeper than furniture"),
            ((2, -0.5, 4, -0.5), "behind"),
            ((4, 0.5, 2, 0.5), "seen from the other side"),
            ((2, 0.5, 2, 2.5), "across"),
            ((3.1, 0.5, 5, 0.5), "too far beside"),
            ((-3.2, 0.5, 2.2, 0.5), "longer, so the wall would be the niche"),
            ((-2.8, 0.5, 1.8, 0.5), "too little of the wall is seen beside"),
        ],
    )
    def test_what_stands_before_no_wall(self, thing, why):
        assert before(faces(WALL, thing)) == [], why

    def test_the_longer_line_is_the_wall(self):
        """A short piece of wall beside the cabinet counts with the rest of its line."""
        pieces = [(0, 0, 1, 0), (4, 0, 6, 0)]
        # 1 m and 2 m of two lines are not longer than the cabinet, 3 m of one line are
        assert before(faces(*pieces, CABINET)) == []
        assert before(faces(*pieces, CABINET, line=[0, 0, 1])) == [(2, 0), (2, 1)]

    def test_what_is_seen_through_a_door_in_the_front_is_not_beside_it(self):
        front, in_it = [(1, 0.5, 2, 0.5), (2.9, 0.5, 4, 0.5)], (1.1, 0, 3.9, 0)
        assert before(faces(*front, in_it, line=[0, 0, 1])) == []
        assert before(faces(front[0], in_it)) == [(0, 1)]

    def test_beyond_what_ends_the_room_nothing_is_beside(self):
        """A wall of 5 m goes on beside one of 2 m; what faces the first parts their rooms."""
        shallow, deep = (0, 0.5, 2.1, 0.5), (2.2, 0, 7.2, 0)
        assert before(faces(shallow, deep)) == [(0, 1)]
        assert before(faces(shallow, deep, (2, 0.5, 2, 4))) == []
        # seen from the other room it ends that one
        assert (0, 1) in before(faces(shallow, deep, (2.2, 4, 2.2, 0.5)))


def test_no_faces():
    assert before(faces()) == []


@given(
    st.integers(0, 10_000),
    st.floats(-np.pi, np.pi),
    st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
)
def test_neither_turn_nor_place_nor_order_matters(seed, angle_rad, shift_m):
    rng = np.random.default_rng(seed)
    ends_m = np.round(rng.uniform(-2, 2, (8, 1, 2)), 1)
    ways = np.array(
        [(1.1, 0), (-1.1, 0), (0, 1.7), (0, -1.7), (2.3, 0), (0.7, 0), (0, 0.7), (3, 0)]
    )
    ends_m = np.concatenate([ends_m, ends_m + ways[:, None]], axis=1) + rng.normal(
        0, 1e-3, (8, 2, 2)
    )
    order, line = rng.permutation(8), rng.integers(0, 6, 8)
    here = faces(*ends_m.reshape(8, 4), line=line)
    there = faces(*turned(ends_m, angle_rad, shift_m)[order].reshape(8, 4), line=line[order])

    def arranged(found):
        return stand_before(found, np.ones(8, bool), depth_m=DEPTH_M, door_m=DOOR_M)

    np.testing.assert_array_equal(arranged(here)[np.ix_(order, order)], arranged(there))
