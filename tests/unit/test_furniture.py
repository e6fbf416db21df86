from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import toy_rooms
from helpers.upright import SENSOR_M, returns
from scanplan.extraction import furniture, segments

LIMITS = furniture.FurnitureLimits(**toy_rooms.FURNITURE)


def view(points):
    return segments.view_scan(points, planar=False)


def row(x0, y0, x1, y1, low, high, rmse_m=0.01):
    """Return a row of `segments.cut_line`; the sensor, at the origin, is to the left of the way."""
    way = np.array([x1 - x0, y1 - y0]) / np.hypot(x1 - x0, y1 - y0)
    return (x0, y0, x1, y1, -way[1], way[0], 200, rmse_m, low - SENSOR_M, high - SENSOR_M)


def kept(faces, others=(), **seen):
    """Return which faces count as walls, in a scan of them and others."""
    rows = [row(*face, **seen) for face in faces]
    walls_found = furniture.keep_walls(rows, view(returns([*faces, *others])), LIMITS)
    return [r in walls_found for r in rows]


WALL = (6, -3, 6, 3, 0, 2.6)
LOW_WALL = (4, -2, 4, 2, 0, 1.6)


def test_a_wall_is_one():
    assert kept([WALL]) == [True]


def test_what_rays_pass_over_is_none():
    # at 4 m beams of 15 degrees reach 1.47 m
    assert kept([(4, -1, 4, 1, 0, 1.2)], [WALL]) == [False]
    assert kept([(4, -1, 4, 1, 0, 2.6)], [WALL]) == [True]


def test_where_all_scans_decide_what_rays_pass_over_stays():
    low, behind = (4, -1, 4, 1, 0, 1.2), WALL
    rows = [row(*low), row(*low, rmse_m=0.03)]
    limits = replace(LIMITS, by_scan=False)
    # what scatters by more than a wall is none all the same
    assert furniture.keep_walls(rows, view(returns([low, behind])), limits) == rows[:1]
    assert furniture.keep_walls(rows, view(returns([low, behind])), LIMITS) == []


def test_nothing_behind_is_no_evidence():
    assert kept([(4, -1, 4, 1, 0, 1.2)]) == [True]


def test_what_no_beam_could_pass_over_is_judged_by_its_corners():
    # at 1.5 m beams of 15 degrees reach 0.8 m: nothing tells a wall from a desk there
    desk = (1.5, -1, 1.5, 1, 0, 0.8)
    assert kept([desk], [WALL]) == [False]
    # but in a small room, whose walls meet in inner corners
    room = [(1.5, -1, 1.5, 1), (1.5, 1, -1.5, 1), (-1.5, 1, -1.5, -1), (-1.5, -1, 1.5, -1)]
    assert kept([(*side, 0, 2.6) for side in room]) == [True] * 4


def test_an_outer_corner_shows_that_a_low_face_is_furniture():
    faces = [(1.5, -0.5, 1.5, 0.5, 0, 0.8), (1.5, 0.5, 2.5, 0.5, 0, 0.8)]
    # the second is seen edge-on from the origin's side; its normal is up
    rows = [row(*faces[0]), row(2.5, 0.5, 1.5, 0.5, 0, 0.8)]
    assert furniture.keep_walls(rows, view(returns(faces)), LIMITS) == []


def test_what_is_seen_higher_than_furniture_is_no_side_of_it():
    """A wall of 0.9 m, at whose end stands a unit of 0.9 m height.

    And the side of clutter as high as itself.
    """
    wall, unit = (3, -0.5, 3, 0.4, 0, 2.6), (3, 0.4, 5, 0.9, 0, 0.9)
    assert kept([wall, unit], [(9, -6, 9, 6, 0, 2.6)]) == [True, False]
    clutter = (3, 0.4, 5, 0.9, 0, 2.0)
    rows = [row(*wall), row(*clutter, rmse_m=0.03)]
    assert furniture.keep_walls(rows, view(returns([wall, clutter])), LIMITS) == []


def test_stairs_let_rays_through():
    treads = [(4, -1 + 0.1 * i, 4, -0.95 + 0.1 * i, 0, 2.6) for i in range(20)]
    rows = [row(4, -1, 4, 1, 0, 2.6)]
    assert furniture.keep_walls(rows, view(returns([*treads, WALL])), LIMITS) == []
    assert furniture.keep_walls(rows, view(returns([(4, -1, 4, 1, 0, 2.6), WALL])), LIMITS) == rows


