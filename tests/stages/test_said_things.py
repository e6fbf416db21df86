"""Heights, leaves, furniture, uses, settled rooms and taped lengths on the plan of two rooms."""

import json

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.correcting import corrected, write_plan
from scanplan.exports.sheet.leaves import find_leaves
from scanplan.exports.sheet.openings import find_swings
from scanplan.report.wording import state_lengths
from scanplan.store import schemas, tables


@pytest.fixture
def plan(tmp_path):
    return write_plan(tmp_path)


def test_a_wall_ends_as_high_as_said(plan):
    found = corrected(plan, {"element": "wall", "at": [4.05, 0.5], "height_m": 1.2})
    assert found.heights_m.tolist() == [2.5, 2.5, 2.5, 2.5, 2.5, 1.2]


@pytest.mark.parametrize(
    ("opens", "end", "block"),
    [([3.2, 1.0], [3.15, 1.0], "SWING-LEFT"), ([5.0, 1.9], [4.95, 1.9], "SWING-LEFT"),
     ([3.2, 1.9], [3.15, 1.9], "SWING-RIGHT")],
)  # fmt: skip
def test_a_leaf_hangs_at_the_nearer_jamb_on_the_side_of_the_place(plan, opens, end, block):
    found = corrected(plan, {"element": "opening", "at": [4.05, 1.45], "swing": opens})
    (leaf_m,) = find_leaves(found.furniture).lines_m
    hinge = [4.05, opens[1]]
    assert sorted(np.round(leaf_m, 3).tolist()) == sorted([hinge, end])
    assert find_swings(found)[1].block == block


def test_a_leaf_of_a_window_is_told(plan):
    found = corrected(plan, {"element": "opening", "at": [1.6, -0.1], "swing": [1, 1]})
    (told,) = found.unmatched_corrections
    assert "opening 2 is a window" in told and len(found.furniture["kind"]) == 1


def test_what_stands_about_is_added_moved_renamed_and_removed(plan):
    ground = [[1, 1], [2, 1], [2, 2], [1, 2]]
    add = {"element": "furniture", "action": "add", "outline": ground, "kind": "column"}
    found = corrected(plan, add)
    assert found.furniture["kind"].tolist() == ["furniture", "column"]
    assert found.furniture["area_m2"].tolist() == [0.5, 1.0] and found.n_corrections == 1
    moved = corrected(plan, {"element": "furniture", "at": [3.5, 2.8], "outline": ground})
    assert shapely.from_wkb(moved.furniture["geometry"][0]).equals(shapely.Polygon(ground))
    named = corrected(plan, {"element": "furniture", "at": [3.5, 2.8], "kind": "column"})
    assert named.furniture["kind"].tolist() == ["column"]
    gone = corrected(plan, {"element": "furniture", "at": [3.5, 2.8], "action": "remove"})
    assert len(gone.furniture["kind"]) == 0


def test_who_said_it_stands_on_the_element_and_on_the_plan(plan):
    said = {"by": "A. Bee", "when": "2026-03-01T09:30:00Z"}
    found = corrected(plan, {"element": "room", "at": [5, 1], "use": "store", **said})
    assert found.rooms["use"].tolist() == ["", "store"]
    assert found.rooms["corrected"].tolist() == ["", "changed by hand, A. Bee, 2026-03-01"]
    assert found.corrected_by == "A. Bee, 2026-03-01"


def test_a_settled_room_leaves_the_other_to_be_checked(plan):
    found = corrected(plan, {"element": "room", "at": [1, 1], "action": "settle"})
    # the south wall runs along the larger room for most of its length
    by = ["checked by hand", "", "", "checked by hand", "checked by hand", "checked by hand"]
    assert found.walls["corrected"].tolist() == by
    assert found.walls["verify"].tolist() == [False, False, True, False, False, False]
    assert found.openings["corrected"].tolist() == ["checked by hand"] * 3
    assert found.rooms["corrected"].tolist() == ["checked by hand", ""]


def test_a_room_is_named_and_settled(plan):
    found = corrected(
        plan,
        {"element": "room", "at": [1, 1], "name": "Foyer"},
        {"element": "room", "at": [1, 1], "action": "settle"},
    )
    assert found.room_names == ["Foyer", "Room 1"] and found.n_corrections == 2


def test_what_was_taped_is_held_against_faces(plan, caplog):
    # 4 m from face to face, whatever the ends of the tape are off
    tape = {"element": "length", "action": "add", "line": [[0.1, 1.0], [3.9, 1.0]]}
    found = corrected(plan, tape | {"length_m": 4.004}, tape | {
        "line": [[2.0, 0.05], [2.0, 2.8]], "length_m": 3.1, "sigma_m": 0.003})  # fmt: skip
    # with the tape's error that of two faces, 2 mm each
    sigmas = [np.sqrt(25 + 8) / 1000, np.sqrt(9 + 8) / 1000]
    assert found.taped_m == [
        pytest.approx(of) for of in ([4.0, 4.004, sigmas[0]], [3.0, 3.1, sigmas[1]])
    ]
    told = [line for line in caplog.messages if "were taped" in line]
    assert len([line for line in told if "entry 2: 3.000 m are drawn" in line]) == 1
    assert not any("entry 1: " in line for line in told)
    notes = tables.read_notes(plan["free"].parent / "corrected/free.parquet", schemas.FREE)
    assert len(json.loads(notes["lengths"])) == 2
    # both cannot be a scale
    assert "-4, -100 mm" in state_lengths(found) and "not applied" in state_lengths(found)


