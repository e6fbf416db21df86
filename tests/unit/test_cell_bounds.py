import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from helpers.hull_making import hull_sets
from scanplan.selection import area_greedy
from scanplan.selection.union_area import cell_bounds


def polygons_of(geometries):
    parts = shapely.get_parts(np.array(geometries, object))
    return parts[shapely.area(parts) > 0]


def test_a_cell_that_both_cross_is_all_that_makes_the_bound_loose():
    wide, tall = box(0, 0, 8, 1), box(0, 0, 1, 8)
    bounds = cell_bounds.CellBounds(np.array([wide, tall]))
    assert bounds.area_m2(np.array([0, 1])) == pytest.approx([8, 8], abs=1e-3)
    bounds.cover(np.array([wide]))
    edge_m = 4.5 / 8  # the mean of the sides in eight
    left_m2 = bounds.area_m2(np.array([1, 0]))
    # the row of cells that the lower edge of what is left runs through is wide and tall alike
    assert 7 <= left_m2[0] <= 7 + edge_m * 2
    assert left_m2[1] <= 8 * edge_m


def test_nothing_is_left_where_all_is_covered():
    full = cell_bounds.CellBounds(np.array([box(0, 0, 9, 9), box(3, 3, 6, 6)]))
    full.cover(np.array([box(0, 0, 9, 9)]))
    assert full.area_m2(np.array([1])) == pytest.approx([0], abs=1e-3)


def test_a_hole_is_not_covered():
    ring, middle = box(0, 0, 9, 9) - box(2, 2, 7, 7), box(3, 3, 6, 6)
    bounds = cell_bounds.CellBounds(np.array([ring, middle]))
    bounds.cover(np.array([ring]))
    assert bounds.area_m2(np.array([1])) == pytest.approx([9], abs=1e-3)


@pytest.mark.parametrize(("side_m", "size_m"), [(1e4, 0.1), (300.0, 0.01)])
def test_small_parts_among_large_ones_keep_their_areas(side_m, size_m):
    """A cell suits the large part, and a small one fills next to nothing of it."""
    large = shapely.Polygon([(0, 0), (side_m, 0), (0, side_m)])
    corners_m = 0.9 * side_m + np.arange(4) * 10 * size_m
    small = shapely.box(
        corners_m, corners_m, corners_m + size_m, corners_m + size_m * np.linspace(1, 1.3, 4)
    )
    polygons = np.array([large, *small])
    bounds = cell_bounds.CellBounds(polygons)
    bounds.cover(np.array([large]))
    assert (bounds.area_m2(np.arange(1, 5)) >= shapely.area(small)).all()
    assert area_greedy.order_by_area(polygons).order.tolist() == [0, 4, 3, 2, 1]


@settings(max_examples=150, deadline=None)
@given(hull_sets(), st.integers(0, 8))
def test_never_less_than_is_uncovered(geometries, n_chosen):
    polygons = polygons_of(geometries)
    bounds, union = cell_bounds.CellBounds(polygons), shapely.Polygon()
    for polygon in polygons[:n_chosen]:
        bounds.cover(polygons_of([polygon - union]))
        union = union | polygon
    left_m2 = shapely.area(shapely.difference(polygons, union))
    found_m2 = bounds.area_m2(np.arange(len(polygons)))
    assert (found_m2 >= left_m2 - 1e-12).all()
    assert (found_m2 <= shapely.area(polygons) * (1 + 1e-5) + 1e-2).all()


@pytest.mark.parametrize("shift_m", [(0.0, 0.0), (-3.7, 12.3), (1e4, -1e4)])
def test_areas_of_cells_are_those_of_intersections(shift_m):
    star = shapely.Polygon([(0, 0), (5, 1), (9, -2), (6, 3), (8, 8), (4, 4.5), (-1, 7), (2, 3)])
    star = shapely.transform(star, lambda xy: xy + shift_m)
    row, at, share = cell_bounds._fill_cells(np.array([star, box(0, 0, 1, 1)]), 0.7)
    of_star = row == 0
    cells = shapely.box(*(0.7 * at[of_star]).T, *(0.7 * (at[of_star] + 1)).T)
    assert 0.49 * share[of_star] == pytest.approx(
        shapely.area(shapely.intersection(cells, star)), abs=1e-9
    )
    assert 0.49 * share[of_star].sum() == pytest.approx(star.area, abs=1e-5)


def test_a_few_far_apart_take_no_more_cells_than_many_close_together():
    bounds = cell_bounds.CellBounds(np.array([box(0, 0, 1, 1), box(1e5, 1e5, 1e5 + 1, 1e5 + 1)]))
    assert len(bounds._free) < 2 * 10**7
    assert (bounds.area_m2(np.array([0, 1])) >= 1).all()


def test_lists_members_of_groups():
    place, member = cell_bounds.list_members(np.array([0, 2, 2, 5]), np.array([2, 1, 0]))
    assert place.tolist() == [0, 0, 0, 2, 2]
    assert member.tolist() == [2, 3, 4, 0, 1]
