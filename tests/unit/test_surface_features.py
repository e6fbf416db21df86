"""What is around toy surfaces: corners, jambs, what runs behind, what rays say of them."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely

from helpers.observation_making import line_through, observation
from helpers.plan_wall_making import box, wall
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model import islands
from scanplan.plan.model.surface_counts import BEYOND, DEEP, FACE, LOST, N_ENDS, SurfaceCounts
from scanplan.plan.model.surface_features import Surroundings

NAN = float("nan")
NO_FLOOR = shapely.Polygon()
NOTHING = SurfaceCounts(0.0, np.zeros((20, 20, 2, N_ENDS)))


def look(walls, number=0, counts=NOTHING, floor=NO_FLOOR):
    unknown = np.full(len(walls), NAN)
    return Surroundings(walls, floor).observe([counts] * len(walls), unknown, unknown)[number]


def with_face(made):
    """Return a wall with its left face, of which nothing was seen."""
    half_m = made.half_m * made.line.normal
    (x0, y0), (x1, y1) = made.ends + half_m
    seen = observation(line_through(x0, y0, x1, y1))
    return replace(made, left=[FaceInterval(seen, 0.0, made.length_m)])


def with_door(made, low_m, high_m, kind="door"):
    opened = wall(*made.ends.ravel().tolist(), made.thickness_m, openings=[(low_m, high_m)])
    return replace(opened, openings=[replace(o, kind=kind) for o in opened.openings])


class TestIslands:
    HALL = shapely.box(-3, -3, 12, 8)
    RACK = ((0, 0), (0, 0.8), (5, 0.8), (5, 0), (0, 0))

    def sides(self, turn_rad=0.0):
        """Sides of a rack of 5 m by 0.8 m, seen from outside, the first 5 cm from the others."""
        c, s = math.cos(turn_rad), math.sin(turn_rad)
        corners_m = np.array(self.RACK) @ np.array([[c, s], [-s, c]])
        sides = [wall(*a, *b, NAN) for a, b in pairwise(corners_m)]
        return [replace(sides[0], low_m=sides[0].low_m + 0.05), *sides[1:]]

    @pytest.mark.parametrize("turn_rad", [0.0, 0.6])
    def test_a_rack_is_as_deep_as_it_is_whichever_way_it_stands(self, turn_rad):
        walls = [*self.sides(turn_rad), wall(-3, -3, 12, -3, NAN)]
        depth_m = islands.find_island_depths_m(walls, self.HALL)
        assert depth_m[:4] == pytest.approx(0.8, abs=0.1) and math.isinf(depth_m[4])
        assert Surroundings(walls, self.HALL)._is_free.tolist() == [True] * 4 + [False]

    def test_where_no_floor_is_known_nothing_stands_free(self):
        found = look(self.sides(), 1)
        assert (found.free, found.back_m) == (0.0, pytest.approx(0.8))
        assert math.isnan(found.free_back_m)

    def test_what_stands_free_has_a_back_of_its_own_kind(self):
        found = look(self.sides(), 1, floor=self.HALL)
        assert (found.free, found.free_back_m) == (1.0, pytest.approx(0.8))
        assert math.isnan(found.back_m)

    def test_a_screen_whose_both_sides_see_the_same_floor_stands_free(self):
        screen = wall(2, 0, 6, 0, 0.05)
        assert islands.find_island_depths_m([screen], self.HALL)[0] == pytest.approx(0.1, abs=0.1)

    @pytest.mark.parametrize("gap_m", [0.1, 0.6])
    def test_a_rack_at_a_wall_holds_on_to_it(self, gap_m):
        """Between the two nobody goes where it is narrower than 0.3 m."""
        rack = wall(2, -3 + gap_m, 2, 0, 0.3)
        is_held = np.isinf(islands.find_island_depths_m([rack], self.HALL)[0])
        assert is_held == (gap_m < 0.3)

    def test_a_core_that_one_can_go_around_is_a_part_of_the_building(self):
        core = shapely.box(0, 0, 4, 3)
        walls = [wall(0, 0, 4, 0, NAN), wall(0, 3, 4, 3, NAN)]
        found = Surroundings(walls, self.HALL - core)
        assert islands.find_island_depths_m(walls, found.floor) == pytest.approx(3.0, abs=0.2)
        assert not found._is_free.any()


class TestDepths:
    def test_a_cupboard_at_a_wall_is_as_deep_as_it_stands_before_that(self):
        """Seen are its front and, of one side, from corner to wall; the wall itself goes on."""
        front, side = wall(1, 0.6, 3, 0.6, NAN), wall(1, 0, 1, 0.6, NAN)
        room = [wall(*of, NAN) for of in ((0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 3), (0, 3, 0, 0))]
        found = [look([front, side, *room], number).depth_m for number in range(3)]
        assert found == [pytest.approx(0.6), pytest.approx(0.6), math.inf]
        corners = Surroundings([front, side, *room]).corners
        assert corners.tolist() == [[0, 1]]


class TestCorners:
    def test_a_wall_of_a_room_has_inner_corners(self):
        """Seen from inside, the next walls come forward at both ends."""
        assert (look(box()).n_inner, look(box()).n_outer) == (2, 0)

    def test_a_side_of_a_cupboard_has_outer_ones(self):
        """Seen from outside, its other sides go back."""
        around = [(0, 0), (0, 1), (1, 1), (1, 0), (0, 0)]
        sides = [wall(*a, *b, NAN) for a, b in pairwise(around)]
        assert (look(sides).n_inner, look(sides).n_outer) == (0, 2)

    def test_a_niche_has_one_of_each(self):
        """Along +x, seen from the north: a wall comes forward at its begin, another goes back."""
        walls = [wall(0, 0, 2, 0, NAN), wall(0, 2, 0, 0, NAN), wall(2, 0, 2, -2, NAN)]
        assert (look(walls).n_inner, look(walls).n_outer) == (1, 1)

    def test_what_goes_on_straight_or_far_away_is_no_corner(self):
        walls = [wall(0, 0, 2, 0, NAN), wall(2, 0, 4, 0, NAN), wall(-0.5, 2, -0.5, 0, NAN)]
        assert look(walls).n_inner == 0

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
        assert found.hinge_m == pytest.approx(0.9 - 0.85)

    def test_of_two_openings_it_is_the_one_that_fits(self):
        """At x = 2.9 begins another one of 1.6 m."""
        facade = wall(0, 0, 5, 0, 0.2, openings=[(2.0, 2.9), (2.9, 4.5)])
        facade = replace(facade, openings=[replace(o, kind="door") for o in facade.openings])
        found = look([wall(2.9, 0.1, 2.9, 1.0, NAN), facade])
        assert found.hinge_m == pytest.approx(0, abs=1e-9)

    def test_off_its_jamb_and_too_long_it_fits_less(self):
        """0.3 m beside the jamb, and 0.4 m longer than the opening."""
        found = look([wall(1.7, 0.1, 1.7, 1.4, NAN), self.FACADE])
        assert found.hinge_m == pytest.approx(0.5)

    def test_its_own_openings_and_windows_are_none(self):
        own = look([self.FACADE])
        window = with_door(wall(0, 0, 5, 0, 0.2), 2.0, 2.9, kind="window")
        other = look([wall(2, 0.1, 2, 0.95, NAN), window])
        for found in (own, other):
            assert math.isinf(found.hinge_m)

    @pytest.mark.parametrize("width_m", [0.4, 2.6])
    def test_no_leaf_hangs_in_what_is_narrower_or_wider_than_doors(self, width_m):
        facade = with_door(wall(0, 0, 5, 0, 0.2), 2.0, 2.0 + width_m)
        assert math.isinf(look([wall(2, 0.1, 2, 0.5, NAN), facade]).hinge_m)


class TestBehind:
    FRONT = wall(1, 0.6, 2, 0.6, NAN)

    def test_a_wall_that_faces_the_same_way_runs_behind_a_cupboard(self):
        found = look([self.FRONT, with_face(wall(0, 0, 5, 0, NAN))])
        assert found.before_m == pytest.approx(0.6)

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
        assert math.isinf(look([self.FRONT, with_face(other)]).before_m)


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

    def test_its_top_is_that_of_its_columns_in_the_mean(self):
        """Rows end at 1.1 and 3.1 m."""
        counts = self.counts([5] * 4 + [15] * 12 + [0] * 4)
        top_m = (4 * 1.1 + 12 * 3.1) / 16
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).top_m == pytest.approx(top_m)

    def test_half_a_witness_is_none(self):
        assert look([wall(0, 0, 1, 0, NAN)], counts=self.counts(5, n=0.5)).overlooked == 0

    def test_openings_are_not_asked(self):
        """A window from 0.25 to 0.5 m."""
        counts = self.counts([20] * 5 + [5] * 5 + [20] * 10)
        made = with_door(wall(0, 0, 1, 0, NAN), 0.25, 0.5, kind="window")
        assert look([made], counts=counts).overlooked == 0
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).overlooked == pytest.approx(5 / 20)

    def test_in_the_plane_nothing_is_known_of_it(self):
        counts = SurfaceCounts(0.0, np.full((20, 1, 2, N_ENDS), 3.0))
        found = look([wall(0, 0, 1, 0, NAN)], counts=counts)
        assert math.isnan(found.overlooked) and math.isnan(found.top_m)

    def test_what_was_not_seen_at_all_is_not_overlooked(self):
        assert look([wall(0, 0, 1, 0, NAN)]).overlooked == 0


class TestWhatRaysSay:
    """One metre in columns of 5 cm, rows of 0.2 m, of single walls."""

    def test_what_is_an_opening_is_not_solid(self):
        """A window of 0.25 m; of a column's middle it is told in which it lies."""
        made = with_door(wall(0, 0, 1, 0, NAN), 0.25, 0.5, kind="window")
        assert look([made]).solid == pytest.approx(0.75)

    def test_a_slot_between_things_is_no_opening(self):
        assert look([with_door(wall(0, 0, 1, 0, NAN), 0.25, 0.5, kind="gap")]).solid == 1

    def test_what_ends_behind_is_a_share_of_what_ended(self):
        """Of rows 2 to 4; what passes below and above is none of it."""
        ends = np.zeros((20, 20, 2, N_ENDS))
        ends[:, 2:5, 1, FACE] = 3.0
        ends[:, 3, 1, DEEP] = 1.0
        ends[:, 8, 1, DEEP] = 5.0
        ends[:, 3, 1, LOST] = 7.0
        counts = SurfaceCounts(0.0, ends)
        assert look([wall(0, 0, 1, 0, NAN)], counts=counts).deep == pytest.approx(1 / 10)

    def test_witnesses_are_counted_in_those_of_the_usual_surface(self):
        """Ten, four and two of each column."""
        walls = [wall(0, y, 1, y, NAN) for y in (0, 5, 10)]
        ends = np.zeros((20, 20, 2, N_ENDS))
        ends[:, :2, 1, FACE] = 1.0
        counts = [SurfaceCounts(0.0, ends * of) for of in (5, 2, 1)]
        found = Surroundings(walls).observe(counts, np.zeros(3), np.ones(3))
        assert [of.witnesses for of in found] == pytest.approx([2.5, 1.0, 0.5])


