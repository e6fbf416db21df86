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
    assert not map_tilt.measure_tilt([scan(np.eye(3))]).is_beyond
    assert not map_tilt.measure_tilt([scan(turned(4, 0))]).is_beyond


def test_a_tilted_map_is_told():
    found = map_tilt.measure_tilt([scan(turned(27, 0))])
    assert found.value == pytest.approx(27, abs=1.5)
    assert found.is_beyond and "z is up" in found.finding.remedy


def test_next_to_nothing_tells_nothing():
    nothing = ([], [(np.empty((0, 3)), (0, 0, 0))], [(np.ones((50, 3)), (0, 0, 0))])
    assert not any(map_tilt.measure_tilt(scans).is_beyond for scans in nothing)


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
