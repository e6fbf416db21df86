from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from scanplan.selection.objectives import CellCoverage, PolygonArea


def area(polygons, chosen):
    return shapely.union_all([polygons[i] for i in chosen]).area


def test_by_gain_per_cost():
    boxes = [box(0, 0, 10, 1), box(20, 0, 26, 1), box(30, 0, 36, 1)]
    # 10 m2 for 10, or 6 + 6 m2 for 5 each; for 15 the largest and one more
    assert PolygonArea(boxes).within([10, 5, 5], 10) == [1, 2]
    assert PolygonArea(boxes).within([10, 5, 5], 15) == [0, 1]
    # all fit: by gain
    assert PolygonArea(boxes).within([10, 5, 5], 20) == [0, 1, 2]


def test_a_cheap_trifle_does_not_shut_out_a_good_one():
    boxes = [box(0, 0, 1, 1), box(10, 0, 20, 1)]
    assert PolygonArea(boxes).within([0.05, 1.0], 1.0) == [1]


def test_what_is_covered_already_is_not_paid_for():
    boxes = [box(0, 0, 9, 1), box(0, 0, 8, 1), box(50, 0, 52, 1)]
    assert PolygonArea(boxes).within([3, 3, 3], 9) == [0, 2]


def test_of_equals_the_first():
    assert PolygonArea([box(4 * i, 0, 4 * i + 1, 1) for i in range(4)]).within([2] * 4, 5) == [0, 1]


@pytest.mark.parametrize(("cost", "budget"), [([5, 6], 4), ([], 10)])
def test_nothing_that_fits(cost, budget):
    assert PolygonArea([box(0, 0, 1, 1)] * len(cost)).within(cost, budget) == []


@pytest.mark.parametrize("cost", [[1.0], [1, 0], [1, -1], [1, np.nan]])
def test_refuses_costs_that_are_none(cost):
    with pytest.raises(ValueError, match="costs above 0"):
        PolygonArea([box(0, 0, 1, 1)] * 2).within(cost, 5)


def test_cells_have_budgets_too():
    cells = CellCoverage(np.array([0, 1, 2]), np.array([0, 1, 2]), np.array([10.0, 6.0, 6.0]), 3)
    assert cells.within([10, 5, 5], 10) == [1, 2]


BOXES = st.lists(
    st.tuples(*[st.integers(0, 6)] * 2, *[st.integers(0, 4)] * 2, st.integers(1, 9)),
    min_size=1,
    max_size=7,
)


@settings(max_examples=100, deadline=None)
@given(BOXES, st.integers(1, 25))
def test_within_the_budget_and_as_good_as_promised(numbers, budget):
    polygons = [box(x, y, x + w, y + h) for x, y, w, h, _ in numbers]
    cost = np.array([n[4] for n in numbers])
    chosen = PolygonArea(polygons).within(cost, budget)
    assert len(set(chosen)) == len(chosen) and cost[chosen].sum() <= budget
    subsets = [
        s
        for k in range(len(cost) + 1)
        for s in combinations(range(len(cost)), k)
        if cost[list(s)].sum() <= budget
    ]
    best = max(area(polygons, s) for s in subsets)
    assert area(polygons, chosen) >= (1 - 1 / np.e) / 2 * best - 1e-9
