"""Kinds of openings of a toy room.

What becomes of the rays to a part of its south wall is known on paper.
"""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers.facade_making import ENDS_M, LIMITS, NICHE, ROOM, SENSORS, SETTINGS, SOUTH, look, wall
from helpers.observation_making import line_through, observation
from helpers.ray_making import rays
from scanplan.plan import opening_kinds
from scanplan.plan.faces import intervals
from scanplan.plan.openings import (
    CLOSED,
    GAP,
    OPEN,
    Opening,
    OpeningSettings,
    classify_gap,
)
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.wall_ground import UNSEEN, BareSpan, find_bare_spans
from scanplan.rays.height_profile import ROWS_M, HeightProfile

MAX_DOOR_M = SETTINGS.openings.max_door_m


def profile(rows, *, n_floor=0):
    """A profile of ten rays a row; `rows` says where each ends: s(olid), o(pen), - for none."""
    ends = {"s": (10, 0, 0), "r": (0, 10, 0), "o": (0, 0, 10), "-": (0, 0, 0)}
    assert len(rows) == len(ROWS_M) - 1
    return HeightProfile(np.array([ends[row] for row in rows], float), n_floor, 1.0)


def likeliest(rows, *, is_outside, n_floor=0, **more):
    share = opening_kinds.weigh_kinds(profile(rows, n_floor=n_floor), is_outside=is_outside, **more)
    assert share.sum() == pytest.approx(1)
    return opening_kinds.KINDS[share.argmax()], share.max()


DOOR, WINDOW, HIDDEN = "oooooooooosss", "sssooooooosss", "----ooooooss-"


@pytest.mark.parametrize("is_outside", [False, True])
@pytest.mark.parametrize(
    ("rows", "n_floor", "kind"),
    [
        (DOOR, 50, "door"),
        (WINDOW, 0, "window"),
        ("s" * 13, 0, "wall"),
        ("r" * 13, 0, "wall"),
    ],
)
def test_what_is_seen_from_floor_to_lintel_is_told_inside_as_outside(
    rows, n_floor, kind, is_outside
):
    found, share = likeliest(rows, is_outside=is_outside, n_floor=n_floor)
    assert (found, share > 0.8) == (kind, True)


def test_a_way_out_that_no_floor_was_seen_through_and_nobody_drove_is_no_door():
    assert likeliest(DOOR, is_outside=True)[0] == "glass"
    assert likeliest(DOOR, is_outside=True, is_driven=True)[0] == "door"
    assert likeliest(DOOR, is_outside=True, n_floor=9)[0] == "door"


def test_a_gap_of_a_facade_whose_foot_furniture_hides_is_a_window():
    found, share = likeliest(HIDDEN, is_outside=True)
    assert (found, share > 0.8) == ("window", True)


def test_between_rooms_nothing_is_said_of_a_gap_whose_foot_is_hidden():
    assert likeliest(HIDDEN, is_outside=False)[1] < 0.8


def test_a_low_step_makes_a_window_of_what_is_open_down_to_it():
    assert likeliest(DOOR, is_outside=True, sill_m=0.12)[0] == "window"


def test_without_rays_the_priors_are_left():
    """Nothing reached the foot, either, so that these are weighed by what stands before things."""
    share = opening_kinds.weigh_kinds(profile("-" * 13), is_outside=True)
    weight = np.array([2 * 0.5, 1 * 0.05, 6.5 * 0.5, 0.5 * 0.1])
    np.testing.assert_allclose(share, weight / weight.sum())


def test_nobody_calls_anything_a_window_in_a_plane():
    share = opening_kinds.weigh_kinds(profile("o" + 12 * "-"), is_outside=True, planar=True)
    assert share[opening_kinds.KINDS.index("window")] == 0


def test_a_leaf_makes_a_door_of_a_way_out_in_a_plane():
    kind, share = likeliest(DOOR, is_outside=True, planar=True)
    assert (kind, share < 0.8) == ("door", True)
    kind, share = likeliest(DOOR, is_outside=True, planar=True, has_leaf=True)
    assert (kind, share > 0.9) == ("door", True)


def test_what_is_as_wide_as_a_door_is_one_in_a_plane():
    """A door to glass as 1 to 0.5 of what leads out, and 0.9 to 0.3 by width: 6 of 7."""
    kind, share = likeliest(DOOR, is_outside=True, planar=True, is_door_wide=True)
    assert (kind, share) == ("door", pytest.approx(6 / 7, abs=0.01))
    # in space heights say more
    wide = likeliest(DOOR, is_outside=True, is_door_wide=True)
    assert wide == likeliest(DOOR, is_outside=True)


