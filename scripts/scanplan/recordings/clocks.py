"""Stamps that cannot be true, judged by one another and by the times of receipt."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from scanplan.types import BoolArray, FilePath, IntArray

OF_ANOTHER_CLOCK_S = 1.0
"""Stamps off by more are of a clock that was set, or another one: recorders delay messages by less,
and a rover drives a metre in it."""

_AHEAD_S = 0.02  # below it a lead is jitter of the receipt
_MOST_AHEAD_S = 5.0  # no localiser stamps so far ahead: beyond it two clocks differ
_MOST_SCATTER = 0.9  # of times of receipt: the others are of a recorder that was busy
_FEWEST_BACK = 3  # fewer messages are late ones, not a clock set back


def read_date(t_ns: int) -> datetime | None:
    """Return when a recording began by its first stamp (UTC); None where its clock was not set.

    A clock that nobody set is known by where it begins: in the seventies, as it counts from when a
    sensor or a simulation was switched on; in the first hour of a year, as computers without a
    battery do; or within an hour after a whole multiple of 100 million seconds, which programs that
    convert or simulate recordings add (9 September 2001 is a thousand million). Of true surveys one
    in some 6,700 begins in such an hour.

    Parameters
    ----------
    t_ns : int
        Since the epoch.
    """
    t_s = t_ns / 1e9
    begun = datetime.fromtimestamp(t_s, UTC)
    hour = timedelta(hours=1)
    new_year = datetime(begun.year, 1, 1, tzinfo=UTC)
    is_unset = (
        begun.year < 1980 or begun - new_year < hour or timedelta(seconds=t_s % 100_000_000) < hour
    )
    return None if is_unset else begun


def state_date(t_ns: int, form: str = "%Y-%m-%d") -> str:
    """Return when a recording began, or that its clock was not set."""
    date = read_date(t_ns)
    return date.strftime(form) if date else "not known, clock not set"


def end_of_survey_ns(t_ns: IntArray) -> int:
    """Return the last of a survey's stamps; 0, where time begins, if its clock was not set.

    What files have to state where their format cannot leave the date out.

    Parameters
    ----------
    t_ns : (n,) int64
    """
    if len(t_ns) == 0 or read_date(int(t_ns.min())) is None:
        return 0
    return int(t_ns.max())


def describe_gaps(starts: Sequence[tuple[FilePath, int]]) -> list[str]:
    """Return whether recordings of one survey lie more than a day apart, as a sentence.

    Parameters
    ----------
    starts : sequence of (path-like, int)
        The recordings, and when each began in nanoseconds, the first first.
    """
    pauses = [
        (timedelta(microseconds=(later[1] - earlier[1]) / 1000), earlier[0], later[0])
        for earlier, later in pairwise(starts)
    ]
    far = [pause for pause in pauses if pause[0] > timedelta(days=1)]
    if not far:
        return []
    widest, earlier_path, later_path = max(far, key=lambda pause: pause[0])
    more = f", and {len(far) - 1} more lie more than a day after another" if far[1:] else ""
    return [
        f"recordings of one survey lie far apart in time: {later_path} begins"
        f" {widest / timedelta(days=1):,.1f} days after {earlier_path}{more}"
    ]


def count_stamp_faults(t_ns: IntArray, receive_ns: IntArray) -> dict[str, int]:
    """Count what is odd about the stamps of a topic.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64
        In the order of recording.

    Returns
    -------
    dict of str to int
        How many repeat the stamp before, go back behind it, or step by a second more or less than
        the recorder's clock.
    """
    step_ns = np.diff(t_ns)
    difference_ns = np.abs(step_ns - np.diff(receive_ns))
    return {
        "of a repeated stamp": int((step_ns == 0).sum()),
        "backwards in time": int((step_ns < 0).sum()),
        f"jumping by more than {OF_ANOTHER_CLOCK_S:g} s": int(
            (difference_ns > OF_ANOTHER_CLOCK_S * 1e9).sum()
        ),
    }


def summarise_faults(counts: Mapping[str, int]) -> str:
    """Return the counts that are not zero as one phrase, empty if all are."""
    return ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)


def estimate_ahead_ns(
    t_ns: IntArray, receive_ns: IntArray, cloud_t_ns: IntArray, cloud_receive_ns: IntArray
) -> int:
    """Estimate by how much stamps are ahead of their time, 0 if they are not.

    Nothing is received before it was measured. AMCL stamps map to odom ahead by its
    `transform_tolerance`, robot_localization by its `transform_time_offset`; a lead that the clouds
    have too is the recorder's clock.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64, n >= 1
    cloud_t_ns, cloud_receive_ns : (m,) int64, m >= 1
        Of the clouds.

    Returns
    -------
    int
    """
    ahead_ns = np.median(np.asarray(t_ns) - receive_ns)
    cloud_ahead_ns = max(np.median(np.asarray(cloud_t_ns) - cloud_receive_ns), 0.0)
    lead_ns = ahead_ns - cloud_ahead_ns
    return int(lead_ns) if _AHEAD_S * 1e9 < lead_ns < _MOST_AHEAD_S * 1e9 else 0


def describe_lead(name: str, ahead_ns: int) -> str:
    """Return a line that says by how much stamps of a source were taken back."""
    return f"{name} is stamped {ahead_ns / 1e9:.3f} s ahead of its receipt: taken back"


class ClockOffset(NamedTuple):
    """What stamps of clouds lack of another clock.

    Attributes
    ----------
    offset_ns : (n,) int64
        To be added to the stamp of each.
    spread_ns : int
        How far nine tenths of the times of receipt lie from it, one way or the other.
    """

    offset_ns: IntArray
    spread_ns: int


def find_clock_offset(
    t_ns: IntArray,
    receive_ns: IntArray,
    cloud_t_ns: IntArray,
    cloud_receive_ns: IntArray,
    recording: IntArray,
) -> ClockOffset | None:
    """Find what clouds' stamps lack of the clock of poses, by when both were received.

    Asked where the delays of both differ by more than those of one clock do, and more clouds were
    received among poses than are stamped among them: poses may be computed, and recorded, long
    after their clouds.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64, n >= 1
        Of the poses.
    cloud_t_ns, cloud_receive_ns : (m,) int64, m >= 1
        Of the clouds.
    recording : (m,) int
        In which recording each cloud is: between two of them the sensor may have been switched on
        anew.

    Returns
    -------
    ClockOffset or None
        None where they are stamped by one clock, or no time of receipt tells otherwise.
    """
    delay_ns, scatter_ns = _measure_delay(receive_ns - t_ns)
    offset_ns = np.empty(len(cloud_t_ns), np.int64)
    cloud_scatter_ns = np.empty(len(cloud_t_ns), np.int64)
    for part in np.unique(recording):
        rows = recording == part
        cloud_delay_ns, cloud_scatter_ns[rows] = _measure_delay(
            (cloud_receive_ns - cloud_t_ns)[rows]
        )
        offset_ns[rows] = cloud_delay_ns - delay_ns
    if np.abs(offset_ns).max() <= _MOST_AHEAD_S * 1e9:
        return None
    if _count_within(cloud_receive_ns, receive_ns) <= _count_within(cloud_t_ns, t_ns):
        return None
    spread_ns = sum(np.quantile(each, _MOST_SCATTER) for each in (scatter_ns, cloud_scatter_ns))
    return ClockOffset(offset_ns, int(spread_ns))


def _measure_delay(delays_ns: IntArray) -> tuple[int, IntArray]:
    """Return the median of delays (n,), and how far each lies from it."""
    # float64 has 200 ns of what is counted since the epoch
    median_ns = int(delays_ns[0]) + round(float(np.median(delays_ns - delays_ns[0])))
    return median_ns, np.abs(delays_ns - median_ns)


def _count_within(cloud_t_ns: IntArray, t_ns: IntArray) -> int:
    return int(((cloud_t_ns >= t_ns.min()) & (cloud_t_ns <= t_ns.max())).sum())


def find_repeated_times(t_ns: IntArray) -> BoolArray:
    """Return which stamps lie in a time that went by twice, since the clock was set back.

    One message that comes late, or was kept since long ago, is no clock set back.

    Parameters
    ----------
    t_ns : (n,) int64
        In the order of recording.

    Returns
    -------
    (n,) bool
    """
    twice = np.zeros(len(t_ns), bool)
    # messages overtake one another by less than half of what tells clocks apart
    for i in np.flatnonzero(np.diff(t_ns) < -OF_ANOTHER_CLOCK_S / 2 * 1e9) + 1:
        begin = t_ns[i]
        end = t_ns[:i].max()
        if (t_ns[i:] < end).sum() >= _FEWEST_BACK:
            twice |= (t_ns >= begin) & (t_ns <= end)
    return twice
