"""Numbers that speak for or against a survey: limits, words, and what each is measured by."""

import dataclasses
import string

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from scanplan.registration import pose_lean
from scanplan.stage import witness_table, witnesses
from scanplan.store import doubts
from scanplan.validation import survey_witnesses


def fields(text):
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


def state_all(value_of):
    """Every witness with a value by its limit, and any number for what its words name."""
    for name, known in witness_table.WITNESSES.items():
        words = known.means + known.cause + known.remedy
        more = dict.fromkeys(fields(words) - {"value", "limit"}, 7)
        yield name, witnesses.state_witness(name, value_of(known.limit), **more)


def test_what_is_beyond_its_limit_is_told_with_value_and_remedy():
    measured = [found for _, found in state_all(lambda limit: limit + 1)]
    told = witnesses.tell("stage", measured)
    assert len(told) == len(witness_table.WITNESSES)
    for finding, found in zip(told, measured, strict=True):
        known = witness_table.WITNESSES[found.name]
        assert finding.remedy and finding.cause and finding.beyond > 1
        assert "{" not in finding.sentence + known.gist
        assert known.leaves in witness_table.WORTHS


@pytest.mark.parametrize("value_of", [lambda limit: limit, lambda limit: np.nan])
def test_what_is_at_its_limit_or_not_known_is_not_told(value_of):
    assert witnesses.tell("stage", [found for _, found in state_all(value_of)]) == []


@given(lean_deg=st.floats(0, 90), turn_deg=st.floats(0, 360))
def test_a_plane_leans_by_what_it_was_turned_by(lean_deg, turn_deg):
    x_m, y_m = np.meshgrid(np.arange(6.0), np.arange(4.0))
    flat_m = np.column_stack([x_m.ravel(), y_m.ravel(), np.zeros(x_m.size)])
    lean, turn = np.radians([lean_deg, turn_deg])
    about_x = np.array(
        [[1, 0, 0], [0, np.cos(lean), -np.sin(lean)], [0, np.sin(lean), np.cos(lean)]]
    )
    about_z = np.array(
        [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    )
    found_deg = pose_lean.measure_lean_deg(flat_m @ (about_z @ about_x).T)
    assert found_deg == pytest.approx(lean_deg, abs=1e-3)


def test_ways_along_a_line_or_over_stairs_have_no_plane():
    along = np.column_stack([np.arange(9.0), np.zeros(9), np.zeros(9)])
    x_m, y_m = np.meshgrid(np.arange(6.0), np.arange(4.0))
    stairs = np.column_stack([x_m.ravel(), y_m.ravel(), np.where(x_m.ravel() > 2, 1.5, 0.0)])
    assert np.isnan(pose_lean.measure_lean_deg(along))
    assert np.isnan(pose_lean.measure_lean_deg(stairs))


def test_a_way_is_as_narrow_as_its_narrowest_place():
    plan = floorplan_making.bare(((0, -5, 0, -1, -1), (0, 1, 0, 5, -1)))
    # there and back through a way 2 m wide, where half of it is hidden from the other half
    ends = [[(x, y) for y in np.linspace(-4, 4, 9)] for x in (-4.0, 4.0)]
    way_m = np.array([*ends[0], (0.0, 0.0), *ends[1]])
    assert survey_witnesses.measure_narrowest(plan, way_m) == pytest.approx(1.0, abs=0.6)
    in_one_room = np.array(ends[0])
    assert np.isnan(survey_witnesses.measure_narrowest(plan, in_one_room))


def test_where_no_rays_were_recorded_the_narrowest_door_is_asked_for():
    rayless = doubts.Doubts(rayless=("no rays",))
    plan = floorplan_making.plan(doubted=rayless)
    plan.openings["width_m"][:] = np.where(plan.openings["type"] == "door", 3.0, 1.0)
    assert survey_witnesses.measure_narrowest_door(plan) == 3.0
    without = dataclasses.replace(floorplan_making.bare(), doubted=rayless)
    for other in (floorplan_making.plan(), without):
        assert np.isnan(survey_witnesses.measure_narrowest_door(other))


@pytest.mark.parametrize("name", ["contradicted rays", "wide doors"])
def test_what_panes_or_gates_may_explain_leaves_a_sketch(name):
    assert witness_table.WITNESSES[name].leaves == witness_table.SKETCH


def test_head_room_speaks_where_no_door_shows_which_way_is_up():
    seen = {"ceiling_z_m": 2.4, "floor_z_m": 0.0}
    on_floor = floorplan_making.plan(**seen)
    assert (on_floor.openings["type"] == "door").any()
    assert np.isnan(survey_witnesses.measure_head_room(on_floor, 1.8))
    without = floorplan_making.bare()
    upside = floorplan_making.plan(ceiling_z_m=2.4, floor_z_m=np.nan)
    assert survey_witnesses.measure_head_room(upside, 1.8) == pytest.approx(1 - 0.6 / 2.4, abs=0.02)
    assert np.isnan(survey_witnesses.measure_head_room(without, 1.8))
