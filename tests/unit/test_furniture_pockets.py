"""Fronts of furniture in the plane: rooms with cupboards of known place, seen from above."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import box

from helpers.observation_making import stretch
from scanplan.plan.furniture import fronts
from scanplan.plan.furniture.plan_faces import PlanFaces
from scanplan.plan.furniture.pockets import find_pockets
from scanplan.plan.furniture.recesses import stands_before_facade
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall, greatest_thickness_m, usual_thickness_m

ROOM = [(0, 0, 5, 0), (5, 0, 5, 4), (0, 4, 0, 0)]
"""South, east and west face of a room of 5 m by 4 m, seen from within."""
MOST = fronts.FrontLimits(
    max_door_m=1.5, max_thickness_m=0.6, max_depth_m=1.0, ghost_distance_m=0.3
)


def wall(faces, openings=()):
    """A wall of faces of one line that are seen from within."""
    found = [stretch(*face, planar=True) for face in faces]
    line = found[0].line
    along_m = np.concatenate([line.along_m(face.ends) for face in found])
    ways = [Opening(low, high, OPEN, 99, 0.0, np.nan, False) for low, high in openings]
    return PlanWall(line, along_m.min(), along_m.max(), np.nan, found, [], ways)


def pockets(walls, floor):
    return find_pockets(walls, floor, unpaired_m=0.1, max_thickness_m=0.6, max_depth_m=1.0)


def room_with_cupboard(x0, x1, depth_m):
    """North wall seen beside a cupboard, and the cupboard's front."""
    north = wall([(5, 4, x1, 4), (x0, 4, 0, 4)] if x0 > 0 else [(5, 4, x1, 4)])
    # what the cupboard hides of the wall was closed
    north = PlanWall(north.line, *np.sort(north.line.along_m(np.array([[0, 4], [5, 4]]))),
                     np.nan, north.left, [])  # fmt: skip
    front = wall([(x1, 4 - depth_m, x0, 4 - depth_m)])
    sides = [wall([(x1, 4, x1, 4 - depth_m)])] + [wall([(x0, 4 - depth_m, x0, 4)])] * (x0 > 0)
    floor = box(0, 0, 5, 4).difference(box(x0, 4 - depth_m, x1, 4))
    return [*(wall([face]) for face in ROOM), north, front, *sides], floor


@pytest.mark.parametrize("x0", [0.0, 2.0])
def test_a_cupboard_before_a_wall_seen_beside_it_is_furniture_with_all_its_sides(x0):
    walls, floor = room_with_cupboard(x0, 3.5, 0.5)
    (pocket,) = pockets(walls, floor)
    (front,), *sides = (wall.left for wall in walls[4:])
    assert {id(face) for face in pocket.fronts} == {id(front), *(id(side[0]) for side in sides)}
    # a cell more, where returns at the front scatter
    np.testing.assert_allclose(pocket.ground.bounds, (x0 - 0.05, 3.45, 3.55, 4.05), atol=0.051)


def test_what_fills_a_room_from_wall_to_wall_may_be_a_closet():
    faces = [(0, 0, 5, 0), (5, 0, 5, 3.5), (5, 3.5, 0, 3.5), (0, 3.5, 0, 0)]
    behind = wall([(0, 4.1, 5, 4.1)])
    known = shapely.union_all([box(0, 0, 5, 3.5), box(-0.1, 3.4, 0, 4.2), box(5, 3.4, 5.1, 4.2)])
    assert pockets([*(wall([face]) for face in faces), behind], known) == []


def test_what_is_larger_than_furniture_is_a_part_of_the_building():
    assert pockets(*room_with_cupboard(1.5, 4.5, 2.5)) == []


def test_a_desk_in_a_corner_that_hides_both_walls_is_furniture():
    front, side = (wall([face]) for face in [(0, 1, 1.5, 1), (1.5, 1, 1.5, 0)])
    seen = [(1.5, 0, 5, 0), (5, 0, 5, 4), (5, 4, 0, 4), (0, 4, 0, 1)]
    floor = box(0, 0, 5, 4).difference(box(0, 0, 1.5, 1))
    found = pockets([*(wall([face]) for face in seen), front, side], floor)
    assert {id(face) for pocket in found for face in pocket.fronts} == {
        id(front.left[0]),
        id(side.left[0]),
    }
    assert shapely.union_all([pocket.ground for pocket in found]).covers(box(0, 0, 1.5, 1))


