"""Where floor is parted into rooms though no wall was seen, drawn with what a person would part."""

import numpy as np
import pytest
import shapely
from shapely import box

from helpers.observation_making import line_through
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms import parting_lines, partings
from scanplan.plan.rooms.room import Room
from scanplan.plan.wall_ground import Bounds

ACROSS = [(2, 2), (6, 2)]
LEFT, RIGHT = box(0, 0, 4, 4), box(4.1, 0, 8, 4)


def wall(x0, y0, x1, y1):
    length_m = float(np.hypot(x1 - x0, y1 - y0))
    return PlanWall(line_through(x0, y0, x1, y1), 0.0, length_m, 0.1, [], [])


def find(*asked, **known):
    return search(*asked, **known).walls


def search(floor, walls=(), track_m=ACROSS, *, planar=False, **known):
    return partings.find_partings(
        Bounds(walls, unpaired_m=0.1),
        parting_lines.Floor(floor, planar=planar, hidden=known.get("hidden")),
        np.array(track_m, float),
        3.0,
        ways_m=known.get("ways_m", ()),
    )


def union(*shapes):
    return shapely.union_all(shapes)


def spans(found):
    """Return from where to where each opening is, lesser first."""
    ends_m = [
        parting.line.at(np.array([way.low_m, way.high_m]))
        for parting in found
        for way in parting.openings
    ]
    return [np.sort(m, axis=0) for m in ends_m]


TWO_ROOMS = union(LEFT, RIGHT, box(3.9, 1.0, 4.2, 3.4))
CUBICLES = union(box(0, 0, 12, 2), *(box(3 * k + 0.05, 1.9, 3 * k + 2.95, 4.2) for k in range(4)))
FRONTS = [wall(3 * k, 2.0, 3 * k, 4.2) for k in range(5)]
STUBS = [wall(3 * k, 2.05, 3 * k + 0.9, 2.05) for k in range(4)]


@pytest.mark.parametrize(
    ("floor", "walls", "track_m"),
    [
        (box(0, 0, 8, 4), [], ACROSS),
        (box(0, 0, 12, 1.2), [], [(1, 0.6), (11, 0.6)]),
        (union(box(0, 0, 6, 3), box(0, 0, 3, 6)), [], [(1, 1), (5, 1), (1, 5)]),
        (union(box(0, 0, 6, 4), box(2, 3.9, 4, 4.6)), [], [(1, 1), (5, 1)]),
        (union(box(0, 0, 10, 1.6), box(8.4, 0, 10, 8)), [], [(1, 1), (9, 1), (9, 7)]),
        (box(0, 0, 12, 1.6) - box(6, 0, 6.4, 0.3), [], [(1, 1), (11, 1)]),
        (box(0, 0, 10, 6) - box(4.9, 0, 5.1, 1.5), [wall(5, -0.5, 5, 1.5)], [(2, 4), (8, 4)]),
        (
            box(0, 0, 4, 4) - union(*(box(x, 1.9, x + 0.1, 2) for x in (0.5, 1.2, 1.9, 2.6))),
            [],
            [(2, 1)],
        ),
    ],
    ids=["hall", "corridor", "angle", "niche", "bend", "pillar", "spur", "chairs"],
)
@pytest.mark.parametrize("planar", [True, False])
def test_one_room_is_not_parted(floor, walls, track_m, planar):
    assert find(floor, walls, track_m, planar=planar) == []


@pytest.mark.parametrize("turn_deg", [0, 30, 117])
def test_a_door_parts_rooms_however_the_building_is_turned(turn_deg):
    def turn(shape):
        return shapely.affinity.rotate(shape, turn_deg, origin=(0, 0))

    track_m = shapely.get_coordinates(turn(shapely.MultiPoint(ACROSS)))
    found = find(turn(union(LEFT, RIGHT, box(3.9, 1.6, 4.2, 2.5))), track_m=track_m)
    (span_m,) = spans(found)
    assert np.hypot(*(span_m[1] - span_m[0])) == pytest.approx(0.9, abs=0.15)


