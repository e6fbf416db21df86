"""Curved walls of two surveys compared: along their arcs, not between their ends."""

import math

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.changing_floor import survey
from scanplan.changes import face_shifts, wall_changes
from scanplan.changes.curve_shifts import find_moved_curves, join_curves
from scanplan.changes.frame_fit import fit_frame
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.verdicts import GONE, MOVED, NEW, SAME
from scanplan.geometry.arcs import trace_arc
from scanplan.store import schemas

ENDS_M, CENTRE_M = np.array([(3.5, 4.0), (3.5, 1.0)]), np.array([5.0, 2.5])
RADIUS_M, HALF_M = math.hypot(1.5, 1.5), 0.05
NUMBER = 4
CHORD = (3.5, 3.3, 3.5, 1.7)


def sides():
    """Short chords of the inner and the outer side of a quarter of a ring in the larger room."""
    for away_m in (-HALF_M, HALF_M):
        corners_m = trace_arc(ENDS_M, CENTRE_M, away_m=away_m)
        yield from np.stack([corners_m[:-1], corners_m[1:]], axis=1)


def surveyed(*, has_arc=True, hidden=(), by_m=(0.0, 0.0)):
    """The floor without inner walls, with the curved one, which nothing is drawn of but itself.

    `by_m` is how far that stands from where it stood.
    """
    arc = [tuple((line + by_m).ravel()) for line in sides()] if has_arc else []
    found = survey([], [], hidden=[*arc, *hidden])
    if has_arc:
        added = floorplan_making.walls([((ENDS_M + by_m).ravel(), 2 * HALF_M, -1, -1, "observed")])
        values = (*(CENTRE_M + by_m), RADIUS_M, 0.002)
        added |= {name: np.array([of]) for name, of in zip(schemas.ARC, values, strict=True)}
        added |= {"wall": np.array([NUMBER], np.int32), "p_true": np.array([0.99])}
        walls = {name: np.append(of, added[name]) for name, of in found.plan.walls.items()}
        object.__setattr__(found.plan, "walls", walls)
    return found


def compare(a, b):
    fit = fit_frame(a.faces, b.faces, PlaneMotion())
    curves = find_moved_curves(a, b, fit)
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