def test_a_wall_that_goes_farther_than_that_of_a_bay_beside_it_stays():
    faces = [(0, 1, 4, 1), (4, 1, 4, 0), (4, 0, 5, 0), (5, 0, 5, 4), (5, 4, 0, 4), (0, 4, 0, 1)]
    floor = box(0, 1, 5, 4).union(box(4, 0, 5, 1))
    assert pockets([wall([face]) for face in faces], floor) == []


def test_what_is_deeper_than_furniture_hides_more_than_it():
    seen = [(0, 0, 5, 0), (5, 0, 5, 4), (5, 4, 0, 4), (0, 4, 0, 3)]
    front, side = (wall([face]) for face in [(3, 3, 3, 2.2), (3, 2.2, 0, 2.2)])
    floor = box(0, 0, 5, 4).difference(box(0, 2.2, 3, 3))
    found = pockets([*(wall([face]) for face in seen), front, side], floor)
    assert all(front.left[0] is not face for pocket in found for face in pocket.fronts)


def test_a_corner_that_surfaces_enclose_is_a_part_of_the_building_where_no_furniture_fills_it():
    seen = [(2, 0, 5, 0), (5, 0, 5, 4), (5, 4, 0, 4), (0, 4, 0, 2)]
    corner = [wall([face]) for face in [(0, 2, 2, 2), (2, 2, 2, 0)]]
    floor = box(0, 0, 5, 4).difference(box(0, 0, 2, 2))
    assert pockets([*(wall([face]) for face in seen), *corner], floor) == []


@pytest.mark.parametrize(
    ("length_m", "n_pockets"), [(6.0, 0), (2.6, 0), (2.3, 1)], ids=["wall", "short", "cupboard"]
)
def test_a_wall_that_ends_at_one_across_stands_before_none_in_a_line_far_away(length_m, n_pockets):
    """Beyond it nothing was seen; floor goes round its other end."""
    faces = [(5, 0, 5, length_m), (5, length_m, 0, length_m), (0, length_m, 0, -1), (0, -1, 7, -1)]
    far = wall([(5.65, 8, 5.65, 18)])
    outer = wall([(12, -1, 12, 20)])
    floor = box(0, 0, 5, length_m).union(box(0, -1, 7, 0))
    assert len(pockets([*(wall([face]) for face in faces), far, outer], floor)) == n_pockets


def block(width_m, length_m):
    """A room with a block in its middle, seen from all sides."""
    x1, y1, x2 = 1.5 + length_m, 1.5 + width_m, 4 + length_m
    corners = [(1.5, 1.5), (1.5, y1), (x1, y1), (x1, 1.5), (1.5, 1.5)]
    sides = [wall([(*a, *b)]) for a, b in itertools.pairwise(corners)]
    faces = [(0, 0, x2, 0), (x2, 0, x2, 4), (x2, 4, 0, 4), (0, 4, 0, 0)]
    floor = box(0, 0, x2, 4).difference(box(1.5, 1.5, x1, y1))
    return [*(wall([face]) for face in faces), *sides], floor


@pytest.mark.parametrize(
    ("width_m", "length_m", "n_pockets"),
    [(0.7, 1.6, 1), (0.5, 0.5, 0), (0.19, 1.6, 0), (0.7, 4.6, 1), (1.5, 2.2, 0), (0.7, 9.0, 0)],
    ids=["table", "column", "wall", "row", "shaft", "long"],
)
def test_a_block_is_furniture_if_it_is_no_wall_and_no_column(width_m, length_m, n_pockets):
    assert len(pockets(*block(width_m, length_m))) == n_pockets


@pytest.mark.parametrize(("beyond_m", "n_pockets"), [(0.8, 0), (0.2, 1)], ids=["wall", "chair"])
def test_a_block_that_goes_on_beyond_a_door_is_wall(beyond_m, n_pockets):
    walls, floor = block(0.7, 1.6)
    # its north side, with what stands in that line 0.9 m farther on
    front = walls[5].left[0]
    ends_m = front.line.at(np.array([front.high_m + 0.9, front.high_m + 0.9 + beyond_m]))
    beyond = stretch(*ends_m.ravel(), planar=True)
    walls[5] = PlanWall(walls[5].line, 0.0, 2.5 + beyond_m, np.nan, [front, beyond], [],
                        [Opening(1.6, 2.5, OPEN, 99, 0.0, np.nan, False)])  # fmt: skip
    assert len(pockets(walls, floor)) == n_pockets


