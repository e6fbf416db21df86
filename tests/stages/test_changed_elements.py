"""Walls that are moved or furniture, openings of another size, rooms that are parted or one."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from helpers import floorplan_making
from helpers.correcting import MADE, corrected, faces_of, write_plan
from helpers.refusals import assert_told, refused
from scanplan.plan import floorplan, planning
from scanplan.store import schemas, tables

ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
BETWEEN = [4.05, 0.4]  # on the wall between the rooms, of 0.1 m, with a door from 1.0 to 1.9


@pytest.fixture
def plan(tmp_path):
    return write_plan(tmp_path)


def row_of(columns, element, number):
    (row,) = np.flatnonzero(columns[element] == number)
    return {name: values[row] for name, values in columns.items()}


def ends_of(row):
    return [row[name] for name in ENDS]


def test_a_wall_moves_with_its_faces_and_its_door_stays_where_it_was_along_it(plan):
    line = [[4.55, -0.1], [4.55, 3.1]]
    found = corrected(plan, {"element": "wall", "at": BETWEEN, "line": line})
    wall = row_of(found.walls, "wall", 5)
    assert ends_of(wall) == pytest.approx([4.55, -0.1, 4.55, 3.1])
    assert wall["corrected"] == "drawn by hand" and np.isnan(wall["sigma_offset_m"])
    np.testing.assert_allclose(sorted(faces_of(found, 5)[:, 0, 0]), [4.5, 4.6])
    assert ends_of(row_of(found.openings, "opening", 1)) == pytest.approx([4.55, 1.0, 4.55, 1.9])


@pytest.mark.parametrize(
    ("entry", "is_drawn"),
    [
        ({"element": "opening", "at": [4.1, 1.4], "swing": [4.5, 1.2]}, False),
        ({"element": "opening", "at": [4.1, 1.4], "kind": "passage"}, False),
        ({"element": "opening", "at": [4.1, 1.4], "lintel_m": 2.1}, False),
        ({"element": "opening", "at": [4.1, 1.4], "width_m": 0.8}, True),
        ({"element": "opening", "at": [4.1, 1.4], "line": [[4.05, 1.1], [4.05, 2.0]]}, True),
        ({"element": "wall", "at": BETWEEN, "height_m": 1.2}, False),
        ({"element": "opening", "at": [4.1, 1.4], "action": "remove"}, False),
        ({"element": "wall", "at": BETWEEN, "thickness_m": 0.112}, True),
    ],
)
def test_a_wall_or_opening_says_whether_a_person_drew_it(plan, entry, is_drawn):
    found = corrected(plan, entry)
    said = [*found.walls["corrected"], *found.openings["corrected"]]
    (word,) = [word for word in said if word]
    assert word.startswith(schemas.DRAWN) == is_drawn


def test_faces_reach_to_the_ends_of_a_wall_that_is_made_longer_or_shorter(plan):
    # the faces ended 0.1 m before the wall's ends
    shorter = {"element": "wall", "at": BETWEEN, "line": [[4.05, 2.5], [4.05, 0.5]]}
    found = corrected(plan, shorter)
    spans = np.sort(faces_of(found, 5)[:, :, 1], axis=1)
    np.testing.assert_allclose(spans, [[0.6, 2.4]] * 2)
    assert row_of(found.openings, "opening", 1)["width_m"] == pytest.approx(0.9)


def test_an_opening_beyond_the_new_end_of_its_wall_is_gone(plan):
    found = corrected(plan, {"element": "wall", "at": BETWEEN, "line": [[4.05, 2.1], [4.05, 3.1]]})
    assert found.openings["opening"].tolist() == [0, 2]


def test_a_thickness_is_around_the_middle_of_a_wall_seen_from_both_sides(plan):
    found = corrected(plan, {"element": "wall", "at": BETWEEN, "thickness_m": 0.3})
    wall = row_of(found.walls, "wall", 5)
    assert wall["thickness_m"] == 0.3 and wall["x0_m"] == 4.05
    np.testing.assert_allclose(sorted(faces_of(found, 5)[:, 0, 0]), [3.9, 4.2])
    assert row_of(found.openings, "opening", 1)["thickness_m"] == 0.3
    assert row_of(found.openings, "opening", 0)["thickness_m"] == 0.2


def test_a_thickness_is_behind_the_only_side_that_was_seen(plan):
    # the face at x = 7.1 looks west, to the left of its wall
    found = corrected(plan, {"element": "wall", "at": [7.1, 1.0], "thickness_m": 0.36})
    wall = row_of(found.walls, "wall", 1)
    assert ends_of(wall) == pytest.approx([7.28, -0.1, 7.28, 3.1])
    np.testing.assert_allclose(sorted(faces_of(found, 1)[:, 0, 0]), [7.1, 7.46])
    assert found.solid("observed").covers(shapely.Point(7.3, 1.5))
    assert wall["face_left"] == 1 and wall["face_right"] in found.faces["face"]


@pytest.fixture
def revealed(plan):
    """The east wall 0.4 m thick by the reveals of a window from y = 1 to 2 m."""
    walls, faces, openings = (
        {name: column.copy() for name, column in MADE[table]().items()}
        for table in ("walls", "faces", "openings")
    )
    for name, value in {"x0_m": 7.3, "x1_m": 7.3, "thickness_m": 0.4}.items():
        walls[name][1] = value
    rows = [*floorplan_making.FACES, (7.5, 3, 7.5, 2, 1), (7.5, 1, 7.5, 0, 1),
            (7.5, 1, 7.1, 1, 1), (7.1, 2, 7.5, 2, 1)]  # fmt: skip
    faces = floorplan_making.faces(rows)
    ends = {"x0_m": 7.3, "y0_m": 1.0, "x1_m": 7.3, "y1_m": 2.0}
    known = {"type": "window", "width_m": 1.0, "thickness_m": 0.4, "room_a": 1, "room_b": -1}
    window = {"opening": 3, "wall": 1, **ends, **known}
    openings = {
        name: np.append(column, np.array([window.get(name, column[0])], column.dtype))
        for name, column in openings.items()
    }
    for name, columns in {"walls": walls, "faces": faces, "openings": openings}.items():
        tables.write_table(plan[name], planning.TABLES[name], columns)
    return plan


def test_a_thickness_of_a_wall_known_by_reveals_is_behind_its_only_side(revealed):
    found = corrected(revealed, {"element": "wall", "at": [7.2, 0.5], "thickness_m": 0.3})
    wall = row_of(found.walls, "wall", 1)
    assert (wall["thickness_m"], wall["x0_m"]) == pytest.approx((0.3, 7.25))
    x_m = faces_of(found, 1)[:, :, 0]
    # the side that was seen stays, what was inferred behind it and both reveals follow
    assert sorted(map(sorted, x_m.tolist())) == [
        pytest.approx(of) for of in ([7.1, 7.1], [7.1, 7.4], [7.1, 7.4], [7.4, 7.4], [7.4, 7.4])
    ]


@pytest.mark.parametrize("thickness_m", [0.8, 1.0])
def test_a_wall_that_is_twice_as_thick_or_more_grows_behind_as_well(revealed, thickness_m):
    found = corrected(revealed, {"element": "wall", "at": [7.2, 0.5], "thickness_m": thickness_m})
    x_m = np.sort(faces_of(found, 1)[:, :, 0], axis=1)
    back_m = 7.1 + thickness_m
    assert sorted(x_m.ravel().tolist()) == pytest.approx([7.1] * 4 + [back_m] * 6)


def test_a_wall_of_one_side_is_gone_with_it_whatever_lay_behind(revealed):
    found = corrected(revealed, {"element": "face", "at": [7.1, 0.5], "action": "remove"})
    assert 1 not in found.walls["wall"] and not len(faces_of(found, 1))
    assert 3 not in found.openings["opening"]


def test_a_window_that_is_none_has_no_reveals(revealed):
    found = corrected(revealed, {"element": "opening", "at": [7.3, 1.5], "action": "remove"})
    lines_m = faces_of(found, 1)
    assert np.allclose(lines_m[:, 0, 0], lines_m[:, 1, 0])
    outer = lines_m[np.isclose(lines_m[:, 0, 0], 7.5)]
    assert shapely.union_all(shapely.linestrings(outer)).length == pytest.approx(3)


@pytest.mark.parametrize("kind", ["furniture", "column"])
def test_what_is_no_wall_becomes_what_it_is(plan, kind):
    found = corrected(plan, {"element": "wall", "at": BETWEEN, "kind": kind})
    assert 5 not in found.walls["wall"] and 1 not in found.openings["opening"]
    path = plan["walls"].parent / "corrected/furniture.parquet"
    pieces = tables.read_table(path, planning.TABLES["furniture"])
    assert pieces["kind"].tolist() == ["furniture", kind]
    ground = shapely.from_wkb(pieces["geometry"][1])
    assert ground.equals(shapely.box(4.0, -0.1, 4.1, 3.1))
    assert pieces["area_m2"][1] == pytest.approx(0.32)


def test_an_opening_is_as_wide_and_as_high_as_a_person_says(plan):
    said = {"width_m": 1.1, "sill_m": 0.1, "lintel_m": 2.2, "kind": "glass"}
    found = corrected(plan, {"element": "opening", "at": [4.05, 1.4], **said})
    door = row_of(found.openings, "opening", 1)
    assert {name: door["type" if name == "kind" else name] for name in said} == said
    # about its middle, 1.45
    assert ends_of(door) == pytest.approx([4.05, 0.9, 4.05, 2.0])
    spans = np.sort(faces_of(found, 5)[:, :, 1], axis=1)
    assert not ((spans[:, 0] < 1.4) & (spans[:, 1] > 1.4)).any()


def test_an_opening_moves_along_its_wall_which_closes_behind_it(plan):
    entry = {"element": "opening", "at": [4.05, 1.4], "line": [[4.2, 2.0], [3.9, 2.9]]}
    found = corrected(plan, entry)
    door = row_of(found.openings, "opening", 1)
    assert ends_of(door) == pytest.approx([4.05, 2.0, 4.05, 2.9])
    assert found.solid("observed").covers(shapely.Point(4.05, 1.2))
    assert not found.solid("observed").covers(shapely.Point(4.05, 2.5))


def test_an_opening_is_not_moved_off_its_wall(plan):
    found = corrected(plan, {"element": "opening", "at": [4.05, 1.4], "line": [[4, 5], [4, 6]]})
    (why,) = found.unmatched_corrections
    assert_told(why, value=("entry 1", "opening 1", "2.9 m", "wall 5"))
    assert row_of(found.openings, "opening", 1)["corrected"] == ""


def test_a_face_that_is_right_needs_no_other_to_verify_its_wall(plan):
    found = corrected(plan, {"element": "face", "at": [5.6, 3.0], "action": "keep"})
    assert row_of(found.walls, "wall", 2)["corrected"] == "kept by hand"
    assert not found.walls["verify"].any()


def test_a_single_face_that_is_right_is_a_wall_of_one_side(plan):
    found = corrected(plan, {"element": "face", "at": [2.5, 2.0], "action": "keep"})
    wall = row_of(found.walls, "wall", 6)
    assert (wall["face_left"], wall["face_right"], wall["state"]) == (8, -1, "observed")
    assert np.isnan(wall["thickness_m"]) and row_of(found.faces, "face", 8)["wall"] == 6


def test_a_wall_without_one_of_its_faces_is_seen_from_the_other_side(plan):
    found = corrected(plan, {"element": "face", "at": [4.1, 2.5], "action": "remove"})
    wall = row_of(found.walls, "wall", 5)
    assert (wall["face_left"], wall["face_right"]) == (5, -1)
    assert np.isnan(wall["thickness_m"]) and ends_of(wall) == pytest.approx([4, -0.1, 4, 3.1])
    assert row_of(found.openings, "opening", 1)["x0_m"] == pytest.approx(4)


def test_with_its_only_face_a_wall_goes(plan):
    found = corrected(plan, {"element": "face", "at": [7.1, 1.5], "action": "remove"})
    assert 1 not in found.walls["wall"] and 1 not in found.faces["face"]


def test_a_room_is_parted_by_a_line_that_is_drawn_nearly_from_wall_to_wall(plan):
    found = corrected(
        plan,
        {"element": "room", "action": "split", "line": [[1.5, 0.3], [1.5, 2.8]]},
        {"element": "room", "at": [0.5, 1.5], "name": "Store", "number": "0.01"},
        {"element": "room", "at": [3.0, 1.5], "name": "Hall"},
    )
    assert found.rooms["area_m2"] == pytest.approx([7.5, 9.0, 4.5])
    assert found.room_labels == ["Hall", "Room 1", "0.01 Store"]
    assert found.room_numbers == ["0", "1", "0.01"]
    # the entrance in the west is the new room's, the door in the east stays the other's
    sides = {n: (a, b) for n, a, b in zip(*(found.openings[c].tolist() for c in
             ("opening", "room_a", "room_b")), strict=True)}  # fmt: skip
    assert sides == {0: (2, -1), 1: (0, 1), 2: (0, -1), 3: (0, 2)}
    passage = row_of(found.openings, "opening", 3)
    assert (passage["type"], passage["wall"]) == ("passage", -1)
    assert passage["width_m"] == pytest.approx(3.0)


@given(x_m=st.floats(0.3, 3.7), lean=st.floats(-0.2, 0.2))
@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_parts_of_a_room_make_up_the_room(plan, x_m, lean):
    line = [[x_m - lean, 0.0], [x_m + lean, 3.0]]
    found = corrected(plan, {"element": "room", "action": "split", "line": line})
    one, other = found.areas[0], found.areas[2]
    assert one.area + other.area == pytest.approx(12.0) and one.area >= other.area
    assert one.intersection(other).area == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ([[1.0, 1.5], [2.0, 1.5]], "does not part the room from wall to wall"),
        ([[0.5, 2.98], [3.5, 2.98]], "does not part the room from wall to wall"),
        ([[20, 20], [21, 20]], "lies in no room"),
    ],
)
def test_a_line_that_parts_no_room_is_told(plan, line, why):
    found = corrected(plan, {"element": "room", "action": "split", "line": line})
    assert why in found.unmatched_corrections[0] and len(found.rooms["room"]) == 2


def test_rooms_are_one_where_the_wall_between_them_is_gone(plan):
    found = corrected(
        plan,
        {"element": "wall", "at": BETWEEN, "action": "remove"},
        {"element": "room", "action": "merge", "at": [1, 1], "with": [6, 1]},
        {"element": "room", "at": [6, 1], "name": "Hall"},
    )
    assert found.room_names == ["Hall"]
    assert found.areas[0].equals(shapely.box(0, 0, 7.1, 3))
    assert found.rooms["area_m2"] == pytest.approx([21.3])


def test_rooms_are_one_through_an_opening_and_their_wall_stays(plan):
    found = corrected(plan, {"element": "room", "action": "merge", "at": [6, 1], "with": [1, 1]})
    assert found.rooms["room"].tolist() == [1]
    # both, and the ground of the door, 0.9 by 0.1
    assert found.rooms["area_m2"] == pytest.approx([21.09], abs=0.01)
    assert set(found.openings["room_a"].tolist()) == {1}


def test_what_was_parted_may_be_one_again(plan):
    split = {"element": "room", "action": "split", "line": [[1.5, 0.3], [1.5, 2.8]]}
    merge = {"element": "room", "action": "merge", "at": [3, 1], "with": [1, 1]}
    found = corrected(plan, split, merge)
    assert found.areas[0].equals(shapely.box(0, 0, 4, 3))
    assert found.openings["opening"].tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        ({"at": [1, 1], "with": [2, 2]}, "in one room with the other place"),
        ({"at": [1, 1], "with": [20, 2]}, "lies in no room"),
    ],
)
def test_rooms_that_cannot_be_one_are_told(plan, entry, why):
    found = corrected(plan, {"element": "room", "action": "merge", **entry})
    assert why in found.unmatched_corrections[0]


def test_a_wall_without_a_door_keeps_rooms_apart(plan):
    found = corrected(
        plan,
        {"element": "opening", "at": [4.05, 1.4], "action": "remove"},
        {"element": "room", "action": "merge", "at": [1, 1], "with": [6, 1]},
    )
    assert "parted from the other room by a wall; remove that" in found.unmatched_corrections[0]


def test_two_things_said_of_one_wall_end_in_one_line(plan):
    with refused(value=("wall 5", "entry 1")):
        corrected(
            plan,
            {"element": "wall", "at": BETWEEN, "thickness_m": 0.2},
            {"element": "wall", "at": [4.05, 2.5], "action": "remove"},
        )


def test_the_corrected_plan_has_what_every_plan_has(plan):
    found = corrected(
        plan,
        {"element": "wall", "at": BETWEEN, "line": [[4.3, 0], [4.3, 3]], "thickness_m": 0.2},
        {"element": "face", "at": [2.5, 2.0], "action": "keep"},
        {"element": "room", "action": "split", "line": [[1.5, 0], [1.5, 3]]},
    )
    for columns, name in ((found.walls, "wall"), (found.faces, "face"), (found.rooms, "room")):
        assert len(set(columns[name].tolist())) == len(columns[name])
    lengths = np.hypot(*np.diff(floorplan.centrelines_m(found.faces), axis=1)[:, 0].T)
    assert (lengths > 0).all()
    np.testing.assert_allclose(np.hypot(found.faces["nx"], found.faces["ny"]), 1)
