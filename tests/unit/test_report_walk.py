"""Rooms with doubts, in the order in which a person walks through them."""

import numpy as np

from scanplan.report.walk import order_rooms
from scanplan.validation.doubts import Doubt


def doubt(room, x_m, number=0):
    place_m = np.array([x_m, 0.0])
    return Doubt("wall", number, f"Wall {number}", "", "", "", room, place_m, 1.0)


def test_rooms_come_along_the_way_from_where_the_survey_began_and_doubts_stay_in_order():
    rooms = [
        ("far", [doubt("far", 9.0), doubt("far", 8.0, 1)]),
        ("near", [doubt("near", 1.0)]),
        ("between", [doubt("between", 4.0)]),
    ]
    ordered = order_rooms(rooms, np.zeros(2))
    assert [name for name, _ in ordered] == ["near", "between", "far"]
    assert [each.number for each in ordered[2][1]] == [0, 1]


def test_nothing_to_verify_is_no_way():
    assert order_rooms([], np.zeros(2)) == []
