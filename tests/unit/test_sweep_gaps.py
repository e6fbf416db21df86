"""Sweeps with one ray a fifth of a degree, less what is left out of them."""

import numpy as np
import pytest

from scanplan.rays.sweep_gaps import find_sweep_gaps

DEG = np.arange(-180, 180, 0.2)


def sweep(*left_out):
    """Return the azimuths of rays but those between pairs of degrees."""
    kept = np.ones(len(DEG), bool)
    for low, high in left_out:
        kept &= (low + 0.1 > DEG) | (high - 0.1 < DEG)
    return np.radians(DEG[kept])


def test_a_whole_turn_has_none():
    assert find_sweep_gaps(sweep()).shape == (0, 2)


@pytest.mark.parametrize("begin_deg", [-120, 0, 176.4])
def test_a_gap_is_found_where_it_is(begin_deg):
    found = find_sweep_gaps(sweep((begin_deg, begin_deg + 3)))
    np.testing.assert_allclose(np.degrees(found), [[begin_deg, 3]], atol=1e-6)


def test_a_gap_across_the_ends_is_one():
    found = find_sweep_gaps(sweep((-180.2, -178), (177, 180)))
    np.testing.assert_allclose(np.degrees(found), [[177, 5]], atol=1e-6)


def test_wide_ones_and_such_as_all_steps_are_none():
    assert len(find_sweep_gaps(sweep((20, 40)))) == 0
    # three rays a turn, and those of a scanner with few of them
    assert len(find_sweep_gaps(np.radians(np.arange(-180.0, 180, 2)))) == 0


@pytest.mark.parametrize("count", [0, 1])
def test_of_hardly_any_rays_nothing_is_known(count):
    assert find_sweep_gaps(np.zeros(count)).shape == (0, 2)