def test_the_short_end_of_a_long_block_may_lie_in_the_line_of_a_wall():
    walls, floor = block(0.7, 3.0)
    walls[4] = PlanWall(walls[4].line, 0.0, 2.5, np.nan, walls[4].left, [],
                        [Opening(0.8, 1.7, OPEN, 99, 0.0, np.nan, False)])  # fmt: skip
    (pocket,) = pockets(walls, floor)
    assert {id(wall.left[0]) for wall in walls[4:]} == {id(face) for face in pocket.fronts}


def two_sided(x0, x1, y, thickness_m, **gaps):
    """A wall whose two sides were seen."""
    left, right = (stretch(*face, planar=True) for face in
                   [(x0, y + thickness_m, x1, y + thickness_m), (x1, y, x0, y)])  # fmt: skip
    middle = replace(left.line, centre=left.line.centre - thickness_m / 2 * left.line.normal)
    return PlanWall(middle, *np.sort(middle.along_m(left.ends)), thickness_m, [left], [right],
                    **gaps)  # fmt: skip


def test_of_two_walls_the_thinner_is_as_walls_usually_are():
    walls = [two_sided(0, 3, 5 * k, thick_m) for k, thick_m in enumerate((0.3, 0.1))]
    assert usual_thickness_m([*walls, wall([(0, 9, 3, 9)])]) == pytest.approx(0.1)
    assert usual_thickness_m([*walls, walls[0]]) == pytest.approx(0.3)
    assert usual_thickness_m([]) == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("thickness_m", "gaps", "most_m"),
    [
        ((0.1, 0.1, 0.5), {}, 0.2),
        ((0.1, 0.1, 0.1, 0.42, 0.5), {}, 0.5),
        ((0.1, 0.1, 0.5), {"openings": [Opening(1, 1.9, OPEN, 9, 0.0, np.nan, False)]}, 0.5),
    ],
    ids=["alone", "as_another", "with_a_door"],
)
def test_no_wall_is_much_thicker_than_all_others(thickness_m, gaps, most_m):
    """The last may be a partition and a cupboard before it; jambs of a door show what it is."""
    *others, last = (two_sided(0, 3, 5 * k, thick_m) for k, thick_m in enumerate(thickness_m))
    walls = [*others, replace(last, **gaps), wall([(0, 30, 3, 30)])]
    assert greatest_thickness_m(walls) == pytest.approx(most_m)


def test_a_pier_may_be_thicker_than_walls_are():
    walls = [two_sided(0, 3, 0, 0.1), two_sided(0, 3, 5, 0.1), two_sided(0, 0.8, 9, 0.5)]
    assert greatest_thickness_m(walls) == pytest.approx(0.5)
    assert greatest_thickness_m([]) == pytest.approx(0.2)


def test_a_block_whose_side_goes_on_with_another_side_beyond_a_door_is_wall():
    walls, floor = block(0.7, 1.6)
    beyond = stretch(4.0, 2.1, 5.0, 2.1, planar=True)
    walls[5] = PlanWall(walls[5].line, 0.0, 3.4, 0.1, walls[5].left, [beyond],
                        [Opening(1.7, 2.6, OPEN, 99, 0.0, np.nan, False)])  # fmt: skip
    assert pockets(walls, floor) == []


def test_a_surface_of_the_next_room_is_no_front():
    walls, floor = room_with_cupboard(2.0, 3.5, 0.5)
    beyond = wall([(1.5, 4.05, 4.0, 4.05)])
    floor = shapely.union_all([floor, box(0, 4.15, 5, 7)])
    found = pockets([*walls, beyond], floor)
    assert all(beyond.left[0] is not face for pocket in found for face in pocket.fronts)


@pytest.mark.parametrize(("seen_m", "is_front"), [(0.0, True), (0.2, True), (0.3, False)])
def test_walls_are_left_without_fronts_unless_other_scans_saw_most_behind_them(seen_m, is_front):
    walls, floor = room_with_cupboard(2.0, 3.5, 0.5)
    seen = floor.union(box(2.0, 3.5, 3.5, 3.5 + seen_m))

    def assemble(faces):
        return [wall for wall in walls if any(face in faces for face in wall.members)]

    left, grounds, leaves = fronts.drop_fronts(walls, floor, seen, assemble, MOST)
    assert left == (walls[:4] if is_front else walls)
    assert len(grounds) == is_front and leaves == []


