import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import toy_rooms
from scanplan.extraction import map_tilt


def turned(angle_deg, about):
    """Return the rotation by an angle about x (0) or y (1)."""
    cos, sin = np.cos(np.deg2rad(angle_deg)), np.sin(np.deg2rad(angle_deg))
    turn = np.eye(3)
    other = 1 - about
    turn[other, other], turn[other, 2], turn[2, other], turn[2, 2] = cos, -sin, sin, cos
    return turn


def scan(turn):
    return toy_rooms.vlp16() @ turn.T, turn @ toy_rooms.SENSOR


def test_of_a_level_room_nothing_is_said():
    assert map_tilt.tilt_warning([scan(np.eye(3))]) == ""
    assert map_tilt.tilt_warning([scan(turned(4, 0))]) == ""


def test_a_tilted_map_is_told():
    said = map_tilt.tilt_warning([scan(turned(27, 0))])
    assert re.search(r"2[678] degrees off the map's z.*z is up", said)


def test_next_to_nothing_tells_nothing():
    assert map_tilt.tilt_warning([]) == ""
    assert map_tilt.tilt_warning([(np.empty((0, 3)), (0, 0, 0))]) == ""
    assert map_tilt.tilt_warning([(np.ones((50, 3)), (0, 0, 0))]) == ""


@given(st.floats(10, 40), st.integers(0, 1))
@settings(max_examples=20, deadline=None)
def test_up_of_a_tilted_box(angle_deg, about):
    turn = turned(angle_deg, about)
    normal = np.vstack([np.eye(3), -np.eye(3)]) @ turn.T
    up = map_tilt.estimate_up_direction(np.repeat(normal, 5, axis=0), np.ones(30))
    assert up == pytest.approx(turn[:, 2])


def test_a_lone_ramp_tilts_no_map():
    ramp = turned(20, 0)[:, 2]
    normal = np.vstack([[(0, 0, 1), (1, 0, 0), (0, 1, 0)], [ramp]])
    assert map_tilt.estimate_up_direction(normal, np.array([5.0, 5, 5, 8])).tolist() == [0, 0, 1]


def test_ten_scans_of_all_are_looked_at():
    assert map_tilt.sample_scan_ids([3, 4]) == [3, 4]
    assert map_tilt.sample_scan_ids(list(range(100)))[::9] == [0, 99]
