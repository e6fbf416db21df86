"""Surrogates of the walls found, on scans whose ratios are worked out on paper."""

import numpy as np
import pandas as pd
import pytest

from scanplan.selection.objectives import CellCoverage
from thesis import surrogates
from thesis.figures import more_figures


def test_what_two_scans_share_counts_twice_singly():
    # scan 0 shows cell 0, scans 1 and 2 cell 1 alike: singly 1 + 1, together 1
    cover = CellCoverage(np.array([0, 1, 2]), np.array([0, 1, 1]), np.ones(3), 3)
    value, ratio = surrogates._measure_draw(cover, np.array([0]), np.array([1, 2]))
    assert value == 1 and ratio == pytest.approx(2.0)


def test_without_anything_to_add_there_is_no_ratio():
    cover = CellCoverage(np.array([0, 1]), np.array([0, 0]), np.ones(2), 2)
    assert np.isnan(surrogates._measure_draw(cover, np.array([0]), np.array([1]))[1])


def test_ranks_are_compared_within_a_seed():
    """Two seeds of other sizes, each in perfect order: together they would not be."""
    seed = pd.DataFrame({"surrogate": "area", "value": [1.0, 2, 3], "found": [0.7, 0.8, 0.9]})
    other = seed.assign(value=[11.0, 12, 13], found=[0.1, 0.2, 0.3])
    table = pd.concat([seed, other], keys=[0, 1], names=["seed", None])
    assert more_figures.rank_correlations(table)["area"] == pytest.approx(1.0)
