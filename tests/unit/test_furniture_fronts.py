"""A wall along y = 0, seen from above, and things that stand before it."""

import dataclasses

import numpy as np
import pytest
from scanplan.rays.face_profile import FaceObservation

from scanplan.geometry.lines import Line
from scanplan.plan import furniture_fronts
from scanplan.plan.faces.intervals import FaceInterval

LIMITS = furniture_fronts.FrontLimits(
    wall_height_m=1.0,
    furniture_height_m=2.1,
    furniture_length_m=2.6,
    furniture_depth_m=1.0,
    door_width_m=1.5,
)
NORTH = np.array([0.0, 1.0])


def stretches(y_m, *spans_m, top_m=1.5, normal=NORTH):
    """Return stretches of one line, seen from its normal's side up to a height, over the given spans of x."""
    line = Line(np.array([0.0, y_m]), normal)
    places = (
        np.concatenate([np.linspace(low, high, 50) for low, high in spans_m]) * line.direction[0]
    )
    places = np.sort(places)
    nothing = [np.empty(0)] * 2 + [np.empty(0, int)]
    heights = np.full(len(places), top_m)
    seen = FaceObservation(line, places, 0 * places, heights, np.zeros(len(places), int), *nothing)
    return [FaceInterval(seen, *sorted(x * line.direction[0] for x in span)) for span in spans_m]


def kept(*groups, planar=False, limits=LIMITS):
    """Return which stretches stay, by their place in the groups."""
    every = [s for group in groups for s in group]
    left = furniture_fronts.remove_furniture_fronts(every, limits, planar=planar)
    return [any(s is other for other in left) for s in every]


WALL = stretches(0.0, (0.0, 2.0), (4.0, 6.0))


def test_a_cabinet_before_a_wall_that_goes_on_beside_it_goes():
    assert kept(WALL, stretches(0.5, (2.0, 4.0))) == [True, True, False]


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"top_m": 2.2}, "seen higher than furniture"),
        ({"spans": (1.5, 4.2)}, "longer than furniture"),
        ({"y_m": 1.1}, "farther before the wall than furniture"),
        ({"y_m": 0.1}, "on the wall itself"),
        ({"y_m": -0.5}, "behind the wall"),
        ({"normal": -NORTH}, "seen from the other side"),
    ],
)
def test_what_is_no_front_stays(change, why):
    told = {"y_m": 0.5, "spans": (2.0, 4.0), **change}
    thing = stretches(told.pop("y_m"), told.pop("spans"), **told)
    assert kept(WALL, thing) == [True, True, True], why


def test_a_wall_too_far_beside_says_nothing():
    assert kept(stretches(0.0, (5.1, 8.0)), stretches(0.5, (2.0, 4.0))) == [True, True]
    assert kept(stretches(0.0, (4.9, 8.0)), stretches(0.5, (2.0, 4.0))) == [True, False]


def test_a_trace_of_wall_beside_says_nothing():
    assert kept(stretches(0.0, (2.0, 4.2)), stretches(0.5, (2.0, 4.0))) == [True, True]


def test_the_front_of_a_closet_stays_for_the_wall_in_it_is_behind_its_door():
    front = stretches(0.5, (1.0, 2.0), (2.9, 4.0))
    assert kept(stretches(0.0, (1.1, 3.9)), front) == [True, True, True]
    # without the second half there is no door, and the wall goes on beside
    assert kept(stretches(0.0, (1.1, 3.9)), front[:1]) == [True, False]


def test_the_walls_beside_a_niche_stay_for_they_are_longer():
    niche, beside = stretches(0.0, (2.0, 5.0)), stretches(0.5, (0.0, 2.0), (5.0, 7.0))
    assert kept(niche, beside) == [True, True, True]


def across(x_m, y_m, normal_x):
    """Return the stretch of a wall along x = x_m, over a span of y."""
    line = Line(np.array([x_m, 0.0]), np.array([normal_x, 0.0]))
    places = np.sort(np.linspace(*y_m, 50) * line.direction[1])
    nothing = [np.empty(0)] * 2 + [np.empty(0, int)]
    seen = FaceObservation(line, places, 0 * places, 0 * places + 1.5, np.zeros(50, int), *nothing)
    return [FaceInterval(seen, float(places[0]), float(places[-1]))]


@pytest.mark.parametrize("mirrored", [1, -1])
@pytest.mark.parametrize("begin_m", [0.5, 1.7])
def test_the_wall_of_a_room_beside_a_deeper_one_stays(mirrored, begin_m):
    # it is drawn into the wall between the rooms, which has a door next to the corner, or none
    deeper, shallow = (sorted((mirrored * a, mirrored * b)) for a, b in ((2.2, 6.2), (0.0, 2.1)))
    parting = across(2.0 * mirrored, (begin_m, 4.0), -mirrored)
    assert kept(stretches(0.0, deeper), stretches(0.5, shallow), parting) == [True, True, True]
    # what faces the other room, or ends this one elsewhere, parts nothing
    for other in (
        across(2.2 * mirrored, (0.0, 4.0), mirrored),
        across(6.2 * mirrored, (0.0, 4.0), -mirrored),
    ):
        assert kept(stretches(0.0, deeper), stretches(0.5, shallow), other) == [True, False, True]


def test_the_side_of_a_cabinet_is_no_end_of_the_room():
    deep, side = stretches(0.7, (4.2, 5.2)), across(4.2, (0.0, 0.7), -1.0)
    assert kept(WALL, stretches(0.5, (2.0, 4.0)), deep, side) == [True, True, False, False, True]


def test_a_shelf_before_a_cabinet_goes_with_it():
    assert kept(WALL, stretches(0.5, (2.0, 4.0)), stretches(0.8, (2.0, 3.0))) == [
        True,
        True,
        False,
        False,
    ]


def test_what_stands_before_low_things_alone_stays():
    bench = stretches(0.0, (0.0, 2.0), top_m=0.5)
    assert kept(bench, stretches(0.5, (2.0, 4.0))) == [True, True]


def test_of_a_planar_survey_all_stays():
    assert kept(WALL, stretches(0.5, (2.0, 4.0)), planar=True) == [True, True, True]
    assert furniture_fronts.remove_furniture_fronts([], LIMITS, planar=False) == []


def test_the_same_holds_from_the_other_side():
    south = -NORTH
    wall = stretches(0.0, (0.0, 2.0), (4.0, 6.0), normal=south)
    assert kept(wall, stretches(-0.5, (2.0, 4.0), normal=south)) == [True, True, False]


def test_limits_matter():
    short = dataclasses.replace(LIMITS, furniture_length_m=1.9)
    assert kept(WALL, stretches(0.5, (2.0, 4.0)), limits=short) == [True, True, True]
