"""What would be redrawn of a sheet, counted on plans where it is known on paper."""

import sys
from pathlib import Path

import numpy as np
import pytest
import shapely

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import redraw_bench

from helpers import floorplan_making
from scanplan.exports.sheet.composition import compose_sheet

NONE = dict.fromkeys(redraw_bench.LIST, 0)


def counted(*lines, openings=floorplan_making.OPENINGS, pieces=(), kind="leaf", said=""):
    """The counts of the toy plan with more walls of 0.1 m, openings, furniture or corrections."""
    walls = [*floorplan_making.WALLS, *((line_m, 0.1, -1, -1, "observed") for line_m in lines)]
    made = floorplan_making.openings(openings, walls)
    plan = floorplan_making.plan(
        walls=floorplan_making.walls(walls),
        openings=made | {"corrected": np.full(len(openings), said, object)},
        furniture=floorplan_making.furniture(list(pieces), kind),
    )
    return redraw_bench.count_redrawn(plan, compose_sheet(plan))


@pytest.mark.parametrize(
    ("line_m", "found"),
    [
        # in the first room, 4 m by 3 m: from its south side, 0.2 m before the north side's face
        ((2.0, 0.0, 2.0, 2.8), {"nearly met": 1}),
        ((2.0, 0.0, 2.0, 2.5), {}),
        # 0.2 m beside the north wall's face, from the west side, and 0.5 m beside it
        ((0.0, 2.75, 1.5, 2.75), {"double": 1}),
        ((0.0, 2.45, 1.5, 2.45), {}),
        # a degree off, and 10 degrees
        ((0.0, 1.5, 2.0, 1.5 + 2 * np.tan(np.radians(1))), {"askew": 1}),
        ((0.0, 1.5, 2.0, 1.5 + 2 * np.tan(np.radians(10))), {}),
        # 0.3 m long with both ends free, and between two walls
        ((2.0, 1.5, 2.3, 1.5), {"scrap": 1}),
    ],
)
def test_walls_are_counted_by_what_is_wrong_of_them(line_m, found):
    assert counted(line_m) == NONE | found


def test_openings_on_one_another_are_counted_and_such_at_a_corner_are_not():
    door, inner, window = floorplan_making.OPENINGS
    again = ((2.1, -0.1, 3.0, -0.1), *window[1:])
    assert counted(openings=[door, inner, window, again])["openings"] == 1
    corner = ((-0.1, -0.1, -0.1, 0.9), *door[1:])
    assert counted(openings=[((-0.1, -0.1, 0.9, -0.1), *window[1:]), corner])["openings"] == 0


def test_a_door_that_swings_through_a_wall_is_counted():
    leaf = shapely.box(4.05, 0.98, 4.95, 1.02)
    assert counted(pieces=[leaf]) == NONE
    in_the_way = (4.5, 0.0, 4.5, 1.8)
    assert counted(in_the_way, pieces=[leaf])["swing"] == 0
    assert counted(in_the_way, pieces=[leaf], said="swing")["swing"] == 1
