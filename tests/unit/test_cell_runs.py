"""Runs of cells are what was chosen, none longer, none side by side."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from scanplan.geometry.cell_runs import find_cell_runs


@given(arrays.arrays(bool, st.tuples(st.integers(0, 4), st.integers(0, 9))))
def test_they_cover_what_is_chosen_and_are_apart(chosen):
    rows, begins, ends = find_cell_runs(chosen)
    again = np.zeros(chosen.shape, bool)
    for row, begin, end in zip(rows, begins, ends, strict=True):
        assert begin < end
        again[row, begin:end] = True
    assert (again == chosen).all()
    is_next = np.diff(rows) == 0
    assert (begins[1:] > ends[:-1])[is_next].all() and (np.diff(rows) >= 0).all()
