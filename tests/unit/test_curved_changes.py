"""Curved walls of two surveys compared: along their arcs, not between their ends."""

import math

import numpy as np
import pytest
import shapely

from helpers.curved_floor import CENTRE_M, NUMBER, RADIUS_M, surveyed
from scanplan.changes import face_shifts, wall_changes
from scanplan.changes.curve_shifts import join_curves, measure_curves
from scanplan.changes.frame_fit import fit_frame
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.verdicts import GONE, MOVED, NEW, SAME

CHORD = (3.5, 3.3, 3.5, 1.7)


def compare(a, b):
    fit = fit_frame(a.faces, b.faces, PlaneMotion())
    curves = measure_curves(a, b, fit)
    changes = wall_changes.compare_walls(a, b, face_shifts.measure_shifts(a, b, fit))
    return join_curves(changes, curves)


def test_a_curved_wall_that_stands_is_the_same_all_along():
    changes = compare(surveyed(), surveyed())
    curved = [c for c in changes if c.number_a == NUMBER]
    assert {c.verdict for c in changes} == {SAME}
    length_m = sum(c.shape.length for c in curved)
    assert length_m == pytest.approx(math.pi / 2 * RADIUS_M, abs=0.2)
    for change in curved:
        corners_m = shapely.get_coordinates(change.shape)
        assert np.hypot(*(corners_m - CENTRE_M).T) == pytest.approx(RADIUS_M, abs=0.06)


def test_what_stood_at_the_chord_of_a_curved_wall_is_none_of_it():
    with_thing = surveyed(hidden=[CHORD])
    assert {c.verdict for c in compare(with_thing, surveyed()) if c.number_a == NUMBER} == {SAME}
    assert {c.verdict for c in compare(surveyed(), with_thing)} == {SAME}


def test_a_curved_wall_that_rays_go_through_is_gone_and_the_other_way_round_new():
    gone = [c for c in compare(surveyed(), surveyed(has_arc=False)) if c.verdict == GONE]
    assert {(c.number_a, c.is_change) for c in gone} == {(NUMBER, True)}
    length_m = sum(c.shape.length for c in gone)
    assert length_m == pytest.approx(math.pi / 2 * RADIUS_M, abs=0.3)
    new = [c for c in compare(surveyed(has_arc=False), surveyed()) if c.verdict == NEW]
    assert sum(c.shape.length for c in new) == pytest.approx(length_m)


@pytest.mark.parametrize("by_m", [(0.4, 0.0), (-0.3, 0.2)])
def test_a_curved_wall_that_moved_is_told_as_one_wall_by_how_far(by_m):
    changes = compare(surveyed(), surveyed(by_m=by_m))
    (moved,) = [c for c in changes if NUMBER in (c.number_a, c.number_b)]
    assert (moved.number_a, moved.number_b, moved.verdict) == (NUMBER, NUMBER, MOVED)
    assert moved.is_change and moved.moved_m == pytest.approx(by_m, abs=0.01)
    assert moved.shift_m == pytest.approx(math.hypot(*by_m), abs=0.01)
    assert moved.shape.length == pytest.approx(math.pi / 2 * RADIUS_M, abs=0.01)


def test_a_curved_wall_of_another_curvature_has_not_moved():
    bent = surveyed(by_m=(0.3, 0.0))
    flatter_m = np.append(np.full(4, np.nan), CENTRE_M[0] + 3.0)
    object.__setattr__(bent.plan, "walls", bent.plan.walls | {"arc_x_m": flatter_m})
    assert MOVED not in {c.verdict for c in compare(surveyed(), bent)}
