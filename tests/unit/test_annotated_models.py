"""Properties on a copy of a building model, and topics: read back by their own libraries."""

import ifcopenshell
import ifcopenshell.util.element
import numpy as np
import pytest
from bcf.v2.bcfxml import BcfXml

from helpers import ifc_making
from helpers.refusals import refused
from scanplan.exports.changes.annotated_ifc import annotate_model
from scanplan.exports.changes.model_facts import carry_ids, gather_changes
from scanplan.exports.data.model_topics import Topic, format_topics

NAME = "Scanplan_AsBuilt"
T_NS = 1_700_000_000 * 10**9


@pytest.mark.parametrize("millimetres", [False, True])
def test_an_element_has_its_properties_in_the_unit_of_its_model(tmp_path, millimetres):
    path = tmp_path / "made.ifc"
    path.write_bytes(ifc_making.model(millimetres=millimetres))
    before = ifcopenshell.open(path)
    wall, other, *_ = before.by_type("IfcWall")
    facts = {"verdict": "deviates", "differs": True, "deviation_m": 0.012, "probability": 0.97}
    text = annotate_model(path, NAME, {wall.GlobalId: facts})
    assert text == annotate_model(path, NAME, {wall.GlobalId: facts})
    after = ifcopenshell.file.from_string(text)
    stated = ifcopenshell.util.element.get_psets(after.by_guid(wall.GlobalId))[NAME]
    assert (stated["Verdict"], stated["Differs"]) == ("deviates", True)
    assert stated["Deviation"] == pytest.approx(12 if millimetres else 0.012)
    assert stated["Probability"] == 0.97
    assert NAME not in ifcopenshell.util.element.get_psets(after.by_guid(other.GlobalId))
    assert len(after.by_type("IfcWall")) == len(before.by_type("IfcWall"))


def test_an_element_that_is_not_there_ends_in_a_line(tmp_path):
    path = tmp_path / "made.ifc"
    path.write_bytes(ifc_making.model())
    with refused(file="made.ifc", remedy="run again"):
        annotate_model(path, NAME, {"0" * 22: {"verdict": "within"}})


def test_topics_are_read_back_with_what_they_select(tmp_path):
    path = tmp_path / "topics.bcf"
    guid = "2ptk1k7qn8_Qk22vjh$0DE"
    topics = [
        Topic("1", "Wall 1: +10.2 cm", "Tolerance 20 mm.", "deviates", guid, (3.0, 4.0, 0.0)),
        Topic("7", "wall 7 of the survey: additional", "", "additional", "", (1.0, 2.0, 0.0)),
    ]
    path.write_bytes(format_topics("house", topics, T_NS))
    assert path.read_bytes() == format_topics("house", topics, T_NS)
    with BcfXml.load(path) as read:
        found = {handler.topic.title: handler for handler in read.topics.values()}
        assert set(found) == {topic.title for topic in topics}
        first = found[topics[0].title]
        assert (first.topic.topic_type, first.topic.topic_status) == ("deviates", "Open")
        assert first.topic.creation_date.year == 2023
        (view,) = first.viewpoints.values()
        selected = view.visualization_info.components.selection.component
        assert [component.ifc_guid for component in selected] == [guid]
        eye = view.visualization_info.orthogonal_camera.camera_view_point
        assert (eye.x, eye.y) == (3.0, 4.0) and eye.z > 2


def test_what_was_there_before_keeps_its_id_in_the_copy(tmp_path):
    columns = {
        "element": np.array(["wall", "wall", "wall", "opening", "wall"], object),
        "number_a": np.array([0, 0, 1, 5, 2]),
        "number_b": np.array([7, 8, 8, -1, 9]),
        "length_m": np.array([3.0, 1.0, 0.5, 0.9, 1.0]),
        "area_m2": np.full(5, np.nan),
    }

    def ids(*rows):
        kinds, numbers, names = zip(*rows, strict=True)
        return {
            "kind": np.array(kinds, object),
            "number": np.array(numbers),
            "global_id": np.array(names, object),
        }

    earlier = ids(("wall", 0, "A"), ("wall", 1, "B"), ("opening", 5, "D"), ("wall", 2, "N"))
    later = ids(("wall", 7, "L"), ("wall", 8, "M"), ("wall", 9, "N"))
    # the longer part of A keeps its id, the other has that of B; N bears its own already
    assert carry_ids(columns, earlier, later) == {"L": "A", "M": "B"}
    path = tmp_path / "made.ifc"
    path.write_bytes(ifc_making.model())
    before = ifcopenshell.open(path)
    wall, other, *_ = (w.GlobalId for w in before.by_type("IfcWall"))
    new = "0" * 21 + "1"
    # ids may change places
    text = annotate_model(path, NAME, {wall: {"id_in_plan": wall}}, {wall: other, other: new})
    after = ifcopenshell.file.from_string(text)
    stated = ifcopenshell.util.element.get_psets(after.by_guid(other))[NAME]
    assert stated["IdInPlan"] == wall and after.by_guid(new).is_a("IfcWall")


def test_a_model_of_the_later_survey_says_what_became_of_its_elements():
    columns = {
        "element": np.array(["wall", "wall", "opening", "wall"], object),
        "number_b": np.array([0, 0, 3, -1]),
        "verdict": np.array(["same", "moved", "new", "gone"], object),
        "likely": np.array([False, True, False, True]),
        "p": np.array([0.99, 0.95, 0.6, 0.99]),
        "shift_m": np.array([0.001, 0.1, np.nan, np.nan]),
        "sigma_m": np.array([0.01, 0.01, np.nan, np.nan]),
        "kind_a": np.array(["", "", "", ""], object),
        "doubt": np.array(["", "", "as some leaves are", ""], object),
        "length_m": np.array([3.0, 1.0, 0.9, 2.0]),
        "area_m2": np.full(4, np.nan),
    }
    ids = {
        "kind": np.array(["wall", "opening"], object),
        "number": np.array([0, 3]),
        "global_id": np.array(["W", "O"], object),
    }
    facts = gather_changes(columns, ids)
    assert facts["W"] == {
        **{"verdict": "moved", "differs": True, "probability": 0.95},
        **{"shift_m": 0.1, "standard_deviation_m": 0.01},
    }
    assert facts["O"]["differs"] is False and facts["O"]["doubt"] == "as some leaves are"
    assert set(facts) == {"W", "O"}
