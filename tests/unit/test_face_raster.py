"""Rays given cell by cell: columns of 10 cm or 25 cm along a surface of 1 m, rows of 5 cm."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.rays import face_raster
from scanplan.rays.face_raster import rasterise_rays

DOOR_M, SILL_M = 1.9, 0.5
COLUMN_M = 0.1


def rasterise(occupied=(), free=(), occluded=(), *, span_m=(0.0, 0.95), column_m=COLUMN_M, **more):
    """Return the raster of rays, each given by its place along and its height."""
    kinds = [np.reshape(np.array(rows, float), (-1, 2)).T for rows in (occupied, free, occluded)]
    return rasterise_rays(
        *(tuple(kind) for kind in kinds), span_m=span_m, column_m=column_m, **more
    )


def column(number, *heights_m):
    """Return rays through the middle of a column, one at each height."""
    return [(COLUMN_M * (number + 0.5), z_m) for z_m in heights_m]


class TestCells:
    def test_every_ray_is_in_the_cell_of_its_place_and_height(self):
        found = rasterise(column(2, 0.52, 0.53, 1.01), column(3, 0.52), column(9, 0.0))
        assert found.occupied.shape == (10, 160)
        assert np.argwhere(found.occupied).tolist() == [[2, 10], [2, 20]]
        assert found.occupied[2, 10] == 2
        assert np.argwhere(found.free).tolist() == [[3, 10]]
        assert np.argwhere(found.occluded).tolist() == [[9, 0]]
        assert (len(found), found.first_m, found.column_m) == (10, 0.0, 0.1)

    def test_a_ray_on_a_border_is_in_the_cell_that_begins_there(self):
        found = rasterise([(0.5, 0.5), (0.499, 0.499)], column_m=0.25, span_m=(0.0, 1.0))
        assert np.argwhere(found.occupied).tolist() == [[1, 9], [2, 10]]
        # what is at the very end has a column of its own
        assert len(found) == 5
        assert rasterise([(1.0, 0)], column_m=0.25, span_m=(0.0, 1.0)).occupied[4, 0] == 1

    def test_rays_beyond_count_for_the_outermost_cells(self):
        found = rasterise([(-3.0, -0.2), (7.0, 99.0)])
        assert np.argwhere(found.occupied).tolist() == [[0, 0], [9, 159]]

    def test_the_highest_of_each_column_is_known_to_the_millimetre(self):
        found = rasterise(column(1, 0.3, 1.234, 0.7), column(2, 2.345))
        assert found.top_m[1] == 1.234 and found.free_top_m[2] == 2.345
        assert np.isinf(found.top_m[[0, 2]]).all() and (found.top_m[[0, 2]] < 0).all()

    def test_a_plane_has_one_row(self):
        found = rasterise(column(1, -5.0, 0.0, 9.0), planar=True)
        assert found.occupied.shape == (10, 1) and found.occupied[1, 0] == 3
        assert found.count_below(found.occupied, 0.1)[1] == 3

    def test_few_columns_however_long_a_surface_is(self):
        assert len(rasterise([(0, 0), (1e6, 0)], span_m=(0.0, 1e6))) <= 10_001

    def test_a_grazing_ray_is_free_until_it_leaves_the_thinnest_wall(self):
        found = rasterise((), [(0.25, 1.0), (0.65, 1.0)], free_until_m=np.array([0.55, 0.62]))
        assert np.argwhere(found.free).tolist() == [[c, 20] for c in (2, 3, 4, 5, 6)]
        # a ray the other way opens the same columns
        back = rasterise((), [(0.55, 1.0), (0.62, 1.0)], free_until_m=np.array([0.25, 0.65]))
        assert (back.free == found.free).all()

    def test_middles_and_columns_of_places(self):
        found = rasterise(column_m=0.25, span_m=(1.0, 2.0))
        assert found.middle_m.tolist() == [1.125, 1.375, 1.625, 1.875, 2.125]
        assert found.column_of(np.array([1.0, 1.25, 1.99])).tolist() == [0, 1, 3]
        # those whose middles lie between
        assert found.between(1.125, 1.376) == slice(0, 2)
        assert found.between(1.13, 1.37) == slice(1, 1)
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

    def test_a_column_is_overlooked_by_three_rays_above_all_that_ends(self):
        found = rasterise(
            column(0, 0.7) + column(1, 0.7) + column(2, 0.7) + column(3, *[0.7] * 40),
            column(0, *[1.2] * 3)
            + column(1, 1.2, 1.2)
            + column(2, *[0.4] * 9)
            + column(3, *[1] * 5),
        )
        # 5 of 40 are fewer than 15 in a hundred
        assert np.flatnonzero(found.is_overlooked(DOOR_M)).tolist() == [0]

    def test_in_the_plane_whatever_goes_through_goes_over(self):
        found = rasterise(column(0, 0) + column(1, 0), column(0, 0, 0, 0), planar=True)
        assert np.flatnonzero(found.is_overlooked(DOOR_M)).tolist() == [0]

    @pytest.mark.parametrize(
        ("ends_m", "through_m", "is_open"),
        [
            ((), (1.0,), True),
            ((), (0.1,), False),  # along the floor
            ((), (2.2,), False),  # above a door
            ((2.2,), (1.0,), True),  # below a lintel
            ((0.3,), (1.0,), True),  # over a sill
            ((0.3,), (0.22,), False),  # below what ends rays
            ((0.52,), (1.0,), False),  # higher than a sill
            ((1.0,), (0.5,), False),
        ],
    )
    def test_a_column_is_open_where_a_ray_goes_over_its_sill(self, ends_m, through_m, is_open):
        found = rasterise(column(4, *ends_m), column(4, *through_m))
        opened = found.is_open(SILL_M, low_m=0.2, door_m=DOOR_M)
        assert opened.tolist() == [number == 4 and is_open for number in range(10)]

    @pytest.mark.parametrize(
        ("ends_m", "before_m", "is_stopped"),
        [
            ((1.0,), (), True),
            ((0.1,), (), True),
            ((2.2,), (), False),  # the wall above a door shows nothing of what is below
            ((), (1.0,), True),
            ((), (0.1,), False),  # along the floor
            ((), (2.2,), False),
            ((), (), False),
        ],
    )
    def test_a_column_is_stopped_where_rays_end_at_it_or_before_it(
        self, ends_m, before_m, is_stopped
    ):
        found = rasterise(column(4, *ends_m), column(4, 1.0), column(4, *before_m))
        stopped = found.is_stopped(low_m=0.2, door_m=DOOR_M)
        assert stopped.tolist() == [number == 4 and is_stopped for number in range(10)]


class TestTop:
    def test_a_surface_is_as_high_as_it_is_seen_over_a_stretch_of_30_cm(self):
        tops_m = [1.0, 2.5, 1.2, 2.4, 1.5, 1.1]
        found = rasterise([ray for number, z in enumerate(tops_m) for ray in column(number, z)])
        assert found.seen_top_m() == 1.5
        assert found.seen_top_m(slice(0, 3)) == 1.0

    def test_of_two_columns_the_lower_counts_and_of_one_its_own(self):
        found = rasterise(column(3, 1.0) + column(8, 2.0))
        assert found.seen_top_m() == 1.0
        assert found.seen_top_m(slice(5, 10)) == 2.0
        assert found.seen_top_m(slice(0, 3)) == -np.inf

    def test_a_stretch_is_as_long_in_narrow_columns(self):
        places = np.arange(0.01, 1, 0.05)
        rays = [(x_m, 2.0 - 0.1 * number) for number, x_m in enumerate(places)]
        # the sixth of columns of 5 cm
        assert rasterise(rays, column_m=face_raster.CELL_M).seen_top_m() == pytest.approx(1.5)

    def test_what_rays_pass_over_all_along_surely_ends(self):
        numbers = range(10)
        front = [ray for number in numbers for ray in column(number, 0.2, 0.72)]
        over = [ray for number in numbers for ray in column(number, 1.2)]
        assert rasterise(front, over).over_share() == 1
        assert rasterise(front).over_share() == 0
        # where nothing ends at it there is no surface to pass over
        assert rasterise((), over).over_share() == 0

    def test_the_share_is_that_of_what_rays_cross_above_its_end(self):
        """Of ten columns three are 2 m high, six are passed over, and of one no more is known."""
        ends_m = [2.05] * 3 + [0.72] * 7
        front = [ray for number, z_m in enumerate(ends_m) for ray in column(number, z_m)]
        over = [ray for number in range(3, 9) for ray in column(number, 1.2)]
        assert rasterise(front, over).over_share() == pytest.approx(6 / 9)

    def test_less_than_30_cm_passed_over_may_be_something_else(self):
        front = [ray for number in range(10) for ray in column(number, 0.72)]
        over = [ray for number in range(2) for ray in column(number, 1.2)]
        assert rasterise(front, over).over_share() == 0
        assert rasterise(front, over + column(2, 1.2)).over_share() == 1

    def test_a_top_and_a_ray_closer_than_noise_do_not_part(self):
        front = [ray for number in range(10) for ray in column(number, 0.79)]
        over = [ray for number in range(10) for ray in column(number, 0.82)]
        assert rasterise(front, over).over_share() == 0


places = st.lists(st.tuples(st.floats(-1, 2), st.floats(-1, 9)), max_size=30)


@given(places, places, places, st.booleans())
def test_every_ray_is_counted_once(occupied, free, occluded, planar):
    found = rasterise(occupied, free, occluded, planar=planar)
    counts = found.occupied.sum(), found.free.sum(), found.occluded.sum()
    assert counts == (len(occupied), len(free), len(occluded))
    below = found.count_below(found.occupied, 8.0)
    assert below.tolist() == found.occupied.sum(axis=1).tolist()


@given(places, places, st.randoms())
def test_the_order_of_rays_does_not_matter(occupied, free, random):
    shuffled = random.sample(occupied, len(occupied)), random.sample(free, len(free))
    one, other = rasterise(occupied, free), rasterise(*shuffled)
    assert (one.occupied == other.occupied).all() and (one.free == other.free).all()
    assert (one.top_m == other.top_m).all() and one.over_share() == other.over_share()


@given(places, places)
def test_no_column_is_both_solid_and_opened(occupied, free):
    found = rasterise(occupied, free)
    assert not (found.is_solid(DOOR_M) & found.is_opened(DOOR_M)).any()
    assert not (found.is_opened(DOOR_M) & ~found.is_crossed(DOOR_M)).any()
    assert 0 <= found.over_share() <= 1
