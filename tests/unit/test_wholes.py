"""What of two surveys counts as one: stretches of a wall, through doors, with their marks."""

from dataclasses import replace

import pytest
import shapely

from helpers.changing_floor import INNER, survey
from scanplan.changes import change_table, comparison, frames
from scanplan.changes.change_words import say_change
from scanplan.changes.seen_floors import see_floor
from scanplan.changes.verdicts import GONE, MOVED, NEW, NOT_SEEN, SAME, Change
from scanplan.changes.wholes import list_wholes, number_wholes
from scanplan.exports.changes import change_sheet
from scanplan.exports.changes.compared_sheet import ComparedFacts
from scanplan.report import floor_table
from scanplan.store import schemas, tables


def wall(x0, y0, x1, y1, number_a=-1, number_b=-1, verdict=GONE, p=0.95):
    return Change("wall", number_a, number_b, verdict, p, shapely.LineString([(x0, y0), (x1, y1)]))


DOOR = Change("opening", 0, -1, GONE, 0.95, shapely.LineString([(0, 2), (0, 2.9)]))


@pytest.mark.parametrize(
    ("changes", "numbers"),
    [
        # one wall on both sides of its door, and a cell that is told apart
        ([wall(0, 0, 0, 1.7, 3), wall(0, 1.7, 0, 2, 3), wall(0, 2.9, 0, 5, 3), DOOR], [0, 0, 0, 3]),
        # drawn as two walls, which a door joins, or nothing parts
        ([wall(0, 0, 0, 2, 3), DOOR, wall(0, 2.9, 0, 5, 4)], [0, 1, 0]),
        ([wall(0, 0, 0, 2, 3), wall(0, 2.1, 0, 5, 4)], [0, 0]),
        # both are where one is now
        ([wall(0, 0, 0, 2, 3, 7, MOVED), wall(0.2, 2, 0.2, 5, 4, 7, MOVED)], [0, 0]),
        # in one line beyond a corridor, and at a corner
        ([wall(0, 0, 0, 2, 3), wall(0, 2.9, 0, 5, 4)], [0, 1]),
        ([wall(0, 0, 0, 2, 3), wall(0, 2, 3, 2, 4)], [0, 1]),
        # side by side, a door at both
        ([wall(0, 0, 0, 2, 3), DOOR, wall(0.35, 2, 0.35, 5, 4)], [0, 1, 2]),
        # what became of them differs, or how sure that is
        ([wall(0, 0, 0, 2, 3), wall(0, 2, 0, 5, 3, 3, SAME)], [0, 1]),
        ([wall(0, 0, 0, 2, 3), wall(0, 2, 0, 5, 3, p=0.5)], [0, 1]),
        ([], []),
    ],
)
def test_stretches_of_one_wall_in_one_line_are_one(changes, numbers):
    assert number_wholes(changes).tolist() == numbers
    assert sum(map(len, list_wholes(changes))) == len(changes)
    assert change_table.tabulate_changes(changes)["whole"].tolist() == numbers


def test_a_wall_that_went_in_pieces_is_counted_once_by_its_longest_and_with_all_its_length():
    pieces = [wall(0, 0, 0, 1.7, 3, p=0.92), wall(0, 1.7, 0, 2, 3, p=0.91), wall(0, 2.9, 0, 5, 4)]
    changes = [*pieces, DOOR, wall(9, 0, 9, 2, -1, 1, NEW)]
    said = change_table.summarise_changes(changes)
    assert said[0] == "wall: 1 gone (4.1 m), 1 new (2.0 m)"
    words = say_change(list_wholes(changes)[0])
    assert (words.element, words.verdict, words.p) == ("wall a3+4", "gone", "0.95")
    columns = change_table.tabulate_changes(changes)
    row = floor_table.describe_survey({}, survey().plan, tables.no_rows(schemas.EVIDENCE), columns)
    assert row["walls_changed"] == 2 and row["doubtful_changes"] == 0


def compose(changes):
    a, b = survey([INNER], []), survey([INNER], [])
    tie = frames.tie_frames((see_floor(a.plan), see_floor(b.plan)), ("a", "b"))
    compared = comparison.Comparison(a, b, tie, changes)
    return change_sheet.compose_change_sheet(compared, ComparedFacts("", ("", ""), ""))


def beside(sheet, label):
    """The value of the title block under a label."""
    texts = [word.text for word in sheet.paper_words]
    return texts[texts.index(label) + 1]


def test_what_is_to_be_verified_is_drawn_numbered_and_listed_as_often_as_it_is_counted():
    gone = wall(5, 0, 5, 2, 4)
    maybe = wall(5, 3, 5, 5, 4, p=0.5)
    new = wall(2, 1, 2, 3, -1, 4, NEW, p=0.5)
    carried = Change("furniture", 0, -1, GONE, 0.5, shapely.box(1, 1, 2, 2))
    seen = wall(0, 0, 8, 0, 0, verdict=NOT_SEEN)
    sheet = compose([gone, maybe, new, carried, seen])
    assert beside(sheet, "To verify") == "2" and beside(sheet, "Changed").startswith("1 wall;")
    assert [mark.kind for mark in sheet.marks].count("verify") == 2
    listed = [word.text for word in sheet.paper_words]
    assert [text for text in listed if text in ("gone", "gone?", "new?")] == [
        "gone",
        "gone?",
        "new?",
    ]
    assert {word.text for word in sheet.words} == {"1", "2", "3"}


def test_what_is_gone_for_certain_and_maybe_furniture_is_to_be_verified():
    gone = replace(wall(5, 0, 5, 5, 4, p=0.7), p_furniture=0.29)
    sheet = compose([gone])
    assert beside(sheet, "To verify") == "1" and beside(sheet, "Changed").startswith("1 wall;")
    assert "gone" in {mark.kind for mark in sheet.marks}
    assert "wall? a4" in {word.text for word in sheet.paper_words}