@pytest.mark.parametrize(
    ("in_line", "n_pockets"),
    [
        ([], 1),
        ([(2.5, 4.0, 1.0), (5.0, 7.5, 1.0)], 0),
        # scans placed badly show it in steps
        ([(1.5, 4.0, 1.1), (4.05, 7.5, 1.14)], 0),
        ([(1.7, 4.0, 1.1), (4.05, 7.5, 1.14)], 1),
        ([(1.5, 4.0, 1.2), (4.05, 7.5, 1.2)], 1),
        # seen from the other side
        ([(4.0, 1.5, 1.1), (7.5, 4.05, 1.1)], 1),
    ],
    ids=["alone", "in_line", "in_steps", "farther_on", "farther_off", "turned"],
)
def test_a_front_is_no_longer_with_what_stands_in_its_line_than_furniture(in_line, n_pockets):
    """A surface of 1.5 m hides the corner, 1 m deep: 7.5 m of its line would be 7.5 m2."""
    seen = [(1.5, 0, 12, 0), (12, 0, 12, 4), (12, 4, 0, 4), (0, 4, 0, 1)]
    fronts_m = [(0, 1, 1.5, 1), *((low, y, high, y) for low, high, y in in_line)]
    floor = box(0, 0, 12, 4).difference(box(0, 0, 1.5, 1))
    assert len(pockets([wall([face]) for face in [*seen, *fronts_m]], floor)) == n_pockets


@pytest.mark.parametrize(("aslant_m", "is_behind"), [(0.12, True), (0.18, False)])
def test_a_wall_behind_is_as_far_from_one_end_of_a_front_as_from_the_other(aslant_m, is_behind):
    """A front of 2.4 m, and what is 1.2 m long: a wall, or the leaf of a door that is open."""
    front = stretch(4, 2.4, 4, 0, planar=True)
    behind = stretch(3 + aslant_m, 3.6, 3, 2.4, planar=True)
    found = PlanFaces([front, behind]).backs([front, behind], [front])
    assert found == [front, behind] if is_behind else found == [front]


@pytest.mark.parametrize("depth_m", [0.25, 0.28])
def test_a_cupboard_is_no_longer_for_the_wall_close_behind_it(depth_m):
    """One of 1.2 m in a corridor of 30 m, whose wall is seen beside it."""
    around = [(0, 0, 30, 0), (30, 0, 30, 2), (0, 2, 0, 0), (30, 2, 14.2, 2), (13, 2, 0, 2)]
    cupboard = [(14.2, 2 - depth_m, 13, 2 - depth_m)]
    floor = box(0, 0, 30, 2).difference(box(13, 2 - depth_m, 14.2, 2))
    assert len(pockets([wall([face]) for face in [*around, *cupboard]], floor)) == 1


@pytest.mark.parametrize(("east_m", "n_pockets"), [(12, 0), (5, 2)])
def test_corners_beside_a_door_are_no_furniture_if_the_wall_goes_farther_than_that_across(
    east_m, n_pockets
):
    """A room whose door was driven through: behind the wall on either side nothing was seen.

    The walls across are 8 m long; the wall with the door is 12 m long, or it may be two cupboards.
    """
    faces = [(0, 0, east_m, 0), (east_m, 0, east_m, 4), (east_m, 4, 3, 4), (2, 4, 0, 4)]
    faces += [(0, 4, 0, 0), (5, 4.1, 5, 8), (5, 8, 0, 8), (0, 8, 0, 4.1)]
    fan = shapely.Polygon([(2, 4), (3, 4), (5, 5.8), (5, 8), (0, 8), (0, 5.8)])
    floor = shapely.union(box(0, 0, east_m, 4), fan)
    assert len(pockets([wall([face]) for face in faces], floor)) == n_pockets


def facade_rooms(bench_m, beyond=()):
    """Two rooms whose south wall is y = 0; in the west one a bench stands before all of it."""
    faces = [(0, bench_m, 4, bench_m), (4, bench_m, 4, 4), (4, 4, 0, 4), (0, 4, 0, bench_m)]
    faces += [(4.1, 0, 10, 0), (10, 0, 10, 4), (10, 4, 4.1, 4), (4.1, 4, 4.1, 0), *beyond]
    floor = shapely.union(box(0, bench_m, 4, 4), box(4.1, 0, 10, 4))
    walls = [wall([face]) for face in faces]
    return walls, walls[0].left[0], floor


