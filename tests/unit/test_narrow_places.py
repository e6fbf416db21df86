"""Where ground is narrow, at rooms whose doors can be seen on paper."""

import numpy as np
import pytest
import shapely
from shapely import box

from scanplan.geometry.narrow_places import NarrowLimits, find_narrow_places

LEFT = box(0, 0, 4, 4)
RIGHT = box(4.2, 0, 8, 4)
DOOR = box(3.9, 1.5, 4.3, 2.4)  # 0.9 m wide
IN_BOTH = np.array([[2.0, 2.0], [6.0, 2.0]])


def find(*shapes, visited_m=IN_BOTH, gaps_m=(), max_width_m=1.5, min_area_m2=1.0):
    ground = shapely.union_all(shapes)
    limits = NarrowLimits(max_width_m, min_area_m2, cell_m=0.05)
    return find_narrow_places(ground, visited_m, limits, gaps_m=gaps_m)


def test_a_door_between_two_rooms_parts_them_where_it_is_narrowest():
    (line,) = find(LEFT, RIGHT, DOOR)
    np.testing.assert_allclose(np.sort(line[:, 1]), [1.5, 2.4], atol=0.06)
    assert np.all((line[:, 0] > 3.85) & (line[:, 0] < 4.35))


@pytest.mark.parametrize("turn_deg", [30, 117])
def test_it_is_found_however_the_building_is_turned(turn_deg):
    def turn(shape):
        return shapely.affinity.rotate(shape, turn_deg, origin=(0, 0))

    visited_m = shapely.get_coordinates(turn(shapely.MultiPoint(IN_BOTH)))
    (line,) = find(turn(LEFT), turn(RIGHT), turn(DOOR), visited_m=visited_m)
    assert abs(np.hypot(*(line[1] - line[0])) - 0.9) < 0.1


@pytest.mark.parametrize(
    "shapes",
    [
        [box(0, 0, 12, 1.2)],  # a corridor has no narrow place
        [box(0, 0, 8, 4)],  # nor has a hall
        [LEFT, RIGHT, box(3.9, 1, 4.3, 3)],  # 2 m are no door
        [box(0, 0, 12, 1.6).difference(box(6, 0, 6.4, 0.3))],  # a pillar leaves most of it
    ],
)
def test_what_is_wide_or_as_narrow_on_either_side_is_not_parted(shapes):
    assert find(*shapes) == []


def test_a_corner_behind_a_cupboard_is_no_room_but_one_that_was_visited_is():
    corner = box(0, 4.5, 1.4, 6)
    mouth = box(0.4, 3.9, 1.0, 4.6)
    assert find(LEFT, corner, mouth, visited_m=IN_BOTH[:1]) == []
    visited_m = np.array([[2.0, 2.0], [0.7, 5.2]])
    assert len(find(LEFT, corner, mouth, visited_m=visited_m)) == 1


@pytest.mark.parametrize(
    ("visited_m", "place_m"),
    # what lies between goes with the side that nobody was on, else where it is narrower
    [(IN_BOTH[:1], 4.1), (IN_BOTH[1:], 5.5), (IN_BOTH, 5.5)],
)
def test_a_corner_between_two_rooms_is_of_one_of_them(visited_m, place_m):
    """A place of 1.2 m by 1.2 m between two doors, the right one the narrower, is no room."""
    porch = box(4.2, 1.4, 5.4, 2.6)
    far = box(5.6, 0, 10, 4)
    doors = [box(3.9, 1.65, 4.3, 2.35), box(5.3, 1.7, 5.7, 2.3)]
    (line,) = find(LEFT, porch, far, *doors, visited_m=visited_m)
    assert abs(line[:, 0].mean() - place_m) < 0.2


def test_chairs_part_nothing():
    chairs = [box(x, 1.9, x + 0.1, 2.0) for x in (0.5, 1.2, 1.9, 2.6, 3.3)]
    assert find(LEFT.difference(shapely.union_all(chairs)), visited_m=IN_BOTH[:1]) == []


def test_a_fan_seen_through_a_gap_is_parted_off():
    fan = shapely.Polygon([(4, 2.0), (4, 2.4), (20, 8), (20, 4)])
    (line,) = find(LEFT, fan, visited_m=IN_BOTH[:1])
    assert line[:, 0].min() > 3.9


@pytest.mark.parametrize("is_passed", [False, True])
def test_a_fan_between_two_visited_rooms_parts_them_where_nobody_passed(is_passed):
    """Seen from the left room; a corridor that is wider leads to the right one."""
    fan = shapely.Polygon([(4, 2.0), (4, 2.4), (8, 3.2), (8, 1.6)])
    around = box(1, -3, 11, -1)
    places_m = [[1.5, -2], [2, 2], [9, 2]] if is_passed else [[2, 2], [1.5, -2], [9.5, -2], [9, 2]]
    lines = find(
        *(LEFT, fan, box(8, 0, 12, 4), around, box(1, -1.1, 2, 0.1), box(9, -1.1, 10, 0.1)),
        visited_m=np.array(places_m, float),
    )
    assert any((line[:, 0] > 3.9).all() and (line[:, 0] < 5).all() for line in lines) != is_passed


