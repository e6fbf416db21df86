"""What was built against its design, on a floor on paper: nothing invented, signs, limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers.changing_floor import DOOR, INNER, survey
from helpers.drawn_floor_making import OUTER_M, storey
from helpers.refusals import refused
from helpers.sheet_words import LANGUAGES, find_english, texts
from scanplan.changes import comparison
from scanplan.changes.change_words import ChangeWords
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.verdicts import NOT_SEEN
from scanplan.design import as_built, deviation_table
from scanplan.design.as_built import AsBuilt
from scanplan.design.design_plan import make_plan, see_design
from scanplan.design.deviations import (
    ADDITIONAL,
    DEVIATES,
    FAULTS,
    MISSING,
    OTHER_KIND,
    UNDECIDED,
    WITHIN,
    rate_deviations,
)
from scanplan.design.tolerances import Tolerances
from scanplan.errors import StageError
from scanplan.exports import drawing
from scanplan.exports.changes import change_sheet, design_sheet, model_facts
from scanplan.exports.changes.compared_sheet import (
    ComparedFacts,
    Overlay,
    Told,
    compose_compared_sheet,
    draw_areas,
)
from scanplan.exports.sheet.lettering import word_box
from scanplan.exports.sheet.locale import ENGLISH, Locale, make_locale
from scanplan.geometry.lines import Line
from scanplan.project.words_file import read_words
from scanplan.store import schemas, tables

LIMITS = Tolerances(
    "ours",
    (3.0, math.inf),
    {"wall": (0.016, 0.02), "opening": (0.012, 0.012), "column": (0.02, 0.02)},
)
STILL = (3.2, 0, 3.2, 2.0)
"""A wall that stays: with one that moves alone, as many faces agree either way."""
MOTION = PlaneMotion(np.radians(25), -2.0, 4.0)


def against(drawn, built):
    """A survey against a design, both in the frame of the design."""
    tie = comparison.tie_plans(make_plan(drawn, "design"), built.plan)
    design = see_design(drawn, "design")
    found = AsBuilt(drawn, comparison.compare_placed(design, built, tie), [])
    return found, rate_deviations(found.compared, drawn, LIMITS)


def told(rated, table, *verdicts):
    return [of for of in rated if of.change.table == table and of.verdict in (verdicts or FAULTS)]


def test_what_is_built_as_designed_is_within_tolerance_and_nothing_is_invented():
    _, rated = against(storey(), survey())
    assert [of for of in rated if of.verdict in FAULTS] == []
    # nobody sees the outer corners
    walls = [of for of in rated if of.change.table == "wall" and of.verdict != NOT_SEEN]
    assert {of.verdict for of in walls} == {WITHIN} and all(of.p > 0.9 for of in walls)
    assert {of.guid for of in walls} == {*(f"outer {n}" for n in range(4)), "inner 0"}
    assert [of.verdict for of in rated if of.change.table == "room"] == [WITHIN, WITHIN]


@pytest.mark.parametrize("by_m", [0.1, -0.06])
def test_a_wall_built_off_its_place_deviates_by_as_much_to_that_side(by_m):
    moved = (INNER[0] + by_m, 0, INNER[2] + by_m, 5)
    there = (DOOR[0] + by_m, DOOR[1], DOOR[2] + by_m, DOOR[3])
    _, rated = against(storey(inner=[INNER, STILL]), survey([moved, STILL], [there]))
    walls = told(rated, "wall")
    assert {(of.guid, of.verdict) for of in walls} == {("inner 0", DEVIATES)}
    assert all(of.is_fault for of in walls)
    # to the left of a line that leads up is towards smaller x
    assert [of.change.shift_m for of in walls] == pytest.approx([-by_m] * len(walls), abs=0.005)
    assert [of.change.moved_m[0] for of in walls] == pytest.approx([by_m] * len(walls), abs=0.005)
    # the next wall is 2.9 m away
    assert {of.limit_m for of in walls} == {0.016}


def test_a_wall_within_its_tolerance_is_told_as_such_with_what_it_is_off_by():
    moved = (INNER[0] + 0.004, 0, INNER[2] + 0.004, 5)
    _, rated = against(storey(doors=[]), survey([moved], []))
    (wall,) = [of for of in rated if of.guid == "inner 0"]
    assert wall.verdict == WITHIN and wall.change.shift_m == pytest.approx(-0.004, abs=0.002)


def test_what_was_not_built_is_missing_and_what_was_not_designed_additional():
    _, rated = against(storey(doors=[]), survey([], []))
    missing = told(rated, "wall", MISSING)
    assert {of.guid for of in missing} == {"inner 0"} and all(of.is_fault for of in missing)
    _, rated = against(storey(inner=[], doors=[]), survey(doors=[]))
    additional = told(rated, "wall", ADDITIONAL)
    assert {(of.guid, of.change.number_a) for of in additional} == {("", -1)}
    assert all(of.is_fault for of in additional)
    assert sum(of.change.shape.length for of in additional) == pytest.approx(5, abs=0.3)


def test_a_door_that_was_left_out_is_missing_and_one_more_is_additional():
    _, rated = against(storey(), survey(doors=[]))
    (door,) = told(rated, "opening")
    assert (door.verdict, door.guid, door.is_fault) == (MISSING, "door 0", True)
    _, rated = against(storey(doors=[]), survey())
    (door,) = told(rated, "opening")
    assert (door.verdict, door.guid, door.is_fault) == (ADDITIONAL, "", True)


def test_what_nobody_looked_at_is_not_seen_and_never_missing():
    near = [(x, y) for x in (1.0, 2.5, 4.0) for y in (1.0, 2.5)]
    drawn = storey(inner=[INNER, (6.5, 0, 6.5, 5)], doors=[])
    _, rated = against(drawn, survey(doors=[], sensors=near))
    hidden = [of for of in rated if of.guid == "inner 1"]
    assert hidden and {of.verdict for of in hidden} == {NOT_SEEN}


def test_an_opening_of_another_kind_is_told_with_both_kinds():
    _, rated = against(storey(kind="window"), survey())
    (door,) = told(rated, "opening", OTHER_KIND)
    assert (door.change.kind_a, door.change.kind_b) == ("window", "door")
    assert door.p == pytest.approx(0.95) and door.is_fault


def test_an_opening_whose_edges_are_known_coarsely_is_undecided():
    _, rated = against(storey(), survey())
    (door,) = [of for of in rated if of.change.table == "opening"]
    assert door.verdict == UNDECIDED and math.isnan(door.p) and "coarse" in door.doubt


def test_a_column_that_is_not_there_is_missing():
    pillar = shapely.box(2.3, 1.6, 2.7, 2.0)
    _, rated = against(storey(columns=[pillar]), survey())
    (column,) = [of for of in rated if of.change.table == "column"]
    assert (column.verdict, column.guid) == (MISSING, "column 0")


def test_a_drawing_answers_for_places_as_rays_that_saw_all_of_it():
    sight = see_design(storey(), "design").sight
    looks = sight.look_at(Line(np.array([5.0, 0.0]), np.array([-1.0, 0.0])), (0.0, 5.0), 0.1)
    door = slice(31, 38)
    # a door of 2 m: solid beside it up to where rays are asked, open below its lintel
    assert (looks.hits[:30, :8] > 0).all() and (looks.passes[door, :8] > 0).all()
    assert looks.hits[door, :8].sum() == 0 and looks.hits[:, 8:].sum() == 0
    # a face of the outer wall is 0.3 m behind what lies before it
    line = Line(np.array([0.0, OUTER_M]), np.array([0.0, 1.0]))
    before_m = sight.place_returns(line, (1.0, 2.0), 0.5)
    assert before_m[:, 0] == pytest.approx([-OUTER_M] * 10)


def test_faces_of_a_design_end_where_other_walls_meet_them():
    plan = make_plan(storey(doors=[]), "design")
    inner = plan.faces["wall"] == 4
    assert inner.sum() == 2
    lengths_m = np.hypot(
        plan.faces["x1_m"] - plan.faces["x0_m"], plan.faces["y1_m"] - plan.faces["y0_m"]
    )
    assert lengths_m[inner] == pytest.approx([5.0, 5.0], abs=0.01)
    # inside, outside, and the inner side parted by the inner wall
    assert sorted(lengths_m[plan.faces["wall"] == 0].round(1)) == [2.9, 4.9, 8.0]


class TestStoreys:
    def test_the_storey_that_fits_is_taken(self):
        lofts = [(3.0, 0, 3.0, 5), (0, 2, 3.0, 2), (6.3, 0, 6.3, 5)]
        upper = storey("Upper", inner=lofts, doors=[])
        upper = replace(upper, walls=upper.walls[2:])
        found = as_built.compare_design([storey(), upper], "a.ifc", plan_of(), scans=None)
        assert found.storey.name == "Ground" and as_built.warn_of_alike(found) == ""

    def test_one_that_fits_as_well_is_told(self):
        twin = storey("Upper")
        found = as_built.compare_design([storey(), twin], "a.ifc", plan_of(), scans=None)
        assert found.alike == ["Upper"] and "plan.design.storey" in as_built.warn_of_alike(found)

    def test_a_wrong_building_is_refused_in_one_line_with_a_remedy(self):
        star = [(0, 0, 3, 1), (3, 1, 9, 0.2), (9, 0.2, 5, 7), (5, 7, 1.2, 4), (1.2, 4, 0, 0)]
        other = survey([], [], outer=star).plan
        with refused(file="a.ifc", key="plan.design.storey") as fault:
            as_built.compare_design([storey()], "a.ifc", other, scans=None)
        assert "\n" not in str(fault.value)

    @pytest.mark.parametrize("chosen", ["Cellar", 2])
    def test_a_storey_that_is_not_there_is_refused_with_those_that_are(self, chosen):
        with pytest.raises(
            StageError, match=r"plan\.design\.storey .*0 'Ground' at .*, 1 'Upper' at"
        ):
            as_built.compare_design(
                [storey(), storey("Upper")], "a.ifc", plan_of(), scans=None, chosen=chosen
            )


def plan_of():
    return survey(motion=MOTION).plan


@pytest.fixture(autouse=True)
def rays_at_hand(monkeypatch):
    """Place surveys with the rays of the floor on paper, where a test has no scans of it."""

    def place(plan, scans, motion, tie):
        return survey()

    monkeypatch.setattr(comparison, "place_survey", place)


def test_the_table_is_read_back_and_the_sheet_lists_what_differs(tmp_path):
    drawn = storey(inner=[INNER, STILL], doors=[])
    found, rated = against(drawn, survey([(5.1, 0, 5.1, 5), STILL], []))
    columns = deviation_table.tabulate_deviations(rated)
    path = tmp_path / "deviations.parquet"
    notes = deviation_table.state_design(found, "ours")
    tables.write_table(path, schemas.DEVIATIONS, columns, notes=notes)
    read = tables.read_table(path, schemas.DEVIATIONS)
    assert read["guid"].tolist() == [of.guid for of in rated] and read["fault"].any()
    facts = ComparedFacts("", ("", "today"), "")
    sheet = design_sheet.compose_design_sheet(found, rated, "ours", facts)
    kinds = {mark.kind for mark in sheet.marks}
    assert {"within", "far-beyond", "way"} <= kinds and "missing" not in kinds
    assert any(word.text.startswith("-10.0") for word in sheet.paper_words)
    assert drawing.draw_sheet(sheet) is not None


@pytest.mark.parametrize("language", LANGUAGES)
def test_sheets_of_changes_and_deviations_are_in_the_language_of_the_receiver(language):
    drawn = storey(inner=[INNER, STILL], doors=[DOOR])
    built = survey([(5.1, 0, 5.1, 5), STILL], [])
    found, rated = against(drawn, built)
    changes = comparison.compare_placed(survey([INNER, STILL], [DOOR]), built, found.compared.tie)

    def compose_design(locale):
        facts = ComparedFacts("", ("", "2026-02-18"), "", locale)
        return design_sheet.compose_design_sheet(found, rated, "ours", facts)

    def compose_changes(locale):
        facts = ComparedFacts("", ("2026-02-17", "2026-02-18"), "", locale)
        return change_sheet.compose_change_sheet(changes, facts)

    # names of the plans and of the table stay
    assert find_english(compose_design, language) == {"design", "floor", "ours"}
    assert find_english(compose_changes, language) == {"floor"}


@pytest.mark.parametrize(
    ("unit", "expected"),
    # moved by 0.1 m: 10 cm, 3.9 inches
    [("m", {"By, cm", "-10.0"}), ("mm", {"By, mm", "-100.0"}), ("ft", {"By, in", "-3.9"})],
)
def test_distances_are_in_the_unit_of_the_receiver(unit, expected):
    drawn = storey(inner=[INNER, STILL], doors=[])
    found, rated = against(drawn, survey([(5.1, 0, 5.1, 5), STILL], []))
    facts = ComparedFacts("", ("", "today"), "", Locale(unit))
    sheet = design_sheet.compose_design_sheet(found, rated, "ours", facts)
    assert expected <= {text.partition(" ±")[0] for text in texts(sheet)}


def test_words_of_the_list_do_not_run_into_each_other():
    rows = [
        ChangeWords("wall a13/b10", "moved", "10.1 ± 1.0", "0.96"),
        ChangeWords("window a113/b210", "kind differs", "+110.2 ± 10.8", "0.96"),
    ]
    told = [Told(row, shapely.Point(4, 2)) for row in rows]
    marks = list(draw_areas("within", shapely.box(0, 0, 8, 5), "wall-0"))
    for listed in (told[:1], told):
        sheet = compose_compared_sheet(
            "floor",
            Overlay(marks, [], listed),
            ENGLISH,
            turn_deg=0.0,
            list_values=lambda _: [[("Of", "a", 3)]],
        )
        boxes = [word_box(word) for word in sheet.paper_words]
        one, other = shapely.STRtree(boxes).query(boxes, predicate="intersects")
        assert (one == other).all()
    # all but the element is whole
    texts = [word.text for word in sheet.paper_words]
    assert set(rows[1][1:]) <= set(texts) and "window a113/b210" not in texts


@pytest.mark.wording
def test_models_state_the_gravest_of_an_element_and_topics_what_differs():
    moved = (INNER[0] + 0.1, 0, INNER[2] + 0.1, 5)
    drawn = storey(inner=[INNER, STILL], doors=[])
    _, rated = against(drawn, survey([moved, STILL], []))
    columns = deviation_table.tabulate_deviations(rated)
    facts = model_facts.gather_deviations(columns)
    assert facts["inner 0"]["verdict"] == DEVIATES and facts["inner 0"]["differs"] is True
    assert facts["inner 0"]["deviation_m"] == pytest.approx(-0.1, abs=0.005)
    assert facts["inner 0"]["tolerance_m"] == 0.016 and facts["outer 0"]["verdict"] == WITHIN
    (wall,) = model_facts.list_topics(columns, 3.0)
    (german,) = model_facts.list_topics(columns, 3.0, make_locale("m", read_words("de")))
    assert (german.key, german.guid, german.kind) == (wall.key, wall.guid, wall.kind)
    assert "weicht ab um -10" in german.title and "Toleranz 16 mm." in german.text
    assert wall.guid == "inner 0" and wall.kind == "deviates"
    assert wall.place_m == pytest.approx((5.0, 2.5, 3.0), abs=0.1) and "-10" in wall.title
