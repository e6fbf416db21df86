"""Lines along arcs, circles fitted to places, and paths with arcs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.exports.sheet.marks import flatten
from scanplan.geometry import arcs

ANGLES = st.floats(0.0, 6.28)
SHIFTS = st.floats(-100.0, 100.0)


def on_circle(radius_m, at_rad, centre_m=(0.0, 0.0)):
    return np.asarray(centre_m) + radius_m * np.column_stack([np.cos(at_rad), np.sin(at_rad)])


@pytest.mark.parametrize("turn_rad", [0.01, 1.0, -1.0, 3.0])
def test_chords_of_an_arc_are_within_the_sagitta(turn_rad):
    corners_m = arcs.trace_arc(on_circle(4.0, [0.3, 0.3 + turn_rad]), np.zeros(2))
    middles_m = (corners_m[1:] + corners_m[:-1]) / 2
    assert np.hypot(*corners_m.T) == pytest.approx(4.0)
    assert np.hypot(*middles_m.T).min() >= 4.0 - arcs.SAGITTA_M - 1e-9
    length_m = np.hypot(*np.diff(corners_m, axis=0).T).sum()
    assert length_m == pytest.approx(4.0 * abs(turn_rad), rel=1e-3)
    assert arcs.arc_length_m(corners_m[[0, -1]], np.zeros(2)) == pytest.approx(4 * abs(turn_rad))


def test_a_parallel_arc_turns_as_far_at_its_own_radius():
    ends_m = on_circle(4.0, [0.0, 1.0])
    assert arcs.trace_arc(ends_m, np.zeros(2), away_m=0.15)[[0, -1]] == pytest.approx(
        on_circle(4.15, [0.0, 1.0])
    )


def test_an_arc_goes_on_along_its_circle_but_once_around():
    ends_m = on_circle(2.0, [0.0, 1.0])
    on = arcs.trace_arc(ends_m, np.zeros(2), beyond_m=1.0)
    assert on[[0, -1]] == pytest.approx(on_circle(2.0, [-0.5, 1.5]))
    whole = arcs.trace_arc(ends_m, np.zeros(2), beyond_m=100.0)
    assert whole[0] == pytest.approx(whole[-1])


@given(ANGLES, SHIFTS, SHIFTS, st.floats(0.5, 20.0))
def test_exact_places_give_their_circles_wherever_they_are(begin_rad, x_m, y_m, radius_m):
    at = begin_rad + np.linspace(0.0, 1.5, 30)
    centre_m = np.array([x_m, y_m])
    places_m = [on_circle(radius_m, at, centre_m), on_circle(radius_m + 0.3, at, centre_m)]
    guess_m = centre_m + 0.2 * radius_m * np.array([np.cos(begin_rad), np.sin(begin_rad)])
    fitted = arcs.fit_circles(
        np.concatenate(places_m), np.full(60, 1e-4), np.repeat([0, 1], 30), guess_m
    )
    assert fitted is not None
    assert fitted.centre_m == pytest.approx(centre_m, abs=1e-5)
    assert fitted.radii_m == pytest.approx([radius_m, radius_m + 0.3], abs=1e-5)


def test_the_error_of_a_radius_is_what_it_scatters_by():
    rng = np.random.default_rng(3)
    at = np.linspace(0.0, 1.5, 60)
    outward = on_circle(1.0, at)
    radii_m, sigmas_m = [], []
    for _ in range(100):
        places_m = (4.0 + rng.normal(0, 0.005, 60))[:, None] * outward
        fitted = arcs.fit_circles(
            places_m, np.full(60, 0.005**2), np.zeros(60, np.int64), np.zeros(2)
        )
        assert fitted is not None
        radii_m.append(fitted.radii_m[0])
        sigmas_m.append(fitted.sigmas_m[0])
    assert np.std(radii_m) == pytest.approx(np.mean(sigmas_m), rel=0.25)
    assert abs(np.mean(radii_m) - 4.0) < 3 * np.std(radii_m) / 10


def test_places_on_a_line_are_on_no_circle():
    places_m = np.column_stack([np.linspace(0, 5, 20), np.zeros(20)])
    guess_m = np.array([2.5, 1e6])
    assert arcs.fit_circles(places_m, np.ones(20), np.zeros(20, np.int64), guess_m) is None


def test_a_path_follows_known_circles_in_arcs():
    outer_m = arcs.trace_arc(on_circle(4.0, [0.0, 2.0]), np.zeros(2))
    inner_m = arcs.trace_arc(on_circle(3.7, [2.0, 0.0]), np.zeros(2))
    ring_m = np.concatenate([outer_m, inner_m, outer_m[:1]])
    circles_m = np.array([[0.0, 0.0, 4.0], [0.0, 0.0, 3.7]])
    path = arcs.bend_path(ring_m, circles_m, arcs.SAGITTA_M)
    assert path[:, 2] == pytest.approx([np.tan(0.5), 0.0, -np.tan(0.5), 0.0, 0.0])
    drawn_m = flatten(path, per_rad=50)
    radius_m = np.hypot(*drawn_m.T)
    assert np.minimum(np.abs(radius_m - 4.0), np.abs(radius_m - 3.7)).max() < 1e-9


def test_a_path_off_all_circles_stays_straight():
    square_m = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
    path = arcs.bend_path(square_m, np.array([[2.0, 2.0, 8**0.5]]), arcs.SAGITTA_M)
    assert (path[:, :2] == square_m).all()
    assert not path[:, 2].any()


def test_no_arc_of_a_path_turns_by_half_a_circle():
    ring_m = on_circle(4.0, np.linspace(0, 2 * np.pi, 120))
    path = arcs.bend_path(ring_m, np.array([[0.0, 0.0, 4.0]]), 2 * arcs.SAGITTA_M)
    assert len(path) == 4
    assert np.abs(path[:, 2]).max() < 1.0
