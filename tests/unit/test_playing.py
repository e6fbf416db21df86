"""Choice while a recording plays, on scans of a few cells: who is taken is worked out on paper."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scanplan.selection.playing import PlayingSelection


def showing(*cells, length_m=1.0):
    """A scan that shows some cells of one wall."""
    n = len(cells)
    nothing = np.zeros(n, int)
    return {"facing": nothing, "along": np.array(cells, int), "across": nothing,
            "length_m": np.full(n, length_m)}  # fmt: skip


def test_a_scan_is_taken_for_the_share_that_is_new():
    playing = PlayingSelection(min_new_share=0.5, max_cells=10)
    assert playing.take(showing(0, 1, 2, 3))
    # a quarter of it is new, then half
    assert not playing.take(showing(1, 2, 3, 4))
    assert playing.take(showing(2, 3, 4, 5))
    assert playing.most_held == 6


def test_what_is_shown_better_is_new_by_as_much_as_it_is_better():
    playing = PlayingSelection(min_new_share=0.5, max_cells=10)
    assert playing.take(showing(0, 1, length_m=0.4))
    assert not playing.take(showing(0, 1, length_m=0.7))
    assert playing.take(showing(0, 1, length_m=0.8))


def test_a_scan_that_shows_nothing_is_left():
    assert not PlayingSelection(min_new_share=0.1, max_cells=1).take(showing())


def test_what_was_not_shown_for_longest_is_forgotten():
    playing = PlayingSelection(min_new_share=0.5, max_cells=2)
    assert playing.take(showing(0)) and playing.take(showing(1))
    # shown again, though not taken: 1 is now the one not shown for longest
    assert not playing.take(showing(0))
    assert playing.take(showing(2))
    assert not playing.take(showing(0)) and playing.take(showing(1))


@settings(max_examples=50, deadline=None)
@given(st.lists(st.sets(st.integers(0, 9)), max_size=12), st.integers(1, 8))
def test_memory_is_bounded(scans, max_cells):
    playing = PlayingSelection(min_new_share=0.2, max_cells=max_cells)
    for cells in scans:
        playing.take(showing(*sorted(cells)))
    assert playing.most_held <= max_cells


@pytest.mark.parametrize(
    "wrong", [{"min_new_share": 0.0}, {"min_new_share": 1.5}, {"max_cells": 0}]
)
def test_limits_out_of_range_are_refused(wrong):
    with pytest.raises(ValueError, match="must be"):
        PlayingSelection(**{"min_new_share": 0.3, "max_cells": 5, **wrong})
