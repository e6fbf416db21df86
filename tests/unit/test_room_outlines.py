"""Outlines of rooms in floor and between walls known on paper."""

import numpy as np
import pytest
import shapely

from helpers.plan_wall_making import box, wall
from scanplan.plan.rooms import room_outlines
from scanplan.plan.rooms.room import RoomSettings, rooms_beside
from scanplan.plan.wall_ground import Bounds

ROOMS = RoomSettings(min_area_m2=1, min_walled=0.7, min_width_m=0.6)


def find_rooms(walls, views, track_m):
    return room_outlines.find_rooms(Bounds(walls, unpaired_m=0.1), views, track_m, ROOMS)


def test_a_square_is_filled_to_its_faces():
    star = shapely.Point(2, 2).buffer(1.9)
    (room,) = find_rooms(box(), [star], np.array([(2.0, 2.0)]))
    assert room.polygon.area == pytest.approx(16, abs=0.05)
    assert (room.closed, room.entered, room.n_scans) == (True, True, 1)


def test_an_opening_parts_rooms_and_tells_which():
    walls_ = [*box(4.0), wall(2, 0, 2, 4, 0.2, openings=[(1.0, 1.9)])]
    star = shapely.box(0, 0, 4, 4)
    found = find_rooms(walls_, [star], np.array([(1.0, 1.0)]))
    np.testing.assert_allclose([r.polygon.area for r in found], [7.6, 7.6], rtol=0.01)
    left, right = rooms_beside(found, np.array([2.0, 1.45]), walls_[-1])
    assert {left, right} == {0, 1}
    assert found[left].polygon.centroid.x < found[right].polygon.centroid.x


def test_what_is_seen_through_a_window_is_no_room():
    found = find_rooms(
        *(
            box(),
            [shapely.box(0, 0, 4, 4), shapely.box(-3, 1, -0.2, 3)],
            np.array([(2.0, 2.0)]),
        ),
    )
    assert len(found) == 1


@pytest.mark.parametrize(("width", "count"), [(0.5, 1), (0.9, 2)])
def test_a_strip_as_narrow_as_a_wall_is_no_room_unless_entered(width, count):
    walls_ = [*box(), wall(0, 4 - width, 4, 4 - width, 0.02)]
    found = find_rooms(walls_, [shapely.box(0, 0, 4, 4)], np.array([(2.0, 2.0)]))
    assert len(found) == count
    assert len(find_rooms(walls_, [shapely.box(0, 0, 4, 4)], np.array([(2, 2), (2, 3.8)]))) == 2


def test_walls_that_never_close_still_bound_a_room_that_was_entered():
    open_side = box()[:3]
    (room,) = find_rooms(
        *(open_side, [shapely.box(0.5, 0.1, 3.9, 3.9)], np.array([(2.0, 2.0)])),
    )
    assert not room.closed
    assert room.walled == pytest.approx(0.75, abs=0.06)


@pytest.mark.parametrize(("track_m", "is_cut"), [([(1, 1), (2, 2)], True), ([(2, 2)] * 2, False)])
def test_who_looks_out_through_glass_leaves_a_room_inside(track_m, is_cut):
    """Who stood still saw all parts of a hall from as far, whichever of its walls furniture hid."""
    fan = shapely.Polygon([(3.9, 0.5), (3.9, 3.5), (20, 9), (20, -5)])
    floor = shapely.union(shapely.box(0.1, 0.1, 3.9, 3.9), fan)
    walls_ = [w for w in box() if np.abs(w.ends[:, 0] - 4).max() > 0.1]
    (room,) = find_rooms(walls_, [floor], np.array(track_m, float))
    assert room.polygon.area == pytest.approx(14.4 if is_cut else floor.area, rel=0.04)


def test_no_place_that_was_driven_to_is_drawn_out_of_its_room():
    """A corridor of which no wall was found hangs on a square with four walls."""
    corridor = shapely.box(3.5, 1.5, 12, 2.5)
    floor = shapely.union(shapely.box(0.1, 0.1, 3.9, 3.9), corridor)
    walls_ = [wall(0, 0, 4, 0), wall(0, 4, 0, 0), wall(4, 4, 0, 4), wall(4, 0, 4, 1.4)]
    walls_.append(wall(4, 2.6, 4, 4))
    ways = np.array([(2.0, 2.0), (11.0, 2.0)])
    (room,) = find_rooms(walls_, [floor], ways)
    assert room.polygon.covers(shapely.LineString(ways))


def test_no_walls_leave_what_was_seen():
    found = find_rooms([], [shapely.box(0, 0, 3, 3)], np.array([(1.0, 1.0)]))
    assert [r.polygon.area for r in found] == [pytest.approx(9, rel=0.01)]
    assert find_rooms([], [], np.empty((0, 2))) == []
