"""What bounds rooms without a ray ending there, seen from above: panes, narrow places."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import box

from helpers.observation_making import line_through
from scanplan.geometry.lines import Line
from scanplan.plan.openings import OPEN, Opening, OpeningSettings
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms import room_bounds
from scanplan.plan.wall_ground import Bounds

WAYS = OpeningSettings(
    min_opening_m=0.5, max_opening_m=1.5, max_closed_m=1.5, max_door_m=1.5, door_height_m=1.9
)
SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))


def find_partings(walls, ground, track_m, *, max_width_m=1.5, ways_m=(), **floor):
    return room_bounds.find_partings(
        Bounds(walls, unpaired_m=0.1),
        room_bounds.Floor(ground, **floor),
        track_m,
        replace(WAYS, max_opening_m=max_width_m),
        min_area_m2=1.0,
        ways_m=ways_m,
    )


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


def test_floor_without_a_door_is_parted_on_the_line_of_the_wall_beside():
    wall = PlanWall(Line(np.array([4.05, 0.0]), np.array([1.0, 0.0])), -1.6, 0.0, 0.1, [], [])
    rooms = shapely.union_all([box(0, 0, 4, 4), box(4.1, 0, 8, 4), box(3.9, 1.6, 4.2, 2.5)])
    track_m = np.array([[2.0, 2.0], [6.0, 2.0]])
    (parting,) = find_partings([wall], rooms, track_m)
    (way,) = parting.openings
    np.testing.assert_allclose(parting.line.at(way.low_m)[0], 4.05)
    assert abs(way.width_m - 0.9) < 0.1
    assert parting.low_m < way.low_m and way.high_m < parting.high_m


TWO_ROOMS = shapely.union_all([box(0, 0, 4, 4), box(4.1, 0, 8, 4), box(3.9, 1.0, 4.2, 3.4)])
TRACK_M = np.array([[2.0, 2.0], [6.0, 2.0]])


def part(walls, *, planar=True, floor=TWO_ROOMS, hidden=None):
    return find_partings(walls, floor, TRACK_M, planar=planar, hidden=hidden)


def test_a_gap_wider_than_a_door_parts_rooms_in_the_line_of_a_longer_wall():
    """The wall between the rooms has a gap of 2.4 m, and is 3 m long on one side of it."""
    walls = [wall(4.05, -2, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]
    (parting,) = part(walls)
    (way,) = parting.openings
    np.testing.assert_allclose(parting.line.at(way.low_m)[0], 4.05, atol=0.01)
    assert abs(way.width_m - 2.4) < 0.02


def test_a_gap_as_wide_as_a_door_parts_rooms_in_the_line_of_a_wall():
    """It is 1.46 m wide, and the room west of it 2.2 m: by distances alone it is hardly narrow."""
    floor = shapely.union_all([box(0, 0, 4, 2.2), box(4.1, 0, 8, 4), box(3.9, 0.25, 4.2, 1.71)])
    walls = [wall(4.05, -2, 4.05, 0.25), wall(4.05, 1.71, 4.05, 4)]
    (parting,) = part(walls, floor=floor)
    assert abs(parting.openings[0].width_m - 1.46) < 0.02


def test_a_gap_wider_than_the_wall_is_long_parts_nothing():
    assert part([wall(4.05, 0, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]) == []


def test_walls_of_two_sides_part_rooms_whose_gap_is_wider_than_they_are_long():
    """Pieces of 0.9 and 0.6 m on either side of a way of 2.3 m; screens would say nothing."""
    pieces = [wall(4.05, 0, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]
    paired = [replace(piece, left=["west"], right=["east"]) for piece in pieces]
    (parting,) = part(paired)
    assert abs(parting.openings[0].width_m - 2.4) < 0.02
    assert part([paired[0], pieces[1]]) == []


@pytest.mark.parametrize(("begin_m", "n_partings"), [(-1.2, 1), (-1.0, 0)])
@pytest.mark.parametrize("right", [["east"], []], ids=["two sides", "one side"])
def test_a_gap_is_as_wide_as_a_wall_is_long_but_for_a_corner(begin_m, n_partings, right):
    """A way of 2.4 m beside 2.2 or 2.0 m of wall, whether or not its other side was seen."""
    west = replace(wall(4.05, begin_m, 4.05, 1), right=right)
    assert len(part([west, wall(4.05, 3.4, 4.05, 4)])) == n_partings


def test_floor_that_begins_beyond_the_end_of_a_wall_leaves_that_end_free():
    """As in the test of walls across, but for 0.2 m beside the end that nobody saw."""
    walls = [wall(4.05, -2, 4.05, 1), wall(0, 3.4, 8, 3.4)]
    floor = TWO_ROOMS.difference(box(3.9, 0.9, 4.2, 1.2))
    assert len(part(walls, floor=floor, hidden=box(3, 2, 5, 3.4))) == 1


def test_a_hairline_shadow_does_not_end_a_gap():
    shadow = box(3.0, 2.0, 5.0, 2.03)
    walls = [wall(4.05, -2, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]
    (parting,) = part(walls, floor=TWO_ROOMS.difference(shadow))
    assert abs(parting.openings[0].width_m - 2.4) < 0.02


def corridor_partings(unseen, others=()):
    """Partings of a corridor 2 m wide and 12 m long, of which some ground was not seen."""
    sides = [wall(12, 2.05, 0, 2.05), wall(0, -0.05, 12, -0.05)]
    track_m = np.array([[1.0, 0.6], [6.0, 0.6], [11.0, 0.6]])
    floor = box(0, 0, 12, 2).difference(unseen)
    ends = [wall(0, -0.05, 0, 2.05), wall(12, 2.05, 12, -0.05)]
    return find_partings([*sides, *ends, *others], floor, track_m, planar=True)


@pytest.mark.parametrize(("max_width_m", "count"), [(2.2, 1), (1.5, 0)])
def test_what_is_as_wide_as_an_opening_parts_rooms(max_width_m, count):
    """A passage of 1.8 m between two halls, in no wall that was seen."""
    halls = shapely.union_all([box(0, 0, 6, 8), box(6.2, 0, 12, 8), box(5.9, 3, 6.3, 4.8)])
    track_m = np.array([[3.0, 4.0], [6.1, 4.0], [9.0, 4.0]])
    found = find_partings([], halls, track_m, max_width_m=max_width_m)
    assert len(found) == count


def test_the_stubs_of_a_door_in_a_corridor_part_it():
    stubs = box(5.8, 1.4, 6.2, 2.1).union(box(5.8, -0.1, 6.2, 0.4))
    (parting,) = corridor_partings(stubs)
    assert parting.openings[0].width_m == pytest.approx(1.0, abs=0.15)


def test_what_stands_into_a_corridor_parts_it():
    (parting,) = corridor_partings(box(5.4, 0.9, 6.6, 2.1))
    assert parting.openings[0].width_m == pytest.approx(0.9, abs=0.15)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_door_whose_leaf_was_seen_parts_floor_where_no_wall_has_it(turn):
    """Two sides of a leaf tell of one door, 1 m wide, in the gap of 2.4 m."""
    way_m = np.array([(4.05, 1.0), (4.05, 2.0)])
    (parting,) = find_partings(
        *([], TWO_ROOMS, TRACK_M),
        max_width_m=0.5,
        ways_m=[way_m, way_m[::turn] + 0.02],
    )
    (way,) = parting.openings
    assert way.kind == "door"
    assert way.width_m == pytest.approx(1.0)


def test_a_door_that_a_wall_has_is_not_parted_twice():
    way_m = np.array([(4.05, 1.0), (4.05, 2.0)])
    assert (
        find_partings(
            *([wall(4.05, 0, 4.05, 4)], TWO_ROOMS, TRACK_M),
            max_width_m=0.5,
            ways_m=[way_m],
        )
        == []
    )


def test_a_corner_that_stands_into_a_room_parts_nothing():
    """The wall's line ends at a wall across: around a corner it may be one room."""
    across = wall(8, 3.5, 0, 3.5)
    assert part([wall(4.05, -2, 4.05, 1), wall(4.15, 1, 7, 1), across]) == []
    assert part([wall(4.05, -2, 4.05, 1)]) == []


