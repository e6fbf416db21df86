import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.geometry import intervals

SPANS = st.lists(st.tuples(st.floats(-9, 9), st.floats(0.01, 4)), min_size=1, max_size=8).map(
    lambda spans: np.array([(low, low + length) for low, length in spans])
)


def test_gaps_between_intervals_that_overlap():
    spans = np.array([(4.0, 6), (0, 3), (1, 2), (5, 7), (9, 9.5)])
    assert intervals.find_gaps(spans).tolist() == [[3, 4], [7, 9]]


def test_gaps_between_two_places():
    spans = np.array([(1.0, 2), (4, 6)])
    assert intervals.find_gaps(spans, 0, 8).tolist() == [[0, 1], [2, 4], [6, 8]]
    assert intervals.find_gaps(spans, 1.5, 3).tolist() == [[2, 3]]
    assert intervals.find_gaps(spans, 4, 5).tolist() == []


@given(SPANS)
def test_gaps_and_intervals_are_the_whole(spans):
    gaps = intervals.find_gaps(spans)
    places = np.linspace(spans.min(), spans.max(), 301)
    in_span = ((places[:, None] >= spans[:, 0]) & (places[:, None] <= spans[:, 1])).any(axis=1)
    in_gap = ((places[:, None] > gaps[:, 0]) & (places[:, None] < gaps[:, 1])).any(axis=1)
    np.testing.assert_array_equal(in_span, ~in_gap)


@given(SPANS)
def test_what_intervals_add_is_the_whole_less_the_gaps(spans):
    spans = spans[np.argsort(spans[:, 0])]
    gaps = intervals.find_gaps(spans)
    covered_m = spans.max() - spans.min() - (gaps[:, 1] - gaps[:, 0]).sum()
    assert intervals.added_lengths_m(*spans.T).sum() == pytest.approx(covered_m)


def test_runs_of_intervals_and_of_positions():
    begin_m, end_m = np.array([0.0, 1, 4, 4.4]), np.array([3.0, 2, 4.2, 5])
    assert intervals.find_run_starts(begin_m, end_m, 0.5).tolist() == [2]
    positions_m = np.array([0.0, 0.4, 3, 3.1])
    assert intervals.find_run_starts(positions_m, positions_m, 0.5).tolist() == [2]
    assert intervals.find_run_starts(np.empty(0), np.empty(0), 0.5).tolist() == []


def test_where_a_linear_function_is_in_range():
    low, high = intervals.solve_range(
        np.array([0.0, 4, 1, 9]), np.array([2.0, -2, 0, 0]), least=0.0, most=2.0
    )
    assert low.tolist() == [0, 1, -np.inf, np.inf]
    assert high.tolist() == [1, 2, np.inf, -np.inf]
