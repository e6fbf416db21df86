import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from scanplan.plan import wall_footprints


def bodies(lines, thickness_m):
    half_m = np.broadcast_to(np.asarray(thickness_m, float) / 2, len(lines))
    return wall_footprints.draw_footprints(
        np.asarray(lines, float).reshape(-1, 2, 2), half_m, half_m
    )


def the_same(polygon, other):
    return shapely.area(shapely.symmetric_difference(polygon, other)) < 1e-9


def test_a_wall_alone_is_cut_off_square():
    (body,) = bodies([(0, 0, 4, 0)], 0.2)
    assert the_same(body, shapely.box(0, -0.1, 4, 0.1))
    assert body.exterior.is_ccw


def test_sides_are_told_apart():
    (body,) = wall_footprints.draw_footprints(
        np.array([[[0, 0], [4, 0]]]), np.array([0.0]), np.array([0.1])
    )
    assert the_same(body, shapely.box(0, -0.1, 4, 0))


def test_a_corner_is_mitred():
    one, other = bodies([(0, 0, 4, 0), (4, 0, 4, 3)], 0.2)
    assert the_same(one, shapely.Polygon([(0, -0.1), (4.1, -0.1), (3.9, 0.1), (0, 0.1)]))
    assert the_same(other, shapely.Polygon([(4.1, -0.1), (4.1, 3), (3.9, 3), (3.9, 0.1)]))


@pytest.mark.parametrize("gap_m", [-0.1, -0.03, 0.03, 0.1])
def test_ends_that_do_not_quite_meet_make_the_same_corner(gap_m):
    meeting = shapely.union_all(bodies([(0, 0, 4, 0), (4, 0, 4, 3)], 0.2))
    apart = shapely.union_all(bodies([(0, 0, 4 + gap_m, 0), (4, gap_m, 4, 3)], 0.2))
    assert the_same(meeting, apart)


@pytest.mark.parametrize("line", [(8, 3, 7.56, 3), (7.56, 3, 8, 3)])
def test_a_wall_shorter_than_thick_ones_reach_makes_one_corner(line):
    """0.44 m long, and both 0.4 m thick: its far end is near the other wall's, too."""
    long, short = bodies([(8, 0, 8, 3), line], 0.4)
    assert the_same(long | short, shapely.box(7.8, 0, 8.2, 3.2) | shapely.box(7.56, 2.8, 8.2, 3.2))
    assert shapely.intersection(long, short).area < 1e-9


def test_ends_far_apart_make_no_corner():
    assert the_same(bodies([(0, 0, 4, 0), (4, 0.4, 4, 3)], 0.2)[1], shapely.box(3.9, 0.4, 4.1, 3))


def test_a_wall_stops_at_the_side_of_another():
    through, stem = bodies([(0, 0, 4, 0), (2, 0, 2, 3)], [0.2, 0.1])
    assert the_same(through, shapely.box(0, -0.1, 4, 0.1))
    assert the_same(stem, shapely.box(1.95, 0.1, 2.05, 3))
    assert the_same(
        bodies([(0, 0, 4, 0), (2, -3, 2, -0.15)], [0.2, 0.1])[1], shapely.box(1.95, -3, 2.05, -0.1)
    )


def test_walls_of_different_thickness_meet_without_gap_or_overlap():
    one, other = bodies([(0, 0, 4, 0), (4, 0, 4, 3)], [0.4, 0.1])
    assert shapely.area(shapely.intersection(one, other)) < 1e-9
    assert the_same(
        shapely.union(one, other), shapely.box(0, -0.2, 4.05, 0.2) | shapely.box(3.95, 0.2, 4.05, 3)
    )


def test_a_wall_that_runs_on_is_not_mitred():
    one, other = bodies([(0, 0, 4, 0), (4, 0, 9, 0.1)], 0.2)
    assert the_same(one, shapely.box(0, -0.1, 4, 0.1))
    assert other.area == pytest.approx(0.2 * np.hypot(5, 0.1))


def test_a_sharp_corner_has_no_endless_tip():
    for body in bodies([(0, 0, 4, 0), (4, 0, 0, 0.9)], 0.2):
        assert body.bounds[2] < 4.8


def test_walls_that_cross_near_their_ends_make_a_corner_there():
    # both run on for 0.35 m beyond where they cross at 30 degrees
    way = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6)])
    crossing = [(-4, 0, 0.35, 0), (*(-0.35 * way), *(4 * way))]
    meeting = [(-4, 0, 0, 0), (0, 0, *(4 * way))]
    for found, expected in zip(bodies(crossing, 0.1), bodies(meeting, 0.1), strict=True):
        assert the_same(found, expected)


def test_walls_in_one_line_that_overlap_stay_as_long_as_they_are():
    one, other = bodies([(0, 0, 5, 0), (4, 0, 9, 0)], 0.1)
    assert the_same(one, shapely.box(0, -0.05, 5, 0.05))
    assert the_same(other, shapely.box(4, -0.05, 9, 0.05))


