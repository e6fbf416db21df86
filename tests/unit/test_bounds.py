import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from helpers.hull_making import best_by_trying_all
from scanplan.selection import area_greedy, bounds

# greedy takes the middle first (6), then one side (3); the two sides together are 10
TRAP = [box(2, 0, 8, 1), box(0, 0, 5, 1), box(5, 0, 10, 1)]


def test_of_disjoint_polygons_greedy_is_certified_best():
    order = area_greedy.order_by_area([box(3 * i, 0, 3 * i + 2, 1 + i % 3) for i in range(7)])
    assert bounds.bound_any_subset(order) == pytest.approx(order.covered)


def test_on_paper():
    order = area_greedy.order_by_area(TRAP)
    assert order.covered.tolist() == pytest.approx([6, 8, 10])
    # at k = 2: 6 + 5 with nothing chosen, 6 + (2 + 2) = 10 with the middle chosen, 10 in all
    assert bounds.bound_any_subset(order) == pytest.approx([6, 10, 10], abs=1e-5)


def polygon(numbers):
    x, y, w, h = numbers
    return (
        box(x, y, x + w, y + h)
        if w * h != 4
        else shapely.Point(x, y).buffer(1 + h / 3, quad_segs=3)
    )


POLYGONS = st.lists(
    st.tuples(*[st.integers(0, 6)] * 2, *[st.integers(0, 5)] * 2).map(polygon),
    min_size=1,
    max_size=8,
)


@settings(max_examples=150, deadline=None)
@given(POLYGONS)
def test_never_below_the_best_subset(polygons):
    order = area_greedy.order_by_area(polygons)
    bound_m2 = bounds.bound_any_subset(order)
    assert (bound_m2 >= np.array(best_by_trying_all(polygons)) - 1e-9).all()
    assert (bound_m2 >= order.covered).all()


@settings(max_examples=100, deadline=None)
@given(POLYGONS)
def test_as_tight_as_theory_promises(polygons):
    order = area_greedy.order_by_area(polygons)
    bound_m2 = bounds.bound_any_subset(order)
    k = np.arange(1, len(polygons) + 1)
    guarantee = 1 - (1 - 1 / k) ** k
    assert (order.covered >= guarantee * bound_m2 - 1e-5 * k).all()
    assert (np.diff(bound_m2) >= -1e-9).all()
    assert (bound_m2 <= order.covered[-1] + 1e-9).all()
    assert bound_m2[0] == pytest.approx(order.covered[0], abs=1e-5)


def test_steps_between_the_checkpoints_tighten_the_bound():
    large = [box(2 * i, 0, 2 * i + 1, 1) for i in range(6) for _ in range(7)]
    small = [box(2 * i, 5, 2 * i + 1, 5.1) for i in range(20)]
    bound_m2 = bounds.bound_any_subset(area_greedy.order_by_area(large + small))
    # at k = 7: 7 with nothing chosen, 4 + 7 with 4, 6.2 + 0.7 with 8; with the six large chosen 6 +
    # 7 * 0.1
    assert bound_m2[6] == pytest.approx(6.7, abs=1e-4)


def test_of_none_and_of_nothing():
    assert bounds.bound_any_subset(area_greedy.order_by_area([])).shape == (0,)
    assert bounds.bound_any_subset(area_greedy.order_by_area([shapely.Polygon()] * 3)).tolist() == [
        0,
        0,
        0,
    ]


def test_nearly_linear_in_the_number_of_scans():
    steps = [len(bounds._steps(n)) for n in (1000, 10_000)]
    assert steps[0] < 180 and steps[1] < 260
    assert bounds._steps(1) == [0] and bounds._steps(40) == list(range(40))
