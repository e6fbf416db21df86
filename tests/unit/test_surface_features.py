"""What is around toy surfaces: corners, jambs, what runs behind, what rays pass over."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from helpers.observation_making import line_through, observation
from helpers.plan_wall_making import box, wall
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model.surface_counts import BEYOND, DEEP, FACE, LOST, N_ENDS, SurfaceCounts
from scanplan.plan.model.surface_features import Surroundings

NAN = float("nan")
NOTHING = SurfaceCounts(0.0, np.zeros((20, 20, 2, N_ENDS)))


def look(walls, number=0, counts=NOTHING):
    return Surroundings(walls).observe(number, counts, NAN, 0.0)


def with_face(made):
    """Return a wall with its left face, of which nothing was seen."""
    half_m = made.half_m * made.line.normal
    (x0, y0), (x1, y1) = made.ends + half_m
    seen = observation(line_through(x0, y0, x1, y1))
    return replace(made, left=[FaceInterval(seen, 0.0, made.length_m)])


def with_door(made, low_m, high_m, kind="door"):
    opened = wall(*made.ends.ravel().tolist(), made.thickness_m, openings=[(low_m, high_m)])
    return replace(opened, openings=[replace(o, kind=kind) for o in opened.openings])


class TestCorners:
    def test_a_wall_of_a_room_has_inner_corners(self):
        """Seen from inside, the next walls come forward at both ends."""
        found = look(box())
        assert (found.n_inner, found.n_outer) == (2, 0)

    def test_a_side_of_a_cupboard_has_outer_ones(self):
        """Seen from outside, its other sides go back."""
        around = [(0, 0), (0, 1), (1, 1), (1, 0), (0, 0)]
        sides = [wall(*a, *b, NAN) for a, b in pairwise(around)]
        found = look(sides)
        assert (found.n_inner, found.n_outer) == (0, 2)

    def test_a_niche_has_one_of_each(self):
        """Along +x, seen from the north: a wall comes forward at its begin, another goes back."""
        walls = [wall(0, 0, 2, 0, NAN), wall(0, 2, 0, 0, NAN), wall(2, 0, 2, -2, NAN)]
        found = look(walls)
        assert (found.n_inner, found.n_outer) == (1, 1)

    def test_what_goes_on_straight_or_far_away_is_no_corner(self):
        walls = [wall(0, 0, 2, 0, NAN), wall(2, 0, 4, 0, NAN), wall(-0.5, 2, -0.5, 0, NAN)]
        found = look(walls)
        assert (found.n_inner, found.n_outer) == (0, 0)

    def test_of_a_thick_wall_corners_are_at_its_face(self):
        """A wall across ends 0.3 m from the middle of one of 0.4 m."""
        walls = [wall(0, 0, 2, 0, 0.4), wall(0, 2, 0, 0.3, NAN)]
        assert look(walls).n_inner == 1
        assert look([replace(walls[0], thickness_m=0.1), walls[1]]).n_inner == 0


class TestHinge:
    FACADE = with_door(wall(0, 0, 5, 0, 0.2), 2.0, 2.9)

    def test_an_open_leaf_ends_at_the_jamb_and_is_as_long_as_the_opening(self):
        """It hangs at x = 2 on the wall's northern face, y = 0.1, and is 0.85 m long."""
        found = look([wall(2, 0.1, 2, 0.95, NAN), self.FACADE])
        assert found.hinge_m == pytest.approx(0)
        assert found.fits_door_m == pytest.approx(0.85 - 0.9)

    def test_of_two_openings_it_is_the_one_that_fits(self):
        """At x = 2.9 begins another one of 1.6 m."""
        facade = wall(0, 0, 5, 0, 0.2, openings=[(2.0, 2.9), (2.9, 4.5)])
        facade = replace(facade, openings=[replace(o, kind="door") for o in facade.openings])
        found = look([wall(2.9, 0.1, 2.9, 1.0, NAN), facade])
        assert (found.hinge_m, found.fits_door_m) == pytest.approx((0, 0), abs=1e-9)

    def test_its_own_openings_and_windows_are_none(self):
        own = look([self.FACADE])
        window = with_door(wall(0, 0, 5, 0, 0.2), 2.0, 2.9, kind="window")
        other = look([wall(2, 0.1, 2, 0.95, NAN), window])
        for found in (own, other):
            assert math.isinf(found.hinge_m) and math.isinf(found.fits_door_m)

    @pytest.mark.parametrize("width_m", [0.4, 2.6])
    def test_no_leaf_hangs_in_what_is_narrower_or_wider_than_doors(self, width_m):
        facade = with_door(wall(0, 0, 5, 0, 0.2), 2.0, 2.0 + width_m)
        assert math.isinf(look([wall(2, 0.1, 2, 0.5, NAN), facade]).hinge_m)