@pytest.mark.parametrize(
    ("bench_m", "beyond", "n_pockets"),
    [
        (0.9, (), 1),
        (1.4, (), 0),
        # another room lies south of the wall
        (0.9, [(0, -0.1, 10, -0.1), (0, -3, 0, -0.1), (10, -3, 0, -3)], 0),
        # a house across the court: the wall is not the last
        (0.9, [(2, -6, 8, -6)], 0),
        (0.9, [(12, -6, 18, -6)], 1),
    ],
    ids=["bench", "room", "closet", "court", "wing_elsewhere"],
)
def test_what_fills_a_room_before_the_outer_wall_is_furniture(bench_m, beyond, n_pockets):
    walls, front, floor = facade_rooms(bench_m, beyond)
    found = pockets(walls, floor)
    assert [front in pocket.fronts for pocket in found] == [True] * n_pockets
    assert all(pocket.ground.covers(box(0, 0.01, 4, bench_m)) for pocket in found)


@pytest.mark.parametrize("jamb_m", [0.15, 1.0])
def test_an_outer_wall_with_a_door_is_no_bench(jamb_m):
    walls, front, floor = facade_rooms(0.9)
    beside = stretch(4.0 - jamb_m, 0.9, 4.0, 0.9, planar=True)
    west = stretch(0.0, 0.9, 3.0 - jamb_m, 0.9, planar=True)
    way = Opening(3.0 - jamb_m, 4.0 - jamb_m, OPEN, 99, 0.0, np.nan, False)
    walls[0] = PlanWall(front.line, 0.0, 4.0, np.nan, [west, beside], [], [way])
    assert pockets(walls, floor) == []


def test_a_bench_is_found_where_chairs_hide_the_floor_before_it():
    walls, front, floor = facade_rooms(0.9)
    (pocket,) = pockets(walls, floor.difference(box(0, 0, 3.5, 1.3)))
    assert pocket.fronts == [front]


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("nudge_m", [-1e-9, 0.0, 1e-9])
def test_a_house_behind_either_end_of_a_wall_tells_that_it_is_not_the_last(mirrored, nudge_m):
    """The wall shows as far to the left of a room as to the right; the house is behind one side."""
    sign = -1 if mirrored else 1
    front = stretch(-2, 0.9, 2, 0.9, planar=True)
    beside = [stretch(-8, 0, -3 + nudge_m, 0, planar=True), stretch(3, 0, 8, 0, planar=True)]
    across = sorted([sign * 4.0, sign * 7.0])
    house = stretch(across[0], -4, across[1], -4, planar=True)
    hidden = box(-2, 0, 2, 0.9)
    faces = PlanFaces([front, *beside, house])
    assert not stands_before_facade(front, hidden, faces, 1.0)
    assert stands_before_facade(front, hidden, PlanFaces([front, *beside]), 1.0)


@pytest.mark.parametrize(("behind_m", "is_before"), [(0.28, True), (0.32, False)])
def test_ground_that_goes_on_behind_a_facade_is_not_before_it(behind_m, is_before):
    front, *facade = (
        stretch(*ends, planar=True) for ends in [(-2, 0.9, 2, 0.9), (-8, 0, -3, 0), (3, 0, 8, 0)]
    )
    hidden = box(-2, -behind_m, 2, 0.9)
    assert stands_before_facade(front, hidden, PlanFaces([front, *facade]), 1.0) == is_before


def test_ground_is_not_told_of_where_no_front_is():
    """Behind a wall 0.3 m thick, as all are, there is no room for anything."""
    walls, front, floor = facade_rooms(0.3)
    found = find_pockets(walls, floor, unpaired_m=0.3, max_thickness_m=0.6, max_depth_m=1.0)
    assert all(front in pocket.fronts for pocket in found)


def test_piers_between_niches_stay():
    """An outer wall with four piers of 1.4 m and three niches of 1.6 m, 0.5 m deep."""
    piers = [(3.0 * k, 0, 3.0 * k + 1.4, 0) for k in range(4)]
    niches = [(3.0 * k + 1.4, -0.5, 3.0 * k + 3, -0.5) for k in range(3)]
    sides = [(x, y0, x, y1) for k in range(3) for x, y0, y1 in
             [(3.0 * k + 1.4, 0, -0.5), (3.0 * k + 3, -0.5, 0)]]  # fmt: skip
    around = [(10.4, 0, 10.4, 4), (10.4, 4, 0, 4), (0, 4, 0, 0)]
    floor = shapely.union_all(
        [box(0, 0, 10.4, 4), *(box(x0, -0.5, x1, 0) for x0, _, x1, _ in niches)]
    )
    walls = [wall([face]) for face in [*piers, *niches, *sides, *around]]
    middle = [walls[1].left[0], walls[2].left[0]]
    assert not any(face in pocket.fronts for pocket in pockets(walls, floor) for face in middle)