class TestEnds:
    def test_it_is_the_nearer_end_to_the_body_of_another_wall(self):
        """One ends 0.3 m from the middle of a wall of 0.2 m, the other 1 m from one."""
        walls = [wall(0, 0, 3, 0, NAN), wall(3.3, -1, 3.3, 1, 0.2), wall(-1, 1, -1, -1, NAN)]
        assert look(walls).joint_m == pytest.approx(0.2)

    def test_what_stands_alone_ends_nowhere(self):
        assert math.isinf(look([wall(0, 0, 3, 0, NAN), wall(6, 0, 9, 0, NAN)]).joint_m)


class TestBack:
    FRONT = wall(0, 0.5, 1, 0.5, NAN)

    def test_the_back_of_what_stands_free_faces_the_other_way(self):
        assert look([self.FRONT, wall(1, 0, 0, 0, NAN)]).back_m == pytest.approx(0.5)

    @pytest.mark.parametrize(
        "other",
        [
            pytest.param(wall(0, 0, 1, 0, NAN), id="it faces the same way"),
            pytest.param(wall(1, 1, 0, 1, NAN), id="it runs before it"),
            pytest.param(wall(1, -0.6, 0, -0.6, NAN), id="it is farther than furniture is deep"),
            pytest.param(wall(3, 0, 0.8, 0, NAN), id="it is beside it"),
        ],
    )
    def test_nothing_else_is_its_back(self, other):
        assert math.isinf(look([self.FRONT, other]).back_m)


