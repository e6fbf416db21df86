"""Floor of rooms that was not seen: what furniture may hide, worked out on paper."""

import numpy as np
import pytest
import shapely

from helpers.observation_making import line_through
from helpers.plan_wall_making import box
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms.room import Room
from scanplan.plan.rooms.unseen_floor import leave_out_unseen

ALONE = {"partings": (), "views": ()}


def test_what_furniture_may_hide_before_a_wall_stays_in_a_room():
    """Unseen from x = 1 to 4 before the upper wall: 3 m and 1 m would be bare, `depth` deep."""

    def leave_out(depth_m: float) -> Room:
        seen = shapely.box(0, 0, 4, 3.9 - depth_m).union(shapely.box(0, 0, 1, 4))
        (left,) = leave_out_unseen([room], seen, box(), **rest)
        return left

    room = Room(shapely.box(0.1, 0.1, 3.9, 3.9), 1.0, entered=True, n_scans=1)
    rest = {
        "track_m": np.array([(2.0, 1.0)]),
        "min_area_m2": 1.0,
        "max_depth_m": 1.0,
        "max_unseen": 1.0,
        **ALONE,
        "unpaired_m": 0.1,
    }
    # 2.9 d < 2.9 + d below 1.5 m
    assert leave_out(1.4).polygon.area == pytest.approx(room.polygon.area)
    shallow = leave_out(1.6)
    assert shallow.polygon.area == pytest.approx(room.polygon.area - 2.9 * 1.6, abs=0.02)
    assert shallow.walled < room.walled
    assert leave_out_unseen([room], shapely.box(0, 0, 0.9, 1), box(), **rest) == []


@pytest.mark.parametrize(("side_m", "is_left"), [(1.7, True), (1.8, False)])
def test_what_was_not_seen_in_the_middle_of_a_room_is_no_larger_than_furniture(side_m, is_left):
    room = Room(shapely.box(0.1, 0.1, 11.9, 11.9), 1.0, entered=True, n_scans=1)
    hidden = shapely.box(5, 5, 5 + side_m, 5 + side_m)
    (left,) = leave_out_unseen(
        *([room], shapely.box(0, 0, 12, 12).difference(hidden), box(12.0)),
        track_m=np.array([(2.0, 1.0)]),
        min_area_m2=1.0,
        max_depth_m=1.0,
        max_unseen=1.0,
        **ALONE,
        unpaired_m=0.1,
    )
    assert left.polygon.covers(hidden) == is_left


def test_a_room_without_furniture_keeps_nothing_that_was_not_seen():
    room = Room(shapely.box(0.1, 0.1, 3.9, 3.9), 1.0, entered=True, n_scans=1)
    (left,) = leave_out_unseen(
        *([room], shapely.box(0, 0, 4, 3), box(), np.array([(2.0, 1.0)])),
        **{"min_area_m2": 1.0, "max_depth_m": 0.0, "max_unseen": 1.0, "unpaired_m": 0.1, **ALONE},
    )
    assert left.polygon.bounds[3] == pytest.approx(3)


def test_unseen_floor_beyond_which_no_wall_is_drawn_is_left_out():
    room = Room(shapely.box(0.1, 0.1, 3.9, 3.9), 1.0, entered=True, n_scans=1)
    seen = shapely.box(0, 0, 4, 3.5)
    rest = {
        "track_m": np.array([(2.0, 1.0)]),
        "min_area_m2": 1.0,
        "max_depth_m": 1.0,
        "max_unseen": 1.0,
        **ALONE,
        "unpaired_m": 0.1,
    }
    below, right, _, left = box()
    (bare,) = leave_out_unseen([room], seen, [below, right, left], **rest)
    assert bare.polygon.bounds[3] == pytest.approx(3.5)
    (hidden,) = leave_out_unseen([room], seen, box(), **rest)
    assert hidden.polygon.bounds[3] == pytest.approx(3.9)


