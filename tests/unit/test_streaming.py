import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from helpers.hull_making import best_by_trying_all, hull_sets, scattered
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.selection import area_greedy, streaming


def covered(polygons, chosen):
    return shapely.union_all([polygons[i] for i in chosen]).area


def test_the_large_ones_are_kept_whenever_they_come():
    boxes = [box(3 * i, 0, 3 * i + 1 + (i in (2, 7)), 1) for i in range(10)]
    order, _ = streaming.order_streaming(boxes, k=2)
    assert order.tolist() == [2, 7, 0, 1, 3, 4, 5, 6, 8, 9]


def test_the_same_scan_again_takes_no_slot():
    boxes = [box(0, 0, 4, 1)] * 20 + [box(10, 0, 13, 1)]
    order, most_held = streaming.order_streaming(boxes, k=3)
    assert order[:2].tolist() == [0, 20]
    assert most_held == 2


@settings(max_examples=100, deadline=None)
@given(hull_sets(), st.integers(1, 9), st.sampled_from([0.05, 0.3]))
def test_half_of_the_best_is_covered(polygons, k, epsilon):
    polygons = [p if p.is_valid else shapely.make_valid(p) for p in polygons]
    order, most_held = streaming.order_streaming(polygons, k=k, epsilon=epsilon)
    best_m2 = best_by_trying_all(polygons)
    k = min(k, len(polygons))
    assert sorted(order) == list(range(len(polygons)))
    assert covered(polygons, order[:k]) >= (0.5 - epsilon) * best_m2[k - 1] - 1e-9
    assert most_held <= len(polygons)


def test_nearly_as_much_as_greedy_and_few_held_however_long_the_stream():
    held = []
    for n in (300, 900):
        polygons = scattered(n)
        order, most_held = streaming.order_streaming(polygons, k=12, epsilon=0.2)
        assert (
            covered(polygons, order[:12]) >= 0.85 * area_greedy.order_by_area(polygons).covered[11]
        )
        held.append(most_held)
    assert held[1] <= min(1.3 * held[0], 80)


def test_the_choice_is_in_greedy_order():
    order, _ = streaming.order_streaming(scattered(100), k=10)
    gain_m2 = area_greedy.area_gains(scattered(100), order)[:10]
    assert (np.diff(gain_m2) <= SMALLEST_M2).all()


def test_as_many_slots_as_scans_is_greedy():
    polygons = scattered(20)
    order, most_held = streaming.order_streaming(polygons, k=20)
    assert order.tolist() == area_greedy.order_by_area(polygons).order.tolist() and most_held == 20


def test_none_one_and_empty():
    assert streaming.order_streaming([], k=3)[0].tolist() == []
    assert streaming.order_streaming([box(0, 0, 1, 1)], k=1)[0].tolist() == [0]
    assert streaming.order_streaming([shapely.Polygon()] * 3, k=1)[0].tolist() == [0, 1, 2]


def test_far_from_the_origin_the_choice_is_the_same():
    near = shapely.transform(np.array(scattered(60)), lambda xy: np.round(xy * 1024) / 1024)
    far = shapely.transform(near, lambda xy: xy + np.array([2.0**20, -(2.0**21)]))
    assert (
        streaming.order_streaming(far, k=8)[0].tolist()
        == streaming.order_streaming(near, k=8)[0].tolist()
    )


@pytest.mark.parametrize(
    "wrong", [{"k": 0}, {"k": -1}, {"k": 3, "epsilon": 0.0}, {"k": 3, "epsilon": 0.5}]
)
def test_refuses_parameters_out_of_range(wrong):
    with pytest.raises(ValueError, match="epsilon"):
        streaming.order_streaming([box(0, 0, 1, 1)], **wrong)
