"""Doubts as topics: who reads them finds the element, the place and the question."""

import io
from dataclasses import replace
from pathlib import Path

import bcf.v2.bcfxml
import numpy as np
import pytest

from helpers import floorplan_making
from scanplan.exports.data import doubt_topics, element_ids
from scanplan.exports.model_origin import ModelOrigin
from scanplan.exports.sheet.locale import ENGLISH, make_locale
from scanplan.project.words_file import read_words
from scanplan.validation.doubt_words import list_phrases
from scanplan.validation.doubts import OF_WALL, list_doubts

ORIGIN = ModelOrigin(author="A. Uthor", t_ns=1_700_000_000 * 10**9)


@pytest.fixture
def doubted():
    """The plan with a wall and a face to be verified, and a room that is not closed."""
    faces = floorplan_making.faces()
    faces["verify"] = np.isin(faces["face"], [4])
    rooms = floorplan_making.rooms()
    rooms["closed"][1] = False
    return floorplan_making.plan(faces=faces, rooms=rooms, floor_z_m=-0.3)


def read(content, folder):
    file = folder / "doubts.bcf"
    file.write_bytes(content)
    return bcf.v2.bcfxml.BcfXml.load(Path(file))


def test_a_topic_for_each_doubt_selects_its_element_from_above(doubted, tmp_path):
    ids = element_ids.ids_from_places(doubted)
    found = read(doubt_topics.format_bcf(doubted, ids, ORIGIN), tmp_path)
    assert found is not None and found.version.version_id == "2.1"
    topics = sorted(found.topics.values(), key=lambda handler: handler.topic.index)
    doubts = list_doubts(doubted)
    assert {"wall", "face", "room"} <= {doubt.kind for doubt in doubts}
    # the wall whose face is doubtful
    expected = {
        "wall": lambda number: ids["wall"][number],
        "face": lambda number: ids["wall"][doubted.faces["wall"][number]],
        "room": lambda number: ids["room"][number],
    }
    for doubt, handler in zip(doubts, topics, strict=True):
        assert handler.topic.description == doubt.question
        assert handler.topic.creation_author == "A. Uthor"
        (view,) = handler.viewpoints.values()
        shown = view.visualization_info
        (component,) = shown.components.selection.component
        assert component.ifc_guid == expected[doubt.kind](doubt.number)
        camera = shown.orthogonal_camera
        assert [camera.camera_view_point.x, camera.camera_view_point.y] == pytest.approx(
            doubt.place_m
        )
        assert camera.camera_direction.z == -1
        (plane,) = shown.clipping_planes.clipping_plane
        # 1.2 m above a floor that lies at -0.3 m
        assert plane.location.z == pytest.approx(0.9) and plane.direction.z == 1


def test_a_topic_names_the_first_model_that_has_its_element(doubted, tmp_path):
    """The wall is left out of the first model, the room of both."""
    ids = element_ids.ids_from_places(doubted)
    wall = next(d.number for d in list_doubts(doubted) if d.kind == "wall")
    hosts = doubted.faces["wall"][[d.number for d in list_doubts(doubted) if d.kind == "face"]]
    (host,) = {int(number) for number in hosts} - {wall}
    models = {
        "presentation.ifc": f"IFCWALL('{ids['wall'][host]}')",
        "plan.ifc": f"IFCWALL('{ids['wall'][host]}'); IFCWALL('{ids['wall'][wall]}')",
    }
    found = read(doubt_topics.format_bcf(doubted, ids, ORIGIN, models), tmp_path)
    told = {}
    for handler in found.topics.values():
        (file,) = handler.markup.header.file
        (view,) = handler.viewpoints.values()
        selection = view.visualization_info.components.selection
        chosen = [c.ifc_guid for c in selection.component] if selection else []
        told[handler.topic.labels[0]] = (file.filename, chosen)
    assert told == {
        "wall": ("plan.ifc", [ids["wall"][wall]]),
        "face": ("presentation.ifc", [ids["wall"][host]]),
        "room": ("presentation.ifc", []),
    }


def test_the_same_plan_gives_the_same_bytes(doubted):
    ids = element_ids.ids_from_places(doubted)
    first = doubt_topics.format_bcf(doubted, ids, ORIGIN)
    assert doubt_topics.format_bcf(doubted, ids, ORIGIN) == first
    assert io.BytesIO(first).read(2) == b"PK"


def test_a_plan_without_doubts_has_no_topics(tmp_path):
    walls = floorplan_making.walls()
    walls["verify"][:] = False
    sure = floorplan_making.plan(walls=walls)
    found = read(doubt_topics.format_bcf(sure, element_ids.ids_from_places(sure), ORIGIN), tmp_path)
    assert found is not None and found.topics == {}


@pytest.mark.wording
@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_topics_are_in_the_language_but_for_names_of_rooms(doubted, language):
    doubted.rooms["name"][1] = "wall"  # a name is none of our words
    openings = {
        "verify": np.array([False, True, False]),
        "about": np.array(["", "kind", ""], object),
    }
    openings["doubt"] = np.array(["", "may be open in part, bounds no room", ""], object)
    plan = replace(doubted, openings=doubted.openings | openings)

    def words(locale):
        found = list_doubts(plan, locale)
        return [(of.name, of.reason, of.question) for of in found]

    english, other = words(ENGLISH), words(make_locale("m", read_words(language)))
    assert len(english) == len(other) >= 4
    for one, two in zip(english, other, strict=True):
        assert one[1] != two[1] and one[2] != two[2]
        assert (one[0] == two[0]) == (one[0] == "wall")
    assert any("wall" in question for _, _, question in other)
    if language == "de":
        reason = "vielleicht zum Teil offen, begrenzt keinen Raum"
        question = "Ist es das: Tür rechts in Room 0, 0,9 m breit gezeichnet?"
        assert ("Tür 1", reason, question) in other


def test_a_file_of_topics_is_in_the_language(doubted, tmp_path):
    german = make_locale("m", read_words("de"))
    origin = ModelOrigin(locale=german)
    ids = element_ids.ids_from_places(doubted)
    found = read(doubt_topics.format_bcf(doubted, ids, origin), tmp_path)
    topics = [handler.topic for handler in found.topics.values()]
    doubts = list_doubts(doubted, german)
    assert {t.title for t in topics} == {f"{d.name}: {d.reason}" for d in doubts}
    assert {t.description for t in topics} == {d.question for d in doubts}
    assert {"Wand", "Wandseite", "Raum"} & {label for t in topics for label in t.labels}


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_whatever_may_be_asked_has_words(language):
    assert set(list_phrases()) | {OF_WALL, "face"} <= set(read_words(language)["phrases"])