CORRIDOR_M = [[1.0, 0.9], [11.0, 0.9]]


@pytest.mark.parametrize(
    ("visited_m", "width_m", "n_lines"),
    [
        (CORRIDOR_M, 1.75, 1),
        ([[6.0, 5.0]], 1.75, 1),
        ([*CORRIDOR_M, [6.0, 5.0]], 1.75, 0),
        # in a corner of the room that is hardly narrower
        ([*CORRIDOR_M, [11.4, 4.6]], 1.75, 0),
        (np.zeros((0, 2)), 1.75, 0),
        (CORRIDOR_M, 1.9, 0),
    ],
    ids=["looked_into", "from_the_room", "entered", "its_corner", "nobody", "wider"],
)
def test_what_nobody_entered_is_parted_where_it_narrows_the_less(visited_m, width_m, n_lines):
    """An opening of a corridor of 1.8 m, that is 2.2 m wide where it begins."""
    corner = box(10.3, 3.6, 12.4, 5.7).union(box(9.9, 3.7, 10.4, 5.6))
    shapes = [box(0, 0, 12, 1.8), box(2, 2.2, 10, 8), corner, box(5, 1.7, 5 + width_m, 2.3)]
    assert len(find(*shapes, visited_m=np.array(visited_m), max_width_m=2.2)) == n_lines


def test_no_ground_has_no_narrow_place():
    assert find(shapely.Polygon()) == []


GAP = np.array([[4.1, 1.0], [4.1, 3.0]])  # 2 m wide, in the line of the wall between the rooms
WIDE = box(3.9, 1, 4.3, 3)


@pytest.mark.parametrize("visited_m", [IN_BOTH, IN_BOTH[:1]])
def test_a_wide_gap_of_a_wall_parts_rooms_though_one_was_only_looked_into(visited_m):
    (line,) = find(LEFT, RIGHT, WIDE, gaps_m=[GAP], visited_m=visited_m)
    np.testing.assert_array_equal(line, GAP)


def test_a_narrow_place_of_a_ring_parts_nothing_by_itself():
    """A corridor around a courtyard, 2 m wide but where a pillar leaves 0.8 m."""
    ring = box(0, 0, 12, 12).difference(box(2, 2, 10, 10))
    assert find(ring.difference(box(0, 6, 1.2, 6.5)), visited_m=np.array([[1, 1], [1, 11.0]])) == []


def test_where_a_corridor_goes_on_as_wide_no_gap_parts_it():
    mouth = np.array([[4.1, 1.0], [4.1, 2.8]])
    corridor = box(4.2, 1, 12, 2.8)
    assert find(LEFT, corridor, box(3.9, 1, 4.3, 2.8), gaps_m=[mouth]) == []


def test_of_two_gaps_in_one_place_the_narrower_parts():
    longer = np.array([[4.0, 1.0], [4.25, 3.1]])
    (line,) = find(LEFT, RIGHT, WIDE, gaps_m=[longer, GAP])
    np.testing.assert_array_equal(line, GAP)


def test_a_door_beyond_the_end_of_a_gap_does_not_stand_for_it():
    gap = np.array([[4.1, 0.8], [4.1, 3.0]])
    above, door = box(2, 4.2, 4, 7), box(3.4, 3.9, 4, 4.3)
    lines = find(LEFT, RIGHT, box(3.9, 0.8, 4.3, 3), above, door, gaps_m=[gap])
    assert len(lines) == 2


def test_a_cupboard_behind_the_wall_that_a_gap_ends_at_is_not_beside_the_gap():
    cupboard, mouth = box(4.05, 3.1, 5.5, 4.4), box(3.9, 3.5, 4.1, 3.8)
    (line,) = find(LEFT, box(4.2, 0, 8, 3), WIDE, cupboard, mouth, gaps_m=[GAP])
    np.testing.assert_allclose(line, GAP)


def test_a_sliver_beside_a_gap_does_not_join_the_rooms_on_either_side():
    """The line also crosses the end of a niche of the room on the left."""
    niche = box(3.5, 0.6, 4.15, 0.9)
    left = box(0, 0, 3.6, 4)
    gap = np.array([[4.1, 0.5], [4.1, 3.0]])
    (line,) = find(left, RIGHT, box(3.5, 1, 4.3, 3.0), niche, gaps_m=[gap])
    np.testing.assert_allclose(line, gap)


@pytest.mark.parametrize(("is_wall", "n_lines"), [(True, 2), (False, 0)])
def test_a_wall_between_two_doors_is_no_island_of_furniture(is_wall, n_lines):
    """3 m of it, 0.2 m thick, stand alone between doors of 0.5 m."""
    between = box(4, 0.5, 4.2, 3.5)
    ground = box(0, 0, 8, 4).difference(between)
    walls = between if is_wall else None
    limits = NarrowLimits(1.5, min_area_m2=1.0, cell_m=0.05)
    found = find_narrow_places(ground, IN_BOTH, limits, walls=walls)
    assert len(found) == n_lines
