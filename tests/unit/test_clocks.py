from datetime import UTC, datetime

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.refusals import assert_told
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


POSES = np.arange(0, 10 * S, S // 10)
UPTIME = 734 * S


def offset_of(cloud_t_ns, cloud_receive_ns, pose_receive_ns=POSES + S // 50, recording=None):
    recording = np.zeros(len(cloud_t_ns), int) if recording is None else recording
    return clocks.find_clock_offset(POSES, pose_receive_ns, cloud_t_ns, cloud_receive_ns, recording)


def test_uptime_becomes_the_time_of_poses_by_when_both_were_received():
    seen = np.arange(S, 9 * S, S)
    late = S // 50 + np.array([0, 0, 0, 0, 1, -1, 2, -1]) * S // 1000
    found = offset_of(seen + UPTIME, seen + late)
    assert found.offset_ns.tolist() == [-UPTIME] * 8
    assert abs(found.spread_ns - 1_300_000) < 1000  # at 6.3 of 7 between those of 1 and 2 ms


def test_a_sensor_that_was_switched_on_anew_has_another_offset_in_each_recording():
    seen = np.arange(S, 9 * S, S)
    second = seen > 4 * S
    found = offset_of(
        np.where(second, seen - 4 * S, seen + UPTIME), seen + S // 50, recording=second.astype(int)
    )
    assert found.offset_ns.tolist() == [-UPTIME] * 4 + [4 * S] * 4
    assert found.spread_ns == 0


@pytest.mark.parametrize("late_s", [0, 2, 7, 3600])
def test_poses_that_were_computed_later_keep_their_stamps(late_s):
    seen = np.arange(0, 10 * S, S)
    assert offset_of(seen, seen + S // 50, POSES + late_s * S) is None


def test_where_receipt_is_the_stamp_there_is_no_offset():
    seen = np.arange(S, 9 * S, S)
    assert offset_of(seen + UPTIME, seen + UPTIME, POSES) is None


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


def stamp_ns(said):
    return int(datetime.fromisoformat(said).replace(tzinfo=UTC).timestamp()) * S


@pytest.mark.parametrize(
    "said",
    [
        "1970-01-01T00:07:12",  # since a sensor or a simulation was switched on
        "1979-12-31T23:59:59",
        "2000-01-01T00:20:00",  # a computer without a battery
        "2024-01-01T00:00:00",
        "2001-09-09T01:46:40",  # 1,000,000,000 s, added to a log that counts from 0
        "2020-09-13T12:40:00",  # 1,600,000,000 s and 800 s
    ],
)
def test_where_clocks_begin_that_nobody_set_is_no_date(said):
    assert clocks.read_date(stamp_ns(said)) is None
    assert clocks.state_date(stamp_ns(said)) == "not known, clock not set"


@pytest.mark.parametrize(
    "said",
    ["1999-06-11T08:00:00", "2000-01-01T01:00:00", "2001-09-09T02:46:40", "2019-04-01T08:31:00"],
)
def test_any_other_stamp_is_a_date(said):
    assert clocks.read_date(stamp_ns(said)) == datetime.fromisoformat(said).replace(tzinfo=UTC)
    assert clocks.state_date(stamp_ns(said)) == said[:10]


@given(st.integers(0, 4_000_000_000))
def test_of_a_year_at_most_some_hours_are_no_date(t_s):
    # one may be in the first hour of a year, one in that of a hundred million seconds
    hours = [clocks.read_date((max(t_s, 400_000_000) + 3600 * n) * S) for n in range(4)]
    assert any(hours)


def test_a_survey_ends_with_its_last_stamp_and_nowhere_where_its_clock_was_not_set():
    begin_ns = stamp_ns("2026-03-01T09:30:00")
    stamps = begin_ns + np.array([5, 0, 7], np.int64) * S
    assert clocks.end_of_survey_ns(stamps) == begin_ns + 7 * S
    begin_ns = stamp_ns("2024-01-01T00:00:10")
    assert clocks.end_of_survey_ns(begin_ns + np.array([0, 9000], np.int64) * S) == 0
    assert clocks.end_of_survey_ns(np.zeros(0, np.int64)) == 0


def test_of_several_gaps_the_widest_is_named():
    day_ns = 86_400 * 10**9
    assert clocks.describe_gaps([("a", 0), ("b", day_ns)]) == []
    (said,) = clocks.describe_gaps([("a", 0), ("b", 2 * day_ns), ("c", 5 * day_ns)])
    assert_told(said, value=("3.0 days", "1 more"))
