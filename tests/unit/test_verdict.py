"""What a drawing is worth as a whole, and which cause is the likeliest."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from helpers.refusals import assert_told
from scanplan.stage import witness_table, witnesses
from scanplan.store.doubts import Doubts, Finding
from scanplan.validation.verdict import judge_plan


def finding(name, beyond=2.0):
    return Finding(name, beyond, f"said of {name}", f"cause of {name}", f"remedy of {name}")


def judged(findings=(), closed=(True, True), areas_m2=(12.0, 9.0)):
    rooms = floorplan_making.rooms()
    n = len(closed)
    rows = {name: np.repeat(values[:1], n) for name, values in rooms.items()}
    rows |= {"room": np.arange(n), "closed": np.array(closed), "area_m2": np.array(areas_m2)}
    return judge_plan(floorplan_making.plan(rooms=rows, doubted=Doubts(findings=tuple(findings))))


def test_closed_rooms_and_nothing_against_them_are_a_plan():
    verdict = judged()
    assert_told(verdict.line, value=("a plan", "2 of 2 rooms", "100%"))
    assert not verdict.cause and not verdict.remedy


def test_less_than_half_of_the_rooms_or_of_their_floor_closed_is_a_sketch():
    half = judged(closed=(True, False), areas_m2=(9.0, 9.0))
    less = judged(closed=(True, False), areas_m2=(8.9, 9.0))
    assert half.worth == witness_table.PLAN and less.worth == witness_table.SKETCH
    assert_told(less.gist, value=("1 of 2 rooms is", "50%"))
    assert "Room 1 " in less.remedy
    few = judged(closed=(True, False, False), areas_m2=(90.0, 9.0, 9.0))
    assert few.worth == witness_table.SKETCH


def test_of_many_open_rooms_the_widest_are_named():
    n = 20
    verdict = judged(closed=[False] * n, areas_m2=np.arange(n) + 1.0)
    assert "Room 19 and others" in verdict.remedy and "Room 0," not in verdict.remedy


def test_rooms_that_corrections_opened_are_not_blamed_on_the_recording():
    rows = floorplan_making.rooms() | {"closed": np.array([False, False])}
    # 12 and 9 m²: what most of the open floor is open by is named, with its rooms
    by_hand = judge_plan(floorplan_making.plan(rooms=rows, opened_by_hand=[0]))
    assert_told(by_hand.line, value=("corrections", "Room 0"), remedy="merge")
    unseen = judge_plan(floorplan_making.plan(rooms=rows, opened_by_hand=[1]))
    assert_told(unseen.line, value=("not seen", "Room 0"), remedy="look into")
    for verdict, other in ((by_hand, "not seen"), (unseen, "corrections")):
        assert other not in verdict.line and "Room 1" not in verdict.line


def test_one_open_room_is_said_in_the_singular():
    gist = judged(closed=(False,), areas_m2=(9.0,)).gist
    assert_told(gist, value=("0 of 1 room is", "0%"))


def test_no_room_is_a_sketch():
    assert judged(closed=(), areas_m2=()).worth == witness_table.SKETCH


@given(st.lists(st.sampled_from(sorted(witness_table.WITNESSES)), max_size=6, unique=True))
def test_the_worst_that_was_found_is_the_worth_and_the_cause_comes_before_its_signs(names):
    verdict = judged([finding(name) for name in names])
    known = [witness_table.WITNESSES[name] for name in names]
    worths = [witness_table.WORTHS.index(each.leaves) for each in known]
    assert verdict.worth == witness_table.WORTHS[min(worths, default=2)]
    if verdict.worth == witness_table.PLAN:
        return
    told = [each.tells for each in known if each.leaves != witness_table.PLAN]
    name = verdict.cause.removeprefix("cause of ")
    assert witness_table.WITNESSES[name].tells == min(told)
    assert verdict.remedy == f"remedy of {name}"


def test_of_several_causes_the_one_farthest_beyond_its_limit_leads():
    # ranges a tenth short also part a map by a little
    verdict = judged([finding("map jump", 1.2), finding("scale", 4.3)])
    assert verdict.cause == "cause of scale" and verdict.worth == witness_table.NOT_A_PLAN


@pytest.mark.parametrize("value", [0, 3])
def test_of_what_no_sound_survey_has_any_number_is_told(value):
    found = witnesses.state_witness("odometry resets", value)
    assert found.is_beyond == (value > 0)
    assert value == 0 or found.finding.beyond == 4.0
