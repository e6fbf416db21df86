"""Which faces claim the points where they cross a line, of stretches known on paper."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.observation_making import stretch
from scanplan.plan.faces import tracing


def claims_on_first(*found):
    return tracing.owned_intervals([found[0].seen], list(found))[0]


def test_a_wall_that_crosses_claims_what_is_beside_it():
    assert claims_on_first(stretch(0, 0, 4, 0), stretch(3, 0.05, 3, 2)) == [
        pytest.approx((2.92, 3.08))
    ]


def test_a_wall_that_ends_well_before_a_line_claims_nothing():
    assert claims_on_first(stretch(0, 0, 4, 0), stretch(3, 0.2, 3, 2)) == []


def test_the_end_of_a_wall_between_its_two_faces_claims_nothing():
    jamb = stretch(3.05, 0.01, 3.05, -0.16)
    assert claims_on_first(stretch(0, 0, 3, 0), stretch(3, -0.15, 0, -0.15), jamb) == []


def test_the_end_of_a_thick_wall_claims_its_corners():
    jamb = stretch(3.05, 0.0, 3.05, -0.5)
    assert len(claims_on_first(stretch(0, 0, 3, 0), stretch(3, -0.5, 0, -0.5), jamb)) == 1


def test_what_a_cut_leaves_without_a_point_is_no_face():
    # points to x = 2 alone: a crossing face took them over
    points = np.column_stack([np.arange(0, 2, 0.02), np.zeros((100, 2))])
    face = stretch(0, 0, 3, 0, points)
    found = [replace(face, low_m=2.5, high_m=2.7), replace(face, low_m=1.0)]
    assert tracing._without_stubs(found) == found[1:]
