"""External walls are those with nothing of the plan behind one side."""

import numpy as np
import shapely

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports import envelope


def test_all_but_the_wall_between_the_rooms_are_external():
    assert envelope.find_external_walls(plan()).tolist() == [True] * 5 + [False]


def test_a_wall_within_a_room_is_internal_though_seen_from_one_side():
    row = ((1.0, 1.0, 3.0, 1.0), np.nan, 0, -1, "observed")
    drawn = plan(walls=floorplan_making.walls([*floorplan_making.WALLS, row]))
    assert envelope.find_external_walls(drawn).tolist() == [True] * 5 + [False] * 2


def test_what_walls_enclose_belongs_to_the_plan():
    """A shaft between three rooms that no scan looked into."""
    ring = shapely.box(0, 0, 9, 9).difference(shapely.box(3, 3, 6, 6))
    row = ((3.0, 3.0, 6.0, 3.0), np.nan, -1, 0, "observed")
    drawn = plan(
        walls=floorplan_making.walls([row]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([ring]),
        free=floorplan_making.free([]),
    )
    assert envelope.find_external_walls(drawn).tolist() == [False]
    assert envelope.outline_plan(drawn).area == 81.0


def test_a_plan_of_faces_alone_has_no_walls_to_ask():
    assert len(envelope.find_external_walls(bare())) == 0