def test_walls_that_hardly_turn_are_not_cut_where_their_lines_cross():
    rise = np.tan(np.radians(1))
    lines = np.array([[[0, 0], [10, 0]], [[3, -3 * rise], [15, 9 * rise]]])
    sides, _ = wall_footprints.cut_sides(lines, np.full(2, 0.05), np.full(2, 0.05))
    np.testing.assert_allclose(sides[:, :, 0], lines[:, :, 0], atol=0.01)


def test_walls_that_cross_in_their_middles_overlap():
    lines = [(-4, 0, 4, 0), (-3, -1, 3, 1)]
    for found, line in zip(bodies(lines, 0.1), lines, strict=True):
        assert the_same(found, bodies([line], 0.1)[0])


def test_a_short_wall_across_another_is_cut_off_square():
    # both its ends are near the other wall, which it crosses at 15 degrees
    end = 0.25 * np.array([np.cos(np.pi / 12), np.sin(np.pi / 12)])
    short = (*-end, *end)
    assert the_same(bodies([(-4, 0, 4, 0), short], 0.1)[1], bodies([short], 0.1)[0])


def test_a_wall_that_nearly_runs_along_another_has_no_long_tip():
    # 12 degrees: its upper corner would meet the other wall 0.9 m on
    way = np.array([np.cos(np.pi / 15), np.sin(np.pi / 15)])
    line = (0, 0.18, *(np.array([0, 0.18]) + 3 * way))
    assert the_same(bodies([(-4, 0, 4, 0), line], 0.1)[1], bodies([line], 0.1)[0])


def test_sides_end_where_walls_cross_and_are_never_longer_than_walls():
    lines_m = np.array([[[-4, 0], [0.25, 0]], [[0, -0.25], [0, 3.0]]])
    zero, tenth = np.zeros(2), np.full(2, 0.1)
    # seen from the left, in the corner of a room
    left_m, _ = wall_footprints.cut_sides(lines_m, zero, tenth)
    np.testing.assert_allclose(left_m, [[[-4, 0], [0, 0]], [[0, 0], [0, 3]]], atol=1e-9)
    # from the right, around the corner, sides would have to be drawn on where walls end before it
    ends_m = np.array([[[-4, 0], [-0.05, 0]], [[0, 0.05], [0, 3.0]]])
    _, right_m = wall_footprints.cut_sides(ends_m, tenth, zero)
    np.testing.assert_allclose(right_m, ends_m, atol=1e-9)


def test_the_walls_of_a_plan_tile_its_footprint():
    walls = floorplan_making.walls()
    half_m = walls["thickness_m"] / 2
    lines_m = np.column_stack([walls[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
        -1, 2, 2
    )
    found = wall_footprints.draw_footprints(
        lines_m, np.nan_to_num(half_m), np.nan_to_num(half_m, nan=floorplan_making.ASSUMED_M)
    )
    assert shapely.area(found).sum() == pytest.approx(floorplan_making.FOOTPRINT_M2)
    assert shapely.area(shapely.union_all(found)) == pytest.approx(floorplan_making.FOOTPRINT_M2)
    assert (
        shapely.area(
            shapely.intersection(
                shapely.union_all(found), shapely.union_all(floorplan_making.ROOMS)
            )
        )
        < 1e-9
    )


def test_no_walls_have_no_bodies():
    assert len(bodies([], 0.2)) == 0


@pytest.mark.parametrize(("line", "thickness_m"), [((1, 1, 1, 1), 0.2), ((0, 0, 1, 0), 0.0)])
def test_walls_without_length_or_thickness_are_refused(line, thickness_m):
    with pytest.raises(ValueError, match="no length"):
        bodies([line], thickness_m)


@given(
    angle_rad=st.floats(-3.1, 3.1),
    thickness_m=st.tuples(st.floats(0.05, 0.4), st.floats(0.05, 0.4)),
    turn_rad=st.floats(0, 6.2),
)
def test_two_walls_at_any_angle_make_valid_bodies_that_do_not_overlap(
    angle_rad, thickness_m, turn_rad
):
    ends = 4 * np.array([[np.cos(t), np.sin(t)] for t in (turn_rad, turn_rad + angle_rad)])
    lines = [(*ends[0], 0, 0), (0, 0, *ends[1])]
    found = bodies(lines, thickness_m)
    assert shapely.is_valid(found).all()
    if 0.6 < abs(angle_rad) < 2.9:
        assert shapely.area(shapely.intersection(*found)) < 1e-6
        assert shapely.union_all(found).geom_type == "Polygon"


@given(st.lists(st.tuples(*[st.integers(0, 12)] * 4), max_size=12))
def test_any_walls_have_valid_bodies(lines):
    lines = [[v / 4 for v in line] for line in lines if line[:2] != line[2:]]
    for body in bodies(lines, 0.2):
        assert body.is_valid and body.area > 0
