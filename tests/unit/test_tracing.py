"""Which faces are walls, and claim the points where they cross a line, known on paper."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.default_settings import SETTINGS
from helpers.observation_making import stretch
from scanplan.plan import planning
from scanplan.plan.faces import tracing
from scanplan.project import stage_settings

_SETTINGS = planning.make_plan_settings(stage_settings.select_plan(SETTINGS))
SELECTION = tracing._FaceSelection(_SETTINGS.merge, _SETTINGS.pairs)


def claims_on_first(*found):
    return tracing.owned_intervals([found[0].observation], list(found))[0]


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


def seen_by(scan, *ends):
    """Return a stretch of which a planar scan shows a point every 5 cm."""
    length_m = np.hypot(ends[2] - ends[0], ends[3] - ends[1])
    return stretch(*ends, [(m, 0, 0, scan) for m in np.arange(0.02, length_m, 0.05)], planar=True)


@pytest.mark.parametrize(("other_scan", "n_drawn"), [(1, 2), (0, 0)])
def test_two_scans_that_show_a_side_each_show_a_wall(other_scan, n_drawn):
    """A partition with a door: of either side one scan sees the wall at another jamb."""
    one, other = seen_by(0, 0, 0.1, 0.75, 0.1), seen_by(other_scan, 2.4, 0, 1.65, 0)
    assert len(SELECTION.select_walls([[one], [other]])) == n_drawn


@pytest.mark.parametrize(
    "other",
    [(0.75, -0.8, 0, -0.8), (0, -0.1, 0.75, -0.1), (0.2, 0, 0, 0)],
    ids=["too_thick", "same_side", "too_short"],
)
def test_what_is_not_the_other_side_of_a_wall_does_not_speak_for_it(other):
    assert SELECTION.select_walls([[seen_by(0, 0, 0.1, 0.75, 0.1)], [seen_by(1, *other)]]) == []
