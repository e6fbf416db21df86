"""How single rays at a toy wall are counted: y = 0, its face to the north, the floor at z = 0.

Columns of 5 cm begin at x = 0, rows of 0.2 m at 0.1 m; a ray at 1.2 m is in row 5.
"""

from dataclasses import replace

import numpy as np
import pytest

from helpers import toy_rooms
from helpers.ray_making import NORTH, rays
from scanplan.geometry.lines import Line
from scanplan.plan.model.surface_counts import (
    BEYOND,
    DEEP,
    FACE,
    LOST,
    N_ENDS,
    SHALLOW,
    Side,
    count_ends,
)
from scanplan.rays import ray_set
from scanplan.rays.azimuth_sectors import N_SECTORS, number_sectors

ALL = np.array([(-np.inf, np.inf)])
SENSOR = (0.025, 2.0, 1.2)
SQUARE, OBLIQUE = 0, 1
SOUTH = Line(np.array([0.0, -0.2]), np.array([0.0, -1.0]))
"""The face on the other side of a wall of 0.2 m, whose direction is the other way round."""


def count(*scans, sides=None, high_m=2.0, planar=False):
    """Return what rays say of 2 m of the wall, (columns, rows, incidence, ends)."""
    own = [Side(NORTH, 0.24, ALL)] if sides is None else sides
    return count_ends(rays(*scans, planar=planar), NORTH, 0.0, high_m, own).ends


def said(ends):
    """Return all that is said: (column, row, incidence, end) with how many witnesses."""
    where = np.argwhere(ends > 0)
    return {tuple(cell): round(float(ends[tuple(cell)]), 6) for cell in where.tolist()}


@pytest.mark.parametrize(
    ("y_m", "end"),
    [
        *((0.03, FACE), (0.0, FACE), (-0.03, FACE)),
        *((-0.05, SHALLOW), (-0.11, SHALLOW)),
        *((-0.13, DEEP), (-0.23, DEEP)),
        *((-0.25, BEYOND), (-6.0, BEYOND)),
    ],
)
def test_a_ray_ends_at_the_face_behind_it_in_the_wall_or_beyond(y_m, end):
    assert said(count((SENSOR, [(0.025, y_m, 1.2)]))) == {(0, 5, SQUARE, end): 1}


@pytest.mark.parametrize("y_m", [0.05, 0.5, 1.9])
def test_a_ray_that_ends_before_the_face_says_nothing(y_m):
    assert said(count((SENSOR, [(0.025, y_m, 1.2)]))) == {}


@pytest.mark.parametrize("end_m", [(2.525, 0, 1.2), (-0.5, 0, 1.2), (0.025, 0, 4.3)])
def test_what_is_beyond_the_cells_is_not_counted(end_m):
    assert said(count((SENSOR, [end_m]))) == {}


def test_a_ray_counts_where_it_meets_the_wall_not_where_it_ends():
    """From 2 m before the wall to 2 m behind it: it meets the wall half way, and 0.6 m lower."""
    assert said(count((SENSOR, [(1.075, -2, 0.0)]))) == {(11, 2, OBLIQUE, BEYOND): 1}


def test_middles_are_those_of_the_columns():
    counts = count_ends(rays((SENSOR, [])), NORTH, 3.0, 3.12, [Side(NORTH, 0.24, ALL)])
    np.testing.assert_allclose(counts.middles_m, [3.025, 3.075, 3.125])
    assert counts.ends.shape == (3, 20, 2, N_ENDS) and not counts.ends.any()


class TestWitnesses:
    """Places are cells of half a metre."""

    END = (0.225, 0, 1.2)
    HERE, BESIDE, AWAY = (0.1, 2.1, 1.2), (0.3, 2.3, 1.2), (0.7, 2.1, 1.2)

    def test_two_rays_of_a_scan_are_one_witness(self):
        assert said(count((self.HERE, [self.END] * 2))) == {(4, 5, SQUARE, FACE): 1}

    def test_two_scans_of_one_place_are_one_witness(self):
        seen = count((self.HERE, [self.END]), (self.BESIDE, [self.END]))
        assert said(seen) == {(4, 5, SQUARE, FACE): 1}

    def test_scans_of_two_places_are_two(self):
        seen = count((self.HERE, [self.END]), (self.AWAY, [self.END]))
        assert seen[4, 5].sum() == 2

    def test_a_place_that_says_two_things_says_each_by_its_share(self):
        behind = (0.225, -0.1, 1.2)
        seen = count((self.HERE, [self.END]), (self.BESIDE, [behind]))
        assert seen[4, 5, :, FACE].sum() == 0.5 and seen[4, 5, :, SHALLOW].sum() == 0.5


class TestIncidence:
    """Square is within 10 degrees: 0.35 m of two."""

    @pytest.mark.parametrize(
        ("end_m", "incidence"),
        [
            ((0.325, 0, 1.2), SQUARE),
            ((0.425, 0, 1.2), OBLIQUE),
            ((0.025, 0, 1.5), SQUARE),
            ((0.025, 0, 1.6), OBLIQUE),
            ((0.325, 0, 1.5), OBLIQUE),
        ],
    )
    def test_rays_along_and_up_are_told_from_square_ones(self, end_m, incidence):
        seen = count((SENSOR, [end_m]))
        assert seen[:, :, incidence].sum() == 1 and seen[:, :, 1 - incidence].sum() == 0

    def test_in_the_plane_the_way_along_alone_counts(self):
        seen = count((SENSOR, [(0.325, 0, 0), (0.425, 0, 0)]), planar=True)
        assert said(seen) == {(6, 0, SQUARE, FACE): 1, (8, 0, OBLIQUE, FACE): 1}


