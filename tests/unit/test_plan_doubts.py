"""What is listed of a toy plan's doubts, in which order and words."""

from dataclasses import replace

import numpy as np
import pytest

from helpers import floorplan_making
from scanplan.exports.sheet import composition
from scanplan.plan import floorplan_files
from scanplan.plan.plan_wall import Nearly
from scanplan.store import schemas, tables
from scanplan.validation import doubt_words, doubts


def rated(columns, rows, *, p_true=0.5, about="existence", verify=True):
    """Return a table of which these rows are doubtful, and all others sure."""
    n = len(columns["x0_m"]) if "x0_m" in columns else len(columns["room"])
    chosen = np.isin(np.arange(n), rows)
    return columns | {
        "p_true": np.where(chosen, p_true, 0.9),
        "verify": chosen & verify,
        "about": np.where(chosen, about, "").astype(object),
        "doubt": np.where(chosen, "why", "").astype(object),
    }


def plan(**tables):
    made = {
        "walls": rated(floorplan_making.walls(), []),
        "openings": rated(floorplan_making.openings(), []),
        "rooms": rated(floorplan_making.rooms(), []),
    }
    return floorplan_making.plan(**made | tables)


def test_what_costs_most_if_it_is_wrong_comes_first():
    """A room at 2, a door at 1.7, a wall at 1.4, a window at 1, each as likely wrong as right."""
    made = plan(
        walls=rated(floorplan_making.walls(), [0]),
        openings=rated(floorplan_making.openings(), [0, 2]),
        rooms=rated(floorplan_making.rooms(), [0]),
    )
    found = doubts.list_doubts(made)
    assert [doubt.element for doubt in found] == ["room 0", "opening 0", "wall 0", "opening 2"]
    assert [doubt.cost for doubt in found] == [1.0, 0.85, 0.7, 0.5]


def test_what_is_likelier_wrong_comes_before_what_costs_as_much():
    walls = rated(floorplan_making.walls(), [0, 1])
    walls["p_true"][:2] = (0.6, 0.1)
    found = doubts.list_doubts(plan(walls=walls))
    assert [doubt.element for doubt in found] == ["wall 1", "wall 0"]


def test_an_end_is_a_part_last_and_where_it_is_known_less():
    walls = rated(floorplan_making.walls(), [1], about="end", verify=False)
    made = plan(walls=walls, openings=rated(floorplan_making.openings(), [2]))
    part = doubts.list_doubts(made)[-1]
    assert (part.element, part.is_part) == ("wall 1", True)
    # the toy's second ends are known less
    np.testing.assert_allclose(part.place_m, [walls["x1_m"][1], walls["y1_m"][1]])
    by_kind = doubts.group_by_kind(made)
    counted = {kind: [doubt.element for doubt in of] for kind, of in by_kind.items()}
    assert counted == {"opening": ["opening 2"], "end": ["wall 1"]}
    assert len(doubts.list_doubts(made)) == sum(map(len, by_kind.values()))
    ((row, end_m),) = doubts.list_loose_ends(made)
    assert row == 1
    np.testing.assert_allclose(end_m, part.place_m)


def test_a_sheet_marks_an_end_beside_it_and_no_wall():
    walls = rated(floorplan_making.walls(), [1], about="end", verify=False)
    sheet = composition.compose_sheet(plan(walls=walls))
    marked = [mark.element for mark in composition.paper_marks(sheet) if mark.kind == "verify"]
    assert [element for element in marked if element.startswith("verify-")] == ["verify-end-1"]
    assert [w.text for w in composition.paper_words(sheet) if w.text.endswith("?")] == ["end?"]


@pytest.mark.parametrize(("about", "mark"), [("existence", "?"), ("kind", " kind?"),
                                             ("width", " width?")])  # fmt: skip
def test_a_sheet_says_what_of_a_door_is_doubtful(about, mark):
    openings = rated(floorplan_making.openings(), [0], about=about, verify=about != "width")
    sheet = composition.compose_sheet(plan(openings=openings))
    (said,) = [word.text for word in composition.paper_words(sheet) if word.text.endswith("?")]
    assert said.endswith(mark.strip())


def test_doubts_of_a_room_stand_together_the_costliest_room_first():
    made = plan(
        walls=rated(floorplan_making.walls(), [0, 1, 2]),
        rooms=rated(floorplan_making.rooms(), [1]),
    )
    groups = doubts.group_by_room(doubts.list_doubts(made))
    assert groups[0][0] == "Room 1" and groups[0][1][0].element == "room 1"
    assert sum(len(of_room) for _, of_room in groups) == 4
    assert len({room for room, _ in groups}) == len(groups)


@pytest.mark.parametrize(
    ("way", "side"),
    [((1, 0), "right"), ((0, 1), "top"), ((-1, 0.1), "left"), ((0.1, -1), "bottom")],
)
def test_a_place_is_told_by_the_side_of_its_room(way, side):
    made = plan()
    middle_m = np.array([made.rooms["x_m"][1], made.rooms["y_m"][1]])
    assert doubt_words.say_where(made, 1, middle_m + way) == f"at the {side} of Room 1"
    assert doubt_words.say_where(made, 1, None) == "Room 1"
    assert "outside" in doubt_words.say_where(made, -1, middle_m)


@pytest.mark.wording
def test_what_was_nearly_drawn_is_listed_apart_the_likeliest_first():
    near = [Nearly(kind, np.array([(1.0, 0.0), (2.0, 0.0)]), p)
            for kind, p in (("window", 0.3), ("wall", 0.45))]  # fmt: skip
    made = replace(plan(), nearly=near)
    assert doubts.list_doubts(made) == []
    found = doubts.list_nearly(made)
    assert [doubt.name for doubt in found] == ["Perhaps a wall", "Perhaps a window"]
    assert found[0].question.startswith("Perhaps a wall") and "1.0 m long" in found[0].question


def test_a_note_holds_what_was_nearly_drawn(tmp_path):
    near = [Nearly("door", np.array([(1.0, 0.0), (1.9, 0.12345)]), 0.34567)]
    files = {name: tmp_path / f"{name}.parquet" for name in ("faces", "walls", "openings", "rooms")}
    parts = {name: getattr(floorplan_making, name)() for name in files}
    named = {"faces": schemas.FACES, "walls": schemas.PLAN_WALLS}
    named |= {"openings": schemas.OPENINGS, "rooms": schemas.ROOMS}
    for name, path in files.items():
        tables.write_table(path, named[name], parts[name])
    files["free"] = tmp_path / "free.parquet"
    for notes, expected in ((None, 0), ({"nearly": floorplan_files.format_nearly(near)}, 1)):
        tables.write_table(files["free"], schemas.FREE, floorplan_making.free(), notes=notes)
        found = floorplan_files.read_floorplan(files).nearly
        assert len(found) == expected
    assert (found[0].kind, found[0].p) == ("door", 0.346)
    np.testing.assert_allclose(found[0].ends_m, [(1, 0), (1.9, 0.123)])


@pytest.mark.parametrize("about", ["", "existence", "kind", "place", "outline", "end", "width"])
@pytest.mark.parametrize("noun", ["wall", "door", "gap", "glass", "room", "face"])
@pytest.mark.wording
def test_every_doubt_is_a_question_that_says_where(noun, about):
    size_m = np.nan if noun == "room" else 0.9
    asked = doubt_words.ask(noun, about, size_m, "at the top of Room 1")
    assert asked.endswith("?") and "at the top of Room 1" in asked
    assert ("0.9 m" in asked) == (noun != "room")
