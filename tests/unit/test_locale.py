"""Sheets in the receiver's units and language, and the files of words that say them."""

import io
import re

import ezdxf
import numpy as np
import pytest

from helpers import floorplan_making
from helpers.refusals import refused
from helpers.sheet_words import LANGUAGES, find_english, texts
from scanplan.errors import StageError
from scanplan.exports import dxf
from scanplan.exports.drafting.presentation import compose_overview, compose_presentation
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.model_colours import COLOURS
from scanplan.exports.model_origin import Site
from scanplan.exports.sheet import title
from scanplan.exports.sheet.composition import compose_sheet
from scanplan.exports.sheet.facts import SheetFacts, state_frame
from scanplan.exports.sheet.lettering import measure_width_mm
from scanplan.exports.sheet.locale import ENGLISH, Locale, make_locale
from scanplan.exports.sheet.marks import Word
from scanplan.exports.sheet.paper import Slot
from scanplan.exports.sheet.styles import LAYERS, STYLES, Paper
from scanplan.plan.corrections.applying import SAID
from scanplan.plan.floorplan import HEIGHTS, GeoReference
from scanplan.plan.floorplan_files import UNRATED
from scanplan.project.words_file import read_layers, read_words
from scanplan.validation.confidence import NOT_CLOSED, OF_DOUBTFUL_WALLS
from scanplan.validation.doubts import MARKS
from scanplan.validation.element_features import REASONS

SETTINGS = DraftSettings(0.05, (0.1, 0.2), (0.9, 1.0), (1.2,), 0.3)


def sheets(locale):
    """The sheets of the toy plan: as measured, regular, and the overview."""
    measured = floorplan_making.plan(floor_z_m=0.0, ceiling_z_m=2.5)
    measured.rooms["closed"][1] = False
    facts = SheetFacts(n_scans=5, surveyed="2026-02-17", locale=locale)
    regular, changes = draft_plan(measured, SETTINGS)
    found = [
        compose_sheet(measured, facts),
        compose_presentation(measured, regular, changes, facts),
        compose_overview(measured, regular, facts),
    ]
    return [sheet for sheet in found if sheet is not None]


@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_on_a_sheet_stays_english(language):
    for number in range(len(sheets(ENGLISH))):
        assert find_english(lambda locale, of=number: sheets(locale)[of], language) == set()


@pytest.mark.parametrize("language", ["en", *LANGUAGES])
def test_a_title_block_holds_place_and_people_in_every_language(language):
    locale = make_locale("ft" if language == "en" else "m", read_words(language))
    measured = GeoReference("EPSG:25832", 0.0, 0.0, 0.0, 0.0234, check_off_m=[("K1", 0.02)])
    site = Site("EPSG:25832", 512_999.999, 5_401_999.999, turn_deg=130.0041)
    facts = SheetFacts(
        locale=locale,
        author="A. Bee",
        organisation="Bee",
        frame=state_frame(site, measured, locale),
    )
    drawn = floorplan_making.plan(corrected_by="C. Dee, 2026-03-01")
    words = compose_sheet(drawn, facts, turn_deg=-12.3).paper_words
    values = [word for word in words if word.element.startswith(title.TITLE_TAG)]
    assert not [word.text for word in values if word.text.endswith("…")]
    for head in [word for word in words if word.kind == "note"]:
        end = head.place[0] + measure_width_mm(head.text, head.size_mm)
        of_row = [of for of in values if abs(of.place[1] - head.place[1]) < 2]
        after = [of.place[0] for of in of_row if of.place[0] > head.place[0]]
        assert not after or end < min(after)


