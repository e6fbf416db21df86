"""Edges of openings whose returns are known place by place: of a wall along +x, from the north."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.observation_making import line_through, observation
from helpers.plan_wall_making import wall
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model.line_labels import Stretch
from scanplan.plan.model.opening_edges import is_opening, measure_opening

NAN = float("nan")
DOOR = Stretch("door", 2.0, 2.9, 0.0, 2.1, 0.9)
WINDOW = Stretch("window", 2.0, 3.2, 0.9, 2.1, 0.8)


def seen(occupied=(), free=(), **more):
    """Return a wall of 5 m of which this is seen, see `observation`."""
    face = observation(line_through(0, 0, 5, 0), occupied, free, **more)
    return replace(wall(0, 0, 5, 0, np.nan), left=[FaceInterval(face, 0.0, 5.0)])


def beside(low_m, high_m, scan=0, z_m=1.0):
    """Return returns of a scan that sees the wall up to one place and from another on."""
    along = [*np.arange(low_m - 0.5, low_m, 0.02), low_m, high_m, *np.arange(high_m, 4.5, 0.02)]
    return [(x, z_m, 0.0, scan) for x in along]


@pytest.mark.parametrize(
    ("kind", "drawn"),
    [
        *(("door", "door"), ("shut", "door"), ("open", "gap")),
        *(("window", "window"), ("glass", "glass")),
    ],
)
def test_a_stretch_that_is_no_wall_is_an_opening_of_its_kind(kind, drawn):
    stretch = replace(DOOR, kind=kind)
    assert is_opening(stretch)
    opening = measure_opening(seen(), stretch)
    assert (opening.kind, opening.p_kind, opening.state) == (drawn, 0.9, "open")


def test_what_is_open_to_any_height_and_as_wide_as_a_passage_is_one():
    opening = measure_opening(seen(), replace(DOOR, kind="open", high_m=DOOR.low_m + 1.3))
    assert opening.type_name(max_door_m=1.2) == "passage"


@pytest.mark.parametrize("kind", ["solid", "low"])
def test_wall_is_no_opening(kind):
    assert not is_opening(replace(DOOR, kind=kind))


class TestJambs:
    def test_they_are_where_the_wall_beside_ends(self):
        opening = measure_opening(seen(beside(2.04, 2.87)), DOOR)
        assert (opening.low_m, opening.high_m) == pytest.approx((2.04, 2.87))

    def test_they_are_those_of_most_rays_of_scans_that_see_them(self):
        """One of three scans stands 8 cm aside."""
        rows = [*beside(2.02, 2.88, 0), *beside(2.02, 2.88, 1), *beside(2.1, 2.96, 2)]
        opening = measure_opening(seen(rows), DOOR)
        assert (opening.low_m, opening.high_m) == pytest.approx((2.02, 2.88))

    def test_without_returns_they_are_the_edges_of_columns(self):
        opening = measure_opening(seen(beside(1.5, 3.4)), DOOR)
        assert (opening.low_m, opening.high_m) == (2.0, 2.9)

    def test_what_is_above_a_door_is_not_beside_it(self):
        lintel = [(x, 2.3, 0.0, 0) for x in np.arange(1.5, 3.4, 0.02)]
        opening = measure_opening(seen([*beside(1.96, 2.94), *lintel]), DOOR)
        assert (opening.low_m, opening.high_m) == pytest.approx((1.96, 2.94))

    def test_in_the_plane_all_returns_are_beside(self):
        stretch = replace(DOOR, sill_m=NAN, lintel_m=NAN)
        opening = measure_opening(seen(beside(2.04, 2.87, z_m=0.0), planar=True), stretch)
        assert (opening.low_m, opening.high_m) == pytest.approx((2.04, 2.87))
        assert np.isnan([opening.sill_m, opening.lintel_m]).all() and not opening.below_wall


class TestHeights:
    def test_a_door_begins_at_the_floor_and_ends_between_rays_and_returns(self):
        """Rays go through up to 2.00 m, returns come from 2.04 m on."""
        above = [(x, z) for x in np.arange(2.1, 2.8, 0.02) for z in (2.04, 2.3)]
        through = [(x, z) for x in np.arange(2.1, 2.8, 0.02) for z in (1.0, 2.0)]
        opening = measure_opening(seen(above, through), DOOR)
        assert opening.sill_m == 0 and opening.below_wall
        assert opening.lintel_m == pytest.approx(2.02)
        assert opening.n_rays == len(through)

    def test_of_rays_that_end_far_below_a_lintel_it_is_close_below_the_returns(self):
        """The highest that went through is 14 cm lower, of which a lintel is 10 at most."""
        above = [(x, 2.2) for x in np.arange(2.1, 2.8, 0.02)]
        through = [(x, 2.06) for x in np.arange(2.1, 2.8, 0.02)]
        opening = measure_opening(seen(above, through), DOOR)
        assert opening.lintel_m == pytest.approx((2.1 + 2.2) / 2)

    def test_a_sill_is_as_high_as_what_was_seen_below(self):
        below = [(x, z) for x in np.arange(2.1, 3.1, 0.02) for z in (0.3, 0.86)]
        opening = measure_opening(seen(below), WINDOW)
        assert opening.sill_m == pytest.approx(0.86)
        assert opening.lintel_m == 2.1  # nothing was seen there

    def test_few_returns_say_nothing_of_heights(self):
        few = [(x, z) for x in (2.4, 2.5, 2.6) for z in (0.7, 2.3)]
        opening = measure_opening(seen(few), WINDOW)
        assert (opening.sill_m, opening.lintel_m) == (0.9, 2.1)

    def test_glass_to_the_ceiling_has_no_lintel(self):
        opening = measure_opening(seen(), Stretch("glass", 1.0, 4.0, 0.0, NAN, 0.7))
        assert opening.sill_m == 0 and np.isnan(opening.lintel_m) and not opening.below_wall