@pytest.mark.parametrize(
    ("first_m", "openings", "n_partings"),
    [(-2, (), 1), (-1, (), 0), (-2, [(0.2, 1.1)], 0), (-4, [(0.2, 1.1)], 1)],
    ids=["long", "shorter_than_the_gap", "short_beside_a_door", "long_beside_a_door"],
)
def test_a_wall_that_ends_free_parts_rooms_up_to_the_wall_across(first_m, openings, n_partings):
    """The gap is 2.5 m wide, from the wall's end at y = 1 to the wall across; of it 1 m is seen.

    All of it would be one room.
    """
    walls = [wall(4.05, first_m, 4.05, 1, openings), wall(8, 3.5, 0, 3.5)]
    assert part(walls) == part(walls, hidden=box(3, 3.0, 5, 3.5)) == []
    found = part(walls, hidden=box(3, 2, 5, 3.5))
    assert len(found) == n_partings
    for parting in found:
        (way,) = parting.openings
        assert abs(way.width_m - 2.4) < 0.02


HALL = box(0, 0, 10, 8)


def hall_partings(spur, others=(), across=((10, 8, 0, 8),), thickness_m=0.1):
    """Partings of a hall driven through from west to east, with a wall that stands into it.

    Furniture in the north hides the last metre of the wall's line.
    """
    x_m, high_m = spur
    end = PlanWall(line_through(x_m, -0.5, x_m, high_m), 0.0, high_m + 0.5, thickness_m, [], [])
    around = [*(wall(*ends) for ends in across), *others]
    track_m = np.array([[2.0, 4.0], [5.0, 7.5], [8.0, 4.0]])
    return find_partings([end, *around], HALL, track_m, planar=True, hidden=box(4, 7, 6, 8))


