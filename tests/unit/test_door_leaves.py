"""How doors open on the regular drawing, by leaves that were seen standing open."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.sheet.leaves import Leaves, Swing, draw_swing, find_leaves, hang_leaves
from scanplan.exports.sheet.marks import Symbol, flatten
from scanplan.exports.sheet.openings import draw_things, find_swings, list_symbols
from scanplan.exports.sheet.symbols import symbol_paths

# a wall of 0.2 m along y = 0, a door from x = 1 to 2
DOOR = Symbol("door", np.array([[1.0, 0.0], [2.0, 0.0]]), 0.2, "door-0", "")
WALL = shapely.union(shapely.box(0, -0.1, 1, 0.1), shapely.box(2, -0.1, 3, 0.1))


def leaf(x, y, to_x, to_y):
    return Leaves(np.array([[[x, y], [to_x, to_y]]], float), np.zeros(1, bool))


def hang_one(door, seen, walls):
    """One door as it is drawn."""
    (drawn,) = hang_leaves([door], seen, walls)
    return drawn


@pytest.mark.parametrize(
    ("seen", "tip"),
    [
        # hinged at either jamb, to either side: the tip of a leaf at right angles to the wall
        (leaf(1, 0.05, 1, 0.95), (1, 1.1)),
        (leaf(2, 0.95, 2, 0.05), (2, 1.1)),
        (leaf(1, -0.05, 1.2, -0.9), (1, -1.1)),
        (leaf(2, -0.05, 1.8, -0.9), (2, -1.1)),
    ],
)
def test_a_door_swings_as_its_leaf_stood(seen, tip):
    swing = hang_one(DOOR, seen, WALL)
    assert swing.kind == "swing" and swing.width_m == pytest.approx(1)
    opened, way = (flatten(path) for path in symbol_paths(swing))
    # from the face of the wall at the jamb
    np.testing.assert_allclose(opened[-1], tip, atol=1e-9)
    np.testing.assert_allclose(opened[0], [tip[0], np.sign(tip[1]) * 0.1], atol=1e-9)
    # to the other jamb, a quarter around the hinge
    np.testing.assert_allclose(way[[0, -1]], [tip, [3 - tip[0], opened[0][1]]], atol=1e-9)
    np.testing.assert_allclose(np.hypot(*(way - opened[0]).T), 1, atol=1e-9)
    # its wall stays where it is
    np.testing.assert_allclose(np.sort(swing.axis_m, axis=0), DOOR.ends_m, atol=1e-9)


def test_a_wide_door_has_two_leaves():
    wide = Symbol("door", np.array([[2.0, 0.0], [4.0, 0.0]]), 0.2, "door-0", "")
    swing = hang_one(wide, leaf(4, 0, 4, 0.95), shapely.Polygon())
    assert swing.block == "SWING-2"
    tips = [flatten(path)[-1] for path in symbol_paths(swing)][::2]
    np.testing.assert_allclose(tips, [[2, 1.1], [4, 1.1]], atol=1e-9)


@pytest.mark.parametrize(
    "seen",
    [
        leaf(1, 0, 1.9, 0.0),  # shut
        leaf(1.5, 0.1, 1.5, 1.0),  # at no jamb
        leaf(1, 0, 1, 0.4),  # too short
        Leaves(np.empty((0, 2, 2)), np.empty(0, bool)),
    ],
)
def test_a_door_whose_leaf_was_not_seen_open_is_a_plain_opening(seen):
    assert hang_one(DOOR, seen, WALL) is DOOR


@pytest.mark.parametrize(
    ("in_the_way", "tip"),
    [
        (shapely.box(1.3, 0.95, 1.6, 2), (2 - 0.5**0.5, 0.1 + 0.5**0.5)),
        # a frame is: 0.1 m of the leaf
        (shapely.box(1.95, 0.6, 2.1, 0.69), (2, 1.1)),
    ],
)
def test_a_door_is_drawn_ajar_where_a_wall_stands_in_its_way(in_the_way, tip):
    walls = shapely.union(WALL, in_the_way)
    swing = hang_one(DOOR, leaf(2, 0.05, 2, 0.95), walls)
    assert swing.kind == "swing" and swing.is_hinged
    opened, way = (flatten(path) for path in symbol_paths(swing))
    np.testing.assert_allclose(opened, [(2, 0.1), tip], atol=1e-9)
    np.testing.assert_allclose(way[[0, -1]], [tip, (1, 0.1)], atol=1e-9)
    np.testing.assert_allclose(np.hypot(*(way - opened[0]).T), 1, atol=1e-9)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_of_two_leaves_that_hangs_in_a_door_that_no_wall_is_in_the_way_of(order):
    walls = shapely.union(WALL, shapely.box(0.9, 0.4, 2.1, 0.6))
    both = np.concatenate([leaf(2, 0.05, 2, 0.95).lines_m, leaf(1, -0.05, 1, -0.95).lines_m])
    seen = Leaves(both[list(order)], np.zeros(2, bool))
    assert hang_one(DOOR, seen, walls).ends_m[0, 1] == pytest.approx(-0.1)


def test_a_leaf_that_goes_through_a_wall_hangs_in_no_door_but_one_a_person_has_seen():
    walls = shapely.union(WALL, shapely.box(0.9, 0.4, 2.1, 0.6))
    seen = leaf(2, 0.05, 2, 0.95)
    assert hang_one(DOOR, seen, walls) is DOOR
    corrected = replace(DOOR, facts={"corrected": "swing"})
    assert hang_one(corrected, seen, walls).block == "SWING-RIGHT"


def beside(low_m, width_m, number=1):
    """A door further along the wall."""
    ends_m = np.array([[low_m, 0.0], [low_m + width_m, 0.0]])
    return Symbol("door", ends_m, 0.2, f"door-{number}", "")


def swings(doors, *lines_m):
    seen = Leaves(np.array(lines_m, float).reshape(-1, 2, 2), np.zeros(len(lines_m), bool))
    return [door.block for door in hang_leaves(doors, seen, shapely.Polygon())]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_leaf_hangs_in_the_one_of_two_doors_that_it_fits(order):
    """Doors of 1.0 and 0.6 m, whose jambs are 0.1 m apart; a leaf of 0.7 m, in the middle."""
    doors = [DOOR, beside(2.1, 0.6)]
    found = swings([doors[row] for row in order], [(2.05, 0), (2.05, 0.7)])
    assert [found[row] for row in order] == ["", "SWING-LEFT"]


def test_two_leaves_hang_so_that_both_doors_have_theirs():
    """A leaf in the middle fits both doors; the one at the first's other jamb fits it alone."""
    doors = [DOOR, beside(2.1, 1.0)]
    between = [(2.04, 0), (2.04, 1.1)]
    assert swings(doors, between) == ["SWING-RIGHT", ""]
    assert swings(doors, between, [(1.1, 0), (1.1, 1.1)]) == ["SWING-LEFT", "SWING-LEFT"]


