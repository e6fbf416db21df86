"""Panes of a toy room: a stretch of a wall gives one ray in twenty back."""

import numpy as np
import pytest
from scanplan.rays.face_profile import FaceObservation

from helpers import house_making
from scanplan.geometry.lines import Line
from scanplan.plan import glass
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.walls import PlanWall
from scanplan.rays import missing_returns, ray_set

SENSORS = [(1, 2, 0.9), (2, 3, 0.9), (3, 2, 0.9), (2.5, 3.4, 0.9)]
SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))
ROOM = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]


def look(lost, sensors=SENSORS):
    """Rays of scans, the lowest at 0.5 m, that lose nineteen of twenty of the points (n, 3) that `lost` names."""
    generator = np.random.default_rng(1)
    scans = [
        (i, xyz[~lost(xyz) | (generator.random(len(xyz)) < 0.05)]) for i, xyz in _scans(sensors)
    ]
    return ray_set.gather_rays(scans, dict(enumerate(np.array(sensors, float))), planar=False)


def _scans(sensors):
    return house_making.scans(ROOM, sensors, columns=1800)


def through(low_z, high_z):
    return lambda xyz: (
        (np.abs(xyz[:, 1]) < 0.1)
        & (xyz[:, 0] > 1)
        & (xyz[:, 0] < 3)
        & (xyz[:, 2] > low_z)
        & (xyz[:, 2] < high_z)
    )


def test_a_pane_down_to_the_floor_is_found():
    np.testing.assert_allclose(
        missing_returns.find_missing_returns(look(through(0.1, 2.4)), SOUTH, 0, 4),
        [(1, 3)],
        atol=0.16,
    )


@pytest.mark.parametrize("heights", [(1.3, 2.4), (0.1, 1.3), (9, 9)])
def test_a_wall_below_a_window_or_above_an_oven_is_wall(heights):
    assert len(missing_returns.find_missing_returns(look(through(*heights)), SOUTH, 0, 4)) == 0


def test_two_scans_are_not_enough():
    assert (
        len(missing_returns.find_missing_returns(look(through(0.1, 2.4), SENSORS[:2]), SOUTH, 0, 4))
        == 0
    )


def test_from_behind_nothing_is_told():
    behind = Line(SOUTH.centre, -SOUTH.normal)
    assert len(missing_returns.find_missing_returns(look(through(0.1, 2.4)), behind, -4, 0)) == 0


def test_a_pane_has_a_frame():
    nothing = (np.empty(0), np.empty(0), np.empty(0, int))
    sill = np.arange(1.0, 2.0, 0.02)
    line = FaceObservation(
        SOUTH, *nothing[:2], np.empty(0), nothing[2], *nothing, foot_m=sill, foot_z_m=0 * sill + 0.1
    )
    line = FaceObservation(**{**vars(line), "panes_m": np.array([(1.0, 2.0), (2.0, 3.5)])})
    np.testing.assert_allclose(line.framed_m, [(1.0, 2.0)])


def wall(x0, y0, x1, y1, openings=()):
    start, end = np.array([x0, y0], float), np.array([x1, y1], float)
    along = (end - start) / np.hypot(*(end - start))
    ways = [Opening(low, high, OPEN, 99, 0.0, np.nan, False) for low, high in openings]
    return PlanWall(
        Line(start, np.array([-along[1], along[0]])),
        0.0,
        np.hypot(*(end - start)),
        0.2,
        [],
        [],
        ways,
        [],
    )


class TestGlazing:
    def between(self, walls, *span):
        return [
            p.ends[:, 0]
            for p in glass.find_glass_walls(
                walls, [(SOUTH, *span)], min_length_m=0.5, unpaired_m=0.1
            )
        ]

    def test_a_pane_goes_on_to_the_walls_beside_it(self):
        walls = [wall(0, 0, 0.8, 0), wall(3.5, -1, 3.5, 1)]
        np.testing.assert_allclose(self.between(walls, 1.0, 3.0), [(0.8, 3.5)])

    def test_a_far_wall_leaves_it_as_it_is(self):
        np.testing.assert_allclose(self.between([wall(5, -1, 5, 1)], 1.0, 3.0), [(1, 3)])

    def test_a_glass_door_in_a_wall_is_an_opening_of_it(self):
        assert self.between([wall(0, 0, 4, 0, openings=[(1, 2)])], 1.1, 1.9) == []

    def test_a_slit_bounds_nothing(self):
        assert self.between([], 1.0, 1.3) == []
