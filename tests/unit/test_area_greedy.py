import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely import Polygon, box

from helpers.hull_making import hull_sets, scattered
from reference import hull_selection
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.selection import area_greedy


def test_takes_the_largest_then_what_adds_most():
    boxes = [box(0, 0, 1, 1), box(0, 0, 3, 2), box(2, 0, 5, 2), box(9, 0, 10, 3)]
    result = area_greedy.order_by_area(boxes)
    # 6; then 4 (2 of 6 are covered); then 3; the first box is covered already
    assert result.order.tolist() == [1, 2, 3, 0]
    assert result.gain.tolist() == pytest.approx([6, 4, 3, 0])
    assert result.covered.tolist() == pytest.approx([6, 10, 13, 13])


@given(hull_sets(), st.integers(0, 12))
def test_the_first_are_those_of_the_whole_order(polygons, count):
    assert (
        area_greedy.choose_first(polygons, count).tolist()
        == area_greedy.order_by_area(polygons).order[:count].tolist()
    )


def test_of_equals_the_lowest_index():
    boxes = [box(0, 0, 1, 1), box(5, 0, 7, 1), box(9, 0, 11, 1), box(5, 0, 7, 1), box(0, 0, 1, 1)]
    assert area_greedy.order_by_area(boxes).order.tolist() == [1, 2, 0, 3, 4]


def test_a_gain_within_the_tolerance_is_equal_and_beyond_it_is_not():
    within, beyond = box(0, 0, 1, 1 + 0.5 * SMALLEST_M2), box(5, 0, 6, 1 + 2.5 * SMALLEST_M2)
    assert area_greedy.order_by_area([box(9, 0, 10, 1), within]).order.tolist() == [0, 1]
    assert area_greedy.order_by_area([box(9, 0, 10, 1), within, beyond]).order.tolist() == [2, 0, 1]


def test_identical_one_none_and_all_empty():
    assert area_greedy.order_by_area([box(0, 0, 1, 1)] * 5).order.tolist() == [0, 1, 2, 3, 4]
    assert area_greedy.order_by_area([box(0, 0, 2, 1)]).covered.tolist() == [2.0]
    assert len(area_greedy.order_by_area([]).order) == 0
    nothing = area_greedy.order_by_area(
        [shapely.Polygon(), shapely.Point(1, 1), shapely.LineString([(0, 0), (1, 1)])]
    )
    assert nothing.order.tolist() == [0, 1, 2]
    assert nothing.covered.tolist() == [0, 0, 0]


@settings(max_examples=300, deadline=None)
@given(hull_sets())
def test_same_order_as_algorithm_1(polygons):
    order, covered_m2 = hull_selection.hull_selection(polygons)
    result = area_greedy.order_by_area(polygons)
    assert result.order.tolist() == order
    # corners a nanometre apart count for what the order itself takes for nothing
    assert result.covered == pytest.approx(covered_m2, abs=SMALLEST_M2)


def test_what_lies_beside_a_common_edge_is_not_covered():
    common = (6.69960355758667, 0), (0, 1.0099999904632568)
    polygons = [
        *(Polygon([*common, (0, 3)]), Polygon([*common, (3, 3)])),
        Polygon([(0.9775999784469604, 0), (0.3118000030517578, 1), (0, 6.75)]),
    ]
    covered_m2 = area_greedy.order_by_area(polygons).covered[-1]
    assert covered_m2 == pytest.approx(shapely.union_all(polygons).area, abs=1e-9)


@settings(max_examples=100, deadline=None)
@given(hull_sets())
def test_areas_behave_as_areas_of_unions_do(polygons):
    result, area_m2 = area_greedy.order_by_area(polygons), shapely.area(polygons)
    # what is smaller than the order's own tolerance counts for nothing, here and in a union not
    assume(((area_m2 == 0) | (area_m2 > SMALLEST_M2)).all())
    assert sorted(result.order) == list(range(len(polygons)))
    assert (result.gain >= 0).all()
    assert (np.diff(result.gain) <= SMALLEST_M2).all()
    assert result.covered[-1] == pytest.approx(shapely.union_all(polygons).area, abs=1e-9)
    assert area_m2.max() - 1e-9 <= result.covered[-1] <= area_m2.sum() + 1e-9


def test_same_order_as_algorithm_1_on_a_walk():
    polygons = scattered(70)
    order, covered_m2 = hull_selection.hull_selection(polygons)
    result = area_greedy.order_by_area(polygons)
    assert result.order.tolist() == order
    assert result.covered == pytest.approx(covered_m2, abs=1e-9)


def test_same_order_as_algorithm_1_on_a_dense_walk():
    # every scan beside a hundred others, so that batches are large and parts are covered together
    polygons = scattered(160, seed=3)
    order, covered_m2 = hull_selection.hull_selection(polygons, 40)
    found = area_greedy.order_by_area(polygons)
    assert found.order[:40].tolist() == order
    assert found.covered[:40] == pytest.approx(covered_m2, abs=1e-9)


