"""Parts of ground that hardly any wall bounds, at shapes that can be cut on paper."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import box
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.bare_parts import MouthLimits, cut_bare_parts, draw_way, take_visited

ROOM = box(0, 0, 6, 4)
MOUTH_M = (1.0, 3.0)
FAN = Polygon([(6, 1), (16, -4), (16, 8), (6, 3)])  # seen through a mouth of 2 m
WALLS = ROOM.exterior.difference(LineString([(6, 1), (6, 3)]))
INSIDE = LineString([(1, 2), (5, 2)])
LIMITS = MouthLimits(max_walled=0.3, beside_m=0.6, step_m=0.1)


def cut(ground, walls: BaseGeometry = WALLS, visited: BaseGeometry = INSIDE):
    (left,) = cut_bare_parts(ground, walls.buffer(0.1), visited, LIMITS)
    return left


def test_a_fan_seen_through_a_wide_mouth_is_cut_at_the_mouth():
    left = cut(shapely.union(ROOM, FAN))
    assert left.symmetric_difference(ROOM).area < 0.2


def test_a_fan_that_somebody_was_in_stays():
    whole = shapely.union(ROOM, FAN)
    left = cut(whole, visited=LineString([(1, 2), (10, 2)]))
    assert left.intersects(shapely.Point(9.9, 2))
    assert left.area > ROOM.area + 5


def test_a_room_behind_a_wide_mouth_stays_where_its_walls_were_seen():
    beyond = box(6, 0, 10, 4)
    walls = shapely.union(WALLS, beyond.exterior.difference(LineString([(6, 1), (6, 3)])))
    whole = shapely.union(ROOM, beyond)
    assert cut(whole, walls).equals(whole)


def test_a_corner_whose_walls_nobody_saw_stays():
    walls = LineString([(0, 2), (0, 0), (6, 0), (6, 4), (2, 4)])
    assert cut(ROOM, walls).equals(ROOM)


def test_a_fan_alone_is_all_cut():
    assert cut_bare_parts(FAN, WALLS, INSIDE, LIMITS) in (
        [],
        [FAN],
    )
    assert take_visited(Polygon(), INSIDE) == []


def test_two_fans_are_cut_each_at_its_own_mouth():
    other = Polygon([(2, 4), (-2, 12), (8, 12), (3.5, 4)])
    walls = WALLS.difference(LineString([(2, 4), (3.5, 4)]))
    left = cut(shapely.union_all([ROOM, FAN, other]), walls)
    assert left.symmetric_difference(ROOM).area < 0.3


def test_two_fans_that_meet_outside_are_cut_together():
    """What they enclose nobody saw: their mouth leads over it."""
    arms = Polygon([(6, 0.5), (6, 1.1), (14.7, 2), (6, 2.9), (6, 3.5), (16, 2.3), (16, 1.7)])
    walls = ROOM.exterior.difference(LineString([(6, 0.5), (6, 3.5)]))
    whole = shapely.union(ROOM, arms)
    assert len(whole.interiors) == 1
    assert cut(whole, walls).symmetric_difference(ROOM).area < 0.2


def test_a_room_whose_far_sides_are_jagged_stays():
    """Edges of shadows make its outline long, and not what it leaves open."""
    depth_m = np.tile([0.3, 0.0], 6)[:11]
    end = np.column_stack([9 - depth_m, np.linspace(-0.5, 4.5, 13)[1:-1]])
    side = np.column_stack([np.linspace(9, 6, 13)[1:-1], 4.5 - depth_m])
    beyond = Polygon([(6, -0.5), (9, -0.5), *end, (9, 4.5), *side, (6, 4.5)])
    whole = shapely.union(ROOM, beyond)
    left = cut(whole, shapely.union(WALLS, LineString([(6, -0.5), (9, -0.5)])))
    assert left.area == pytest.approx(whole.area, abs=0.1)


def test_a_mouth_does_not_lead_over_a_hole_with_walls():
    """A corridor around a block, whose far end shows no walls but the block's."""
    block = box(2, 1, 7, 3)
    corridor = box(0, 0, 12, 4).difference(block)
    near = LineString([(5, 4), (0, 4), (0, 0), (5, 0)])
    way = LineString([(1, 0.5), (1, 3.5)])
    assert cut(corridor, shapely.union(near, block.exterior), visited=way).equals(corridor)
    assert cut(corridor, near, visited=way).area < corridor.area / 2


