from unittest import mock

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

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


@given(
    st.integers(1, 40), st.integers(1, 40), st.sampled_from([0.5, 0.9, 1.0]), st.integers(0, 2**31)
)
def test_distances_to_the_outline_are_scipys_to_the_bit(rows, columns, share, seed):
    inside = np.random.default_rng(seed).random((rows, columns)) < share
    inside[0, 0] = False
    expected = np.asarray(ndimage.distance_transform_edt(inside))
    # of single tiles what is nearest may lie far beyond
    with mock.patch.object(bitmap, "_TILE", 8):
        np.testing.assert_array_equal(bitmap.distances_to_outline(inside), expected)
    np.testing.assert_array_equal(bitmap.distances_of_inner(inside), expected[inside])


@pytest.mark.parametrize(
    "bounds", [(-2, 1, 3, 4), (3, -2, 9, 2), (2, 2, 9, 9), (-9, -9, 9, 9), (7, 1, 9, 4)]
)
def test_of_a_polygon_what_lies_beyond_the_grid_is_left_out(bounds):
    x0, y0, x1, y1 = np.clip(bounds, 0, 5)
    expected = np.zeros((5, 5), bool)
    expected[y0:y1, x0:x1] = True
    assert (bitmap.fill_polygons([shapely.box(*bounds)], FIVE) == expected).all()
