"""What a person names: how doors open, what furniture is, what rooms are used for."""

import ifcopenshell
import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.edited import dxf_reading
from scanplan.exports import dxf, ifc
from scanplan.exports.data import element_ids, element_tables, wayfinding
from scanplan.exports.drafting import fixtures
from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.ifc_elements import furniture as ifc_furniture
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.openings import find_swings
from scanplan.plan.corrections import applying, rows
from scanplan.project import corrections_file
from scanplan.project.corrections_file import read_corrections
from scanplan.store import schemas

CATALOGUE = {"walls": {}, "doors": {}, "windows": {}, "facade_m": 0.3, "codes": {}}
SETTINGS = make_draft_settings(0.05, CATALOGUE)
# in the first room, its longer side along the south wall, whose face is at y = 0
BATH = shapely.box(1.0, 0.1, 2.0, 0.6)
FLIGHT = shapely.box(1.0, 1.0, 2.0, 3.24)


def corrected(tmp_path, *entries, pieces=(BATH,), kind="furniture"):
    """The plan of two rooms with what a person says of it, and what became of that."""
    path = tmp_path / "corrections.yaml"
    path.write_text("\n".join(["corrections:", *(f"- {entry}" for entry in entries)]))
    made = {
        name: getattr(floorplan_making, name)()
        for name in ("faces", "walls", "openings", "rooms", "evidence")
    }
    made["furniture"] = floorplan_making.furniture(list(pieces), kind)
    plan_rows = rows.rows_of_plan(made)
    outcome = applying.apply_corrections(plan_rows, read_corrections(path))
    tables = rows.columns_of_plan(plan_rows)
    tables.pop("evidence")
    return floorplan_making.plan(**tables), outcome


@pytest.mark.parametrize(
    ("swing", "block"),
    # the door between the rooms, x = 4.05, from y = 1.0 to 1.9: to the east and to the west
    [
        ((4.7, 1.1), "SWING-RIGHT"),
        ((4.7, 1.8), "SWING-LEFT"),
        ((3.4, 1.1), "SWING-LEFT"),
        ((3.4, 1.8), "SWING-RIGHT"),
    ],
)
def test_a_door_swings_to_where_a_person_says(tmp_path, swing, block):
    made, outcome = corrected(
        tmp_path, f"{{element: opening, at: [4.05, 1.45], swing: {list(swing)}}}"
    )
    assert outcome.unmatched == [] and find_swings(made)[1].block == block


def test_what_a_person_says_of_a_leaf_replaces_what_was_seen(tmp_path):
    seen = shapely.box(4.1, 0.98, 4.95, 1.02)
    entry = "{element: opening, at: [4.05, 1.45], swing: [3.4, 1.8]}"
    made, _ = corrected(tmp_path, entry, pieces=[seen], kind="leaf")
    (outline,) = shapely.from_wkb(made.furniture["geometry"])
    # at right angles to the wall, from the northern jamb to the west, as long as the door is wide
    assert outline.bounds[0] == pytest.approx(4.05 - 0.9, abs=0.03)
    assert outline.centroid.y == pytest.approx(1.9, abs=0.03)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("{element: opening, at: [4.05, 1.45], swing: [9, 1.8]}", "beside the door"),
        ("{element: opening, at: [4.05, 1.45], kind: passage, swing: [3.4, 1.8]}", "passage"),
        ("{element: furniture, at: [3.5, 2.5], kind: bath}", "no furniture"),
    ],
)
def test_what_cannot_be_is_told_and_not_done(tmp_path, entry, words):
    made, outcome = corrected(tmp_path, entry)
    assert words in outcome.unmatched[0] and find_swings(made) == {}
    assert made.furniture["named"].tolist() == [""]


def test_a_sliding_door_has_a_symbol_of_its_own(tmp_path):
    made, _ = corrected(tmp_path, "{element: opening, at: [4.05, 1.45], kind: sliding door}")
    assert made.openings["type"][1] == "door" and find_swings(made)[1].block == "SLIDING"


def test_a_piece_is_drawn_by_its_symbol_with_its_back_to_the_wall(tmp_path):
    made, _ = corrected(tmp_path, "{element: furniture, at: [1.5, 0.3], kind: toilet}")
    (mark,) = fixtures.draw_fixtures(made)
    tank, bowl = (path[:, :2] for path in mark.paths)
    assert mark.element == "toilet-0"
    # the tank is a third of the depth of 0.5 m, at the wall; the bowl before it
    assert tank[:, 1].max() == pytest.approx(0.1 + 0.3 * 0.5)
    assert np.ptp(tank[:, 0]) == pytest.approx(1.0) and bowl[:, 1].max() == pytest.approx(0.6)


def test_stairs_have_a_tread_about_every_28_centimetres_across_their_longer_side(tmp_path):
    entry = "{element: furniture, at: [1.5, 2.0], kind: stairs}"
    made, _ = corrected(tmp_path, entry, pieces=[FLIGHT])
    (mark,) = fixtures.draw_fixtures(made)
    around, *treads = (path[:, :2] for path in mark.paths)
    levels_m = sorted(float(tread[0, 1]) for tread in treads)
    assert np.ptp(around[:, 1]) == pytest.approx(2.24)
    np.testing.assert_allclose(np.diff([1.0, *levels_m, 3.24]), 0.28)
    assert all(np.ptp(tread[:, 0]) == pytest.approx(1.0) for tread in treads)


