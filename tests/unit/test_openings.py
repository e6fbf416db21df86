from dataclasses import replace

import numpy as np
import pytest

from helpers.observation_making import observation
from scanplan.geometry.lines import Line
from scanplan.plan import openings

DOOR_HEIGHT_M = 1.8
SETTINGS = openings.OpeningSettings(
    min_opening_m=0.5,
    max_opening_m=2.0,
    max_closed_m=1.5,
    max_door_m=1.5,
    door_height_m=DOOR_HEIGHT_M,
)
AXIS = Line(np.zeros(2), np.array([0.0, 1.0]))


def seen(hits, passes, n_scans=1, behind_m=0.0, **more):
    hits = [(*hit, -behind_m, number % n_scans) for number, hit in enumerate(sorted(hits))]
    return observation(AXIS, hits, passes, **more)


def grid(low, high, *heights):
    return [(x, z) for x in np.arange(low + 0.01, high, 0.03) for z in heights]


def classify(low, high, sides, **more):
    return openings.classify_gap(AXIS, low, high, sides, SETTINGS, **more)


def judge(hits, passes, low=1.0, high=1.9, n_scans=1, behind_m=0.0, *, planar=False, **more):
    line = seen(hits, passes, n_scans, behind_m, planar=planar)
    return classify(low, high, [line], **more)


def test_a_door():
    gap = judge(grid(1, 1.9, 2.2, 2.5), grid(1, 1.9, 0.1, 1.0, 2.0))
    assert (gap.state, gap.kind, gap.sill_m) == (openings.OPEN, openings.GAP, 0)
    assert gap.lintel_m == pytest.approx(2.1, abs=0.11)
    assert gap.width_m == pytest.approx(0.9)


def test_a_window():
    gap = judge(grid(1, 1.9, 0.5, 0.8, 2.2), grid(1, 1.9, 1.0, 1.6))
    assert gap.sill_m == pytest.approx(0.8)


def judge_with_low(low, hits, lowest_m):
    line = seen(hits, grid(1, 1.9, lowest_m, 1.0, 2.0), low=low)
    return classify(1.0, 1.9, [line])


def test_a_low_sill_all_along_makes_a_window():
    gap = judge_with_low(grid(1, 1.9, 0.02, 0.07, 0.09), grid(1, 1.9, 2.2), 0.13)
    assert gap.sill_m == pytest.approx(0.09)


@pytest.mark.parametrize(("below", "sill_m"), [([], 0.09), (grid(1, 1.9, 0.15, 0.2), 0.2)])
def test_a_step_makes_a_window_whether_or_not_wall_is_seen_below_it(below, sill_m):
    """No ray went through below 0.35 m.

    Wall up to 0.2 m says more of the sill than a step up to 0.09 m does.
    """
    gap = judge_with_low(
        grid(1, 1.9, 0.05, 0.09), [*below, *grid(1, 1.9, 2.2)], 0.35 if below else 0.13
    )
    assert gap.sill_m == pytest.approx(sill_m)


def test_a_step_shows_a_sill_that_no_wall_is_below():
    """Far below the lowest rays through, the step is all that is known of the sill."""
    gap = judge_with_low(grid(1, 1.9, 0.05, 0.09), grid(1, 1.9, 2.2), 0.4)
    assert gap.sill_m == pytest.approx(0.09)


@pytest.mark.parametrize("low", [grid(1, 1.9, 0.0, 0.02, 0.03), grid(1, 1.3, 0.05, 0.07, 0.09)])
def test_a_floor_or_what_stands_on_it_is_no_sill(low):
    gap = judge_with_low(low, grid(1, 1.9, 2.2), 0.13)
    assert gap.sill_m == 0


def test_a_wide_opening_is_a_passage():
    gap = replace(judge([], grid(1, 2.8, 0.1, 1.0), high=2.8), kind="door")
    assert gap.type_name(SETTINGS.max_door_m) == "passage"
    assert gap.type_name(2.0) == "door"


def test_nothing_seen_to_pass_is_wall():
    assert judge([], []).state == openings.CLOSED


def test_a_long_pause_that_nothing_passed_is_not_known():
    assert judge([], [], high=2.8).state == openings.UNKNOWN


def test_few_rays_on_one_edge_are_no_opening():
    assert judge([], grid(1, 1.2, 0.5, 1.0, 1.5)).state == openings.UNKNOWN


@pytest.mark.parametrize(
    ("heights", "state"),
    [((1.1, 1.2, 1.3, 1.5), openings.CLOSED), ((0.1, 0.5, 1.0, 1.5), openings.UNKNOWN)],
)
def test_a_corner_of_a_window_that_things_hide_is_wall(heights, state):
    assert judge(grid(1, 1.9, 2.3), grid(1.05, 1.15, *heights)).state == state


def test_a_slit_is_no_opening():
    assert judge([], grid(1, 1.3, 0.5, 1.0, 1.5), high=1.3).state != openings.OPEN


