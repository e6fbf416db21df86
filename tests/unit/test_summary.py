"""A plan in lines that a surveyor reads."""

import dataclasses
import math
import re

import numpy as np

from helpers import floorplan_making, report_making
from helpers.refusals import assert_told
from scanplan.plan import floorplan
from scanplan.project.texts import CONSOLE_WIDTH
from scanplan.report import wording
from scanplan.report.facts import PredictionFacts, SurveyFacts
from scanplan.report.summary import summarise_survey
from scanplan.store import doubts


def survey(prediction=report_making.PREDICTION):
    return SurveyFacts(
        selection=report_making.selection(),
        registration=report_making.registration(),
        poses=report_making.poses(),
        segments=report_making.segments(),
        evidence=floorplan_making.evidence(),
        chosen=3,
        n_recorded=1064,
        prediction=prediction,
        visit=report_making.VISIT,
    )


def plan(**tables):
    names = ("faces", "walls", "openings", "rooms", "free")
    made = {name: getattr(floorplan_making, name)() for name in names}
    return floorplan.FloorPlan(name="office", **(made | tables))


def told_of(made, known=None):
    """Return what a summary says, by the word that each of its texts begins with."""
    text = summarise_survey(made, known or survey())
    assert max(map(len, text.splitlines())) <= CONSOLE_WIDTH
    lines = text.replace("\n" + 9 * " ", " ").splitlines()
    return {line[:9].strip(): line[9:] for line in lines}


def test_it_counts_what_was_found_and_names_what_is_doubtful():
    told = told_of(plan())
    n_rooms = len(floorplan_making.rooms()["room"])
    assert list(told) == ["verdict", "found", "doubtful", "made of", "tested"]
    assert told["verdict"].startswith("a ")
    assert told["found"].startswith(f"{n_rooms} rooms, ") and "m² of floor" in told["found"]
    counted = "3 of 4 registered scans (5 candidates of 1,064 recorded)"
    assert told["made of"].startswith(counted)
    shares = ["90.0%", "85.0%", "93.0%", "7.0%", "2.0%", "1.0%", "95.0%"]
    assert re.findall(r"[\d.]+%", told["tested"]) == shares


def test_what_to_verify_is_named_the_likeliest_to_be_wrong_first():
    made = floorplan_making.openings()
    n = len(made["opening"])
    p_true, verify = np.full(n, 0.99), np.zeros(n, bool)
    doubt = np.full(n, "", object)
    p_true[[0, 1]], verify[[0, 1]], doubt[[0, 1]] = (0.4, 0.2), True, "few rays"
    rated = made | {"p_true": p_true, "verify": verify, "doubt": doubt}
    doubtful = told_of(plan(openings=rated))["doubtful"]
    assert doubtful.startswith("2 openings (1, 0), 1 wall (2)")


def test_a_plan_without_rays_says_what_stands_for_them():
    doubted = doubts.Doubts(rayless=("a map alone",))
    made = plan(doubted=doubted)
    assert summarise_survey(made, survey()).splitlines()[1] == "no rays  a map alone"
    assert made.mark == "made without rays"


def test_an_unknown_prediction_is_no_number():
    unknown = PredictionFacts(
        0, 0, np.nan, (np.nan, np.nan), np.nan, 0, 0, 0, absent="one scan alone"
    )
    tested = told_of(plan(), survey(unknown))["tested"]
    assert "one scan alone" in tested and "%" not in tested


def test_a_plan_without_doubts_says_so_and_many_are_counted_alone():
    walls = floorplan_making.walls()
    sure = walls | {"verify": np.zeros(len(walls["wall"]), bool)}
    rooms = floorplan_making.rooms()
    closed = rooms | {"closed": np.ones(len(rooms["room"]), bool)}
    assert told_of(plan(walls=sure, rooms=closed))["doubtful"].startswith("nothing")
    nine = {name: np.repeat(values[:1], 9) for name, values in rooms.items()}
    nine |= {"room": np.arange(9), "closed": np.zeros(9, bool)}
    assert told_of(plan(walls=sure, rooms=nine))["doubtful"].startswith("9 rooms")


def test_what_speaks_against_all_of_it_stands_before_what_is_merely_noted():
    jump = doubts.Finding("map jump", 9.0, "the map jumps", "it was carried", "cut it")
    apart = doubts.Finding("days apart", 2.0, "recordings lie apart", "two states", "part them")
    found = plan(doubted=doubts.Doubts(findings=(apart, jump)))
    lines = told_of(found)
    assert lines["verdict"].startswith("not a plan: ")
    assert lines["verdict"].endswith("; it was carried; cut it")
    assert lines["doubtful"].startswith("the map jumps: it was carried; cut it; ")
    assert lines["noted"] == "recordings lie apart: two states; part them"


def test_how_far_each_control_and_check_point_is_off_is_told():
    controls = [("P1", 0.1), ("entry 2", 0.3)]
    reference = floorplan.GeoReference(
        "EPSG:25832", 5e5, 54e5, 0.0, 0.2, controls, [("K1", 0.25)], faults=["P1: is off; again"]
    )
    placed = told_of(plan(georeference=reference))["placed"]
    assert_told(placed, value=("2 control points", "P1 0.100, entry 2 0.300 m", "EPSG:25832"))
    assert_told(placed, value=("1 check point", "K1 0.250 m", "P1: is off"))


def test_a_share_that_is_not_known_is_not_stated():
    known = report_making.PREDICTION
    unknown = dataclasses.replace(known, length_share=math.nan)
    assert "nan" not in wording.prediction_sentence(unknown)
    assert wording.prediction_sentence(known).startswith(wording.prediction_sentence(unknown))