def test_a_wide_opening_beside_a_spur_parts_nothing():
    """4.2 m of wall, and 3.7 m open: one living room. 2.2 m of the same would be parted."""
    assert hall_partings((5.0, 4.2)) == []
    assert len(hall_partings((5.0, 5.7))) == 1


@pytest.mark.parametrize("thickness_m", [0.1, 0.3])
def test_a_spur_with_a_return_is_a_corner(thickness_m):
    """The return butts at the face of the spur's end, however thick that is."""
    side = wall(5 + thickness_m / 2 + 0.1, 5.7, 7.0, 5.7)
    assert hall_partings((5.0, 5.7), [side], thickness_m=thickness_m) == []


def test_a_screen_beyond_a_free_end_is_no_wall_across():
    """What stands obliquely where the line leaves the floor neither crosses it nor goes on."""
    screen = wall(4.6, 7.5, 5.4, 8.6)
    assert hall_partings((5.0, 5.7), [screen], across=()) == []
    assert len(hall_partings((5.0, 5.7), [wall(4.4, 8.05, 5.6, 8.05)], across=())) == 1


def test_what_is_hidden_beside_a_door_parts_floor_with_it():
    """A leaf told of a door 1 m wide in a gap of 2.4 m: the rest is no wider than a door."""
    way_m = np.array([(4.05, 1.0), (4.05, 2.0)])
    found = find_partings(
        *([wall(4.05, -2, 4.05, 1), wall(4.05, 3.4, 4.05, 4)], TWO_ROOMS, TRACK_M),
        planar=True,
        ways_m=[way_m],
    )
    widths_m = sorted(parting.openings[0].width_m for parting in found)
    assert widths_m[0] == pytest.approx(1.0)
    # a door's strip is a little longer than the door
    assert [1.1 < width_m < 1.4 for width_m in widths_m[1:]] == [True]


@pytest.mark.parametrize(("hidden_m", "kind"), [(2.0, "unseen"), (1.0, "gap")])
def test_what_furniture_hides_of_a_parting_is_not_known_to_be_a_way(hidden_m, kind):
    """Furniture stands on that much of a gap of 2.4 m, on either side of the line."""
    (parting,) = find_partings(
        *([wall(4.05, -2, 4.05, 1), wall(4.05, 3.4, 4.05, 4)], TWO_ROOMS, TRACK_M),
        planar=True,
        hidden=box(3.5, 1.0, 4.6, 1.0 + hidden_m),
    )
    (way,) = parting.openings
    assert way.kind == kind
