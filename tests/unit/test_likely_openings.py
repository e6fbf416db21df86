"""Openings of toy walls with rooms on one side or on both, and which of them are drawn."""

from dataclasses import replace

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers.label_making import paired, scans_at, with_hole
from scanplan.plan.model import priors
from scanplan.plan.model.likely_openings import settle_openings
from scanplan.plan.model.wall_labels import LabelEvidence, label_wall
from scanplan.plan.plan_wall import Bend
from scanplan.plan.rooms.room import Room

LENGTH_M = 5.0


def rooms(*boxes):
    return [Room(shapely.box(*box), 1.0, entered=True, n_scans=1) for box in boxes]


BOTH = rooms((0, 0.1, 5, 3), (0, -3, 5, -0.1))
"""Before a wall along x, and behind it."""
ONE = rooms((0, -3, 5, 3))
"""The same room on both sides."""


def opened(low_m, high_m, heights_m=(0, 2.1), faces=None):
    """Return a wall with the opening that its labels show."""
    seen = faces or [(0, low_m), (high_m, LENGTH_M)]
    wall, looked = paired(
        scans_at(LENGTH_M, with_hole((low_m, high_m), heights_m)), seen, length_m=LENGTH_M
    )
    ((part, _),) = label_wall(wall, LabelEvidence(looked, np.empty((0, 2)), 2.0))
    assert len(part.openings) == 1
    return part


def settled(wall, rooms):
    parts, _ = settle_openings(wall, rooms, max_door_m=1.4)
    return parts


class TestSettled:
    def test_a_door_from_room_to_room_stays(self):
        (wall,) = settled(opened(2, 2.9), BOTH)
        (door,) = wall.openings
        assert door.kind == "door" and door.p_kind > 0.8

    def test_a_gap_of_60_cm_within_a_room_is_no_door_and_parts_what_stands_there(self):
        wall = opened(2, 2.65)
        assert [opening.kind for opening in wall.openings] == ["door"]
        parts = settled(wall, ONE)
        assert [part.openings for part in parts] == [[], []]
        spans_m = [np.sort(part.ends[:, 0]) for part in parts]
        np.testing.assert_allclose(sorted(map(tuple, spans_m)), [(0, 2), (2.65, 5)], atol=0.05)

    def test_what_is_narrower_than_any_leaf_is_a_gap(self):
        (wall,) = settled(opened(2, 2.55), ONE)
        assert [opening.kind for opening in wall.openings] == ["gap"]

    def test_a_window_from_room_to_room_is_a_picture_or_a_mirror(self):
        wall = opened(2, 2.6, (0.9, 2.1), faces=[(0, 5)])
        (kept,) = settled(wall, ONE)
        assert kept.openings == [] and kept.closed == wall.closed
        assert len(kept.left) == len(wall.left)
        (outer,) = settled(opened(2, 3.2, (0.9, 2.1), faces=[(0, 5)]), BOTH[:1])
        assert [of.kind for of in outer.openings] == ["window"]

    def test_a_gap_in_what_may_be_furniture_is_no_door(self):
        wall = opened(2, 2.9)
        (door,) = [replace(of, p_kind=0.9) for of in wall.openings]
        sure, doubtful = (replace(wall, openings=[door], p_wall=p) for p in (0.98, 0.5))
        assert settled(sure, BOTH)[0].openings[0].kind == "door"
        assert [part.openings for part in settled(doubtful, BOTH)] == [[], []]

    def test_what_is_nearly_likely_is_told(self):
        wall = opened(2, 2.9)
        (door,) = [replace(of, p_kind=0.3) for of in wall.openings]
        parts, (near,) = settle_openings(replace(wall, openings=[door]), BOTH, max_door_m=1.4)
        assert len(parts) == 2 and near.kind == "door" and 0.3 <= near.p < 0.5
        np.testing.assert_allclose(np.sort(near.ends_m[:, 0]), [2, 2.9], atol=0.03)

    def test_where_no_room_is_known_all_stays(self):
        wall = opened(2, 2.55)
        assert settled(wall, []) == [wall]

    def test_a_curved_wall_stays(self):
        wall = replace(opened(2, 2.55), bend=Bend(np.array([2.5, -9.0]), 9.0, 0.01))
        assert settled(wall, ONE) == [wall]

    def test_what_is_wider_than_a_door_stays(self):
        (wall,) = settled(opened(2, 3.6), ONE)
        assert [of.type_name(1.4) for of in wall.openings] == ["passage"]

    def test_what_is_of_no_kind_stays(self):
        wall = opened(2, 2.55)
        unknown = replace(
            wall, openings=[replace(of, kind="gap", p_kind=0.4) for of in wall.openings]
        )
        assert [part.openings for part in settled(unknown, ONE)] == [unknown.openings]


class TestOdds:
    P = st.floats(0.01, 0.99)

    @given(st.sampled_from(["door", "window"]), P, st.floats(0.2, 3.0), P)
    def test_more_is_likelier(self, kind, p, width_m, p_wall):
        within, beside = ((0, 0), (0, 1)) if kind == "door" else ((0, 1), (0, -1))
        odds = priors.weigh_opening(kind, p, width_m, beside, p_wall)
        assert priors.weigh_opening(kind, p, width_m, within, p_wall) < odds
        assert priors.weigh_opening(kind, p, width_m + 0.1, beside, p_wall) >= odds
        assert priors.weigh_opening(kind, p + 0.005, width_m, beside, p_wall) > odds
        assert priors.weigh_opening(kind, p, width_m, beside, p_wall + 0.005) > odds
