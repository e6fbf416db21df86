"""The bitmap metric: the thesis's shares, literally, and whatever the grid's beginning."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference import bitmap as reference
from scanplan.geometry import bitmap
from scanplan.lab.evaluation import bitmap_shares

CELL_M = 0.05
FACE = np.array([[(0.0, 1.0), (4.0, 1.0)]])
NAMES = ("false negative", "correct match", "false positive")


def measured(lines_m, faces_m, cell_m=CELL_M):
    """Shares of the literal grid, and their means over the grids that begin elsewhere."""
    bitmaps = bitmap_shares.trace_truth(faces_m, lines_m, cell_m)
    rank = np.ones(len(lines_m), int)
    of_grids = [
        bitmap_shares.measure_shares(bitmap_shares.match_cells(lines_m, truth), rank, [1])[0]
        for truth in bitmaps
    ]
    return of_grids[0], np.mean(of_grids[1:], axis=0), bitmaps


def moved(lines_m, x_m, y_m):
    return lines_m + np.array([x_m, y_m])


def wrong_per_true(lines_m, faces_m):
    """Cells that are wrong per cell of the truth, by the mean over the grids' beginnings."""
    _, shares, bitmaps = measured(lines_m, faces_m)
    n_true = np.mean([len(truth.cells) for truth in bitmaps[1:]])
    rows, columns = bitmaps[1].grid.shape
    return (shares[0] + shares[2]) * rows * columns / n_true


class TestPaper:
    """Truth: the second row and the last column of 5 x 5.

    Result: the second row but its last two, and two of the first.
    """

    TRUTH = np.array([(0, 1.5, 5, 1.5), (4.5, 0, 4.5, 5)]).reshape(-1, 2, 2)
    RESULT = np.array([(0, 1.5, 3, 1.5), (0, 0.5, 2, 0.5)]).reshape(-1, 2, 2)

    def test_as_worked_out_on_paper(self):
        # 9 true cells, 3 of them found, 2 invented: 6 missed, 17 right
        literal, _, _ = measured(self.RESULT, self.TRUTH, 1.0)
        np.testing.assert_allclose(literal, (6 / 25, 17 / 25, 2 / 25))

    def test_perfect_empty_and_invented(self):
        empty = np.empty((0, 2, 2))
        for shares in measured(self.TRUTH, self.TRUTH, 1.0)[:2]:
            np.testing.assert_array_equal(shares, (0, 1, 0))
        np.testing.assert_allclose(measured(empty, self.TRUTH, 1.0)[0], (9 / 25, 16 / 25, 0))
        np.testing.assert_allclose(measured(self.TRUTH, empty, 1.0)[0], (0, 16 / 25, 9 / 25))

    def test_each_number_of_lines_by_itself(self):
        (truth, *_) = bitmap_shares.trace_truth(self.TRUTH, self.RESULT, 1.0)
        drawn = bitmap_shares.match_cells(self.RESULT, truth)
        found = bitmap_shares.measure_shares(drawn, np.array([2, 1]), [0, 1, 2])
        np.testing.assert_allclose(found * 25, [(9, 16, 0), (9, 14, 2), (6, 17, 2)])


coordinates = st.floats(0.3, 4.7)
ends = st.lists(st.tuples(*[coordinates] * 4), min_size=1, max_size=3)


@given(ends, ends)
def test_every_grid_gives_the_thesiss_shares_literally(result, truth):
    lines_m, faces_m = (np.array(x, float).reshape(-1, 2, 2) for x in (result, truth))
    literal, mean, bitmaps = measured(lines_m, faces_m, 1.0)
    of_reference = []
    for true_bitmap in bitmaps:
        grid = true_bitmap.grid
        maps = [
            bitmap.rasterise_lines(part, grid).astype(int).tolist() for part in (lines_m, faces_m)
        ]
        of_reference.append(reference.shares(*maps))
    assert literal == pytest.approx(of_reference[0])
    assert mean == pytest.approx(np.mean(of_reference[1:], axis=0))
    assert sum(mean) == pytest.approx(1)


def test_cells_are_those_that_many_points_of_a_line_lie_in():
    line = (0.31, 0.42, 4.12, 2.93)
    grid = bitmap.Grid(np.zeros(2), 0.5, (8, 10))
    found = bitmap.rasterise_lines(np.array(line).reshape(1, 2, 2), grid)
    assert found.astype(int).tolist() == reference.rasterise([line], (0, 0), 0.5, (8, 10))


def test_a_millimetre_of_noise_beside_a_face_on_a_cells_edge_is_no_error():
    # twenty stretches of a face on the edge of two cells, each a millimetre to one side of it
    starts = np.linspace(0, 3.8, 20)
    noise_m = np.where(np.arange(20) % 2, 0.001, -0.001)
    lines_m = np.array(
        [[(x, 1 + n), (x + 0.2, 1 + n)] for x, n in zip(starts, noise_m, strict=True)]
    )
    literal, _, bitmaps = measured(lines_m, FACE)
    rows, columns = bitmaps[0].grid.shape
    # half of the face's 80 cells are missed and about as many invented, though all of it is found
    assert literal[0] * rows * columns >= 0.4 * 80 and literal[2] * rows * columns >= 0.4 * 80
    assert wrong_per_true(lines_m, FACE) <= 2 / bitmap_shares.N_PHASES


@given(st.floats(0, 3), st.floats(0, 3))
def test_it_does_not_depend_on_where_building_and_walls_lie(x_m, y_m):
    lines_m = moved(FACE, 0.3, 0.012)
    here = wrong_per_true(lines_m, FACE)
    there = wrong_per_true(moved(lines_m, x_m, y_m), moved(FACE, x_m, y_m))
    assert there == pytest.approx(here, abs=2.5 / bitmap_shares.N_PHASES)


@pytest.mark.parametrize("off_m", [0.0, 0.005, 0.0125, 0.025, 0.04])
def test_a_wall_beside_its_face_is_wrong_by_that_part_of_a_cell(off_m):
    found = wrong_per_true(moved(FACE, 0, off_m), FACE)
    # missed and invented, each
    assert found / 2 == pytest.approx(off_m / CELL_M, abs=1 / bitmap_shares.N_PHASES)


@pytest.mark.parametrize("off_m", [0.05, 0.07, 0.1, 0.5])
def test_a_wall_a_cell_off_is_wrong_altogether(off_m):
    assert wrong_per_true(moved(FACE, 0, off_m), FACE) == pytest.approx(2, abs=0.01)


@given(st.integers(1, 60), st.integers(1, 60))
def test_shifted_grids_meet_every_part_of_a_cell_once(rows, columns):
    grid = bitmap.Grid(np.array([0.3, -2.0]), CELL_M, (rows, columns))
    shifted = bitmap_shares.shift_grid(grid)
    parts = np.array([(grid.low_m - other.low_m) / CELL_M for other in shifted])
    middles = (np.arange(bitmap_shares.N_PHASES) + 0.5) / bitmap_shares.N_PHASES
    for axis in (0, 1):
        np.testing.assert_allclose(np.sort(parts[:, axis]), middles)
    for other in shifted:
        high_m = other.low_m + np.array(other.shape[::-1]) * CELL_M
        assert (other.low_m < grid.low_m).all()
        assert (high_m > grid.low_m + np.array((columns, rows)) * CELL_M).all()