def test_attributes_in_cad_are_in_the_unit_and_language_and_words_of_a_person_are_not():
    measured = floorplan_making.plan()
    measured.rooms["closed"][0] = False
    measured.rooms["name"][0] = "Door"
    measured.rooms["corrected"][0] = "changed by hand, no, 2026-03-01"
    measured.openings["sill_m"][1] = np.nan
    locale = make_locale("cm", read_words("de"))
    sheet = compose_sheet(measured, SheetFacts(storey="Door", author="no", locale=locale))
    space = ezdxf.filemanagement.read(io.StringIO(dxf.format_dxf(sheet))).modelspace()
    inserts = [
        {attribute.dxf.tag: attribute.dxf.text for attribute in insert.attribs}
        for insert in space.query("INSERT")
    ]
    door = next(of for of in inserts if of.get("TAG") == "door-1")
    assert [door[tag] for tag in ("WIDTH", "SILL", "CORRECTED")] == ["90", "nicht gesehen", "nein"]
    room = next(of for of in inserts if of.get("NUMBER") == "0")
    assert (room["NAME"], room["AREA"], room["CLOSED"]) == ("Door", "etwa 12,0 m²", "nein")
    assert room["CORRECTED"] == "von Hand geändert, no, 01.03.2026"
    values = {word.element: word.text for word in sheet.paper_words}
    assert (values["title:STOREY"], values["title:AUTHOR"]) == ("Door", "no")


def test_german_says_of_how_many_walls_in_the_dative_and_percents_apart():
    german = make_locale("m", read_words("de"))
    of = "are square to the building, 5 in line with others, 4 of nominal thickness."
    assert german.say(f"Of 23 walls 22 {of}").startswith("Von 23 Wänden 22 ")
    assert german.say(f"Of 1 wall 1 {of}").startswith("Von 1 Wand 1 ")
    said = german.say("12 of 12 rooms are closed, 100% of the floor")
    assert said.endswith("100 % der Fläche")


