import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference import bitmap as reference
from scanplan.errors import StageError
from scanplan.geometry import bitmap

FIVE = bitmap.Grid(np.zeros(2), 1.0, (5, 5))


def lines(*ends):
    return np.array(ends, float).reshape(-1, 2, 2)


def cells(line, grid=FIVE):
    return sorted(
        zip(
            *(axis.tolist() for axis in np.nonzero(bitmap.rasterise_lines(lines(line), grid))),
            strict=True,
        )
    )


class TestThesis:
    """Truth: the second row and the last column of 5 x 5.

    Result: the second row but its last two, and the first.
    """

    TRUTH = np.zeros((5, 5), bool)
    TRUTH[1, :] = TRUTH[:, 4] = True
    RESULT = np.zeros((5, 5), bool)
    RESULT[1, :3] = RESULT[0, :2] = True

    def test_as_worked_out_on_paper(self):
        # 9 true cells, 3 of them found, 2 invented: 6 missed, 17 right
        found = bitmap.error_shares(bitmap.subtract_bitmaps(self.RESULT, self.TRUTH))
        assert (found.false_negative, found.correct_match, found.false_positive) == (
            6 / 25,
            17 / 25,
            2 / 25,
        )

    def test_lines_make_the_same_maps(self):
        drawn = bitmap.rasterise_lines(lines((0, 1.5, 5, 1.5), (4.5, 0, 4.5, 5)), FIVE)
        np.testing.assert_array_equal(drawn, self.TRUTH)

    def test_the_error_map_is_result_less_truth(self):
        errors = bitmap.subtract_bitmaps(self.RESULT, self.TRUTH)
        assert errors[0, 0] == 1 and errors[1, 0] == 0 and errors[1, 4] == -1 and errors[2, 0] == 0

    def test_perfect_empty_and_invented(self):
        empty = np.zeros((5, 5), bool)
        assert bitmap.error_shares(
            bitmap.subtract_bitmaps(self.TRUTH, self.TRUTH)
        ) == bitmap.Shares(0, 1, 0)
        assert bitmap.error_shares(bitmap.subtract_bitmaps(empty, self.TRUTH)) == bitmap.Shares(
            9 / 25, 16 / 25, 0
        )
        assert bitmap.error_shares(bitmap.subtract_bitmaps(self.TRUTH, empty)) == bitmap.Shares(
            0, 16 / 25, 9 / 25
        )
        assert bitmap.error_shares(bitmap.subtract_bitmaps(empty, empty)) == bitmap.Shares(0, 1, 0)

    @pytest.mark.parametrize("other", [np.zeros((5, 6), bool), np.zeros((5, 5))])
    def test_maps_of_different_size_or_kind_are_refused(self, other):
        with pytest.raises(ValueError, match="one size"):
            bitmap.subtract_bitmaps(other, self.TRUTH)

    @given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=40))
    def test_agrees_with_the_thesis_and_sums_to_one(self, pairs):
        result, truth = np.array(pairs, bool).T[:, None]
        found = bitmap.error_shares(bitmap.subtract_bitmaps(result, truth))
        literal = reference.shares(result.astype(int).tolist(), truth.astype(int).tolist())
        assert (found.false_negative, found.correct_match, found.false_positive) == pytest.approx(
            literal
        )
        assert sum(vars(found).values()) == pytest.approx(1)


class TestRasterise:
    def test_a_slanted_line_has_every_cell_that_it_passes(self):
        assert cells((0.5, 0.5, 3.5, 1.5)) == [(0, 0), (0, 1), (1, 2), (1, 3)]

    def test_through_corners_cells_touch(self):
        assert cells((0, 0, 3, 3)) == [(0, 0), (1, 1), (2, 2)]

    def test_direction_does_not_matter(self):
        assert cells((3.5, 1.7, 0.5, 0.2)) == cells((0.5, 0.2, 3.5, 1.7))

    def test_a_line_on_an_edge_is_in_the_cell_beyond_and_at_the_end_in_the_last(self):
        assert cells((2, 0.5, 2, 1.5)) == [(0, 2), (1, 2)]
        assert cells((5, 0.5, 5, 1.5)) == [(0, 4), (1, 4)]

    def test_a_point_has_one_cell(self):
        assert cells((1.2, 3.4, 1.2, 3.4)) == [(3, 1)]

    def test_what_lies_outside_has_none(self):
        assert cells((-3, 0.5, 1.5, 0.5)) == [(0, 0), (0, 1)]
        assert cells((7, 7, 9, 9)) == []

    def test_of_no_lines_nothing(self):
        assert not bitmap.rasterise_lines(lines(), FIVE).any()

    @given(st.lists(st.floats(0, 20), min_size=4, max_size=4))
    def test_lines_have_no_gaps(self, ends):
        grid = bitmap.Grid(np.zeros(2), 0.7, (29, 29))
        _, cell = bitmap.trace_cells(lines(*ends), grid)
        place = np.column_stack(np.divmod(cell, 29))
        assert np.abs(np.diff(place, axis=0)).max(initial=0) <= 1
        sampled = lines(*ends)[0, 0] + np.linspace(0, 1, 500)[:, None] * (
            lines(*ends)[0, 1] - lines(*ends)[0, 0]
        )
        middle = (place[:, ::-1] + 0.5) * 0.7
        assert np.abs(sampled[:, None] - middle).max(axis=2).min(axis=1).max() <= 0.35 + 1e-6


class TestGrid:
    def test_it_holds_all_lines_on_whole_cells(self):
        grid = bitmap.fit_grid(lines((0.12, -0.3, 1.02, 0.4)), 0.1)
        np.testing.assert_allclose(grid.low_m, (0.1, -0.3))
        assert grid.shape == (7, 10)

    def test_different_extents_share_a_grid(self):
        truth, result = lines((0, 0.5, 2, 0.5)), lines((1, 0.5, 4, 0.5))
        grid = bitmap.fit_grid(np.concatenate([truth, result]), 1.0)
        errors = bitmap.subtract_bitmaps(
            bitmap.rasterise_lines(result, grid), bitmap.rasterise_lines(truth, grid)
        )
        assert errors.tolist() == [[-1, 0, 1, 1]]

    def test_of_nothing_it_is_one_cell(self):
        assert bitmap.fit_grid(lines(), 0.1).shape == (1, 1)

    def test_too_many_cells_are_refused(self):
        with pytest.raises(
            StageError, match=r"10000 m x 500 m.* evaluation.bitmap_cell_m \(0.05 m\) larger"
        ):
            bitmap.fit_grid(lines((0, 0, 1e4, 500)), 0.05)
        with pytest.raises(StageError, match="bitmap_cell_m"):
            bitmap.fit_grid(lines((0, 0, 1e30, 1e30)), 0.05)
        with pytest.raises(ValueError, match="above 0"):
            bitmap.fit_grid(lines(), 0)