@pytest.mark.parametrize(("thick_m", "is_cut"), [(0.2, True), (0.5, True), (0.7, False)])
def test_a_wall_that_stands_in_a_mouth_leaves_less_of_it_open(thick_m, is_cut):
    """Half a metre long, where the mouth is; what is as thick as no wall may be a room's block."""
    pillar = box(6 - thick_m / 2, 1.7, 6 + thick_m / 2, 2.5)
    ground = shapely.union(ROOM, FAN).difference(pillar)
    left = cut(ground, shapely.union(WALLS, pillar.exterior))
    assert (left.area < ROOM.area + 1) == is_cut


@pytest.mark.parametrize("n_still", [0, 30, 300])
def test_what_stands_takes_no_steps_however_long(n_still):
    """6 m driven in steps of 0.25 m, on both sides of a long stand; 50 m on nobody saw the way."""
    rng = np.random.default_rng(0)
    out = np.column_stack([np.arange(0, 3.01, 0.25), np.zeros(13)])
    still = out[-1] + rng.normal(0, 0.003, (n_still, 2))
    on, away = out + np.array([3.0, 0.0]), np.array([[60.0, 0.0]])
    track_m = np.concatenate([out, still, on, away])
    assert draw_way(track_m, 0.1).length == pytest.approx(6, abs=0.1)


@pytest.mark.parametrize("n_places", [0, 1])
def test_no_step_is_no_way(n_places):
    assert draw_way(np.zeros((n_places, 2)), 0.1).length == 0


def test_ground_without_any_wall_is_all_that_is_known():
    whole = shapely.union(ROOM, FAN)
    assert cut(whole, LineString(), visited=shapely.union(INSIDE, FAN.centroid)).area > 20


def test_of_ground_that_a_cut_parts_all_that_was_visited_stays():
    """The fan leads to a second room, which was driven into by another way."""
    second = box(16, 0, 20, 4)
    walls = shapely.union(WALLS, second.exterior.difference(LineString([(16, 0), (16, 4)])))
    ground = shapely.union_all([ROOM, FAN, second])
    ways = shapely.MultiLineString([[(1, 2), (5, 2)], [(17, 2), (19, 2)]])
    found = cut_bare_parts(ground, walls.buffer(0.1), ways, LIMITS)
    assert all(any(part.covers(way) for part in found) for way in ways.geoms)


@pytest.mark.parametrize("turn_deg", [0, 33, 90, 211])
def test_the_building_may_be_turned(turn_deg):
    ground, walls, way = (
        shapely.affinity.rotate(shape, turn_deg, origin=(0, 0))
        for shape in (shapely.union(ROOM, FAN), WALLS, INSIDE)
    )
    assert cut(ground, walls, way).area == pytest.approx(ROOM.area, abs=0.3)


@given(st.floats(0.5, 3.5), st.floats(3, 30), st.floats(-3, 3))
def test_what_is_left_is_of_the_ground_and_holds_all_ways(half_m, depth_m, aside_m):
    low, high = 2 - half_m / 2, 2 + half_m / 2
    fan = Polygon([(6, low), (6 + depth_m, low - 4 + aside_m), (6 + depth_m, high + 4), (6, high)])
    ground = shapely.union(ROOM, fan)
    left = cut(ground)
    assert left.difference(ground).area < 1e-2
    assert left.covers(INSIDE)
    assert np.isfinite(left.area)


def test_shadows_in_the_middle_of_a_room_are_no_mouth():
    """Of a room whose far half is seen as a fan between what stands in it, none of it by walls."""
    fan = Polygon([(2, 1.5), (6, 0.2), (6, 3.8), (2, 2.5)])
    ground = shapely.union(box(0, 0, 2.1, 4), fan)
    walls = LineString([(2.1, 0), (0, 0), (0, 4), (2.1, 4)])
    left = cut(ground, walls, LineString([(1, 1), (1, 3)]))
    assert left.area == pytest.approx(ground.area)
    jambs = shapely.union(
        walls, shapely.MultiLineString([[(2.1, 0), (2.1, 1.4)], [(2.1, 2.6), (2.1, 4)]])
    )
    assert cut(ground, jambs, LineString([(1, 1), (1, 3)])).area < 9