@pytest.mark.parametrize("language", LANGUAGES)
def test_whatever_a_model_may_say_has_words(language):
    words = read_words(language)["phrases"]
    said = [*REASONS.values(), *COLOURS, *HEIGHTS.values(), *SAID.values(), *MARKS.values()]
    said += [NOT_CLOSED, OF_DOUBTFUL_WALLS, UNRATED]
    assert {text for text in said if text not in words} == {"?"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_numbers_and_dates_are_as_written_there(language):
    said = texts(sheets(make_locale("m", read_words(language)))[1])
    assert "7,30" in said and "7.30" not in said
    assert {"17.02.2026", "17/02/2026"} & set(said) and "2026-02-17" not in said


@pytest.mark.parametrize(
    ("unit", "expected"),
    # 7.3 m: 23 feet of 304.8 mm and 11.40 inches; 12 m2: 129.2 square feet
    [
        ("m", {"7.30", "12.0 m²", "2 m"}),
        ("cm", {"730", "12.0 m²", "2 m"}),
        ("mm", {"7300", "12.0 m²", "2 m"}),
        ("ft", {"23'-11 1/2\"", "129 ft²", "4 ft"}),
    ],
)
def test_lengths_and_areas_are_in_the_unit_that_is_asked_for(unit, expected):
    assert expected <= set(texts(sheets(Locale(unit))[1]))


def test_in_feet_no_length_stays_metric():
    said = [text for sheet in sheets(Locale("ft")) for text in texts(sheet)]
    assert [text for text in said if re.search(r"\d (m|cm|mm)\b|m²", text)] == []


@pytest.mark.parametrize(
    ("length_m", "said"),
    [
        (0.0, "0'-0\""),
        (0.3048, "1'-0\""),
        (0.3047, "1'-0\""),
        (1.0, "3'-3 1/4\""),
        (2.4, "7'-10 1/2\""),
        (-0.02, "-0'-0 3/4\""),
        (-1.0, "-3'-3 1/4\""),
        (-0.001, "0'-0\""),
    ],
)
def test_feet_and_inches_are_rounded_to_a_quarter_of_an_inch(length_m, said):
    assert Locale("ft").length(length_m) == said


def test_a_language_has_an_order_of_its_own():
    words = {"{n} of {} in {}": "{3} in {2}: {1}", "wall": "Wand", "line": "Flucht"}
    assert Locale(decimal=",", phrases=words).say("1.5 of wall in line") == "Flucht in Wand: 1,5"


@pytest.mark.parametrize("name", ["2024-13-45", "0000-00-00"])
def test_a_name_like_a_day_that_is_none_stays_as_it_is(name):
    assert Locale(decimal=",", date="%d.%m.%Y").say(name) == name


def test_phrases_hold_numbers_and_other_phrases():
    words = {"{n} doors": "{n} Türen", "about {}": "etwa {}", "a plan: {}": "ein Plan: {}"}
    german = Locale(decimal=",", date="%d.%m.%Y", phrases=words)
    assert german.say("a plan: about 3 doors") == "ein Plan: etwa 3 Türen"
    assert german.say("3 doors; 1.5") == "3 Türen; 1,5"
    assert german.say("no such words, of mine") == "no such words, of mine"
    assert german.say("2026-02-17") == "17.02.2026"


def read_dxf(sheet, **more):
    return ezdxf.filemanagement.read(io.StringIO(dxf.format_dxf(sheet, **more)))


@pytest.mark.parametrize(("unit", "factor"), [("m", 1e-3), ("cm", 0.1), ("mm", 1.0)])
def test_cad_measures_dimensions_in_the_unit_of_the_sheet(unit, factor):
    sheet = sheets(Locale(unit))[0]
    document = read_dxf(sheet)
    assert document.dimstyles.get("SCANPLAN").dxf.dimlfac == pytest.approx(factor)
    drawn = document.modelspace().query("DIMENSION")
    stated = sorted(dimension.word.text for dimension in sheet.dimensions)
    assert len(drawn) == len(stated) and any(text.startswith("~") for text in stated)
    is_about = [dimension.dxf.text.startswith("~") for dimension in drawn]
    assert sum(is_about) == sum(text.startswith("~") for text in stated)


def test_feet_stand_in_cad_as_on_the_sheet():
    sheet = sheets(Locale("ft"))[0]
    drawn = read_dxf(sheet).modelspace().query("DIMENSION")
    stated = sorted(dimension.word.text for dimension in sheet.dimensions)
    assert sorted(dimension.dxf.text for dimension in drawn) == stated


def test_layers_have_the_names_that_are_asked_for_and_nothing_is_lost():
    sheet = sheets(ENGLISH)[0]
    ours, others = read_dxf(sheet), read_dxf(sheet, layers=read_layers("din"))
    names = read_layers("din")
    assert set(names) == set(LAYERS)
    assert not {layer.dxf.name for layer in others.layers} & set(names)

    def count(document):
        layers = [entity.dxf.layer for entity in document.modelspace()]
        return sorted((names.get(layer, layer), layers.count(layer)) for layer in set(layers))

    assert count(ours) == sorted(
        (layer, [e.dxf.layer for e in others.modelspace()].count(layer))
        for layer in {e.dxf.layer for e in others.modelspace()}
    )
    assert others.audit().errors == []


def test_a_file_of_ones_own_is_read(tmp_path):
    file = tmp_path / "it.yaml"
    file.write_text('decimal: ","\ndate: "%d/%m/%Y"\nphrases: {"{n} doors": "{1} porte"}\n')
    assert Locale("m", **read_words(str(file))).say("2 doors") == "2 porte"
    assert read_words("en") == {} and read_layers(None) == {}
    layers = tmp_path / "mine.yaml"
    layers.write_text("A-WALL: Muri\n")
    assert read_layers(layers) == {"A-WALL": "Muri"}


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('decimal: ","\n', "phrases"),
        ('decimal: ";"\ndate: "%d"\nphrases: {}', "decimal"),
        ('decimal: ","\ndate: 3\nphrases: {}', "date"),
        ('decimal: ","\ndate: "%d"\nphrases: []', "phrases"),
        ('decimal: ","\ndate: "%d"\nphrases: {"{n} doors": "porte"}', "{n} doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"{n} doors of {}": "{1} {1}"}', "{n} doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"{n} doors of {}": "{2} {}"}', "{n} doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"doors": "{porte"}', "doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"doors": ""}', "doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"doors": "por\\ate"}', "doors"),
        ('decimal: ","\ndate: "%d"\nphrases: {"{n}": "{n}"}', "{n}"),
        ('decimal: ","\ndate: "%d"\nphrases: {"{}": "({})"}', "{}"),
    ],
)
def test_a_mistake_in_words_is_named(tmp_path, text, named):
    file = tmp_path / "words.yaml"
    file.write_text(text)
    with pytest.raises(StageError) as raised:
        read_words(str(file))
    assert str(file) in str(raised.value) and named in str(raised.value)


