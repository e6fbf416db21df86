"""Walls that go on beyond facades, as they are drawn in a regular plan."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.drafting.stubs import cut_stubs
from scanplan.plan.floorplan import centrelines_m

SETTINGS = DraftSettings(0.05, (0.1, 0.2), (0.9,), (1.2,), 0.3)
EAST_M = 7.1  # the face of the east wall, which was seen from inside alone


def crossing(from_m, to_m):
    """The toy plan with a wall that is 0.1 m thick, and what rays met in its line outside."""
    walls = [*floorplan_making.WALLS, ((from_m, 1.5, to_m, 1.5), 0.1, 9, 10, "observed")]
    outside = (7.2, 1.55, max(from_m, to_m), 1.55, 6)
    faces = [*floorplan_making.FACES, (from_m, 1.45, to_m, 1.45, 6), outside]
    hole = ((7.5, 1.5, 8.1, 1.5), 6, "door", 0.0, 2.0, -1, -1)
    return floorplan_making.plan(
        walls=floorplan_making.walls(walls),
        faces=floorplan_making.faces(faces),
        openings=floorplan_making.openings([*floorplan_making.OPENINGS, hole], walls),
    )


@pytest.mark.parametrize("turned", [False, True])
def test_a_wall_ends_at_the_facade_that_it_crosses_and_its_faces_and_openings_with_it(turned):
    drawn = crossing(8.3, 5.0) if turned else crossing(5.0, 8.3)
    plan, n_cut = cut_stubs(drawn)
    assert n_cut == 1
    ends_m = sorted(centrelines_m(plan.walls)[6][:, 0])
    assert ends_m == pytest.approx([5.0, EAST_M])
    # of its two faces the one that lies outside is gone
    assert plan.faces["face"].tolist() == drawn.faces["face"].tolist()[:-1]
    assert sorted(centrelines_m(plan.faces)[-1][:, 0]) == pytest.approx([5.0, EAST_M])
    assert plan.openings["opening"].tolist() == [0, 1, 2]
    # all others are as they were
    assert np.array_equal(centrelines_m(plan.walls)[:6], centrelines_m(drawn.walls)[:6])


def test_what_is_cut_is_counted_among_scraps():
    assert draft_plan(crossing(5.0, 8.3), SETTINGS)[1].n_left_out == 2  # an end and its opening


@pytest.mark.parametrize(
    ("from_m", "to_m"),
    [
        (5.0, EAST_M + 0.05),  # as far as ends err
        (6.5, 8.3),  # the most of it lies beyond
    ],
)
def test_what_may_be_no_facade_cuts_nothing(from_m, to_m):
    assert cut_stubs(crossing(from_m, to_m))[1] == 0


def test_what_bounds_a_room_or_was_drawn_by_hand_is_not_cut():
    drawn = crossing(5.0, 8.3)
    corrected = drawn.walls["corrected"].copy()
    corrected[6] = "added"
    assert cut_stubs(replace(drawn, walls={**drawn.walls, "corrected": corrected}))[1] == 0
    rooms = floorplan_making.rooms([*floorplan_making.ROOMS, shapely.box(7.2, 1.55, 8.3, 2.0)])
    assert cut_stubs(replace(drawn, rooms=rooms))[1] == 0
