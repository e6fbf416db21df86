"""Cuts through boxes whose sections are known on paper."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import box_making
from scanplan.lab.buildings import slicing

metres = st.integers(0, 60).map(lambda dm: dm / 10)
WALL = box_making.box(0, 0, 0, 4, 0.2, 2.5)


def cut_section(triangles_m, z_m, **limits):
    return slicing.cut_section(slicing.split_bodies(triangles_m), z_m, **limits)


def same(found, expected):
    return found.symmetric_difference(expected).area == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("z_m", [0.0 + 1e-9, 1.0, 2.5])
def test_a_wall_is_cut_to_its_rectangle(z_m):
    solid, sheets = cut_section(WALL, z_m)
    assert same(solid, shapely.box(0, 0, 4, 0.2)) and sheets.is_empty


@pytest.mark.parametrize("z_m", [-0.1, 0.0, 2.6])
def test_beside_it_is_nothing(z_m):
    solid, sheets = cut_section(WALL, z_m)
    assert solid.is_empty and sheets.is_empty


def test_turned_triangles_change_nothing():
    turned = WALL.copy()
    turned[::2] = turned[::2, ::-1]
    assert same(cut_section(turned, 1.0)[0], shapely.box(0, 0, 4, 0.2))


def test_touching_and_overlapping_bodies_are_one():
    touching, overlapping = (
        box_making.box(4, 0, 0, 4.2, 3, 2.5),
        box_making.box(1, -1, 0, 1.2, 1, 2.5),
    )
    solid, sheets = cut_section(np.concatenate([WALL, touching, overlapping]), 1.0)
    expected = shapely.union_all(
        [shapely.box(0, 0, 4, 0.2), shapely.box(4, 0, 4.2, 3), shapely.box(1, -1, 1.2, 1)]
    )
    assert same(solid, expected) and sheets.is_empty


def test_a_wide_shell_is_a_room_of_sheets():
    solid, sheets = cut_section(box_making.box(0, 0, 0, 4, 3, 2.5), 1.0)
    assert solid.is_empty and sheets.length == pytest.approx(14)
    solid, _ = cut_section(box_making.box(0, 0, 0, 4, 3, 2.5), 1.0, max_solid_m=10)
    assert solid.area == pytest.approx(12)


def test_a_wall_with_a_hole_keeps_its_lines():
    open_wall = WALL[np.ptp(WALL[..., 0], axis=1) > 0]  # both ends missing
    solid, sheets = cut_section(open_wall, 1.0)
    assert solid.is_empty and sheets.length == pytest.approx(8)


@given(
    st.lists(st.tuples(metres, metres, st.sampled_from([0.1, 0.2]), metres), min_size=1, max_size=4)
)
@settings(max_examples=40, deadline=None)
def test_any_walls_are_cut_to_their_union(drawn):
    boxes = [(x, y, x + t, y + 0.5 + length) for x, y, t, length in drawn]
    soups = [box_making.box(*b[:2], 0, *b[2:], 2.0) for b in boxes]
    parts = [cut_section(soup, 1.0)[0] for soup in soups]
    assert same(shapely.union_all(parts), shapely.union_all([shapely.box(*b) for b in boxes]))


def test_faces_have_the_wall_on_their_left_and_tell_their_side():
    solid = shapely.box(0, 0, 4, 0.2)
    found = slicing.section_faces(solid, shapely.MultiLineString(), shapely.box(0, 0, 4, 3))
    sides = {tuple(map(tuple, line.coords)): side for line, side in found}
    assert sides[((4.0, 0.2), (0.0, 0.2))] == "inside"
    assert sides[((0.0, 0.0), (4.0, 0.0))] == "outside"
    assert len(found) == 4


def test_a_sheet_is_inside_if_either_side_is():
    sheets = shapely.MultiLineString([[(0, 0), (1, 0), (2, 0)], [(0, 5), (2, 5)]])
    found = slicing.section_faces(shapely.Polygon(), sheets, shapely.box(0, 0, 2, 1))
    assert sorted((line.length, side) for line, side in found) == [(2, "inside"), (2, "outside")]


def test_centreline_between_two_faces_and_none_across_a_room():
    ring = shapely.box(-0.2, -0.2, 4.2, 3.2) - shapely.box(0, 0, 4, 3)
    found = slicing.section_centrelines(ring)
    assert sorted(round(line.length, 6) for line, _ in found) == [3, 3, 4, 4]
    assert {round(thickness, 6) for _, thickness in found} == {0.2}
    south = min((line for line, _ in found), key=lambda line: line.centroid.y)
    assert sorted(south.coords) == [pytest.approx((0, -0.1)), pytest.approx((4, -0.1))]
