"""Cells of ground joined to rooms, on cells that can be weighed on paper."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import box

from scanplan.geometry.ground_cells import part_ground
from scanplan.geometry.outlines import Outline
from scanplan.plan.model.parting_odds import weigh_room
from scanplan.plan.model.room_partition import join_cells


def line(x0, y0, x1, y1):
    return np.array([(x0, y0), (x1, y1)], float)


HALL = box(0, 0, 9, 4)
THIRDS = part_ground(HALL, np.array([line(3, 0, 3, 4), line(6, 0, 6, 4)]), 0.05)


def test_a_line_lies_between_two_cells_all_along():
    pairs, lines, shares = THIRDS.list_borders()
    assert sorted(lines.tolist()) == [0, 1] and shares.tolist() == [1, 1]
    centres_m = [THIRDS.cells[row].centroid.x for row in pairs.ravel()]
    np.testing.assert_allclose(np.sort(centres_m), [1.5, 4.5, 4.5, 7.5], atol=0.01)


def test_a_line_that_ends_within_ground_parts_nothing():
    cells = part_ground(HALL, np.array([line(3, 0, 3, 2)]), 0.05)
    assert len(cells.cells) == 1 and len(cells.list_borders()[0]) == 0


def test_crossing_lines_share_their_borders():
    cells = part_ground(HALL, np.array([line(3, 0, 3, 4), line(0, 1, 9, 1)]), 0.05)
    _, lines, shares = cells.list_borders()
    assert len(cells.cells) == 4
    assert np.bincount(lines, shares) == pytest.approx([1, 1], abs=0.05)
    assert sorted(shares.round(2).tolist()) == pytest.approx([0.25, 0.33, 0.67, 0.75], abs=0.03)


@pytest.mark.parametrize(
    ("log_odds", "n_rooms"), [((2, 2), 3), ((2, -2), 2), ((-2, -2), 1), ((-2, 2), 2)]
)
def test_cells_are_joined_over_lines_that_part_unlikely(log_odds, n_rooms):
    room = join_cells(THIRDS, np.array(log_odds, float), np.ones(3, bool)).room
    assert len(np.unique(room)) == n_rooms
    assert len(THIRDS.find_spans(room)) == n_rooms - 1


def test_rooms_are_as_sure_as_their_doubtful_borders():
    """Three rooms of 12 m2: each line adds its odds to those of one area, two for another."""

    def weigh(area_m2):
        return weigh_room(area_m2, is_visited=True, is_one=True)

    more = 2 * weigh(12.0) - weigh(24.0)
    apart = join_cells(THIRDS, np.array([2.0, 3.0]), np.ones(3, bool))
    by_place = np.argsort([cell.centroid.x for cell in THIRDS.cells])
    np.testing.assert_allclose(apart.apart[by_place], np.array([2, 2, 3]) + more, atol=0.01)
    assert np.isinf(apart.whole).all()
    both = weigh(24.0) + weigh(12.0) - weigh(36.0)
    one = join_cells(THIRDS, np.array([-9.0, -3.0]), np.ones(3, bool))
    np.testing.assert_allclose(one.whole, 3 - both, atol=0.01)
    assert np.isinf(one.apart).all()


def test_ground_that_is_no_room_goes_with_what_is_likelier_beside_it():
    """0.2 m between two lines: wherever they part, nobody can stand there."""
    cells = part_ground(HALL, np.array([line(4, 0, 4, 4), line(4.2, 0, 4.2, 4)]), 0.05)
    room = join_cells(cells, np.array([3.0, 2.0]), np.ones(3, bool)).room
    ((row, first, last),) = cells.find_spans(room)
    assert (row, round(first, 2), round(last, 2)) == (0, 0, 1)


def test_less_is_a_room_where_somebody_was():
    visited, seen = (weigh_room(2.0, is_visited=was, is_one=was) for was in (True, False))
    assert visited - seen > 20
    assert weigh_room(9.0, is_visited=False, is_one=True) < weigh_room(
        9.0, is_visited=True, is_one=True
    )


@given(
    st.lists(st.floats(0.5, 8.5), min_size=1, max_size=5, unique_by=lambda x: round(x, 1)),
    st.lists(st.floats(-5, 5), min_size=5, max_size=5),
)
def test_rooms_are_unions_of_cells_and_borders_lie_between_them(places_m, odds):
    lines = np.array([line(x, 0, x, 4) for x in places_m])
    cells = part_ground(HALL, lines, 0.05)
    joined = join_cells(cells, np.array(odds[: len(lines)]), np.ones(len(cells.cells), bool))
    room = joined.room
    assert (joined.whole >= 0).all() and (joined.apart >= 0).all()
    assert shapely.area(cells.cells).sum() == pytest.approx(HALL.area, abs=0.1)
    assert len(cells.find_spans(room)) == len(np.unique(room)) - 1
    for number in np.unique(room):
        assert shapely.union_all(cells.cells[room == number]).area >= 1.0


def test_a_ray_ends_at_the_next_side_and_beyond_reach_nowhere():
    outline = Outline(HALL)
    ways = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
    assert outline.cast(np.array([2.0, 1.0]), ways, 5.0).tolist() == [np.inf, 3.0, 2.0]


def test_a_corner_that_stands_into_ground_is_closed_along_both_its_sides():
    angle = shapely.union_all([box(0, 0, 6, 3), box(0, 0, 3, 6)])
    found = Outline(angle).find_short_lines(10.0, 0.05)
    tips_m = sorted(tuple(np.round(tip, 6).tolist()) for tip in found[:, 1])
    assert tips_m == [(0.0, 3.0), (3.0, 0.0)]


def test_a_convex_ground_has_no_line():
    assert len(Outline(HALL).find_short_lines(10.0, 0.05)) == 0
