import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.validation.clustered_shares import average_shares, estimate_shares, number_places


def one_group(place, is_good):
    place, is_good = np.array(place), np.array(is_good, bool)
    return estimate_shares(np.zeros_like(place), place, is_good, 1)


def wilson(share, n, z=1.959964):
    middle = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2)) / (1 + z**2 / n)
    return middle - half, middle + half


def test_places_that_agree_to_the_ray_count_one_ray_each():
    found = one_group([0] * 50 + [1] * 50 + [2] * 50, [True] * 150)
    assert (found.share[0], found.n_places[0]) == (1.0, 3)
    np.testing.assert_allclose((found.low[0], found.high[0]), wilson(1.0, 3), atol=1e-6)


def test_places_that_differ_widen_the_interval():
    # 10 of 10, and 0 of 10: two places tell hardly anything
    found = one_group([0] * 10 + [1] * 10, [True] * 10 + [False] * 10)
    # variance 2 / (2 - 1) * (5**2 + 5**2) / 20**2 = 0.25: a single ray's; Student's t is 12.7062
    effective = 1 * (1.959964 / 12.7062) ** 2
    np.testing.assert_allclose((found.low[0], found.high[0]), wilson(0.5, effective), atol=1e-5)
    assert found.share[0] == 0.5


def test_a_single_place_or_none_tells_no_share():
    found = estimate_shares(np.zeros(4, int), np.zeros(4, int), np.ones(4, bool), 2)
    assert found.n_places.tolist() == [1, 0]
    for values in (found.share, found.low, found.high):
        assert np.isnan(values).all()


def test_intervals_hold_what_they_say_of_places_that_differ():
    """Of 95 % intervals of shares that differ from place to place about 95 of 100 hold theirs."""
    random = np.random.default_rng(1)
    held = 0
    for _ in range(400):
        of_place = random.beta(6, 2, 40)
        place = np.repeat(np.arange(40), 100)
        found = one_group(place, random.random(4000) < of_place[place])
        held += found.low[0] <= 0.75 <= found.high[0]
    assert 0.92 <= held / 400 <= 0.98


@given(
    st.lists(
        st.tuples(st.integers(0, 3), st.integers(0, 4), st.booleans()), min_size=1, max_size=60
    )
)
def test_groups_are_what_each_is_alone(rows):
    group, place, is_good = (np.array(column) for column in zip(*rows, strict=True))
    found = estimate_shares(group, place, is_good, 4)
    for number in set(group.tolist()):
        alone = one_group(place[group == number], is_good[group == number])
        for name in ("n_places", "share", "low", "high"):
            np.testing.assert_allclose(getattr(found, name)[number], getattr(alone, name)[0])
        if alone.n_places[0] > 1:
            assert 0 <= alone.low[0] <= alone.share[0] <= alone.high[0] <= 1


def test_a_mean_weighs_groups_by_what_they_stand_for():
    # 3 m that all rays of both places agree with, 1 m that half of each place's do; 6 m seen once
    group = np.repeat([0, 0, 1, 1, 2], 4)
    place = np.repeat([0, 1, 0, 1, 0], 4)
    is_good = np.array([True] * 8 + [True, True, False, False] * 2 + [False] * 4)
    found = average_shares(group, place, is_good, np.array([3.0, 1.0, 6.0]))
    assert (found.share[0], found.n_places[0]) == (3.5 / 4, 2)
    # no place differs from the mean in any group: each counts as one ray
    np.testing.assert_allclose((found.low[0], found.high[0]), wilson(3.5 / 4, 2), atol=1e-6)


def test_a_mean_of_what_no_two_places_saw_is_unknown():
    found = average_shares(np.zeros(3, int), np.zeros(3, int), np.ones(3, bool), np.ones(1))
    assert np.isnan([found.share[0], found.low[0], found.high[0]]).all()


@given(st.lists(st.tuples(st.integers(0, 4), st.booleans()), min_size=1, max_size=60))
def test_the_mean_of_one_group_is_its_share(rows):
    place, is_good = (np.array(column) for column in zip(*rows, strict=True))
    group = np.zeros_like(place)
    alone, mean = one_group(place, is_good), average_shares(group, place, is_good, np.full(1, 2.0))
    for name in ("share", "low", "high"):
        np.testing.assert_allclose(getattr(mean, name), getattr(alone, name))


@pytest.mark.parametrize("start", [0.0, 0.97, -3.3])
def test_scans_of_one_spot_are_of_one_place(start):
    sensors_m = start + np.array([[0.0, 0.0], [0.1, 0.0], [0.05, 0.2], [5.0, 0.0]])
    assert number_places(sensors_m, 1.0).tolist() == [0, 0, 0, 1]
    assert len(number_places(np.empty((0, 2)), 1.0)) == 0
