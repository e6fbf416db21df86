import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from reference import greedy_cover
from thesis.comparison import oracle


def test_on_paper():
    seen = np.array([[1, 0, 0, 0], [0, 1, 1, 0], [1, 1, 0, 0], [0, 0, 0, 1]], bool)
    found = oracle.order_by_truth(seen, np.array([1.0, 2, 2, 0.5]))
    # 4 m, then 1 m by the first of two equals, then 0.5 m; the last sees nothing new
    np.testing.assert_array_equal(found.order, [1, 0, 3, 2])
    np.testing.assert_allclose(found.gain_m, [4, 1, 0.5, 0])


def test_when_all_is_seen_it_begins_anew():
    seen = np.array([[1, 0], [1, 1], [0, 1], [1, 1]], bool)
    found = oracle.order_by_truth(seen, np.array([1.0, 1]))
    np.testing.assert_array_equal(found.order, [1, 3, 0, 2])
    np.testing.assert_allclose(found.gain_m, [2, 0, 0, 0])


def test_scans_that_see_nothing_come_last():
    np.testing.assert_array_equal(
        oracle.order_by_truth(np.array([[0], [1], [0]], bool), np.ones(1)).order, [1, 0, 2]
    )


@given(st.lists(st.lists(st.booleans(), min_size=7, max_size=7), min_size=1, max_size=8))
def test_agrees_with_looking_at_every_scan(rows):
    length_m = np.array([1, 1, 2, 3, 0.5, 0.25, 4])
    found = oracle.order_by_truth(np.array(rows, bool), length_m)
    assert found.order.tolist() == greedy_cover.order(rows, length_m)
    first_round = np.flatnonzero(found.gain_m > 0)
    np.testing.assert_array_equal(first_round, np.arange(len(first_round)))
    assert found.gain_m.sum() == length_m[np.any(np.array(rows, bool), axis=0)].sum()
