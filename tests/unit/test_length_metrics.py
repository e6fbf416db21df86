import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from scanplan.lab.evaluation import length_metrics

WALL = (0, 0, 10, 0)
coordinate = st.integers(-300, 300).map(lambda v: v / 100)
some_lines = st.lists(st.tuples(coordinate, coordinate, coordinate, coordinate), max_size=6).map(
    lambda ends: lines(*(e for e in ends if np.hypot(e[2] - e[0], e[3] - e[1]) > 0.05))
)


def lines(*ends):
    return np.array(ends, float).reshape(-1, 2, 2)


def compare(result, truth, within_m=0.1):
    return length_metrics.compare_lines(lines(*result), lines(*truth), within_m)


class TestOnPaper:
    def test_perfect(self):
        assert compare([WALL], [WALL]) == length_metrics.Agreement(1, 1, 1)

    def test_half_of_a_wall(self):
        found = compare([(0, 0.05, 5, 0.05)], [WALL])
        # the end reaches sqrt(0.1^2 - 0.05^2) further
        assert found.completeness == pytest.approx((5 + np.sqrt(0.0075)) / 10)
        assert found.correctness == 1

    def test_too_far_is_nothing(self):
        assert compare([(0, 0.2, 10, 0.2)], [WALL]) == length_metrics.Agreement(0, 0, 0)

    def test_two_results_find_a_wall_once_but_count_twice(self):
        found = compare([WALL, (0, 0.05, 10, 0.05), (0, 5, 10, 5)], [WALL])
        assert found.completeness == 1
        assert found.correctness == pytest.approx(2 / 3)
        assert found.f1 == pytest.approx(0.8)

    def test_a_crossing_result_finds_twice_the_distance(self):
        found = compare([(5, -1, 5, 1)], [WALL])
        assert found.completeness == pytest.approx(0.02)
        assert found.correctness == pytest.approx(0.1)

    def test_empty_result_empty_truth(self):
        assert compare([], [WALL]) == length_metrics.Agreement(0, 1, 0)
        assert compare([WALL], []) == length_metrics.Agreement(1, 0, 0)
        assert compare([], []) == length_metrics.Agreement(1, 1, 1)

    def test_a_result_of_no_length_is_none(self):
        assert compare([(5, 0, 5, 0)], [WALL]) == length_metrics.Agreement(0, 1, 0)

    def test_distances_must_be_positive(self):
        with pytest.raises(ValueError, match="above 0"):
            compare([WALL], [WALL], 0)


def near_share(some, others, within_m):
    """By polygons: a disc of 4 * 64 corners is 1e-4 of its radius too small."""
    around = shapely.union_all(shapely.buffer(shapely.linestrings(others), within_m, quad_segs=64))
    inside = shapely.length(shapely.intersection(shapely.linestrings(some), around)).sum()
    return inside / shapely.length(shapely.linestrings(some)).sum()


class TestProperties:
    @given(some_lines, some_lines, st.sampled_from([0.05, 0.1, 0.15]))
    def test_agrees_with_buffers(self, result, truth, within_m):
        found = length_metrics.compare_lines(result, truth, within_m)
        if len(truth) and len(result):
            assert found.completeness == pytest.approx(
                near_share(truth, result, within_m), abs=0.01
            )
            assert found.correctness == pytest.approx(near_share(result, truth, within_m), abs=0.01)

    @given(some_lines, some_lines, coordinate, coordinate)
    def test_moving_both_changes_nothing(self, result, truth, x, y):
        found = length_metrics.compare_lines(result, truth, 0.1033)
        shift = np.array([x, y])
        moved = length_metrics.compare_lines(result + shift, truth + shift, 0.1033)
        np.testing.assert_allclose(
            list(vars(moved).values()), list(vars(found).values()), atol=1e-5
        )

    @given(some_lines, some_lines)
    def test_swapping_swaps_completeness_and_correctness(self, result, truth):
        found, swapped = (
            length_metrics.compare_lines(result, truth, 0.1),
            length_metrics.compare_lines(truth, result, 0.1),
        )
        assert (found.completeness, found.correctness) == (
            swapped.correctness,
            swapped.completeness,
        )
        assert found.f1 == pytest.approx(swapped.f1)

    @given(some_lines, some_lines)
    def test_a_wider_distance_finds_no_less(self, result, truth):
        narrow, wide = (length_metrics.compare_lines(result, truth, d) for d in (0.05, 0.15))
        assert (
            wide.completeness >= narrow.completeness - 1e-9
            and wide.correctness >= narrow.correctness - 1e-9
        )


def test_stretches_of_one_line_are_joined_and_lines_kept_apart():
    some = length_metrics.NearIntervals(
        line=np.array([1, 0, 1, 1]),
        other=np.arange(4),
        low_m=np.array([2.0, 0, 0, 5]),
        high_m=np.array([4.0, 3, 2.5, 6]),
    )
    np.testing.assert_allclose(length_metrics.union_length_m(some, 3), [3, 5, 0])
