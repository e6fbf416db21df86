"""A wall along y = 0, seen from above, and things that stand before it."""

import dataclasses

import numpy as np
import pytest

from helpers import toy_rooms
from helpers.observation_making import stretch
from scanplan.plan.faces import tracing
from scanplan.plan.faces.face_arrangement import Faces
from scanplan.plan.faces.furniture_fronts import FurnitureLimits, find_furniture_fronts

LIMITS = FurnitureLimits(**toy_rooms.FURNITURE)
NORTH = np.array([0.0, 1.0])
TURN = np.array([[0.6, 0.8], [-0.8, 0.6]])


def pieces(y_m, *spans_m, normal=NORTH):
    """Return faces of one line, seen from its normal's side, over spans of x."""
    ends = [[(x_m, y_m) for x_m in span[:: int(normal[1])]] for span in spans_m]
    return [(end, normal) for end in ends]


def across(x_m, y_m, normal_x):
    """Return the face of a wall along x = x_m, over a span of y."""
    return [([(x_m, y) for y in y_m[:: -int(normal_x)]], np.array([normal_x, 0.0]))]


def kept(*lines, limits=LIMITS):
    """Return which faces stay, by their place in the lines."""
    ends, normal = zip(*(face for line in lines for face in line), strict=True)
    number = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    faces = Faces(np.array(ends, float), np.array(normal), number)
    return (~find_furniture_fronts(faces, limits)).tolist()


WALL = pieces(0.0, (0.0, 2.0), (4.0, 6.0))


def test_a_cabinet_before_a_wall_that_goes_on_beside_it_goes():
    assert kept(WALL, pieces(0.5, (2.0, 4.0))) == [True, True, False]


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"spans": (1.5, 4.2)}, "longer than furniture"),
        ({"y_m": 1.1}, "farther before the wall than furniture"),
        ({"y_m": 0.1}, "on the wall itself"),
        ({"y_m": -0.5}, "behind the wall"),
        ({"normal": -NORTH}, "seen from the other side"),
    ],
)
def test_what_is_no_front_stays(change, why):
    thing = {"y_m": 0.5, "spans": (2.0, 4.0), **change}
    thing = pieces(thing.pop("y_m"), thing.pop("spans"), **thing)
    assert kept(WALL, thing) == [True, True, True], why


@pytest.mark.parametrize(
    ("behind_m", "span_m", "stays"),
    [
        (0.12, (2.0, 4.0), True),  # between the front and the wall
        (0.12, (2.0, 3.1), True),
        (0.12, (2.0, 2.9), False),  # of less than half
        (0.12, (5.0, 7.0), False),
        (0.62, (0.0, 6.0), False),  # the other side of the wall behind the cabinet
        (-0.2, (2.0, 4.0), False),  # of what stands before the cabinet
    ],
)
def test_a_front_whose_back_is_seen_before_the_wall_is_a_wall(behind_m, span_m, stays):
    back = pieces(0.5 - behind_m, span_m, normal=-NORTH)
    assert kept(WALL, pieces(0.5, (2.0, 4.0)), back) == [True, True, stays, True]
    # whichever way the building is turned
    turned = [
        [(np.array(end) @ TURN, normal @ TURN) for end, normal in line]
        for line in (WALL, pieces(0.5, (2.0, 4.0)), back)
    ]
    assert kept(*turned) == [True, True, stays, True]


def test_a_wall_too_far_beside_says_nothing():
    assert kept(pieces(0.0, (5.1, 8.0)), pieces(0.5, (2.0, 4.0))) == [True, True]
    assert kept(pieces(0.0, (4.9, 8.0)), pieces(0.5, (2.0, 4.0))) == [True, False]


def test_a_trace_of_wall_beside_says_nothing():
    assert kept(pieces(0.0, (2.0, 4.2)), pieces(0.5, (2.0, 4.0))) == [True, True]


def test_the_front_of_a_closet_stays_for_the_wall_in_it_is_behind_its_door():
    front = pieces(0.5, (1.0, 2.0), (2.9, 4.0))
    assert kept(pieces(0.0, (1.1, 3.9)), front) == [True, True, True]
    # without the second half there is no door, and the wall goes on beside
    assert kept(pieces(0.0, (1.1, 3.9)), front[:1]) == [True, False]


def test_the_walls_beside_a_niche_stay_for_they_are_longer():
    niche, beside = pieces(0.0, (2.0, 5.0)), pieces(0.5, (0.0, 2.0), (5.0, 7.0))
    assert kept(niche, beside) == [True, True, True]


@pytest.mark.parametrize("mirrored", [1, -1])
@pytest.mark.parametrize("begin_m", [0.5, 1.7])
def test_the_wall_of_a_room_beside_a_deeper_one_stays(mirrored, begin_m):
    # it is drawn into the wall between the rooms, which has a door next to the corner, or none
    deeper, shallow = (sorted((mirrored * a, mirrored * b)) for a, b in ((2.2, 6.2), (0.0, 2.1)))
    parting = across(2.0 * mirrored, (begin_m, 4.0), -mirrored)
    assert kept(pieces(0.0, deeper), pieces(0.5, shallow), parting) == [True, True, True]
    # what faces the other room, or ends this one elsewhere, parts nothing
    for other in (
        across(2.2 * mirrored, (0.0, 4.0), mirrored),
        across(6.2 * mirrored, (0.0, 4.0), -mirrored),
    ):
        assert kept(pieces(0.0, deeper), pieces(0.5, shallow), other) == [True, False, True]


def test_the_side_of_a_cabinet_is_no_end_of_the_room():
    deep, side = pieces(0.7, (4.2, 5.2)), across(4.2, (0.0, 0.7), -1.0)
    assert kept(WALL, pieces(0.5, (2.0, 4.0)), deep, side) == [True, True, False, False, True]


def test_a_shelf_before_a_cabinet_goes_with_it():
    assert kept(WALL, pieces(0.5, (2.0, 4.0)), pieces(0.8, (2.0, 3.0))) == [
        True,
        True,
        False,
        False,
    ]


def test_in_space_it_is_not_asked():
    def seen(planar):
        drawn = [(-1, 0, 2, 0), (2, 0.5, 4, 0.5)]
        points = [(x_m, 1.5) for x_m in np.linspace(0, 2, 50)]
        return [stretch(*ends, points, planar=planar) for ends in drawn]

    (wall,) = tracing._without_furniture(seen(planar=True), LIMITS)
    assert wall.length_m == 3
    assert len(tracing._without_furniture(seen(planar=False), LIMITS)) == 2
    assert tracing._without_furniture([], LIMITS) == []


def test_the_same_holds_from_the_other_side():
    south = -NORTH
    wall = pieces(0.0, (0.0, 2.0), (4.0, 6.0), normal=south)
    assert kept(wall, pieces(-0.5, (2.0, 4.0), normal=south)) == [True, True, False]


def test_limits_matter():
    short = dataclasses.replace(LIMITS, furniture_length_m=1.9)
    assert kept(WALL, pieces(0.5, (2.0, 4.0)), limits=short) == [True, True, True]