def test_a_leaf_much_longer_than_a_door_does_not_hang_in_it():
    assert swings([beside(1.0, 0.8)], [(1, 0), (1, 0.9)]) == ["SWING-LEFT"]
    assert swings([beside(1.0, 0.8)], [(1, 0), (1, 1.6)]) == [""]


def test_both_leaves_of_a_wide_door_are_its_own():
    wide = beside(1.0, 1.8)
    found = swings([wide, beside(2.9, 0.9)], [(1, 0), (1, 1.0)], [(2.8, 0), (2.8, 1.0)])
    assert found == ["SWING-2", ""]


@pytest.mark.parametrize(
    ("outline", "kind", "is_drawn"),
    [
        # the door between the rooms is 0.9 m wide, from y = 1 to 1.9; its leaf stands in the east
        (shapely.box(4.1, 0.98, 4.98, 1.02), "leaf", False),
        (shapely.Polygon([(4.1, 1.0), (4.8, 1.6), (4.78, 1.63), (4.08, 1.03)]), "leaf", False),
        (shapely.box(4.2, 0.97, 4.9, 1.04), "furniture", False),
        (shapely.box(4.4, 1.3, 4.8, 1.6), "furniture", True),
        (shapely.box(5.5, 0.98, 6.4, 1.02), "leaf", True),
        (shapely.box(4.2, 0.97, 4.9, 1.04), "column", True),
    ],
)
def test_what_a_swing_shows_is_not_drawn_once_more(outline, kind, is_drawn):
    hung = shapely.box(4.1, 0.98, 4.98, 1.02)
    columns = floorplan_making.furniture([hung, outline], "leaf")
    columns["kind"][1] = kind
    plan = floorplan_making.plan(furniture=columns)
    symbols = list_symbols(plan)
    assert [symbol.kind for symbol in symbols] == ["door", "swing", "window"]
    drawn = [mark.facts["furniture"] for mark in draw_things(plan, symbols)]
    assert drawn == [columns["furniture"][1]] * is_drawn
    # without a leaf that stands at the door all is drawn
    shut = floorplan_making.furniture([outline], "furniture")
    assert len([*draw_things(floorplan_making.plan(furniture=shut), symbols[:1])]) == 1


def test_leaves_are_middle_lines_of_their_outlines():
    outline = shapely.box(0, 0, 0.04, 0.9)
    furniture = floorplan_making.furniture([outline], "leaf")
    ends_m = find_leaves(furniture).lines_m[0]
    np.testing.assert_allclose(sorted(ends_m.tolist()), [[0.02, 0.0], [0.02, 0.9]])
    assert find_leaves(floorplan_making.furniture()).lines_m.shape == (0, 2, 2)


def test_a_door_opens_in_the_regular_drawing_as_in_the_measured_one():
    """Of two leaves of 0.98 and 1.05 m the first fits a door of 0.9 m, the other one of 0.95 m."""
    leaves = [shapely.box(4.1, 0.98, 5.08, 1.02), shapely.box(2.95, 0.98, 4.0, 1.02)]
    measured = floorplan_making.plan(furniture=floorplan_making.furniture(leaves, "leaf"))
    regular, _ = draft_plan(measured, DraftSettings(0.05, (), (0.95,), (), 0.3))
    assert regular.openings["width_m"][1] == pytest.approx(0.95)
    swings = find_swings(measured)
    assert swings.keys() == {1} and find_swings(regular) == swings
    # whatever becomes of the leaves
    bare = replace(regular, furniture=floorplan_making.furniture())
    assert find_swings(bare) == swings


@pytest.mark.parametrize("block", ["SWING-LEFT", "SWING-LEFT-45"])
def test_a_door_whose_way_is_known_opens_no_wider_than_walls_let_it(block):
    swing = Swing(block)
    in_the_way = shapely.union(WALL, shapely.box(0.8, 0.9, 1.4, 2))
    drawn = [draw_swing(DOOR, swing, walls).block for walls in (WALL, in_the_way)]
    assert drawn == [block, "SWING-LEFT-45"]
    # where it cannot be, it is all the same
    assert draw_swing(DOOR, swing, shapely.box(0, 0, 3, 3)).block == block
    assert draw_swing(DOOR, Swing(""), WALL) is DOOR
