"""The prior of right angles: what it turns, and what is known too well to be turned."""

import numpy as np
import pytest
from scanplan.rays.face_profile import FaceObservation

from scanplan.geometry.lines import Line
from scanplan.plan import right_angles

PRIOR = right_angles.RightAnglePrior(
    max_turn_deg=1.0, sigmas=2.0, min_share=0.25, registration_sigma_m=0.02
)


def line(direction_deg, length_m, n_scans=4, at=(0.0, 0.0)):
    """A line that each of some scans shows as a whole, every 5 cm."""
    angle = np.radians(direction_deg)
    normal = np.array([-np.sin(angle), np.cos(angle)])
    place = np.tile(np.linspace(0, length_m, int(length_m / 0.05) + 1), n_scans)
    scan = np.repeat(np.arange(n_scans), len(place) // n_scans)
    order = np.argsort(place, kind="stable")
    nothing = (np.empty(0), np.empty(0), np.empty(0, int))
    return FaceObservation(
        Line(np.array(at), normal), place[order], 0 * place, 0 * place + 1, scan[order], *nothing
    )


BUILDING = [line(0, 20), line(90, 15), line(180, 18)]


def direction_deg(seen):
    return np.degrees(np.arctan2(*seen.line.direction[::-1])) % 90


def turned(*lines, **more):
    prior = right_angles.RightAnglePrior(**{**vars(PRIOR), **more})
    return [
        direction_deg(s)
        for s in right_angles.turn_lines([*BUILDING, *lines], prior)[len(BUILDING) :]
    ]


def test_a_short_wall_that_few_scans_show_is_turned():
    # 2 m seen whole by four scans: its direction is known to 0.02 / (2 / 3.46) / 2 rad = 1 degree
    assert turned(line(0.8, 2)) == [pytest.approx(0, abs=0.01)]


def test_a_wall_that_is_truly_oblique_stays():
    # 0.8 degrees off, too, but 15 m long and seen by 40 scans: known to 0.04 degrees
    assert turned(line(0.8, 15, n_scans=40)) == [pytest.approx(0.8, abs=0.001)]


@pytest.mark.parametrize("off_deg", [1.2, 30, 45, 88])
def test_what_is_further_off_is_oblique(off_deg):
    assert turned(line(off_deg, 0.5, n_scans=1)) == [pytest.approx(off_deg, abs=1e-6)]


def test_nothing_is_turned_where_it_is_switched_off():
    lines = [*BUILDING, line(0.8, 2)]
    assert (
        right_angles.turn_lines(lines, right_angles.RightAnglePrior(0.0, 2.0, 0.25, 0.02)) is lines
    )


def test_a_second_wing_has_its_own_directions():
    wing = [line(30, 20), line(120, 10), line(29.4, 2)]
    assert turned(*wing)[-1] == pytest.approx(30, abs=0.05)


def test_a_round_building_has_none():
    lines = [line(a, 2) for a in range(0, 90, 5)]
    assert (
        len(
            right_angles.main_directions(
                np.radians(np.arange(0, 90, 5)), np.full(18, 2.0), min_share=0.25
            )
        )
        == 0
    )
    assert right_angles.turn_lines(lines, PRIOR) is lines


def test_a_line_turns_about_its_middle_and_its_points_stay():
    before = line(0.8, 2, at=(5.0, 3.0))
    after = right_angles.turn_lines([*BUILDING, before], PRIOR)[-1]
    np.testing.assert_allclose(after.line.at(0.0), before.line.at(1.0), atol=1e-9)
    middle, ends = after.hit_off_m[np.abs(after.hit_m) < 0.01], after.hit_off_m[[0, -1]]
    np.testing.assert_allclose(middle, 0, atol=1e-3)
    np.testing.assert_allclose(np.abs(ends), np.sin(np.radians(0.8)), rtol=0.01)


def test_a_line_that_no_point_shows_stays():
    empty = line(0, 2)
    nothing = (
        np.empty(0),
        np.empty(0),
        np.empty(0),
        np.empty(0, int),
        np.empty(0),
        np.empty(0),
        np.empty(0, int),
    )
    assert turned(FaceObservation(empty.line, *nothing)) == [pytest.approx(0)]


def test_no_lines():
    assert right_angles.turn_lines([], PRIOR) == []
