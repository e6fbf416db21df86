"""Rooms whose outlines go with walls that are moved or of another thickness, on the plan of two."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from helpers.correcting import MADE, corrected, write_plan
from scanplan.plan.corrections.following import follow_side
from scanplan.plan.corrections.rows import rows_of_plan

WALL = {"element": "wall", "at": [4.05, 0.5]}


@pytest.fixture
def plan(tmp_path):
    return write_plan(tmp_path)


def rows():
    return rows_of_plan({name: made() for name, made in MADE.items()})


def areas_of(rows):
    return [shapely.from_wkb(room["geometry"]).area for room in rows.rooms]


def test_rooms_go_with_the_wall_between_them(plan):
    found = corrected(plan, WALL | {"line": [[4.25, -0.1], [4.25, 3.1]]})
    # by 0.2 m, 3 m long
    assert found.rooms["area_m2"].tolist() == pytest.approx([12.6, 8.4])
    assert found.rooms["perimeter_m"].tolist() == pytest.approx([14.4, 11.6])
    assert found.rooms["corrected"].tolist() == ["changed by hand"] * 2


def test_a_line_drawn_the_other_way_moves_it_likewise(plan):
    found = corrected(plan, WALL | {"line": [[4.25, 3.1], [4.25, -0.1]]})
    assert found.rooms["area_m2"].tolist() == pytest.approx([12.6, 8.4])


def test_rooms_end_at_a_wall_of_another_thickness(plan):
    found = corrected(plan, WALL | {"thickness_m": 0.3})
    assert found.rooms["area_m2"].tolist() == pytest.approx([11.7, 8.7])


def test_a_wall_that_is_only_longer_leaves_rooms(plan):
    found = corrected(plan, WALL | {"line": [[4.05, -0.1], [4.05, 2.9]]})
    assert found.rooms["area_m2"].tolist() == pytest.approx([12, 9])
    assert found.rooms["corrected"].tolist() == ["", ""]


def test_a_wall_seen_from_one_side_keeps_that_side_when_its_thickness_is_said(plan):
    found = corrected(plan, {"element": "wall", "at": [7.1, 1.0], "thickness_m": 0.4})
    assert found.rooms["area_m2"].tolist() == pytest.approx([12, 9])


def test_an_outline_goes_on_beyond_a_short_wall():
    of_plan = rows()
    line_m = np.array([[2.0, 3.0], [1.0, 3.0]])
    follow_side(of_plan, line_m, line_m + np.array([0, 0.2]), "by hand")
    assert areas_of(of_plan) == pytest.approx([12 + 0.2 * 1.0, 9])


def test_an_outline_that_begins_where_the_wall_ends_stays(plan):
    # the north wall of the large room ends 0.05 m before the small one begins
    found = corrected(plan, {"element": "wall", "at": [2, 3.1], "line": [[4.05, 3.4], [-0.1, 3.4]]})
    assert found.rooms["area_m2"].tolist() == pytest.approx([13.2, 9])


def test_an_outline_that_would_cross_itself_stays():
    of_plan = rows()
    line_m = np.array([[4.0, 0.0], [4.0, 3.0]])
    follow_side(of_plan, line_m, line_m - np.array([5, 0]), "by hand")
    assert areas_of(of_plan) == pytest.approx([12, 9])


@given(st.floats(-1, 1), st.floats(-1, 1))
def test_what_one_room_gets_the_other_loses(south_m, north_m):
    of_plan = rows()
    by_m = np.array([[south_m, 0], [north_m, 0]])
    west_m, east_m = (np.array([[x_m, 0.0], [x_m, 3.0]]) for x_m in (4.0, 4.1))
    follow_side(of_plan, west_m, west_m + by_m, "by hand")
    follow_side(of_plan, east_m[::-1], (east_m + by_m)[::-1], "by hand")
    # a trapezium of as much at its ends
    gained_m2 = 3 * (south_m + north_m) / 2
    assert areas_of(of_plan) == pytest.approx([12 + gained_m2, 9 - gained_m2])


@pytest.mark.parametrize(("by_m", "area_m2"), [(0.5, 11 - 0.5), (-1.2, 11)])
def test_holes_go_with_the_walls_around_them_and_are_not_turned_inside_out(by_m, area_m2):
    ring = shapely.Polygon(shapely.box(0, 0, 4, 3).exterior, [shapely.box(1.5, 1, 2.5, 2).exterior])
    of_plan = rows_of_plan(
        {name: made() for name, made in MADE.items()}
        | {"rooms": floorplan_making.rooms([ring, floorplan_making.ROOMS[1]])}
    )
    line_m = np.array([[1.5, 1.0], [1.5, 2.0]])
    follow_side(of_plan, line_m, line_m - np.array([by_m, 0]), "by hand")
    assert areas_of(of_plan) == pytest.approx([area_m2, 9])
