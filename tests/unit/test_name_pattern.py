"""One pattern for many names."""

import re
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.project.name_pattern import match_names

NAMES = st.text(alphabet="ab.-_(|", max_size=5)


def test_what_names_share_is_written_once():
    assert match_names(["floor_1", "floor_2", "floor_21"]) == "floor_(?:1|2(?:1)?)"


@given(st.sets(NAMES), NAMES)
def test_just_the_names_match(names, other):
    pattern = re.compile(match_names(names))
    assert all(pattern.fullmatch(name) for name in names)
    assert bool(pattern.fullmatch(other)) == (other in names)


@given(st.sets(NAMES.filter(bool), min_size=1), NAMES)
def test_the_whole_name_before_a_slash_matches(names, other):
    found = re.match(f"results/(?P<dataset>{match_names(names)})/plan", f"results/{other}/plan")
    assert (found.group("dataset") if found else None) == (other if other in names else None)


def test_no_name_matches_nothing():
    assert not re.match(match_names([]), "")


def seconds_of_matching(pattern, name):
    best = float("inf")
    for _ in range(5):
        start = time.process_time()
        for _ in range(2000):
            pattern.fullmatch(name)
        best = min(best, time.process_time() - start)
    return best


@pytest.mark.parametrize("name", ["f09999", "f05000"])
def test_a_thousand_times_as_many_names_do_not_take_longer(name):
    few, many = ([f"f{number:05d}" for number in range(n)] for n in (10, 10_000))
    of_few = seconds_of_matching(re.compile(match_names([*few, name])), name)
    assert seconds_of_matching(re.compile(match_names(many)), name) < 10 * of_few
