"""Awkward surveys, through everything that orders polygons by area."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from helpers.hull_making import best_by_trying_all, hull_sets, scattered
from reference import hull_selection
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.selection import area_greedy, bounds, objectives, orderings, stopping

BOWTIE = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
SURVEYS = {
    "no scan": [],
    "one scan": [box(0, 0, 2, 1)],
    "identical": [box(0, 0, 2, 1)] * 6,
    "empty": [shapely.Polygon()] * 3,
    "empty among others": [
        shapely.Polygon(),
        box(0, 0, 1, 1),
        shapely.MultiPolygon(),
        box(0, 0, 2, 1),
    ],
    "lines and points": [
        shapely.LineString([(0, 0), (3, 1)]),
        shapely.Point(1, 1),
        box(0, 0, 1, 1),
    ],
    "invalid": [BOWTIE, box(0, 0, 2, 1), shapely.MultiPolygon([box(0, 0, 2, 2), box(1, 1, 3, 3)])],
    "far": [shapely.affinity.translate(p, 5e5, 5.8e6) for p in scattered(12)],
    "sizes": [box(0, 0, 1e4, 1e4), *(box(i, 0, i + 1e-3, 1e-3) for i in range(4))],
}


def literal_order(polygons):
    """Algorithm 1 on repaired polygons near the origin, where it keeps its digits."""
    valid = [
        shapely.union_all(shapely.get_parts(shapely.make_valid(p))) if not p.is_valid else p
        for p in polygons
    ]
    valid = [p if p.area > 0 else shapely.Polygon() for p in valid]
    middle = (
        np.floor(shapely.get_coordinates(valid).mean(axis=0)) if any(p.area for p in valid) else 0.0
    )
    return hull_selection.hull_selection(
        [shapely.transform(p, lambda xy: xy - middle) for p in valid]
    )


@pytest.mark.parametrize("name", SURVEYS)
def test_order_gains_and_bound(name):
    polygons = SURVEYS[name]
    order, covered_m2 = literal_order(polygons)
    objective = objectives.PolygonArea(polygons)
    found = objective.greedy()
    assert found.order.tolist() == order
    assert found.covered == pytest.approx(covered_m2, abs=1e-6)
    assert objective.gains(np.array(order, int)) == pytest.approx(found.gain, abs=1e-6)
    bound_m2 = bounds.bound_any_subset(found)
    assert bound_m2.shape == (len(polygons),) and (bound_m2 >= found.covered).all()


@pytest.mark.parametrize("name", SURVEYS)
def test_one_at_a_time_and_within_a_budget(name):
    polygons = SURVEYS[name]
    objective = objectives.PolygonArea(polygons)
    # an overlap that all have changes nothing, but goes the other way through the code
    assert objective.greedy(1e-12).order.tolist() == objective.greedy().order.tolist()
    assert sorted(objective.greedy(0.5).order) == list(range(len(polygons)))
    cost = np.full(len(polygons), 10)
    assert objective.within(cost, 5) == []
    adding = int((objective.greedy().gain > SMALLEST_M2).sum())
    assert objective.within(cost, 10 * len(polygons)) == objective.greedy().order[:adding].tolist()


@settings(max_examples=60, deadline=None)
@given(hull_sets(max_size=7))
def test_the_bound_is_above_the_best_of_every_size(polygons):
    bound_m2 = bounds.bound_any_subset(area_greedy.order_by_area(polygons))
    assert (bound_m2 >= np.array(best_by_trying_all(polygons)) - SMALLEST_M2 * len(polygons)).all()


@settings(max_examples=60, deadline=None)
@given(hull_sets(), st.tuples(st.integers(-(2**20), 2**20), st.integers(-(2**23), 2**23)))
def test_same_order_anywhere_on_earth(polygons, shift_m):
    # corners on a grid that float64 holds everywhere, so that only the method could differ
    near = [shapely.transform(p, lambda xy: np.round(xy * 1024) / 1024) for p in polygons]
    near = [p if p.is_valid else shapely.make_valid(p) for p in near]
    far = [shapely.transform(p, lambda xy: xy + np.array(shift_m, float)) for p in near]
    assert area_greedy.order_by_area(far).order.tolist() == literal_order(near)[0]


@pytest.mark.parametrize("k", [0, -1])
def test_no_plan_of_no_scans(k):
    with pytest.raises(ValueError, match="one scan"):
        stopping.choose_n_scans({"covered_m2": np.array([1.0, 2.0])}, n_scans=k)


def test_more_scans_than_there_are():
    k, reason = stopping.choose_n_scans({"covered_m2": np.array([1.0, 2.0])}, n_scans=5)
    assert k == 2 and "5" in reason


@pytest.mark.parametrize(
    "method", ["cluster_hull", "hull", "random", "sequential", "every_nth", "streaming"]
)
def test_no_scans_have_an_empty_order(method):
    nothing = {
        "scan_id": np.zeros(0, np.int32),
        "cluster": np.zeros(0, np.int32),
        "n_points": np.zeros(0, np.int32),
        "geometry": np.zeros(0, object),
    }
    order = orderings.order_scans(method, nothing, seed=1)
    assert all(len(values) == 0 for values in order.values())
