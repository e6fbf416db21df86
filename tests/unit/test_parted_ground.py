"""Which lines part ground enough, at rooms on paper and against all parts made anew."""

import time

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from reference import parted_ground as literal
from scanplan.geometry.parted_ground import part_enough

NOBODY = np.empty((0, 2))
# rooms and cupboards of 0.5 to 3 m on a floor of 12 m, and lines across them, crossing ones too
NUMBERS = st.integers(0, 24).map(lambda number: number / 2)
SIZES = st.integers(1, 6).map(lambda number: number / 2)
BOXES = st.tuples(NUMBERS, NUMBERS, SIZES, SIZES).map(
    lambda b: box(b[0], b[1], b[0] + b[2], b[1] + b[3])
)
LINES = st.tuples(NUMBERS, NUMBERS, SIZES, st.integers(0, 11)).map(
    lambda row: turned_line(*row[:3], row[3] * np.pi / 12 + 0.01)
)


def turned_line(x_m, y_m, length_m, turn_rad):
    way_m = length_m * np.array([np.cos(turn_rad), np.sin(turn_rad)])
    # off the corners of rooms: what touches in a point is up to rounding
    return np.array([x_m + 0.137, y_m + 0.119]) + np.array([[0, 0], way_m])


def comb(n_cells):
    """A hall with cells of 1 m2, half of it nobody entered, at a line of 1 m each."""
    cells = [box(2 * i, 5, 2 * i + 1, 6) for i in range(n_cells)]
    lines = [np.array([[2 * i, 5.0], [2 * i + 1.0, 5.0]]) for i in range(n_cells)]
    return shapely.union_all([box(0, 0, 2 * n_cells, 5), *cells]), lines


def test_a_line_stays_that_parts_enough_on_either_side_and_others_go():
    ground = shapely.union_all([box(0, 0, 4, 4), box(4, 1, 8, 3), box(1, 4, 2, 5)])
    room, cupboard = np.array([[4.0, 1], [4, 3]]), np.array([[1.0, 4], [2, 4]])
    beyond = np.array([[9.0, 1], [9, 3]])
    assert part_enough(ground, [cupboard, beyond, room], NOBODY, 1.0, sliver_m=0.2) == [room]
    assert part_enough(ground, [], NOBODY, 1.0, sliver_m=0.2) == []


def test_two_halves_of_a_part_are_wide_together():
    """Strips of 0.3 m beside one another hold nothing wide, and together a place of 0.6 m."""
    ground = shapely.union_all([box(0, 0, 4, 4), box(4, 0, 20, 0.6)])
    lines = [np.array([[4.0, 0.3], [20, 0.3]]), np.array([[4.0, 0], [4, 0.6]])]
    found = part_enough(ground, lines, NOBODY, 1.0, sliver_m=0.2)
    assert len(found) == 1
    np.testing.assert_array_equal(found[0], lines[1])


@given(
    st.lists(BOXES, min_size=1, max_size=12),
    st.lists(LINES, max_size=12),
    st.lists(st.tuples(NUMBERS, NUMBERS), max_size=4),
    st.sampled_from([0.0, 1.0, 4.0]),
)
@settings(max_examples=60, deadline=None)
def test_it_agrees_with_making_all_parts_anew(boxes, lines, visits, min_area_m2):
    ground = shapely.union_all(boxes, grid_size=1e-3)
    visits_m = np.array(visits).reshape(-1, 2) + 0.07
    found = part_enough(ground, lines, visits_m, min_area_m2, sliver_m=0.2)
    expected = literal.part_enough(
        ground, lines, shapely.points(visits_m), min_area_m2, sliver_m=0.2
    )
    np.testing.assert_array_equal(np.array(found), np.array(expected))


def test_four_times_as_many_cells_take_no_more_than_ten_times_as_long():
    """All parts anew for every line would take sixty-four times as long."""

    def seconds(n_cells):
        ground, lines = comb(n_cells)
        started = time.process_time()
        assert part_enough(ground, lines, np.array([[1.0, 1.0]]), 1.0, sliver_m=0.2) == []
        return time.process_time() - started

    seconds(10)
    assert seconds(200) < 10 * seconds(50)
