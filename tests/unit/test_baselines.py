import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.selection import baselines
from scanplan.selection.survey_scans import SurveyScans


def scans(n):
    return SurveyScans(np.arange(n))


def test_every_nth_on_paper():
    assert baselines.order_every_nth(scans(8)).tolist() == [0, 4, 2, 6, 1, 5, 3, 7]
    assert baselines.order_every_nth(scans(5)).tolist() == [0, 2, 1, 3, 4]
    assert baselines.order_every_nth(scans(1100))[:4].tolist() == [0, 550, 275, 825]
    assert [baselines.order_every_nth(scans(n)).tolist() for n in (0, 1, 2)] == [[], [0], [0, 1]]


@given(st.integers(0, 300), st.integers(1, 300))
def test_any_first_of_every_nth_leave_no_wide_gap(n, k):
    order = baselines.order_every_nth(scans(n))
    assert sorted(order.tolist()) == list(range(n))
    if n and k <= n:
        taken = np.sort(order[:k])
        # the bits halve the gap each time k doubles; n is at most doubled to a power of two
        assert np.diff(np.append(taken, n)).max() <= max(1, 4 * n / k)


def test_distance_on_paper():
    # from the first: 10 is farthest, then 4 (4 from both), then 1 (of 1 and 2: the nearer to one is
    # later)
    assert baselines.order_farthest_first([(0, 0), (1, 0), (4, 0), (10, 0), (2, 0)]).tolist() == [
        0,
        3,
        2,
        4,
        1,
    ]


def test_distance_of_equal_places_goes_by_index():
    assert baselines.order_farthest_first([(3, 3)] * 4).tolist() == [0, 1, 2, 3]
    assert baselines.order_farthest_first(np.empty((0, 2))).tolist() == []


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=12))
def test_distance_takes_the_farthest_every_time(places):
    order, xy = baselines.order_farthest_first(places), np.array(places, float)
    assert sorted(order.tolist()) == list(range(len(places)))
    for k in range(1, len(order)):
        nearest = np.linalg.norm(xy[:, None] - xy[order[:k]], axis=2).min(axis=1)
        assert nearest[order[k]] == pytest.approx(nearest.max())