def test_a_move_of_a_thousand_kilometres_changes_nothing():
    # corners on a grid that float64 holds at both places, so that only the method could differ
    near = shapely.transform(np.array(scattered(40)), lambda xy: np.round(xy * 1024) / 1024)
    far = shapely.transform(near, lambda xy: xy + np.array([2.0**20, -(2.0**21)]))
    order = np.arange(40)
    assert (
        area_greedy.order_by_area(far).order.tolist()
        == area_greedy.order_by_area(near).order.tolist()
    )
    assert area_greedy.order_by_area(far).gain == pytest.approx(
        area_greedy.order_by_area(near).gain, abs=1e-12
    )
    assert area_greedy.area_gains(far, order) == pytest.approx(
        area_greedy.area_gains(near, order), abs=1e-12
    )


@settings(max_examples=100, deadline=None)
@given(hull_sets(), st.randoms(use_true_random=False))
def test_gains_of_a_given_order(polygons, random):
    order = random.sample(range(len(polygons)), len(polygons))
    gain_m2 = area_greedy.area_gains(polygons, order)
    union = [
        shapely.union_all([polygons[i] for i in order[:k]]).area for k in range(len(order) + 1)
    ]
    assert gain_m2 == pytest.approx(np.diff(union), abs=1e-9)
    assert (gain_m2 >= 0).all()


def test_gains_of_the_greedy_order_are_its_own():
    result = area_greedy.order_by_area(scattered(40))
    assert area_greedy.area_gains(scattered(40), result.order) == pytest.approx(
        result.gain, abs=1e-9
    )


@pytest.mark.parametrize("order", [[0, 0], [2], [-1]])
def test_refuses_an_order_of_other_polygons(order):
    with pytest.raises(ValueError, match="distinct"):
        area_greedy.area_gains([box(0, 0, 1, 1)] * 2, order)


def test_repairs_an_invalid_polygon():
    bowtie = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    overlapping = shapely.GeometryCollection(
        [box(10, 0, 12, 2), box(11, 0, 13, 2), shapely.Point(0, 0)]
    )
    result = area_greedy.order_by_area([bowtie, overlapping])
    assert result.order.tolist() == [1, 0]
    assert result.gain.tolist() == pytest.approx([6, 2])


@pytest.mark.parametrize(
    "wrong", [None, shapely.Point(np.nan, 0), shapely.LineString([(0, 0), (np.inf, 1)])]
)
def test_refuses_what_has_no_place(wrong):
    with pytest.raises(ValueError, match="finite"):
        area_greedy.order_by_area([box(0, 0, 1, 1), wrong])


def test_an_inconsistent_overlay_is_done_again_on_a_grid(monkeypatch):
    exact, refused = shapely.difference, []

    def difference(a, b, grid_size=None):
        if grid_size is None:
            refused.append(a)
            raise shapely.GEOSException("TopologyException: side location conflict")
        return exact(a, b, grid_size=grid_size)

    monkeypatch.setattr(shapely, "difference", difference)
    result = area_greedy.order_by_area([box(0, 0, 2, 1), box(1, 0, 4, 1)])
    assert refused
    assert result.gain.tolist() == pytest.approx([3, 1], abs=1e-5)


def test_checkpoints_bound_what_every_polygon_would_add():
    polygons = scattered(20)
    result = area_greedy.order_by_area(polygons)
    assert sorted(result.checkpoints) == [0, 1, 2, 4, 8, 16]
    for j, bound_m2 in result.checkpoints.items():
        union = shapely.union_all([polygons[i] for i in result.order[:j]])
        added_m2 = np.array([(union | p).area - union.area for p in polygons])
        assert (bound_m2 >= added_m2 - 1e-9).all()
        assert (bound_m2[result.order[:j]] == 0).all()
        assert (bound_m2 <= result.checkpoints[0]).all()


def test_numbers_too_small_to_be_squared_are_nought():
    circle = shapely.Point(0, 3).buffer(1.5, quad_segs=4)
    dusty = shapely.transform(circle, lambda xy: np.where(xy == 0, 5e-324, xy))
    others = [box(0, 0, 2, 1), box(0, 1, 1, 5)]
    assert area_greedy.order_by_area([*others, dusty]).gain == pytest.approx(
        area_greedy.order_by_area([*others, circle]).gain
    )


def test_polygons_far_apart_and_of_all_sizes():
    polygons = [
        box(0, 0, 1, 1),
        box(1e5, 0, 1e5 + 300, 2),
        box(0.5, 0, 1.5, 1),
        box(1e5 + 299, 0, 1e5 + 301, 2),
    ]
    assert area_greedy.area_gains(polygons, [0, 1, 2, 3]) == pytest.approx([1, 600, 0.5, 2])
    assert area_greedy.order_by_area(polygons).gain == pytest.approx([600, 2, 1, 0.5])
