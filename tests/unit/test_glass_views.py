"""Which share of the rays to walls leads through windows of others, of a toy room."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.observation_making import line_through, observation
from helpers.plan_wall_making import wall
from helpers.ray_making import rays
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model.glass_views import find_glass_shares
from scanplan.plan.openings import OPEN, Opening

LOOKED = rays(((2.0, 2.0, 1.0), []), ((2.0, -3.0, 1.0), []))
"""A scan 2 m north of y = 0, and one 3 m south of it."""
OUTSIDE_X = np.linspace(1.0, 3.0, 41)


def pane(kind, low_m=0.0, high_m=4.0):
    return Opening(low_m, high_m, OPEN, 9, 0.9, 2.1, True, kind=kind)


def facade(*openings):
    """Return a wall along y = 0 with openings."""
    return replace(wall(0, 0, 4, 0), openings=list(openings))


def far_wall(scans=(0,), y_m=-4.0):
    """Return a wall beyond, with 41 returns of each of these scans."""
    returns = [(x - 1.0, 1.0, 0.0, scan) for scan in scans for x in OUTSIDE_X]
    seen = observation(line_through(1, y_m, 3, y_m), returns)
    return replace(wall(1, y_m, 3, y_m, np.nan), left=[FaceInterval(seen, 0.0, 2.0)])


@pytest.mark.parametrize(("kind", "share"), [("window", 1), ("glass", 1), ("door", 0)])
def test_what_is_seen_through_a_window_of_another_wall_is_told(kind, share):
    shares = find_glass_shares([facade(pane(kind)), far_wall()], LOOKED)
    assert shares.tolist() == [0, share]


def test_of_what_is_seen_through_a_narrow_window_it_is_the_share_of_its_rays():
    """To y = -4 rays cross y = 0 after a third of the way: at x = 2 + (x' - 2) / 3."""
    window = pane("window", 1.9, 4.0)
    crossing_x = 2 + (OUTSIDE_X - 2) / 3
    shares = find_glass_shares([facade(window), far_wall()], LOOKED)
    assert shares[1] == pytest.approx(np.mean(crossing_x >= 1.9))


def test_of_two_scans_each_counts_by_its_rays():
    """The other one stands on the same side of the window as the wall."""
    shares = find_glass_shares([facade(pane("window")), far_wall((0, 1))], LOOKED)
    assert shares[1] == pytest.approx(0.5)


def test_a_walls_own_windows_do_not_count():
    own = replace(facade(pane("window")), left=far_wall().left)
    assert find_glass_shares([own], LOOKED).tolist() == [0]


def test_what_stands_close_behind_a_pane_is_a_part_of_it():
    """Rays end 0.2 m behind; what is within 0.3 m of the surface is not asked."""
    shares = find_glass_shares([facade(pane("window")), far_wall(y_m=-0.2)], LOOKED)
    assert shares[1] == 0


def test_walls_without_returns_or_without_panes_were_seen_through_none():
    assert find_glass_shares([facade(), far_wall()], LOOKED).tolist() == [0, 0]
    assert find_glass_shares([facade(pane("window"))], LOOKED).tolist() == [0]
    assert find_glass_shares([], LOOKED).tolist() == []
