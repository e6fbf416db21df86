"""What bounds rooms without a ray ending there, seen from above: panes."""

import numpy as np
import pytest

from helpers.observation_making import line_through
from scanplan.geometry.lines import Line
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms import room_bounds

SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))


def wall(x0, y0, x1, y1, openings=()):
    ways = [Opening(low, high, OPEN, 99, 0.0, np.nan, False) for low, high in openings]
    length_m = float(np.hypot(x1 - x0, y1 - y0))
    return PlanWall(line_through(x0, y0, x1, y1), 0.0, length_m, 0.2, [], [], ways, [])


def between(walls, *span):
    found = room_bounds.find_glass_walls(walls, [(SOUTH, *span)], min_length_m=0.5, unpaired_m=0.1)
    return [pane.ends[:, 0] for pane in found]


def test_a_pane_goes_on_to_the_walls_beside_it():
    walls = [wall(0, 0, 0.8, 0), wall(3.5, -1, 3.5, 1)]
    np.testing.assert_allclose(between(walls, 1.0, 3.0), [(0.8, 3.5)])


def test_a_far_wall_leaves_it_as_it_is():
    np.testing.assert_allclose(between([wall(5, -1, 5, 1)], 1.0, 3.0), [(1, 3)])


def test_a_glass_door_in_a_wall_is_an_opening_of_it():
    assert between([wall(0, 0, 4, 0, openings=[(1, 2)])], 1.1, 1.9) == []


def test_a_pane_that_two_lines_show_is_one():
    again = Line(np.array([0.0, 0.04]), SOUTH.normal)
    spans = [(again, 1.2, 2.6), (SOUTH, 1.0, 3.0), (again, 4.0, 5.0)]
    found = room_bounds.find_glass_walls([], spans, min_length_m=0.5, unpaired_m=0.1)
    np.testing.assert_allclose([pane.ends[:, 0] for pane in found], [(1, 3), (4, 5)])


@pytest.mark.parametrize(
    ("spans", "drawn"),
    [
        ([(1, 3), (1.9, 5)], [(1, 1.9), (1.9, 5)]),
        ([(0, 4), (1, 5.1)], [(0, 1), (1, 5.1)]),
        ([(0, 1.5), (1.5, 3), (3, 4.2)], [(0, 1.5), (1.5, 3), (3, 4.2)]),
        ([(1, 3), (0.8, 2.9)], [(0.8, 2.9)]),
    ],
)
def test_lines_that_show_parts_of_a_pane_show_all_of_it(spans, drawn):
    found = room_bounds.find_glass_walls(
        [], [(SOUTH, *span) for span in spans], min_length_m=0.5, unpaired_m=0.1
    )
    np.testing.assert_allclose([np.sort(pane.ends[:, 0]) for pane in found], drawn, atol=0.02)


@pytest.mark.parametrize(("off_m", "begin_m"), [(0.15, 0.6), (0.25, 1.0)])
def test_a_pane_goes_on_to_the_end_of_a_wall_in_its_line(off_m, begin_m):
    """The wall is 0.2 m thick, so that the pane may stand anywhere in it, and ends 0.4 m before."""
    beside = wall(-2.0, off_m, 0.6, off_m)
    (pane,) = room_bounds.find_glass_walls(
        [beside], [(SOUTH, 1.0, 4.0)], min_length_m=0.5, unpaired_m=0.1
    )
    np.testing.assert_allclose(np.sort(pane.ends[:, 0]), [begin_m, 4.0], atol=1e-9)


def test_panes_that_cross_are_both_drawn():
    across = Line(np.array([2.0, 0.0]), np.array([1.0, 0.0]))
    spans = [(SOUTH, 0.0, 4.0), (across, -1.5, 1.5)]
    found = room_bounds.find_glass_walls([], spans, min_length_m=0.5, unpaired_m=0.1)
    assert [round(pane.length_m, 2) for pane in found] == [4.0, 3.0]


def test_a_slit_bounds_nothing():
    assert between([], 1.0, 1.3) == []
