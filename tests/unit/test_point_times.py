import numpy as np
import pytest

from scanplan.recordings.motion import point_times
from scanplan.recordings.motion.point_times import TimeConvention

T_NS = 1_700_000_000_250_000_000
# a sweep of 0.1 s, at 0, 0.05 and 0.1 s
SWEEP = np.array([0.0, 0.05, 0.1])


def of(raw):
    return point_times.find_time_convention([(np.asarray(raw), T_NS)])


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        ((SWEEP * 1e9).astype(np.uint32), ("ns", "stamp")),
        ((SWEEP * 1e6).astype(np.uint32), ("us", "stamp")),
        ((SWEEP * 1e6).astype(np.float32), ("us", "stamp")),
        ((SWEEP * 1e3).astype(np.float32), ("ms", "stamp")),
        (SWEEP.astype(np.float32), ("s", "stamp")),
        ((SWEEP * 1e9 + T_NS).astype(np.uint64), ("ns", "epoch")),
        (SWEEP * 1e9 + T_NS, ("ns", "epoch")),
        (SWEEP * 1e6 + T_NS / 1e3, ("us", "epoch")),
        (SWEEP + T_NS / 1e9, ("s", "epoch")),
        (SWEEP + 5432.1, ("s", "earliest")),
        ((SWEEP * 1e9 + 4e9).astype(np.uint32), ("ns", "earliest")),
    ],
)
def test_every_convention_gives_the_same_times(raw, expected):
    found = of(raw)
    assert (found.unit, found.zero) == expected
    np.testing.assert_allclose(found.seconds(raw, T_NS), SWEEP, atol=1e-6)


def test_times_before_the_stamp():
    raw = (SWEEP - 0.1).astype(np.float32)
    np.testing.assert_allclose(of(raw).seconds(raw, T_NS), SWEEP - 0.1, atol=1e-6)
    raw = (-SWEEP * 1e9).astype(np.int32)
    np.testing.assert_allclose(of(raw).seconds(raw, T_NS), -SWEEP, atol=1e-6)


@pytest.mark.parametrize(
    "raw",
    [
        [0.0, 0.0, 0.0],
        [0.0, 0.7, 0.5],  # too long in s, too short in ms
        [np.nan, np.nan],
        [],
        np.full(3, T_NS / 1e9, np.float32),
    ],
)
def test_what_is_no_sweep_in_any_unit(raw):
    assert of(raw) is None


def test_the_fullest_of_the_first_scans_decide():
    few = (np.array([0, 0.0004]) * 1e9).astype(np.uint32)  # 0.4 ms in ns, 0.4 s in us
    full = (np.linspace(0, 0.1, 50) * 1e9).astype(np.uint32)
    assert point_times.find_time_convention(
        [(few, T_NS), (None, T_NS), (full, T_NS)]
    ) == TimeConvention("ns", "stamp")


@pytest.mark.parametrize(("unit", "per_s"), [("s", 1), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_bad_times_of_some_points_do_not_decide(unit, per_s):
    good = np.linspace(0, 0.1, 1000)
    one, many = good.copy(), good + 7.0
    one[500] = 70.0
    many[::50] = 0
    assert point_times.find_time_convention(
        [(good * per_s, T_NS), (one * per_s, T_NS)]
    ) == TimeConvention(unit, "stamp")
    found = point_times.find_time_convention([(many * per_s, T_NS)])
    assert found == TimeConvention(unit, "earliest")
    np.testing.assert_allclose(
        found.seconds(many * per_s, T_NS)[1:50], good[1:50] - good[1], atol=1e-6
    )
    whole = np.round(many * 1e9).astype(np.int64)
    np.testing.assert_allclose(
        TimeConvention("ns", "earliest").seconds(whole, T_NS)[1:50], good[1:50] - good[1], atol=1e-6
    )


def test_scans_that_disagree_give_none():
    good = np.linspace(0, 0.1, 1000)
    assert point_times.find_time_convention(
        [(good, T_NS)] * 4 + [(good * 1e3, T_NS)]
    ) == TimeConvention("s", "stamp")
    assert point_times.find_time_convention([(good, T_NS)] * 3 + [(good * 1e3, T_NS)] * 2) is None


def test_units_can_be_limited():
    assert point_times.find_time_convention([(np.array([0, 30.0]), T_NS)], units=("s",)) is None
    assert point_times.find_time_convention([]) is None


def test_unknown_times_stay_unknown_and_the_earliest_of_the_others_counts():
    seconds = TimeConvention("s", "earliest").seconds(np.array([np.nan, 7.3, 7.2, np.inf]), T_NS)
    np.testing.assert_allclose(seconds, [np.nan, 0.1, 0, np.nan], atol=1e-9)
    assert np.isnan(TimeConvention("s", "earliest").seconds(np.array([np.nan]), T_NS)).all()


@pytest.mark.parametrize("zero", ["stamp", "epoch", "earliest"])
@pytest.mark.parametrize("dtype", [np.uint32, np.float32])
def test_no_times_of_no_points(zero, dtype):
    assert TimeConvention("ns", zero).seconds(np.empty(0, dtype), T_NS).shape == (0,)


def test_a_sweep_is_short_and_near_its_stamp():
    assert point_times.is_one_sweep(np.array([-0.5, 0])) and point_times.is_one_sweep(np.array([]))
    assert not point_times.is_one_sweep(np.array([-0.51, 0]))
    assert not point_times.is_one_sweep(np.array([1.2, 1.3]))
    assert not point_times.is_one_sweep(np.array([0, np.nan]))


def test_a_convention_tells_itself():
    assert str(TimeConvention("us", "epoch")) == "us since the epoch"