def test_glass_gives_few_returns():
    points = returns([(4, -1, 4, 1, 0, 2.6), (-4, 1, -4, -1, 0, 2.6)])
    pane = np.abs(points[:, 0] - 4) < 1e-6
    few = points[~pane | (np.arange(len(points)) % 10 == 0)]
    rows = [row(4, -1, 4, 1, 0, 1.4), row(-4, 1, -4, -1, 0, 1.4)]
    assert furniture.keep_walls(rows, view(few), LIMITS) == rows[1:]


def test_what_stands_close_before_a_wall_is_furniture():
    # 1.5 m tall at 4 m: no ray passes over it, but the wall goes on to both sides 0.6 m behind it
    cabinet, wall = (
        (4, -0.7, 4, 0.7, 0, 2.0),
        [(4.6, -3, 4.6, -0.9, 0, 2.6), (4.6, 0.9, 4.6, 3, 0, 2.6)],
    )
    assert kept([cabinet, *wall]) == [False, True, True]
    far_behind = [(7, -4, 7, -1.5, 0, 2.6), (7, 1.5, 7, 4, 0, 2.6)]
    assert kept([cabinet, *far_behind]) == [True, True, True]


def test_what_hangs_is_no_wall():
    assert kept([(6, -1, 6, 1, 1.4, 2.0)]) == [False]


def test_a_short_face_is_a_wall_where_it_goes_on_beyond_a_door():
    short, on = (4, -0.3, 4, 0.3, 0, 2.6), (4, 1.2, 4, 3, 0, 2.6)
    assert kept([short]) == [False]
    assert kept([short, on]) == [True, True]


def test_a_low_face_is_a_wall_beyond_a_door_but_not_beyond_a_niche():
    """At 1.3 m no beam rises above 0.9 m.

    The wall goes on beyond a door of 0.9 m, or beyond one of two units.
    """
    low, wall, far = (1.3, -1.2, 1.3, -0.2, 0, 1), (1.3, 0.7, 1.3, 5, 0, 2.6), (4, -9, 4, 9, 0, 2.6)
    assert kept([low, wall], [far]) == [True, True]
    assert kept([low, wall], [(1.9, -0.2, 1.9, 0.7, 0, 2.6)]) == [False, True]
    # nor where it shows an outer corner, as the end of a table does
    rows = [row(*low), row(*wall), row(1.3, -0.2, 2.3, -0.2, 0, 1)]
    found = furniture.keep_walls(rows, view(returns([low, wall, far])), LIMITS)
    assert rows[0] not in found and rows[1] in found


def test_faces_side_by_side_have_no_door_between_them():
    """A low unit before a tall wall on much the same line.

    Nothing lies between their ends, and no door does.
    """
    wall, far = (1.3, -0.7, 1.3, 5, 0, 2.6), (4, -9, 4, 9, 0, 2.6)
    low = (1.25, -1.2, 1.25, -0.2, 0, 1)
    # from 0.05 m before its end on, the unit hides what a door would show: rays that lead on
    assert kept([low, wall], [far]) == [False, True]


@pytest.mark.parametrize("planar", [False, True])
def test_clutter_scatters(planar):
    scan = None if planar else view(returns([LOW_WALL]))
    rows = [row(*LOW_WALL, rmse_m=0.028), row(*LOW_WALL, rmse_m=0.02)]
    assert furniture.keep_walls(rows, scan, LIMITS) == rows[1:]
    assert furniture.keep_walls([], scan, LIMITS) == []


@given(st.floats(-3.1, 3.1))
@settings(max_examples=10, deadline=None)
def test_a_turn_of_the_room_changes_nothing(angle_rad):
    cabinet, wall = (
        (4, -0.7, 4, 0.7, 0, 2.0),
        [(4.6, -3, 4.6, -0.9, 0, 2.6), (4.6, 0.9, 4.6, 3, 0, 2.6)],
    )
    turn = np.array(
        [[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]]
    )
    rows = [row(*face) for face in [cabinet, *wall]]
    points = returns([cabinet, *wall])
    turned = [(*turn @ r[0:2], *turn @ r[2:4], *turn @ r[4:6], *r[6:]) for r in rows]
    points = np.column_stack([points[:, :2] @ turn.T, points[:, 2]])
    found = furniture.keep_walls(turned, view(points), LIMITS)
    assert [r in found for r in turned] == [False, True, True]
