"""Rays given cell by cell: columns of 5 cm along a surface of half a metre, rows of 5 cm."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.rays.face_raster import rasterise_rays

DOOR_M = 1.9
COLUMN_M = 0.05


def rasterise(occupied=(), free=(), *, span_m=(0.0, 0.49), **more):
    """Return the raster of rays, each given by its place along and its height."""
    kinds = [np.reshape(np.array(rows, float), (-1, 2)).T for rows in (occupied, free)]
    return rasterise_rays(*(tuple(kind) for kind in kinds), span_m=span_m, **more)


def column(number, *heights_m):
    """Return rays through the middle of a column, one at each height."""
    return [(COLUMN_M * (number + 0.5), z_m) for z_m in heights_m]


def cells(found):
    return np.column_stack(found).tolist()


def test_in_the_plane_columns_beside_each_other_tell_together_where_rays_go_through():
    """In two of three columns of a metre one ray goes on; of others one returns in each."""
    free = [ray for number in range(20, 40) if number % 3 for ray in column(number, 0.0)]
    wall = [ray for number in (*range(20), *range(40, 60)) for ray in column(number, 0.0)]
    ((low_m, high_m),) = rasterise(wall, free, span_m=(0.0, 2.99), planar=True).find_opened(DOOR_M)
    assert (low_m, high_m) == pytest.approx((1.0, 2.0), abs=0.11)
    # of two rays, or where as many end, nothing is known
    few = [*column(22, 0.0), *column(26, 0.0)]
    assert len(rasterise(wall, few, span_m=(0.0, 2.99), planar=True).find_opened(DOOR_M)) == 0
    both = [*wall, *free]
    assert len(rasterise(both, free, span_m=(0.0, 2.99), planar=True).find_opened(DOOR_M)) == 0
    # a pier of two columns between two recesses is none of them
    pier = [ray for number in (29, 30) for ray in column(number, 0.0)]
    free = [ray for ray in free if not 1.45 < ray[0] < 1.55]
    beside = rasterise([*wall, *pier], free, span_m=(0.0, 2.99), planar=True).find_opened(DOOR_M)
    assert len(beside) == 2 and beside[0, 1] <= 1.451 and beside[1, 0] >= 1.549
    # nor do two columns make a stretch, wherever they lie
    for number in range(12, 40):
        lone = [ray for _ in range(5) for ray in (*column(number, 0.0), *column(number + 1, 0.0))]
        solid = [ray for other in range(60) if other not in (number, number + 1)
                 for ray in column(other, 0.0)]  # fmt: skip
        seen = rasterise(solid, lone, span_m=(0.0, 2.99), planar=True)
        assert len(seen.find_opened(DOOR_M)) == 0
    # in space each column says it, or not
    assert len(rasterise(wall, free, span_m=(0.0, 2.99)).find_opened(DOOR_M)) == 0


class TestCells:
    def test_every_ray_is_in_the_cell_of_its_place_and_height(self):
        found = rasterise(column(2, 0.52, 0.53, 1.01), column(3, 0.52))
        assert cells(found.occupied) == [[2, 10], [2, 10], [2, 20]]
        assert cells(found.free) == [[3, 10]]
        assert (len(found), found.first_m) == (10, 0.0)

    def test_a_ray_on_a_border_is_in_the_cell_that_begins_there(self):
        found = rasterise([(0.25, 0.5), (0.249, 0.499)], span_m=(0.0, 0.5))
        assert cells(found.occupied) == [[5, 10], [4, 9]]
        # what is at the very end has a column of its own
        assert len(found) == 11
        assert cells(rasterise([(0.5, 0)], span_m=(0.0, 0.5)).occupied) == [[10, 0]]

    def test_rays_beyond_count_for_the_outermost_columns_and_the_lowest_row(self):
        found = rasterise([(-3.0, -0.2), (7.0, 99.0)])
        assert cells(found.occupied) == [[0, 0], [9, 1980]]

    def test_a_plane_has_one_row(self):
        found = rasterise(column(1, -5.0, 0.0, 9.0), planar=True)
        assert cells(found.occupied) == [[1, 0]] * 3
        assert found.count_occupied(0.1)[1] == 3

    def test_middles_of_columns_and_those_between_places(self):
        found = rasterise(span_m=(1.0, 1.1))
        assert found.middle_m.round(9).tolist() == [1.025, 1.075, 1.125]
        # those whose middles lie between
        assert found.between(1.025, 1.076) == slice(0, 2)
        assert found.between(1.03, 1.07) == slice(1, 1)
        assert found.between(-9, 0) == slice(0, 0)


class TestQueries:
    def test_a_column_is_crossed_where_more_rays_go_through_than_end(self):
        found = rasterise(
            column(0, 1.0, 1.0) + column(1, 1.0) + column(2, 1.0, 2.2, 2.2),
            column(0, 0.5, 0.5) + column(1, 0.5, 0.6) + column(2, 1.0, 1.0),
        )
        assert np.flatnonzero(found.is_crossed(DOOR_M)).tolist() == [1, 2]
        # above a door, too, they end in the last
        assert np.flatnonzero(found.is_crossed(2.5)).tolist() == [1]

    def test_two_rays_may_be_stray_and_three_open_a_column(self):
        found = rasterise((), column(0, 1.0) + column(1, 1.0, 1.0) + column(2, 1.0, 1.1, 1.2))
        assert found.is_opened(DOOR_M).tolist() == [False, False, True] + [False] * 7
        assert not found.is_opened(1.0)[2]

    def test_a_column_is_solid_where_rays_end_and_hardly_one_goes_through(self):
        found = rasterise(
            column(0, 1.0) + column(1, 1.0) + column(2, 1.0) + column(4, 2.3),
            column(1, 1.0, 1.0) + column(2, *[1.0] * 3) + column(3, 1.0),
        )
        assert np.flatnonzero(found.is_solid(DOOR_M)).tolist() == [0, 1]


places = st.lists(st.tuples(st.floats(-1, 2), st.floats(-1, 9)), max_size=30)


@given(places, places, st.booleans())
def test_every_ray_is_counted_once(occupied, free, planar):
    found = rasterise(occupied, free, planar=planar)
    counts = [found.count_occupied(9.1).sum(), found.count_free(9.1).sum()]
    assert counts == [len(occupied), len(free)]


@given(places, places, st.randoms())
def test_the_order_of_rays_does_not_matter(occupied, free, random):
    shuffled = random.sample(occupied, len(occupied)), random.sample(free, len(free))
    one, other = rasterise(occupied, free), rasterise(*shuffled)
    assert (one.is_solid(DOOR_M) == other.is_solid(DOOR_M)).all()


@given(places, places)
def test_no_column_is_both_solid_and_opened(occupied, free):
    found = rasterise(occupied, free)
    assert not (found.is_solid(DOOR_M) & found.is_opened(DOOR_M)).any()
    assert not (found.is_opened(DOOR_M) & ~found.is_crossed(DOOR_M)).any()