def test_furniture_that_nobody_named_is_not_on_the_regular_drawing(tmp_path):
    entry = "{element: room, at: [1, 1], name: Bath, use: restroom}"
    measured, _ = corrected(tmp_path, entry)
    regular, drafted = draft_plan(measured, SETTINGS)
    sheet = compose_presentation(measured, regular, drafted)
    assert {mark.kind for mark in sheet.marks} & {"furniture", "fixture", "stairs"} == set()
    assert regular.rooms["use"].tolist() == ["restroom", ""]


def test_the_model_has_what_was_named_by_its_class(tmp_path):
    measured, _ = corrected(
        tmp_path,
        "{element: furniture, at: [1.5, 0.3], kind: bath}",
        "{element: opening, at: [4.05, 1.45], kind: sliding door}",
        "{element: room, at: [1, 1], use: restroom}",
    )
    regular, _ = draft_plan(measured, SETTINGS)
    ids = element_ids.take_ids(element_ids.ids_from_places(measured), measured, regular)
    model = ifcopenshell.file.from_string(ifc.format_ifc(regular, ids, catalogue=CATALOGUE))
    (bath,) = model.by_type("IfcSanitaryTerminal")
    assert (bath.PredefinedType, model.by_type("IfcFurniture")) == ("BATH", ())
    sliding = [d for d in model.by_type("IfcDoor") if d.OperationType == "USERDEFINED"]
    assert [door.UserDefinedOperationType for door in sliding] == ["SLIDING"]
    assert [space.ObjectType for space in model.by_type("IfcSpace")] == ["restroom", None]


def test_the_use_of_a_room_and_its_number_stand_below_the_name_that_it_was_given(tmp_path):
    measured, _ = corrected(
        tmp_path, "{element: room, at: [1, 2], name: Bath, use: restroom}", pieces=()
    )
    regular, drafted = draft_plan(measured, SETTINGS)
    bath, other = compose_presentation(measured, regular, drafted).stamps
    lines = [word.text for word in bath.words]
    assert lines[0].startswith("Bath") and lines[1:] == ["12.0 m²", "No. 0, restroom"]
    assert (bath.facts["USE"], other.facts["USE"], len(other.words)) == ("restroom", "", 2)
    heights = [word.place[1] for word in bath.words]
    assert heights == sorted(heights, reverse=True)


def test_a_number_that_a_person_gave_is_apart_from_the_name_everywhere(tmp_path):
    measured, _ = corrected(
        tmp_path,
        '{element: room, at: [1, 2], number: "2.10", name: Bath, use: restroom}',
        "{element: room, at: [5, 1], number: A-7}",
        pieces=(),
    )
    assert measured.room_labels == ["2.10 Bath", "Room A-7"]
    regular, drafted = draft_plan(measured, SETTINGS)
    ids = element_ids.take_ids(element_ids.ids_from_places(measured), measured, regular)
    rows = element_tables.tabulate_elements(measured, ids)
    of_rooms = [rows["rooms"][name] for name in ("room", "number", "name", "use")]
    assert of_rooms == [[0, 1], ["2.10", "A-7"], ["Bath", "Room A-7"], ["restroom", ""]]
    model = ifcopenshell.file.from_string(ifc.format_ifc(regular, ids, catalogue=CATALOGUE))
    spaces = [(space.Name, space.LongName) for space in model.by_type("IfcSpace")]
    assert spaces == [("2.10", "Bath"), ("A-7", "Room A-7")]
    units = wayfinding.imdf_layers(measured, rows)["imdf_unit"].rows
    assert (units["name"], units["alt_name"]) == (["Bath", "Room A-7"], ["2.10", "A-7"])
    locale = Locale(decimal=",", phrases={"No.": "Nr.", "Room": "Raum", "Room {n}": "Raum {n}"})
    sheet = compose_presentation(measured, regular, drafted, SheetFacts(locale=locale))
    lines = [[word.text for word in stamp.words] for stamp in sheet.stamps]
    assert lines[0][0].startswith("Bath") and lines[0][1:] == ["12,0 m²", "Nr. 2.10, restroom"]
    assert lines[1][0].startswith("Raum A-7")
    (tmp_path / "plan.dxf").write_text(dxf.format_dxf(sheet))
    read = [of for of in dxf_reading.read_dxf(tmp_path / "plan.dxf").elements if of.kind == "room"]
    said = [(of.key, of.facts["number"], of.facts["name"]) for of in read]
    assert said == [("0", "2.10", "Bath"), ("1", "A-7", "Raum A-7")]


def test_a_room_that_is_parted_or_joined_keeps_its_number_once(tmp_path):
    numbered = '{element: room, at: [1, 1], number: "1"}'
    parted, _ = corrected(
        tmp_path, "{element: room, action: split, line: [[2, 0], [2, 3]]}", numbered
    )
    assert sorted(parted.rooms["number"].tolist()) == ["", "", "1"]


def test_an_opening_that_is_added_may_swing(tmp_path):
    entry = "{element: opening, action: add, kind: window, line: [[1, 0], [2, 0]], swing: [1, 1]}"
    made, outcome = corrected(tmp_path, entry)
    assert "leave `swing` out" in outcome.unmatched[0] and outcome.n_applied == 0
    assert len(made.openings["wall"]) == len(floorplan_making.openings()["wall"])


def test_names_of_fittings_are_the_same_everywhere():
    assert corrections_file._KINDS["furniture"] == ("furniture", "column", *schemas.FIXTURES)
    assert {*fixtures._SYMBOLS, fixtures.STAIRS} == set(schemas.FIXTURES)
    assert set(ifc_furniture._CLASSES) == set(schemas.FIXTURES)
