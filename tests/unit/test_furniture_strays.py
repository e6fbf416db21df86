"""Short surfaces that stand free and oblique in a room of 8 m by 6 m, seen from above."""

import itertools

import numpy as np
import pytest

from helpers.observation_making import stretch
from scanplan.plan.furniture.strays import find_strays
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall

ROOM = [(0, 0, 8, 0), (8, 0, 8, 6), (8, 6, 0, 6), (0, 6, 0, 0)]


def wall(*ends_m, right=(), openings=()):
    face = stretch(*ends_m, planar=True)
    return PlanWall(face.line, 0.0, face.high_m, np.nan, [face], list(right), list(openings))


def oblique(length_m, turn_deg, at_m=(4.0, 3.0)):
    way_m = length_m * np.array([np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))])
    return (*at_m, *(np.array(at_m) + way_m))


def strays(*walls):
    found = find_strays([*(wall(*ends) for ends in ROOM), *walls], max_length_m=1.5)
    return [next(i for i, one in enumerate(walls) if one.left == [face]) for face in found]


@pytest.mark.parametrize(
    ("length_m", "turn_deg", "is_stray"),
    [(1.0, 40, True), (1.0, 70, True), (1.0, 10, False), (1.0, 95, False), (2.0, 40, False)],
    ids=["oblique", "steep", "along", "across", "long"],
)
def test_a_short_surface_oblique_to_all_walls_is_a_stray(length_m, turn_deg, is_stray):
    assert strays(wall(*oblique(length_m, turn_deg))) == [0] * is_stray


def test_one_along_a_longer_oblique_wall_is_a_wall():
    beside = wall(*oblique(3.0, 40, (1, 1)))
    assert strays(wall(*oblique(1.0, 40)), beside) == []


def test_one_that_meets_a_wall_stays_and_so_does_what_meets_it():
    chain = [wall(*oblique(1.0, 40, (0.1, 2))), wall(0.87, 2.7, 1.6, 3.3)]
    assert strays(*chain) == []
    apart = [wall(*oblique(1.0, 40, (2.1, 2))), wall(2.87, 2.7, 3.6, 3.4)]
    assert strays(*apart) == [0, 1]


def test_what_shows_its_other_side_is_a_wall():
    ends_m = oblique(1.0, 40)
    behind = stretch(*ends_m[2:], *ends_m[:2], planar=True)
    assert strays(wall(*ends_m, right=[behind])) == []


@pytest.mark.parametrize(
    ("way_m", "second_m", "n_strays"),
    [(0.9, 0.4, 2), (0.9, 0.9, 0), (2.0, 0.4, 0)],
    ids=["a door apart", "long together", "far apart"],
)
def test_two_things_in_one_line_make_no_wall_with_a_door_between(way_m, second_m, n_strays):
    """A leaf of 0.7 m, and beyond a way what one scan saw."""
    begin_m = 0.7 + way_m
    whole = wall(*oblique(begin_m + second_m, 40))
    line = whole.line
    leaf, other = (
        stretch(*line.at(low_m), *line.at(high_m), planar=True)
        for low_m, high_m in ((0.0, 0.7), (begin_m, begin_m + second_m))
    )
    way = Opening(0.7, begin_m, OPEN, 99, 0.0, np.nan, False)
    both = PlanWall(line, 0.0, whole.high_m, np.nan, [leaf, other], [], [way])
    room = [wall(*ends) for ends in ROOM]
    assert len(find_strays([*room, both], max_length_m=1.5)) == n_strays


def test_a_plan_without_walls_has_none():
    assert find_strays([], max_length_m=1.5) == []


def ring(n_sides, radius_m, share, at_m=(4.0, 3.0)):
    """Faces along a share of the sides of a polygon, seen from its middle."""
    for side in range(n_sides):
        a, b = (
            radius_m * np.array([np.cos(t), np.sin(t)]) + at_m
            for t in 2 * np.pi * (side + 0.5 + share / 2 * np.array([1, -1])) / n_sides
        )
        yield wall(*a, *b)


def test_the_piers_of_a_round_room_and_the_sides_of_a_turned_pillar_stay():
    assert strays(*ring(12, 2.5, 0.6)) == []
    assert strays(*ring(4, 0.5, 1.0, (4.0, 3.2))) == []


def test_pieces_of_an_oblique_wall_stay():
    pieces = [wall(*oblique(1.2, 30, (1 + 1.73 * k, 0.5 + k))) for k in range(4)]
    assert strays(*pieces) == []


def test_a_small_room_without_a_long_wall_stays():
    corners = [(0, 0), (1.1, 0), (1.1, 1.4), (0, 1.4), (0, 0)]
    walls = [wall(*a, *b) for a, b in itertools.pairwise(corners)]
    assert find_strays(walls, max_length_m=1.5) == []
    assert find_strays(list(ring(8, 1.8, 1.0)), max_length_m=1.5) == []