class TestSides:
    NORTH_SCAN = (SENSOR, [(0.025, 0, 1.2)])
    SOUTH_SCAN = ((0.525, -2.2, 1.2), [(0.525, -0.2, 1.2)])

    def test_of_two_lines_of_a_side_each_is_asked_where_it_is_nearest(self):
        """A wall that steps back by 0.1 m at x = 1."""
        back = Line(np.array([0.0, -0.1]), np.array([0.0, 1.0]))
        sides = [
            Side(NORTH, 0.24, np.array([(-np.inf, 1.0)])),
            Side(back, 0.24, np.array([(1.0, np.inf)])),
        ]
        scan = (1.0, 2.0, 1.2), [(0.525, 0, 1.2), (1.525, -0.1, 1.2)]
        assert said(count(scan, sides=sides)) == {
            (10, 5, OBLIQUE, FACE): 1,
            (30, 5, OBLIQUE, FACE): 1,
        }

    def test_the_other_side_counts_in_the_same_columns(self):
        sides = [Side(NORTH, 0.24, ALL), Side(SOUTH, 0.24, ALL)]
        seen = count(self.NORTH_SCAN, self.SOUTH_SCAN, sides=sides)
        assert said(seen) == {(0, 5, SQUARE, FACE): 1, (10, 5, SQUARE, FACE): 1}

    def test_what_comes_from_behind_through_a_wall_of_one_side_counts(self):
        from_behind = ((0.525, -2.2, 1.2), [(0.525, 1, 1.2)])
        assert said(count(from_behind)) == {(10, 5, SQUARE, BEYOND): 1}
        assert said(count(self.SOUTH_SCAN)) == {}  # it ends before the face

    def test_what_comes_through_a_wall_of_two_sides_counts_once(self):
        sides = [Side(NORTH, 0.24, ALL), Side(SOUTH, 0.24, ALL)]
        from_behind = ((0.525, -2.2, 1.2), [(0.525, 1, 1.2)])
        assert said(count(from_behind, sides=sides)) == {(10, 5, SQUARE, BEYOND): 1}


class TestLost:
    """A room whose south wall has a hole of 0.7 m that leads nowhere.

    Two scans look from near, and one from a corner, from where the hole is narrower than what ends
    a sensor's field. What is lost is judged in 0.65 m together.
    """

    ROOM = (
        *((0, 0, 1.65, 0), (2.35, 0, 4, 0)),
        *((4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)),
    )
    SENSORS = ((2.0, 2.0, 0.0), (2.8, 1.5, 0.0), (0.2, 3.8, 0.0))

    @pytest.fixture(scope="class")
    def looked(self):
        sensors = {i: np.array(s) for i, s in enumerate(self.SENSORS)}
        room = np.array(self.ROOM, float)
        scans = [(i, toy_rooms.laser(sensors[i], room, noise_m=0.002)) for i in sensors]
        return ray_set.gather_rays(scans, sensors, planar=True)

    @pytest.fixture(scope="class")
    def counts(self, looked):
        return count_ends(looked, NORTH, 0.0, 4.0, [Side(NORTH, 0.24, ALL)])

    def test_of_a_tilted_sensor_nothing_is_known_to_be_lost(self, looked, counts):
        own = [Side(NORTH, 0.24, ALL)]
        upset = looked.with_up(np.tile((0.6, 0.0, 0.8), (3, 1)))
        tilted = count_ends(upset, NORTH, 0.0, 4.0, own).ends
        assert tilted[..., LOST].sum() == 0
        np.testing.assert_array_equal(tilted[..., :LOST] > 0, counts.ends[..., :LOST] > 0)

    def test_rays_that_were_left_out_are_not_lost(self, looked, counts):
        own = [Side(NORTH, 0.24, ALL)]
        jambs_m = np.array([(1.65, 0), (2.35, 0)])
        ways_m = jambs_m - looked.sensors_m[:, None, :2]
        first, last = number_sectors(np.arctan2(ways_m[..., 1], ways_m[..., 0])).T
        sectors = np.arange(N_SECTORS)
        left_out = (first[:, None] <= sectors) & (sectors <= last[:, None])
        known = count_ends(replace(looked, left_out=left_out), NORTH, 0.0, 4.0, own).ends
        is_hole = np.abs(counts.middles_m - 2.0) < 0.35
        assert counts.ends[is_hole, ..., LOST].sum() > 10
        assert known[is_hole, ..., LOST].sum() == 0
        np.testing.assert_array_equal(known[..., :LOST] > 0, counts.ends[..., :LOST] > 0)

    def test_rays_that_never_come_back_are_lost_where_they_were_sent(self, counts):
        lost = counts.ends[..., LOST].sum(axis=(1, 2))
        from_middle_m = np.abs(counts.middles_m - 2.0)
        assert lost[from_middle_m < 0.1].min() > 1.5
        assert lost[from_middle_m > 0.35 + 0.35].max() < 0.2

    def test_nothing_else_is_said_of_the_hole(self, counts):
        is_hole = np.abs(counts.middles_m - 2.0) < 0.3
        assert counts.ends[is_hole, :, :, :LOST].sum() == 0

    def test_no_place_is_more_than_one_witness(self, counts):
        assert counts.ends.sum(axis=(1, 2, 3)).max() <= len(self.SENSORS) + 1e-9