def test_a_leaf_is_turned_from_the_directions_of_the_walls():
    """Ten metres along the axes, and a metre at 30 degrees to one of them, 60 to the other."""
    walls = [wall(0, 0, 5, 0), wall(0, 0, 0, 5), wall(1, 1, 1 + np.sqrt(0.75), 1.5)]
    turned = [look(walls, number).turned_deg for number in range(3)]
    assert turned[0] == pytest.approx(turned[1])
    assert turned[2] - turned[0] == pytest.approx(30, abs=5)


def test_each_wing_has_directions_of_its_own():
    """Another wing, longer, stands at 30 degrees to this one, 30 m away."""
    wing = [wall(0, 0, 5, 0), wall(0, 0, 0, 5)]
    c, s = 20 * math.cos(math.pi / 6), 20 * math.sin(math.pi / 6)
    other = [wall(30, 0, 30 + c, s), wall(30, 0, 30 - s, c)]
    assert look([*wing, *other]).turned_deg == pytest.approx(0, abs=2)
    assert look([*wing[:1], *other]).turned_deg == pytest.approx(30, abs=2)


def test_what_else_is_known_is_handed_on():
    known = [np.array([share]) for share in (0.4, 0.9)]
    (found,) = Surroundings([wall(0, 0, 3, 0, 0.2)]).observe([NOTHING], *known)
    assert (found.length_m, found.thickness_m) == pytest.approx((3, 0.2))
    assert (found.through_glass, found.roofed) == (0.4, 0.9)
    assert math.isinf(look([wall(0, 0, 3, 0, NAN)]).thickness_m)