@pytest.mark.parametrize("planar", [True, False])
def test_a_wide_gap_parts_rooms_in_the_line_of_walls(planar):
    """A way of 2.4 m between walls of 1 and 0.6 m: as wide it is no narrow place by itself."""
    walls = [wall(4.05, 0, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]
    (span_m,) = spans(find(TWO_ROOMS, walls, planar=planar))
    np.testing.assert_allclose(span_m, [(4.05, 1.0), (4.05, 3.4)], atol=0.12)
    assert find(TWO_ROOMS) == []


def test_cubicles_are_parted_from_the_aisle_along_their_fronts():
    """Each of 3 m has a front of 0.9 m, and is open beside it."""
    found = spans(find(CUBICLES, [*FRONTS, *STUBS], [(1, 1), (11, 1), (2, 3), (5, 3)], planar=True))
    along = [m for m in found if np.ptp(m[:, 1]) < 0.1]
    assert len(along) >= 3
    for m in along:
        np.testing.assert_allclose(m[:, 1], 2.05, atol=0.05)


def test_the_longer_a_wall_stands_into_a_hall_the_rather_it_parts_it():
    def count(high_m):
        floor = box(0, 0, 10, 8) - box(4.9, 0, 5.1, high_m)
        return len(find(floor, [wall(5, -0.5, 5, high_m)], [(2, 4), (5, 7), (8, 4)]))

    assert [count(m) for m in (1.5, 3.0, 5.7, 7.0)] == [0, 0, 1, 1]


def test_what_is_seen_through_a_gap_of_a_wall_is_parted_off_where_it_is_a_room():
    """A fan of floor behind a gap of 0.9 m: of it 3 m2 are no more than furniture hides."""
    walls = [wall(4.05, 0, 4.05, 2.0), wall(4.05, 2.9, 4.05, 4)]
    fan = shapely.Polygon([(3.9, 2.0), (3.9, 2.9), (20, 8), (20, 3)])
    track_m = [(1, 1), (2, 2)]
    (span_m,) = spans(find(union(LEFT, fan), walls, track_m))
    np.testing.assert_allclose(span_m[:, 0], 4.05, atol=0.05)
    assert find(union(LEFT, fan & box(0, 0, 5.5, 8)), walls, track_m) == []


@pytest.mark.parametrize(("hidden_m", "kind"), [(2.0, "unseen"), (1.0, "gap")])
def test_what_furniture_hides_of_a_parting_is_not_known_to_be_a_way(hidden_m, kind):
    walls = [wall(4.05, -2, 4.05, 1), wall(4.05, 3.4, 4.05, 4)]
    hidden = box(3.5, 1.0, 4.6, 1.0 + hidden_m)
    (parting,) = find(TWO_ROOMS, walls, planar=True, hidden=hidden)
    assert [way.kind for way in parting.openings] == [kind]


@pytest.mark.parametrize("turn", [1, -1])
def test_a_door_whose_leaf_was_seen_parts_floor_where_no_wall_has_it(turn):
    """Two sides of a leaf tell of one door, 1 m wide; a wall that has it parts floor itself."""
    way_m = np.array([(4.05, 1.0), (4.05, 2.0)])
    narrow = union(LEFT, RIGHT, box(3.9, 1.0, 4.2, 2.0))
    (parting,) = find(narrow, ways_m=[way_m, way_m[::turn] + 0.02])
    assert [way.kind for way in parting.openings] == ["door"]
    assert parting.openings[0].width_m == pytest.approx(1.0)
    assert find(narrow, [wall(4.05, 0, 4.05, 4)], ways_m=[way_m]) == []


def test_no_floor_has_no_parting():
    assert find(shapely.MultiPolygon()) == []


def test_lines_go_on_from_walls_and_corners_each_once():
    """A spur's line is drawn from its end and from both its corners: one of them is kept."""
    floor = box(0, 0, 10, 8) - box(4.95, 0, 5.05, 5)
    (lines_m,) = parting_lines.find_lines([floor], [wall(5, -0.5, 5, 5)], 0.1)
    up = [m for m in lines_m if abs(np.ptp(m[:, 0])) < 0.05 and m[:, 1].max() > 7]
    assert len(up) == 1
    np.testing.assert_allclose(up[0], [(5, 5), (5, 8)], atol=0.01)


def test_rooms_are_as_sure_as_what_parts_them_from_others_is():
    """A room behind a wall that a line closes may be one with the next; one by itself is."""
    whole = Room(box(0, 0, 8, 4), 1.0, entered=True, n_scans=1)
    alone = search(whole.polygon).rate_rooms([whole])[0]
    assert (alone.p_whole, alone.p_apart) == (1.0, 1.0)
    walls = [wall(4.05, 0, 4.05, 1.0), wall(4.05, 3.4, 4.05, 4)]
    parted = search(TWO_ROOMS, walls, planar=True)
    rooms = [Room(of, 1.0, entered=True, n_scans=1) for of in (LEFT, RIGHT)]
    rated = parted.rate_rooms(rooms)
    assert all(0.5 < room.p_apart < 1.0 for room in rated)
    assert rated[0].p_apart == rated[1].p_apart
    assert parted.rate_rooms([]) == []
