"""What stands around elements of a plan, in rooms small enough to count by hand."""

import numpy as np
import pytest
import shapely

from scanplan.plan import floorplan
from scanplan.validation import surroundings
from scanplan.validation.confidence_coefficients import COEFFICIENTS

SQUARE_M = np.array(
    [
        [[0.0, 0.0], [4.0, 0.0]],
        [[4.0, 0.0], [4.0, 4.0]],
        [[4.0, 4.0], [0.0, 4.0]],
        [[0.0, 4.0], [0.0, 0.0]],
    ]
)
INWARD = np.array([[0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]])
ROOM = np.array([shapely.box(0, 0, 4, 4)], object)


def test_the_walls_of_a_room_meet_at_both_ends_and_one_in_its_middle_at_none():
    lines_m = np.concatenate([SQUARE_M, [[[1.0, 2.0], [3.0, 2.0]]]])
    counts = surroundings.count_joined_ends(lines_m, lines_m, same=True)
    assert counts.tolist() == [2, 2, 2, 2, 0]


def test_a_door_joins_the_wall_on_either_side():
    door_m = np.array([[[1.0, 0.0], [2.0, 0.0]]])
    beside_m = np.array([[[0.0, 0.0], [0.95, 0.0]], [[2.5, 0.0], [4.0, 0.0]]])
    assert surroundings.count_joined_ends(door_m, beside_m, same=False).tolist() == [1]
    assert surroundings.count_joined_ends(door_m, np.empty((0, 2, 2)), same=False).tolist() == [0]


@pytest.mark.parametrize(
    ("offset_m", "looks", "share"),
    [(0.2, 1, 0.5), (0.2, -1, 0.0), (0.5, 1, 0.0)],
    ids=["doubled", "the other side of a thin wall", "too far"],
)
def test_a_face_before_another_that_looks_the_same_way_doubles_it(offset_m, looks, share):
    lines_m = np.array([[[0.0, 0.0], [4.0, 0.0]], [[1.0, offset_m], [3.0, offset_m]]])
    normals = np.array([[0.0, 1.0], [0.0, looks]])
    np.testing.assert_allclose(surroundings.share_doubled(lines_m, normals)[0], share, atol=1e-9)


def test_faces_that_go_on_along_one_line_double_nothing():
    lines_m = np.array([[[0.0, 0.0], [2.0, 0.0]], [[1.9, 0.0], [4.0, 0.0]]])
    normals = np.array([[0.0, 1.0], [0.0, 1.0]])
    assert surroundings.share_doubled(lines_m, normals).tolist() == [0.0, 0.0]


def test_a_wall_bounds_its_room_and_a_shelf_within_does_not():
    lines_m = np.concatenate([SQUARE_M[:1], [[[1.0, 2.0], [3.0, 2.0]], [[2.0, 0.0], [2.0, 2.0]]]])
    # of the last, which stands out from a wall, 0.15 of 2 m
    np.testing.assert_allclose(surroundings.share_along(lines_m, ROOM), [1, 0, 0.075], atol=1e-3)
    assert surroundings.share_along(lines_m, ROOM[:0]).tolist() == [0, 0, 0]


def test_the_outline_of_a_room_with_three_of_four_walls_is_faced_by_three_quarters():
    shares = surroundings.share_faced(ROOM, SQUARE_M[:3])
    # the fourth side lies within 0.15 m of the ends of two
    np.testing.assert_allclose(shares, [(12 + 0.3) / 16], atol=1e-3)


def test_openings_that_overlap_do_not_stand_alone():
    lines_m = np.array(
        [[[0.0, 0.0], [1.0, 0.0]], [[0.3, 0.1], [1.3, 0.1]], [[5.0, 0.0], [6.0, 0.0]]]
    )
    assert surroundings.stand_alone(lines_m).tolist() == [0, 0, 1]
    assert surroundings.stand_alone(lines_m[:1]).tolist() == [1]
    assert surroundings.stand_alone(np.empty((0, 2, 2))).tolist() == []


def test_what_speaks_for_an_element_never_lowers_its_probability():
    for table in floorplan.NUMBERS:
        for of_feature in COEFFICIENTS[table]["features"].values():
            assert of_feature["weight"] >= 0


def test_a_corridor_is_broader_than_a_slip_as_narrow():
    areas = np.array([shapely.box(0, 0, 2, 36), shapely.box(0, 0, 2, 4), shapely.box(0, 0, 3, 4)])
    np.testing.assert_allclose(
        surroundings.measure_breadth(areas), [np.sqrt(72) / 2, 2, 3], rtol=1e-3
    )


def test_the_ground_beyond_a_door_is_a_square_on_the_side_of_no_room():
    door_m = np.array([[[4.0, 0.0], [4.0, 1.0]]])
    room = np.array([shapely.box(0, 0, 3.9, 3)])
    sides_m = np.array([[0.1, -0.1]])

    def share(*floor):
        seen = shapely.union_all([shapely.box(*bounds) for bounds in floor])
        return surroundings.share_floor_beyond(door_m, sides_m, room, seen)[0]

    assert share((0, 0, 3.9, 3)) == 0
    assert share((0, 0, 3.9, 3), (4.1, 0, 4.6, 1)) == pytest.approx(0.5)
    assert share((4.0, -1, 9, 2)) == pytest.approx(1.0)
