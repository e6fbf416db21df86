import numpy as np
import pytest

from scanplan.recordings import clocks

S = 10**9


def test_oddities_of_a_regular_topic_are_none():
    t_ns = np.arange(20) * S // 10
    assert not any(clocks.count_stamp_faults(t_ns, t_ns + 5_000_000).values())


def test_oddities_are_counted():
    t_ns = np.array([0, 1, 1, 3, 2, 5, 3605, 3606]) * S
    found = clocks.count_stamp_faults(t_ns, np.arange(8) * S)
    assert list(found.values()) == [1, 1, 3]  # 3 -> 2 and 2 -> 5 against one second each, 5 -> 3605


def test_a_pause_of_the_recorder_is_no_jump():
    t_ns = np.array([0, 1, 3600, 3601]) * S
    assert not any(clocks.count_stamp_faults(t_ns, t_ns).values())


CLOUDS = np.arange(10) * S, np.arange(10) * S + S // 20


@pytest.mark.parametrize(
    ("ahead_s", "cloud_ahead_s", "expected_s"),
    [
        (0.1, -0.05, 0.1),
        (1.0, -0.05, 1.0),
        (-0.03, -0.05, 0),
        (0.01, -0.2, 0),
        (0.6, 0.5, 0.1),
        (0.5, 0.5, 0),
        (9, 0, 0),
    ],
)
def test_how_far_stamps_are_ahead(ahead_s, cloud_ahead_s, expected_s):
    receive = np.arange(30) * S
    clouds = CLOUDS[1] + round(cloud_ahead_s * S), CLOUDS[1]
    found = clocks.estimate_ahead_ns(receive + round(ahead_s * S), receive, *clouds)
    assert found == round(expected_s * S)


def twice(*t_s):
    return clocks.find_repeated_times((np.array(t_s) * S).astype(np.int64)).tolist()


def test_a_clock_that_is_set_back_tells_a_time_twice():
    assert twice(0, 1, 2, 3, 4, 2.5, 3.5, 3.9, 4.5, 5) == [
        False,
        False,
        False,
        True,
        True,
        True,
        True,
        True,
        False,
        False,
    ]


@pytest.mark.parametrize(
    "t_s",
    [(0, 1, 2, 3, 4), (0, 1, 3, 2.7, 4, 5), (10, 11, 0, 12, 13, 14), (0, 1, 2, 2, 2, 3), (5,), ()],
)
def test_late_and_latched_messages_are_no_clock_set_back(t_s):
    assert not any(twice(*t_s))