def test_the_side_that_more_rays_crossed_decides():
    sides = [seen([], []), seen([], grid(1, 1.9, 0.1, 1.0))]
    assert classify(1.0, 1.9, sides).state == openings.OPEN


def test_a_lintel_that_one_side_shows_is_known():
    sides = [
        seen([], grid(1, 1.3, 0.1, 1.0)),
        seen(grid(1, 1.9, 2.2), grid(1, 1.25, 0.1, 1.0), 2, behind_m=0.03),
    ]
    gap = classify(1.0, 1.9, sides)
    assert (gap.state, gap.lintel_m) == (openings.OPEN, pytest.approx(2.2))


def test_a_lintel_is_between_rays_close_to_each_other():
    gap = judge(grid(1, 1.9, 2.2, 2.5), grid(1, 1.9, 0.1, 1.0, 2.04))
    assert (gap.lintel_m, gap.below_wall) == (pytest.approx(2.12), True)


@pytest.mark.parametrize(
    ("n_scans", "behind_m", "lintel_m"), [(1, 0.03, np.nan), (2, 0.0, np.nan), (2, 0.03, 2.05)]
)
def test_between_rays_far_apart_a_lintel_is_known_by_its_underside_alone(
    n_scans, behind_m, lintel_m
):
    """Beams on the wall's face may be well above the lintel.

    What lies behind it, for two scans, is its underside.
    """
    gap = judge(
        grid(1, 1.9, 2.05, 2.5, 2.6), grid(1, 1.9, 0.1, 1.6), n_scans=n_scans, behind_m=behind_m
    )
    assert gap.lintel_m == pytest.approx(lintel_m, nan_ok=True)
    assert (gap.state, gap.below_wall) == (openings.OPEN, True)


def test_how_many_rays_are_low_does_not_move_the_lintel():
    """As many rays as may be go through near the floor; it is the highest that tell."""
    few, many = ([*grid(1, 1.9, *[0.1] * n), *grid(1, 1.3, 1.9)] for n in (1, 99))
    lintels_m = [judge(grid(1, 1.9, 2.1), passes).lintel_m for passes in (few, many)]
    assert lintels_m == [pytest.approx(2.0)] * 2


def test_points_of_the_reveal_are_no_lintel():
    reveal = [(x, z) for x in (1.04, 1.86) for z in np.arange(1.85, 2.0, 0.01)]
    assert judge([*grid(1, 1.9, 2.0), *reveal], grid(1, 1.9, 0.1, 1.82)).lintel_m == pytest.approx(
        1.91
    )


def test_beside_the_end_of_a_wall_only_a_lintel_makes_an_opening():
    passes = grid(1, 1.9, 0.1, 1.0)
    assert judge([], passes, needs_lintel=True).state == openings.UNKNOWN
    assert judge(grid(1, 1.9, 2.2), passes, needs_lintel=True).state == openings.OPEN


def test_heights_are_not_told_of_a_plane():
    flat = seen([], grid(1, 1.9, 0.0, 0.0), planar=True)
    gap = classify(1.0, 1.9, [flat])
    assert gap.state == openings.OPEN
    assert np.isnan([gap.sill_m, gap.lintel_m]).all()


@pytest.mark.parametrize(("n_rays", "state"), [(2, openings.CLOSED), (3, openings.UNKNOWN)])
def test_one_or_two_rays_through_open_no_wall(n_rays, state):
    """Each goes through a column of its own, more than a tenth of all."""
    passes = [(1.1 + 0.2 * number, 1.0) for number in range(n_rays)]
    assert judge([], passes).state == state


def test_a_few_rays_of_planar_scans_show_a_way_by_the_share_of_its_width():
    """Six rays 0.15 m apart, as a scanner of one degree sends them 8 m away."""
    passes = [(x, 0.0) for x in np.arange(1.05, 1.9, 0.15)]
    assert judge([], passes, planar=True).state == openings.OPEN
    assert judge([], passes[:3], planar=True).state == openings.UNKNOWN
    assert judge([], passes).state == openings.UNKNOWN


def test_a_way_in_the_plane_is_where_more_rays_go_through_than_end():
    passes = [(x, 0.0) for x in np.arange(1.05, 1.9, 0.15)]
    hits = [(x + 0.01 * i, 0.0) for x in np.arange(1.05, 1.9, 0.15) for i in (-1, 1)]
    assert judge(hits, passes, planar=True).state != openings.OPEN


@pytest.mark.parametrize(("end_m", "state"), [(1.85, openings.CLOSED), (1.5, openings.UNKNOWN)])
def test_of_a_gap_where_no_rays_were_gathered_nothing_is_known(end_m, state):
    line = replace(seen([], []), low_end_m=-3.0, high_end_m=end_m)
    assert classify(1.0, 1.9, [line]).state == state
    whole = replace(line, high_end_m=3.0)
    assert classify(1.0, 1.9, [line, whole]).state == openings.CLOSED