@pytest.mark.parametrize(
    "text",
    [
        *("A-WALL: 'a/b'", "A-WALL: ''", "A-WALL: 3", "A-WALL: W\nA-DOOR: w", "A-WALL: [W]"),
        *("A-WALL: A-DOOR", "A-WALL: A-DOOR\nA-DOOR: A-WALL", "A-WALL: a-chng-same"),
        *("A-WALL: '0'", "A-WALL: DEFPOINTS", 'A-WALL: "a\\nb"', "A-WALL: ' W'", "NOPE: W"),
        'A-WALL: "W\\u202e"',
    ],
)
def test_a_mistake_in_names_of_layers_is_named(tmp_path, text):
    file = tmp_path / "layers.yaml"
    file.write_text(text)
    with pytest.raises(StageError, match=str(file)):
        read_layers(file)


@pytest.mark.parametrize("read", [read_words, read_layers])
def test_a_file_that_is_not_there_is_told(read):
    with refused(file="nowhere.yaml"):
        read("nowhere.yaml")
    with pytest.raises(StageError, match="not exist"):
        read("long" * 2000)


@pytest.mark.parametrize(
    ("read", "said"),
    [
        (read_words, r"plan\.export\.language: it does not exist; give one of en, de"),
        (read_layers, r"plan\.export\.layers: it does not exist; give one of din"),
    ],
)
def test_a_language_or_layers_that_are_not_ours_are_refused_with_the_key_and_what_is(read, said):
    with pytest.raises(StageError, match=said):
        read("it")


@pytest.mark.parametrize("language", ["", *LANGUAGES])
def test_a_legend_keeps_to_its_column(language):
    locale = make_locale("m", read_words(language) if language else None)
    kinds = [kind for kind, style in STYLES.items() if style.meaning]
    items = title.draw_legend(kinds, [Slot(0.0, 100.0, len(kinds))], locale)
    reach = {item.text: _reach(item)[1] for item in items if isinstance(item, Word)}
    assert [text for text, right in reach.items() if right > Paper.COLUMN - Paper.GAP] == []


@pytest.mark.parametrize("unit", ["m", "mm", "ft"])
def test_sizes_of_rooms_stand_in_columns_of_their_own(unit):
    locale = Locale(unit)
    for sheet in sheets(locale):
        slot = Slot(0.0, 100.0, len(sheet.stamps))
        items = [*title.draw_room_table(sheet.stamps, [slot], locale)]
        words = [item for item in items if isinstance(item, Word)]
        # the heads, and a row for each of the two rooms
        assert len(words) == 3 * 5
        for row in range(3):
            begins, ends = zip(*(_reach(word) for word in words[5 * row :][:5]), strict=True)
            assert all(end < begin for end, begin in zip(ends, begins[1:], strict=False))
            assert ends[-1] < Paper.COLUMN


def _reach(word):
    """From where to where a word reaches, millimetres."""
    wide = measure_width_mm(word.text, word.size_mm)
    begin = float(word.place[0]) - word.align * wide
    return begin, begin + wide