class TestBehind:
    FRONT = wall(1, 0.6, 2, 0.6, NAN)

    def test_a_wall_that_faces_the_same_way_runs_behind_a_cupboard(self):
        found = look([self.FRONT, with_face(wall(0, 0, 5, 0, NAN))])
        assert found.behind_m == pytest.approx(0.6)

    @pytest.mark.parametrize(
        "other",
        [
            pytest.param(wall(5, 0, 0, 0, NAN), id="it faces the other way"),
            pytest.param(wall(0, 1.2, 5, 1.2, NAN), id="it runs before it"),
            pytest.param(wall(0, 0.4, 5, 0.4, NAN), id="it is the same surface"),
            pytest.param(wall(0, -0.7, 5, -0.7, NAN), id="it is farther than furniture is deep"),
            pytest.param(wall(1.5, 0.4, 1.5, -1, NAN), id="it runs across"),
        ],
    )
    def test_nothing_else_is_behind_it(self, other):
        assert math.isinf(look([self.FRONT, with_face(other)]).behind_m)


class TestOverlooked:
    """One metre in columns of 5 cm, rows of 0.2 m from 0.1 m on; one witness of each cell."""

    @staticmethod
    def counts(top_rows, passing=BEYOND, n=2.0):
        """Return a surface seen up to so many rows, column by column, and rays above it."""
        ends = np.zeros((20, 20, 2, N_ENDS))
        for column, top in enumerate(np.broadcast_to(top_rows, 20)):
            ends[column, :top, 1, FACE] = 1
            ends[column, top : top + 1, 1, passing] = n
        return SurfaceCounts(0.0, ends)

    @pytest.mark.parametrize(
        ("passing", "share"), [(BEYOND, 1), (DEEP, 1), (LOST, 0)], ids=["beyond", "deep", "lost"]
    )
    def test_it_is_what_rays_pass_over(self, passing, share):
        counts = self.counts(5, passing=passing)
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).overlooked == share

    def test_it_is_a_share_of_what_was_seen_of_it(self):
        """Of 16 columns that were seen 4 are low."""
        counts = self.counts([5] * 4 + [20] * 12 + [0] * 4)
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).overlooked == pytest.approx(4 / 16)

    def test_less_than_a_witness_is_none(self):
        assert look([wall(0, 0, 1, 0, NAN)], counts=self.counts(5, n=0.9)).overlooked == 0

    def test_openings_are_not_asked(self):
        """A window from 0.25 to 0.5 m."""
        counts = self.counts([20] * 5 + [5] * 5 + [20] * 10)
        made = wall(0, 0, 1, 0, NAN, openings=[(0.25, 0.5)])
        assert look([made], counts=counts).overlooked == 0
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).overlooked == pytest.approx(5 / 20)

    def test_in_the_plane_nothing_is(self):
        ends = np.full((20, 1, 2, N_ENDS), 3.0)
        made = [wall(0, 0, 1, 0, NAN)]
        assert look(made, counts=SurfaceCounts(0.0, ends)).overlooked == 0

    def test_of_what_was_not_seen_at_all_nothing_is_known(self):
        assert look([wall(0, 0, 1, 0, NAN)]).overlooked == 0


def test_what_else_is_known_is_handed_on():
    found = Surroundings([wall(0, 0, 3, 0, 0.2)]).observe(0, NOTHING, 1.1, 0.4)
    assert (found.length_m, found.thickness_m) == pytest.approx((3, 0.2))
    assert (found.top_m, found.through_glass) == (1.1, 0.4)
