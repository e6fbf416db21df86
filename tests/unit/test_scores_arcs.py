"""Curved walls as scored against a truth of chords: a third of a ring around (2, 1)."""

import numpy as np
import pytest

from helpers.scene_making import tables
from scanplan.geometry.arcs import trace_arc
from scanplan.lab.evaluation.scores import sight
from scanplan.lab.evaluation.scores.arc_scores import score_arcs
from scanplan.lab.evaluation.scores.drawn_plan import place_plan
from scanplan.lab.evaluation.scores.scene import Scene

CENTRE_M = np.array([2.0, 1.0])
ENDS_RAD = np.array([0.0, 2.0])


def ends_m(radius_m, at_rad=ENDS_RAD, centre_m=CENTRE_M):
    return centre_m + radius_m * np.column_stack([np.cos(at_rad), np.sin(at_rad)])


def chords(radius_m):
    corners_m = trace_arc(ends_m(radius_m), CENTRE_M)
    return np.stack([corners_m[:-1], corners_m[1:]], axis=1)


def scene():
    """Both sides of a wall of 0.3 m, its jambs flagged as curved, too, and a straight face."""
    jambs = np.stack([ends_m(4.0), ends_m(4.3)], axis=1)
    straight = np.array([[[2.0, 1.0], [2.0, 3.0]]])
    parts = [chords(4.0), chords(4.3), jambs, straight]
    curved = np.repeat([True, True, True, False], [len(part) for part in parts])
    return Scene(inner_m=np.concatenate(parts), glass=np.zeros(len(curved), bool), curved=curved)


def scored(radius_m, *, thickness_m=0.3, at_rad=ENDS_RAD, centre_m=CENTRE_M):
    drawn = tables(walls=[ends_m(radius_m, at_rad, centre_m)], thickness=thickness_m)
    drawn["walls"] |= {
        "arc_x_m": centre_m[:1],
        "arc_y_m": centre_m[1:],
        "arc_radius_m": np.array([radius_m]),
        "sigma_radius_m": np.array([0.001]),
    }
    truth = scene()
    return score_arcs(place_plan(drawn, np.eye(4)), truth, sight.see_all(truth)).measures


def test_an_arc_along_a_true_one_is_found_with_its_errors():
    found = scored(4.16, thickness_m=0.3, centre_m=CENTRE_M + np.array([0.03, 0.0]))
    assert (found["arcs_true"], found["arcs_found"], found["arcs_drawn"]) == (1, 1, 1)
    assert found["arc_precision"] == 1.0
    assert found["arc_radius_error_m"] == pytest.approx(0.01, abs=0.002)
    assert found["arc_centre_error_m"] == pytest.approx(0.03, abs=0.002)


def test_an_arc_along_less_than_half_finds_nothing_but_is_right():
    short = scored(4.15, at_rad=np.array([0.0, 0.8]))
    assert (short["arcs_found"], short["arc_recall"]) == (0, 0.0)
    assert short["arc_precision"] == 1.0
    assert np.isnan(short["arc_radius_error_m"])


def test_an_arc_where_nothing_is_curved_is_wrong():
    away = scored(4.15, centre_m=CENTRE_M + 20.0)
    assert (away["arcs_found"], away["arcs_drawn"], away["arc_precision"]) == (0, 1, 0.0)
