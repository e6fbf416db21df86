"""How far toy walls go on, in round numbers."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.plan_wall_making import wall
from scanplan.plan.model.line_ends import (
    end_where_seen,
    find_corridors,
    find_facades,
    lengthen_walls,
)
from scanplan.plan.model.line_labels import Stretch

NAN = float("nan")
DOOR_M = 1.2


def spans(walls):
    return [(round(w.low_m, 6), round(w.high_m, 6)) for w in lengthen_walls(walls, DOOR_M)]


class TestLengthening:
    @pytest.mark.parametrize(("thickness_m", "face_m"), [(0.2, 4.8), (NAN, 4.9)])
    def test_a_wall_goes_on_to_the_face_of_the_next_one_across(self, thickness_m, face_m):
        across = wall(4.9, -2, 4.9, 2, thickness_m)
        assert spans([wall(0, 0, 4, 0), across])[0] == (0, pytest.approx(face_m))

    def test_no_farther_than_a_door_is_wide(self):
        assert spans([wall(0, 0, 4, 0), wall(5.4, -2, 5.4, 2)])[0] == (0, 4)

    def test_what_ends_at_a_wall_ends_there(self):
        walls = [wall(0, 0, 4, 0), wall(4.1, -2, 4.1, 2), wall(5.0, -2, 5.0, 2)]
        assert spans(walls)[0] == (0, 4)

    def test_of_two_in_one_line_one_goes_on(self):
        assert spans([wall(0, 0, 4, 0), wall(4.9, 0, 9, 0)]) == [(0, 4.9), (0, 4.1)]

    def test_alone_it_stays(self):
        assert spans([wall(0, 0, 4, 0)]) == [(0, 4)]


class TestCorridors:
    def test_walls_that_run_on_cross_and_those_that_end_there_do_not(self):
        """One of 0.2 m crosses at x = 1, with its corners as wide as an end may err; one ends."""
        walls = [wall(0, 0, 4, 0), wall(1, -2, 1, 2), wall(3, 0, 3, 2)]
        np.testing.assert_allclose(find_corridors(walls)[0], [(0.6, 1.4)])

    def test_nothing_crosses_a_wall_alone(self):
        assert find_corridors([wall(0, 0, 4, 0)])[0].shape == (0, 2)


class TestFacades:
    """A facade along x, seen from above, and a wall through it at x = 2."""

    @pytest.mark.parametrize(
        ("inner", "facade", "places_m"),
        [
            ((2, 3, 2, -1), (0, 0, 4, 0), [3]),
            ((2, -1, 2, 3), (0, 0, 4, 0), [1]),
            ((2, 1, 2, -3), (0, 0, 4, 0), []),
            ((2, 3, 2, -1), (2, 0, 4, 0), []),
            ((2, 3, 2, -1), (4, 0, 0, 0), []),
            ((2, 3, 2, -0.05), (0, 0, 4, 0), []),
        ],
        ids=["through", "back", "mostly behind", "at its end", "seen from there", "no farther"],
    )
    def test_an_end_behind_what_was_seen_from_before_alone_begins_there(
        self, inner, facade, places_m
    ):
        of_two_sides = replace(wall(*inner), right=[None])
        found = find_facades([of_two_sides, wall(*facade, thickness=NAN)])
        np.testing.assert_allclose(found[0], places_m)
        assert not len(found[1])

    def test_a_wall_with_two_sides_is_no_facade(self):
        seen = wall(0, 0, 4, 0)
        found = find_facades([wall(2, 3, 2, -1), replace(seen, right=[None])])
        assert not len(found[0])


def stretch(kind, low_m, high_m):
    return Stretch(kind, low_m, high_m, NAN, NAN, 1.0)


class TestEnds:
    @pytest.mark.parametrize(
        ("kind", "end_m"), [("door", 4.9), ("shut", 4.9), ("window", 4.9), ("open", 4.0)]
    )
    def test_beyond_its_faces_are_none_but_openings(self, kind, end_m):
        found = end_where_seen([stretch("solid", 0, 4), stretch(kind, 4, 4.9)], 0.0, 4.0)
        assert found[-1].high_m == end_m

    def test_what_is_beyond_a_way_stays_with_it(self):
        given = [stretch("solid", -1, -0.9), stretch("door", -0.9, 0), stretch("solid", 0, 4)]
        assert end_where_seen(given, 0.0, 4.0) == given

    def test_a_way_within_its_faces_changes_no_end(self):
        given = [stretch("solid", -0.5, 1), stretch("door", 1, 2), stretch("solid", 2, 4.5)]
        found = end_where_seen(given, 0.0, 4.0)
        np.testing.assert_allclose([(s.low_m, s.high_m) for s in found], [(0, 1), (1, 2), (2, 4)])
