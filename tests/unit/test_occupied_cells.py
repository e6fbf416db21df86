import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.geometry import occupied_cells


@given(st.lists(st.integers(0, 40), min_size=1, max_size=60), st.booleans())
def test_cells_are_numbered_in_their_order(keys, by_table):
    key = np.array(keys)
    size = 41 if by_table else occupied_cells.TABLE_SIZE + 1
    occupied, of_point = occupied_cells.number_occupied(key, size)
    assert occupied.tolist() == sorted(set(keys))
    np.testing.assert_array_equal(occupied[of_point], key)


@pytest.mark.parametrize("size", [5, occupied_cells.TABLE_SIZE + 1])
def test_no_points_are_in_no_cell(size):
    occupied, of_point = occupied_cells.number_occupied(np.zeros(0, np.int64), size)
    assert len(occupied) == len(of_point) == 0
