"""What a draughtsman leaves out of a plan, and what he does not."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.drafting.scraps import find_nowhere, leave_scraps
from scanplan.exports.sheet.styles import STYLES

SETTINGS = DraftSettings(0.05, (0.1, 0.2), (0.9, 1.0), (1.2,), 0.3)
NEW = 6  # the number of a wall that comes to those of the plan


def with_wall(line, openings=(), **columns):
    """Return the plan with one more wall, seen from its left alone, and openings of it."""
    walls = floorplan_making.walls([*floorplan_making.WALLS, (line, np.nan, 0, -1, "observed")]) | {
        name: np.append(np.ones(NEW), value) for name, value in columns.items()
    }
    rows = [*floorplan_making.OPENINGS]
    made = floorplan_making.openings([*rows, *[(row[0], 0, *row[1:]) for row in openings]])
    made["wall"][len(rows) :] = NEW
    return floorplan_making.plan(walls=walls, openings=made)


@pytest.mark.parametrize(
    ("line", "is_left_out"),
    [
        # the east wall is a facade, its face at 7.1 m: a leaf of a window, open behind it
        ((7.05, 1.0, 8.2, 1.3), True),
        # the same in the room: for the most part before the face
        ((6.3, 1.0, 7.2, 1.3), False),
        # along the facade it is the back of a recess
        ((7.3, 1.0, 7.3, 2.2), False),
        # 3 m beyond it stands by itself
        ((9.5, 1.0, 10.7, 1.3), True),
        # the east side of the wall between the rooms once more, which is 0.1 m thick
        ((4.1, 2.5, 4.1, 0.5), True),
        # and 0.08 m before it, by what faces err by, but not 0.25 m
        ((4.18, 2.5, 4.18, 0.5), True),
        ((4.35, 2.5, 4.35, 0.5), False),
    ],
)
def test_walls_behind_facades_or_in_thicker_ones_are_left_out(line, is_left_out):
    kept = leave_scraps(with_wall(line)).walls["wall"]
    assert (NEW not in kept) == is_left_out
    assert set(range(NEW)) <= set(kept.tolist())


def test_what_is_more_likely_wrong_is_left_out_where_it_ends_loose_and_bounds_no_room():
    loose = (1.0, 1.5, 3.0, 1.5)
    assert NEW in leave_scraps(with_wall(loose, p_true=0.6)).walls["wall"]
    assert NEW not in leave_scraps(with_wall(loose, p_true=0.4)).walls["wall"]
    # along the north side of the first room
    beside = (0.5, 2.98, 3.5, 2.98)
    assert NEW in leave_scraps(with_wall(beside, p_true=0.4)).walls["wall"]


@pytest.mark.parametrize(("length_m", "is_left_out"), [(0.12, True), (0.5, False)])
def test_what_is_hardly_longer_than_its_ends_err_by_is_left_out_in_the_midst_of_a_room(
    length_m, is_left_out
):
    """It hangs on the wall between the rooms; the outline of the first goes around it."""
    end_m = 4.0 - length_m
    nib = shapely.box(end_m, 1.4, 4.0, 1.5)
    plan = with_wall((end_m, 1.5, 4.05, 1.5))
    first = floorplan_making.ROOMS[0].difference(nib)
    plan = replace(plan, rooms=floorplan_making.rooms([first, floorplan_making.ROOMS[1]]))
    left = leave_scraps(plan)
    assert (NEW not in left.walls["wall"]) == is_left_out
    # the room has its ground
    assert left.areas[0].area == pytest.approx(12 if is_left_out else first.area)
    assert left.areas[1].equals(floorplan_making.ROOMS[1])


def test_a_wall_that_is_mostly_a_way_from_a_room_into_itself_goes_with_it():
    line, way = (1.0, 0.6, 3.0, 0.6), (1.3, 0.6, 2.9, 0.6)
    into_itself = with_wall(line, [(way, "passage", 0.0, 2.5, 0, 0)])
    assert find_nowhere(into_itself).tolist() == [False, False, False, True]
    kept = leave_scraps(into_itself)
    assert NEW not in kept.walls["wall"] and 3 not in kept.openings["opening"]
    between = with_wall(line, [(way, "passage", 0.0, 2.5, 0, 1)])
    assert NEW in leave_scraps(between).walls["wall"]


@pytest.mark.parametrize(("width_m", "is_left_out"), [(2.0, True), (1.6, False)])
def test_a_way_from_a_room_into_itself_bounds_no_room(width_m, is_left_out):
    # along the side of a room, 0.8 m off the next walls: 0.4 m are wall, too little for one, or 0.8
    line, way = (0.8, 2.0, 3.2, 2.0), (1.0, 2.0, 1.0 + width_m, 2.0)
    plan = with_wall(line, [(way, "passage", 0.0, 2.5, 0, 0)])
    plan = replace(plan, rooms=floorplan_making.rooms([shapely.box(0, 0, 4, 2)]))
    assert (NEW not in leave_scraps(plan).walls["wall"]) == is_left_out


def poche(plan):
    regular, changes = draft_plan(plan, SETTINGS)
    sheet = compose_presentation(plan, regular, changes)
    parts = [shapely.Polygon(m.paths[0][:, :2], [p[:, :2] for p in m.paths[1:]])
             for m in sheet.marks if m.kind == "poche"]  # fmt: skip
    return shapely.union_all(parts), {symbol.element: symbol.kind for symbol in sheet.symbols}


def test_a_face_behind_a_gap_of_a_facade_closes_a_recess_flush_with_it():
    # a gap of 1.2 m in the east wall, whose face is at 7.1 m, and a face 0.2 m behind it
    gap = ((7.1, 1.0, 7.1, 2.2), 1, "gap", 0.0, 2.5, 1, -1)
    rows = [*floorplan_making.OPENINGS, gap]
    back = with_wall((7.3, 1.0, 7.3, 2.2))
    plan = replace(back, openings=floorplan_making.openings(rows))
    solid, drawn = poche(plan)
    # the assumed 0.3 m end at 7.4 m, where the back of 0.1 m does
    assert solid.bounds[2] == pytest.approx(7.4)
    assert not solid.contains(shapely.Point(7.2, 1.6)) and solid.contains(shapely.Point(7.35, 1.6))
    # for CAD programs alone
    assert drawn["gap-3"] == "recess" and STYLES["recess"].ink == STYLES["recess"].fill == "none"
    # without a back it is a way out
    open_solid, open_drawn = poche(floorplan_making.plan(openings=floorplan_making.openings(rows)))
    assert not open_solid.contains(shapely.Point(7.35, 1.6)) and open_drawn["gap-3"] == "passage"


def test_an_opening_that_a_person_stated_keeps_its_wall():
    plan = with_wall((4.18, 2.9, 4.18, 0.1), [((4.18, 2.6, 4.18, 2.0), "door", 0.0, 2.0, 0, 1)])
    assert NEW not in leave_scraps(plan).walls["wall"]
    stated = np.array(["", "", "", "added"], object)
    kept = leave_scraps(replace(plan, openings={**plan.openings, "corrected": stated}))
    assert NEW in kept.walls["wall"] and 3 in kept.openings["opening"]
