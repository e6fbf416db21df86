"""A stage that takes much longer than expected says what it is at."""

import re
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.default_settings import SETTINGS
from helpers.refusals import assert_told
from scanplan.geometry import tour
from scanplan.stage import overtime


class SlowPlaces:
    """Distances between two places that take their time."""

    least_m = np.zeros((2, 2))

    def __getitem__(self, pair):
        time.sleep(1.3)
        return 1.0


def tell(expected_s, work, stage="plan_next_visit"):
    told = []
    with overtime.tell_overtime(stage, expected_s, told.append):
        work()
    return told


def test_it_names_the_step_its_seconds_and_what_lowers_it():
    (line,) = tell(0.2, lambda: tour.shortest_tour(SlowPlaces(), closed=False, first=0))
    assert re.match(r"plan_next_visit: takes long: 2 s, 1\d times as long as expected", line)
    # the innermost public helper of the package
    assert re.search(r"at '(shortest tour|tour length)' for \d s", line)
    assert_told(line, key=("advanced.plan.next_visit.spacing_m", "--cores"))


def test_it_is_told_again_at_twice_the_time():
    told = tell(0.05, lambda: time.sleep(1.8), "no_stage")
    assert len(told) == 2
    assert all("at 'its own script'" in line and "less with more --cores" in line for line in told)


@pytest.mark.parametrize("expected_s", [np.nan, 9.0])
def test_nothing_is_told_in_time_or_where_no_time_is_expected(expected_s):
    assert tell(expected_s, lambda: time.sleep(0.1)) == []


def test_a_hundredth_of_what_the_rule_asks_for_is_expected(monkeypatch):
    assert np.isnan(overtime.expected_s())
    job = SimpleNamespace(resources=SimpleNamespace(runtime=20))
    monkeypatch.setattr(sys.modules["__main__"], "snakemake", job, raising=False)
    assert overtime.expected_s() == pytest.approx(12.0)
    job.resources.runtime = "20m"
    assert np.isnan(overtime.expected_s())


def test_what_lowers_it_are_settings_that_there_are():
    for change in overtime.LOWERED_BY.values():
        for key in re.findall(r"[\w.]+\.\w+", change):
            section = SETTINGS
            for name in key.split("."):
                section = section[name]
