"""Recordings that are joined: whether any scan of one shows what another has seen."""

from types import SimpleNamespace

import numpy as np
import pytest

from scanplan.registration import pauses

IDS = np.arange(10, 20)


def measured(ties, pauses_s, weight=1.0):
    step_s = np.ones(9)
    for row, pause_s in pauses_s.items():
        step_s[row] = pause_s
    t_ns = (np.concatenate([[0], np.cumsum(step_s)]) * 1e9).astype(np.int64)
    edges = [SimpleNamespace(source=a, target=b) for a, b in ties]
    optimised = SimpleNamespace(edges=edges, weight=np.full(len(edges), weight))
    return pauses.measure_untied(IDS, t_ns, optimised)


CHAIN = [(row + 1, row) for row in range(10, 19) if row != 14]


@pytest.mark.parametrize(
    ("ties", "pauses_s", "n_found"),
    [
        (CHAIN, {4: 60.0}, 1),
        # a link over the pause, whichever end comes first
        ([*CHAIN, (11, 17)], {4: 60.0}, 0),
        ([*CHAIN, (17, 11)], {4: 60.0}, 0),
        # without a pause the sensor's way ties them
        (CHAIN, {4: 5.0}, 0),
        # two scans before it displace next to nothing
        (CHAIN, {1: 60.0}, 0),
        ([], {3: 60.0, 6: 90.0}, 2),
    ],
)
def test_a_pause_over_which_nothing_is_aligned_is_told(ties, pauses_s, n_found):
    found = measured(ties, pauses_s)
    assert found.value == n_found and found.is_beyond == (n_found > 0)


def test_the_longest_pause_is_named_and_outliers_tie_nothing():
    found = measured([(17, 11)], {3: 60.0, 6: 90.0}, weight=0.0)
    assert found.value == 2
    assert (found.more["pause_s"], found.more["after_s"]) == (90.0, 3 + 60.0 + 2)