def flat_facade(low_m, high_m, beyond_m):
    """Return planar scans, 2.5 m before a facade, of beams each half degree.

    Those between two places of it end at `beyond_m` behind it, or never.
    """
    azimuth_rad = np.radians(np.arange(-179.75, 0, 0.5))
    scans = []
    for x_m in (1.5, 2.0, 2.5):
        with np.errstate(divide="ignore", invalid="ignore"):
            at_m = x_m + 2.5 / np.tan(-azimuth_rad)
            reach_m = 2.5 / np.sin(-azimuth_rad)
            goes_on = (at_m > low_m) & (at_m < high_m)
            reach_m = np.where(goes_on, reach_m * (1 + beyond_m / 2.5), reach_m)
        kept = reach_m < 12
        ends_m = reach_m[kept, None] * np.column_stack(
            [np.cos(azimuth_rad[kept]), np.sin(azimuth_rad[kept]), 0 * azimuth_rad[kept]]
        )
        scans.append(((x_m, 2.5, 0.3), ends_m + np.array((x_m, 2.5, 0.3))))
    return rays(*scans, planar=True)


def count_beams(low_m, high_m):
    """Return how many beams of `flat_facade` are sent between two places of the facade."""
    sent_m = 2.5 / np.tan(np.radians(np.arange(0.25, 180, 0.5)))
    return sum(((x_m + sent_m > low_m) & (x_m + sent_m < high_m)).sum() for x_m in (1.5, 2.0, 2.5))


@pytest.mark.parametrize(
    ("span_m", "beyond_m", "kind"),
    [
        ((1.5, 2.5), np.nan, "door"),
        ((1.5, 2.5), 2.0, "door"),
        ((1.7, 2.4), 2.0, "door"),
        # a narrow pane rather than a way out of the building
        ((1.7, 2.4), np.nan, GAP),
        ((1.0, 3.0), np.nan, GAP),
        # as wide as two leaves: of what leads out rather a pane, between rooms a door
        ((1.4, 2.7), np.nan, GAP),
        ((1.4, 2.7), 2.0, "door"),
    ],
)
def test_rays_that_never_come_back_show_a_way_out_of_a_plane(span_m, beyond_m, kind):
    looked = flat_facade(*span_m, beyond_m)
    facade = intervals.observe_along(looked, SOUTH, *ENDS_M, band_m=0.08, reach_m=0.0)
    limits = OpeningSettings(0.5, 2.5, 1.0, MAX_DOOR_M)
    found = classify_gap(SOUTH, *span_m, [facade], limits, door_height_m=1.9)
    assert found.state == OPEN
    face = intervals.FaceInterval(facade, *ENDS_M)
    wall = PlanWall(SOUTH, *ENDS_M, np.nan, [face], [], [found])
    track_m = looked.sensors_m[:, :2]
    (decided,) = opening_kinds.decide_kinds(
        [wall], looked, track_m, beside, max_door_m=MAX_DOOR_M, niche_m=1.0, **LIMITS
    )
    assert [opening.kind for opening in decided.openings] == [kind]
    # those between its jambs, less 0.1 m at either; what ends behind it is counted there as a whole
    margin_m = 0.1 if np.isnan(beyond_m) else 0.0
    sent = count_beams(span_m[0] + margin_m, span_m[1] - margin_m)
    assert decided.openings[0].n_rays == pytest.approx(sent, rel=0.2)


def beside(place_m, wall):
    return 0, -1


def decide(looked, **gaps):
    (decided,) = opening_kinds.decide_kinds(
        *([replace(wall(looked), **gaps)], looked, np.array(SENSORS)[:, :2], beside),
        max_door_m=MAX_DOOR_M,
        niche_m=1.0,
        **LIMITS,
    )
    return decided


def gap(state):
    return Opening(1.8, 3.0, state, 0, np.nan, np.nan, False)


def test_a_closed_gap_that_rays_go_through_at_eye_height_is_a_window():
    decided = decide(look((1.0, 2.2), (0.85, 2.4)), closed=[gap(CLOSED)])
    assert [opening.kind for opening in decided.openings] == ["window"]
    assert decided.closed == []


