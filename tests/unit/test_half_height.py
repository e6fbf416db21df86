"""Where a wall ends below the ceiling: points at it below, rays through its line above."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.observation_making import observation
from scanplan.geometry.lines import Line
from scanplan.plan import half_height
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall

LINE = Line(np.zeros(2), np.array([0.0, 1.0]))
LIMITS = {"wall_height_m": 1.0, "furniture_height_m": 2.1, "furniture_side_m": 1.0}
RNG = np.random.default_rng(3)


def rows(count, low_z_m, high_z_m, *, from_m=0.0, to_m=4.0):
    """Return places along the wall and heights, scattered evenly: (2, n)."""
    return np.array([RNG.uniform(from_m, to_m, count), RNG.uniform(low_z_m, high_z_m, count)])


def wall(hits, passes, openings=(), planar=False):
    """Return a wall of 4 m along x, of one face, with points and crossings (2, n) of its line."""
    sign = LINE.direction[0]
    seen = observation(LINE, *(rows_.T * (sign, 1) for rows_ in (hits, passes)), planar=planar)
    low_m, high_m = sorted((0.0, 4.0 * sign))
    spans_m = [sorted((sign * a, sign * b)) for a, b in openings]
    gaps = [SimpleNamespace(low_m=a, high_m=b, width_m=b - a) for a, b in spans_m]
    return PlanWall(LINE, low_m, high_m, np.nan, [FaceInterval(seen, low_m, high_m)], [], gaps)


def test_a_partition_ends_between_its_points_and_the_rays_over_it():
    assert half_height.estimate_wall_top_m(
        wall(rows(2000, 0.1, 1.6), rows(100, 1.62, 1.8))
    ) == pytest.approx(1.61, abs=0.02)


def test_a_wall_that_nothing_passes_is_not_seen_to_end():
    assert np.isnan(half_height.estimate_wall_top_m(wall(rows(2000, 0.1, 1.6), np.empty((2, 0)))))


def test_rays_through_a_window_are_below_points():
    pierced = np.hstack([rows(1500, 0.1, 0.9), rows(1500, 2.0, 2.6)])
    assert np.isnan(half_height.estimate_wall_top_m(wall(pierced, rows(400, 0.9, 2.0))))


def test_a_window_in_a_part_of_a_wall_is_no_top():
    beside = np.hstack([rows(1000, 0.1, 0.9), rows(300, 0.1, 2.5, to_m=2.5)])
    assert np.isnan(half_height.estimate_wall_top_m(wall(beside, rows(200, 0.95, 1.9, from_m=2.5))))


def test_rays_over_a_small_part_alone_are_not_enough():
    hits = rows(2000, 0.1, 1.6)
    assert np.isnan(
        half_height.estimate_wall_top_m(wall(hits, rows(100, 1.62, 1.8, from_m=1.0, to_m=1.5)))
    )
    assert np.isfinite(
        half_height.estimate_wall_top_m(wall(hits, rows(100, 1.62, 1.8, from_m=1.0, to_m=2.5)))
    )


def test_what_happens_in_doors_does_not_count():
    hits, over = rows(2000, 0.1, 1.2, to_m=2.9), rows(60, 1.25, 1.5, to_m=2.9)
    passes = np.hstack([over, rows(500, 0.1, 1.5, from_m=3.0, to_m=3.9)])
    assert np.isnan(half_height.estimate_wall_top_m(wall(hits, passes)))
    assert half_height.estimate_wall_top_m(wall(hits, passes, [(2.95, 3.95)])) == pytest.approx(
        1.22, abs=0.03
    )


def test_rays_far_above_what_was_seen_leave_it_open():
    assert np.isnan(
        half_height.estimate_wall_top_m(wall(rows(2000, 0.1, 1.0), rows(100, 2.0, 2.2)))
    )


def test_a_few_stray_points_above_do_not_raise_it():
    hits = np.hstack([rows(2000, 0.1, 1.3), rows(3, 2.0, 2.4)])
    assert half_height.estimate_wall_top_m(wall(hits, rows(100, 1.34, 1.7))) == pytest.approx(
        1.32, abs=0.03
    )


@given(
    st.lists(st.floats(0, 3), min_size=1, max_size=30),
    st.lists(st.floats(0, 3), min_size=1, max_size=30),
)
def test_the_parting_height_is_the_best_of_all(hit_z_m, pass_z_m):
    hit_z_m, pass_z_m = np.array(hit_z_m), np.array(pass_z_m)

    def wrong(top_m):
        return np.count_nonzero(hit_z_m > top_m) + np.count_nonzero(pass_z_m < top_m)

    low_m, high_m = half_height._part(hit_z_m, pass_z_m)
    assert low_m in hit_z_m and low_m <= high_m
    assert wrong(low_m) == min(wrong(top_m) for top_m in hit_z_m)


def test_single_surfaces_that_end_lower_than_a_wall_are_left_out():
    desk = wall(rows(2000, 0.1, 0.74), rows(100, 0.76, 1.04))
    partition = wall(rows(2000, 0.1, 1.6), rows(100, 1.62, 1.9))
    counter = wall(rows(2000, 0.1, 0.9), rows(100, 0.92, 1.2))
    counter = replace(counter, right=counter.left)
    walls, tops_m = half_height.drop_low_surfaces([desk, partition, counter], **LIMITS)
    assert walls == [partition, counter]
    assert tops_m == pytest.approx([1.61, 0.91], abs=0.02)


def test_the_side_of_a_cupboard_is_no_half_height_wall():
    hits, over = rows(2000, 0.1, 1.8, to_m=0.8), rows(100, 1.82, 2.0, to_m=0.8)
    long = wall(hits, over)
    sign = LINE.direction[0]
    low_m, high_m = sorted((0.0, 0.8 * sign))
    side = replace(long, low_m=low_m, high_m=high_m)
    assert half_height.estimate_wall_top_m(side) == pytest.approx(1.81, abs=0.02)
    both = replace(side, right=side.left)
    tall = wall(rows(2000, 0.1, 2.3, to_m=0.8), rows(100, 2.32, 2.4, to_m=0.8))
    tall = replace(tall, low_m=low_m, high_m=high_m)
    walls, _ = half_height.drop_low_surfaces([side, both, tall], **LIMITS)
    assert walls == [both, tall]


def test_a_plane_shows_no_height():
    desk = wall(rows(2000, 0.1, 0.74), rows(100, 0.76, 1.04), planar=True)
    walls, tops_m = half_height.drop_low_surfaces([desk], **LIMITS)
    assert walls == [desk] and np.isnan(tops_m).all()