def test_a_room_that_goes_around_something_is_parted_by_two_lines(plan):
    # around a core of 1 m x 1 m in the larger room
    ring = shapely.Polygon(shapely.box(0, 0, 4, 3).exterior, [shapely.box(1.5, 1, 2.5, 2).exterior])
    rooms = floorplan_making.rooms([ring, floorplan_making.ROOMS[1]])
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    west = {"element": "room", "action": "split", "line": [[0, 1.4], [1.5, 1.4]]}
    east = {"element": "room", "action": "split", "line": [[2.5, 1.5], [4, 1.5]]}
    found = corrected(plan, west, east)
    assert sorted(found.rooms["area_m2"].round(3)) == [5.35, 5.65, 9.0]
    assert list(found.unmatched_corrections) == [] and found.n_corrections == 2
    assert (found.openings["wall"] == -1).sum() == 2
    (told,) = corrected(plan, west).unmatched_corrections
    assert "does not part the room" in told


def test_a_line_with_a_pillar_at_its_middle_is_carried_out_with_the_other(plan):
    core, pillar = shapely.box(1.5, 1, 2.5, 2), shapely.box(0.6, 1.3, 0.9, 1.5)
    ring = shapely.box(0, 0, 4, 3).difference(shapely.union(core, pillar))
    rooms = floorplan_making.rooms([ring, floorplan_making.ROOMS[1]])
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    west = {"element": "room", "action": "split", "line": [[0, 1.4], [1.5, 1.4]]}
    east = {"element": "room", "action": "split", "line": [[2.5, 1.5], [4, 1.5]]}
    found = corrected(plan, west, east)
    assert list(found.unmatched_corrections) == [] and found.n_corrections == 2
    # west of the pillar, between it and the core, and in the east
    assert sorted(found.openings["width_m"][found.openings["wall"] == -1].round(2)) == [
        0.6, 0.6, 1.5]  # fmt: skip
    # the next line does not find what waited before
    again = {"element": "room", "action": "split", "line": [[2, 2], [2, 3]]}
    assert len(corrected(plan, west, east, again).rooms["room"]) == 4


def test_a_niche_that_a_line_cuts_off_goes_with_its_room(plan):
    # a niche of 0.1 m2 in the south wall, which the line runs along the mouth of
    shape = shapely.union(shapely.box(0, 0, 4, 3), shapely.box(1, -0.2, 1.5, 0))
    rooms = floorplan_making.rooms([shape, floorplan_making.ROOMS[1]])
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    line = [[0, 1.0], [1.6, -0.2]]
    found = corrected(plan, {"element": "room", "action": "split", "line": line})
    assert list(found.unmatched_corrections) == [] and len(found.rooms["room"]) == 3
    assert (found.openings["wall"] == -1).sum() == 1


def test_a_line_that_passes_a_corner_parts_a_room(plan):
    # an L: its line runs a hair above the corner, and on below the bar
    shape = shapely.Polygon([(0, 0), (4, 0), (4, 3), (2, 3), (2, 1), (0, 1)])
    rooms = floorplan_making.rooms([shape, floorplan_making.ROOMS[1]])
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    line = [[2.02, 0.98], [4.0, 0.98]]
    found = corrected(plan, {"element": "room", "action": "split", "line": line})
    assert sorted(found.rooms["area_m2"].round(1)) == [4.0, 4.0, 9.0]


def test_a_line_through_what_stands_in_a_room_parts_it(plan):
    # a shaft of 1 m x 1 m in the middle of the line
    shape = shapely.Polygon(
        shapely.box(0, 0, 4, 3).exterior, [shapely.box(1.5, 1, 2.5, 2).exterior]
    )
    rooms = floorplan_making.rooms([shape, floorplan_making.ROOMS[1]])
    tables.write_table(plan["rooms"], schemas.ROOMS, rooms)
    line = [[0.1, 1.5], [3.9, 1.5]]
    found = corrected(plan, {"element": "room", "action": "split", "line": line})
    assert sorted(found.rooms["area_m2"].round(3)) == [5.5, 5.5, 9.0]
    assert (found.openings["wall"] == -1).sum() == 2


def test_three_lines_to_one_place_make_three_rooms(plan):
    # a star of lines in the larger room, none of which parts it alone
    ends = ([0.0, 0.0], [4.0, 0.0], [2.0, 3.0])
    lines = [{"element": "room", "action": "split", "line": [end, [2.0, 1.0]]} for end in ends]
    found = corrected(plan, *lines)
    # below a triangle of 4 m x 1 m; on both sides of its tip the rest
    assert sorted(found.rooms["area_m2"].round(3)) == [2.0, 5.0, 5.0, 9.0]
    assert list(found.unmatched_corrections) == [] and found.n_corrections == 3
    passages = found.openings["wall"] == -1
    sides = [found.openings[side][passages].tolist() for side in ("room_a", "room_b")]
    assert sorted(map(sorted, zip(*sides, strict=True))) == [[0, 2], [0, 3], [2, 3]]
