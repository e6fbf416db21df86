"""Glass walls: panes between walls, seen from above."""

import numpy as np

from helpers.observation_making import line_through
from scanplan.geometry.lines import Line
from scanplan.plan import glass
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall

SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))


def wall(x0, y0, x1, y1, openings=()):
    ways = [Opening(low, high, OPEN, 99, 0.0, np.nan, False) for low, high in openings]
    length_m = float(np.hypot(x1 - x0, y1 - y0))
    return PlanWall(line_through(x0, y0, x1, y1), 0.0, length_m, 0.2, [], [], ways, [])


def between(walls, *span):
    found = glass.find_glass_walls(walls, [(SOUTH, *span)], min_length_m=0.5, unpaired_m=0.1)
    return [pane.ends[:, 0] for pane in found]


def test_a_pane_goes_on_to_the_walls_beside_it():
    walls = [wall(0, 0, 0.8, 0), wall(3.5, -1, 3.5, 1)]
    np.testing.assert_allclose(between(walls, 1.0, 3.0), [(0.8, 3.5)])


def test_a_far_wall_leaves_it_as_it_is():
    np.testing.assert_allclose(between([wall(5, -1, 5, 1)], 1.0, 3.0), [(1, 3)])


def test_a_glass_door_in_a_wall_is_an_opening_of_it():
    assert between([wall(0, 0, 4, 0, openings=[(1, 2)])], 1.1, 1.9) == []


def test_a_slit_bounds_nothing():
    assert between([], 1.0, 1.3) == []