def test_a_room_that_falls_apart_is_every_part_of_it_that_was_driven_into():
    room = Room(shapely.box(0.1, 0.1, 3.9, 3.9), 1.0, entered=True, n_scans=1)
    seen = shapely.union(shapely.box(0, 0, 4, 1.9), shapely.box(0, 2.4, 4, 4))
    rest = {"min_area_m2": 1.0, "max_depth_m": 0.2, "max_unseen": 1.0, "unpaired_m": 0.1, **ALONE}
    ways = np.array([(2.0, 1.0), (2.0, 3.0)])
    assert len(leave_out_unseen([room], seen, box(), ways, **rest)) == 2
    assert len(leave_out_unseen([room], seen, box(), ways[:1], **rest)) == 1


@pytest.mark.parametrize(
    ("max_unseen", "left_m2"),
    [
        *((0.26, 16), (0.253, 14), (0.24, 14), (0.14, 14)),
        *((0.12, 12.8), (0.06, 12.8), (0.04, 12), (0.005, 11.9)),
    ],
)
def test_of_what_furniture_may_hide_the_largest_parts_are_left_out(max_unseen, left_m2):
    """In three corners of 16 m2 are hidden 0.8, 1.2 and 2 m2, after the narrow shadow of a leg."""
    room = Room(shapely.box(0, 0, 4, 4), 1.0, entered=True, n_scans=1)
    corners = [shapely.box(0, 3.2, 1, 4), shapely.box(3, 2.8, 4, 4), shapely.box(2, 0, 4, 1)]
    seen = shapely.box(0, 0, 4, 4).difference(shapely.union_all(corners))
    (left,) = leave_out_unseen(
        *([room], seen.difference(shapely.box(0, 1.5, 1, 1.6)), box()),
        **{"track_m": np.array([(2.0, 2.0)]), "min_area_m2": 1.0, "unpaired_m": 0.1},
        **{"max_depth_m": 2.0, "max_unseen": max_unseen, **ALONE},
    )
    assert left.polygon.area == pytest.approx(left_m2, abs=0.02)


@pytest.mark.parametrize("depth_m", [0.04, 0.09])
def test_what_is_between_walls_and_where_rays_ended_stays_in_a_room(depth_m):
    """All around 4 m x 4 m: of the area 4 and 9 %."""
    room = Room(shapely.box(0, 0, 4, 4), 1.0, entered=True, n_scans=1)
    (left,) = leave_out_unseen(
        *([room], room.polygon.buffer(-depth_m), box(), np.array([(2.0, 2.0)])),
        **{"min_area_m2": 1.0, "unpaired_m": 0.1, "max_depth_m": 1.0, "max_unseen": 0.02},
        **ALONE,
    )
    assert left is room


def test_parts_of_a_room_are_closed_by_partings_and_seen_by_their_own_scans():
    """A strip from wall to wall was not seen; what is beyond it ends at a parting."""
    room = Room(shapely.box(0.1, 0.1, 3.9, 3.9), 1.0, entered=True, n_scans=1)
    parts = [shapely.box(0, 0, 4, 1.5), shapely.box(0, 2.5, 4, 4)]
    parting = PlanWall(line_through(0, 2.45, 4, 2.45), 0.0, 4.0, 0.1, [], [])
    lower, upper = sorted(
        leave_out_unseen(
            *([room], shapely.union_all(parts), box(), np.array([(2.0, 1.0), (2.0, 3.0)])),
            **{"min_area_m2": 1.0, "unpaired_m": 0.1, "max_depth_m": 0.2, "max_unseen": 1.0},
            partings=[parting],
            views=[shapely.box(0, 0, 4, 1.0)],
        ),
        key=lambda part: part.polygon.bounds[1],
    )
    assert (lower.n_scans, upper.n_scans) == (1, 0)
    assert upper.closed and not lower.closed