def kitchen(depth_m, ends_m=(1.0, 4.0)):
    """A row between walls of a room of 5 m, as long as the wall that shows on both sides of it."""
    first_m, last_m = ends_m
    faces = [(last_m, 4, last_m, 4 - depth_m), (first_m, 4 - depth_m, first_m, 4)]
    front = (last_m, 4 - depth_m, first_m, 4 - depth_m)
    beside = [(5, 4, last_m, 4), (first_m, 4, 0, 4)]
    # what else lies in the front's line on one side reaches as far as the wall does
    in_line = (-1, 4 - depth_m, -2, 4 - depth_m)
    walls = [wall([face]) for face in [*ROOM, *beside, *faces, front, in_line]]
    return walls, box(0, 0, 5, 4).difference(box(first_m, 4 - depth_m, last_m, 4))


@pytest.mark.parametrize(
    ("depth_m", "ends_m", "n_pockets"),
    [(0.6, (1.0, 4.0), 1), (0.25, (1.0, 4.0), 0), (1.4, (1.0, 4.0), 0), (0.6, (0.2, 4.0), 0)],
    ids=["row", "pier_between_niches", "shaft", "one_side"],
)
def test_before_a_wall_that_goes_on_on_both_sides_stands_furniture(depth_m, ends_m, n_pockets):
    walls, floor = kitchen(depth_m, ends_m)
    found = [pocket for pocket in pockets(walls, floor) if walls[-2].left[0] in pocket.fronts]
    assert len(found) == n_pockets


def test_a_front_is_as_far_from_a_wall_as_from_the_nearest_of_its_pieces():
    """The wall reaches 10 m; its long piece is 11 m from the front, a short tilted one 4 m."""
    pieces = [(14, 0, 17, 0), (7, -0.03, 8, 0.03)]
    around = [(17, 0, 17, 4), (17, 4, 0, 4), (0, 4, 0, 0.6), (0, -3, 17, -3)]
    front, side = (wall([face]) for face in [(0, 0.6, 3, 0.6), (3, 0.6, 3, 0)])
    floor = box(0, 0, 17, 4).difference(box(0, 0, 3, 0.6))
    walls = [*(wall([face]) for face in [*pieces, *around]), front, side]
    (pocket,) = [one for one in pockets(walls, floor) if front.left[0] in one.fronts]
    assert side.left[0] in pocket.fronts


def divided_room(east_m, *, has_door):
    """A room that a partition divides, seen from the south, from x = 0 to `east_m`.

    From the north both of its pieces stand before ground that no scan saw.
    """
    pieces = [(east_m, 4, 3, 4), (2, 4, 0, 4)]
    apart = (
        [wall(pieces, openings=[(east_m - 3, east_m - 2)])]
        if has_door
        else [wall([piece]) for piece in pieces]
    )
    hidden = [shapely.Polygon([(0, 4), (1.9, 4), (1.4, 4.6), (0, 4.8)])]
    hidden.append(shapely.Polygon([(3.1, 4), (east_m, 4), (east_m, 4.8), (3.6, 4.6)]))
    sides = [[(5, 0, 5, 4), (5, 4.8, 5, 8)], [(0, 8, 0, 4.8), (0, 4, 0, 0)]]
    floor = box(0, 0, 5, 8).difference(shapely.union_all(hidden))
    ends = [(0, 0, 5, 0), (5, 8, 0, 8)]
    return [*(wall([face]) for face in ends), *map(wall, sides), *apart], floor


@pytest.mark.parametrize(
    ("east_m", "has_door", "n_fronts"), [(5.0, True, 0), (4.2, True, 0), (4.2, False, 2)]
)
def test_a_partition_with_a_door_that_meets_a_wall_is_no_cupboard(east_m, has_door, n_fronts):
    found = pockets(*divided_room(east_m, has_door=has_door))
    assert sum(len(pocket.fronts) for pocket in found) == n_fronts