@pytest.mark.parametrize(("middle_m", "kind"), [(1.6, GAP), (2.6, "glass")])
def test_a_leaf_tells_only_of_the_gap_that_it_hangs_at(middle_m, kind):
    """From 1 to 2.2 m rays go out; it would be a door, but that no floor was seen in it."""
    way_m = np.array([(middle_m - 0.5, 0.0), (middle_m + 0.5, 0.0)])
    looked = look((1.0, 2.2), (-1.0, 2.1))
    gaps = [replace(wall(looked), openings=[gap(OPEN)])]
    (decided,) = opening_kinds.decide_kinds(
        *(gaps, looked, np.array(SENSORS)[:, :2], beside),
        ways_m=[way_m],
        max_door_m=MAX_DOOR_M,
        niche_m=1.0,
        **LIMITS,
    )
    assert [opening.kind for opening in decided.openings] == [kind]


def test_a_gap_where_rays_end_in_a_niche_is_closed():
    decided = decide(look((1.0, 2.2), (-1.0, 2.4), NICHE), openings=[gap(OPEN)])
    assert decided.openings == []
    assert [closed.kind for closed in decided.closed] == ["wall"]


def test_a_bare_span_of_an_outline_is_what_rays_show_it_to_be():
    room = shapely.box(0, 0, 4, 4)
    spans = [BareSpan(np.array([(x, 0.0), (x + 1.2, 0.0)]), 0, UNSEEN) for x in (1.0, 2.5)]
    track_m = np.array(SENSORS)[:, :2]
    looked = look((1.0, 2.2), (0.85, 2.4))
    kinds = [
        span.kind
        for span in opening_kinds.decide_bare_spans(
            spans, looked, track_m, [room], max_width_m=2.0, band_m=0.08
        )
    ]
    assert kinds == ["window", UNSEEN]


@pytest.mark.parametrize(
    ("track_m", "max_width_m", "kind"),
    [
        ([(2.0, 2.0), (2.0, 1.0)], 3.0, "door"),
        ([(2.0, 2.0), (2.0, 1.0)], 2.0, "glass"),
        ([(2.0, 1.0), (2.0, -1.0)], 2.0, "door"),
    ],
)
def test_a_bare_way_out_too_wide_for_leaves_is_glass_if_nobody_drove_there(
    track_m, max_width_m, kind, monkeypatch
):
    """Over 2.4 m it is open down to the floor, which is seen."""
    seen = profile(DOOR, n_floor=50)
    monkeypatch.setattr(opening_kinds, "observe_heights", lambda *_, **__: seen)
    (span,) = opening_kinds.decide_bare_spans(
        [BareSpan(np.array([(0.8, 0.0), (3.2, 0.0)]), 0, UNSEEN)],
        look((0.8, 3.2), (-1.0, 2.4)),
        np.array(track_m),
        [shapely.box(0, 0, 4, 4)],
        max_width_m=max_width_m,
        band_m=0.08,
    )
    assert (span.kind, span.p_kind > 0.8, span.n_rays) == (kind, True, 100)


@pytest.mark.parametrize(("floor", "kind"), [((0, -1, 4, 4), GAP), ((0, 0, 4, 4), UNSEEN)])
def test_what_no_wall_stands_along_is_open_where_the_floor_goes_on(floor, kind):
    """Three of four sides have walls; the fourth is bare."""
    sides = [
        intervals.FaceInterval(observation(line_through(*ends)), 0.0, 4.0) for ends in ROOM[1:]
    ]
    three = [PlanWall(side.line, 0.0, 4.0, np.nan, [side], []) for side in sides]
    (span,) = find_bare_spans(
        [shapely.box(0, 0, 4, 4)], three, shapely.box(*floor), unpaired_m=0.1, min_length_m=0.5
    )
    assert (span.kind, span.room) == (kind, 0)
    np.testing.assert_allclose(np.sort(span.ends_m[:, 0]), [0.1, 3.9], atol=0.11)
    np.testing.assert_allclose(span.ends_m[:, 1], 0)


@pytest.mark.parametrize(("depth_m", "kind"), [(0.8, GAP), (1.6, "door")])
def test_what_ends_in_a_plane_no_deeper_than_furniture_may_be_a_pause_between_cupboards(
    depth_m, kind
):
    looked = flat_facade(1.0, 2.0, depth_m)
    facade = intervals.observe_along(looked, SOUTH, *ENDS_M, band_m=0.08, reach_m=0.0)
    way = Opening(1.0, 2.0, OPEN, 0, np.nan, np.nan, False)
    face = intervals.FaceInterval(facade, *ENDS_M)
    (decided,) = opening_kinds.decide_kinds(
        *([PlanWall(SOUTH, *ENDS_M, np.nan, [face], [], [way])], looked),
        *(looked.sensors_m[:, :2], beside),
        max_door_m=MAX_DOOR_M,
        niche_m=1.0,
        **LIMITS,
    )
    assert [opening.kind for opening in decided.openings] == [kind]
