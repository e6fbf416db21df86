"""Odd messages drawn by hypothesis: field layouts, sizes, stamps, values that are no numbers."""

from types import SimpleNamespace

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from faults.judging import Case, judge
from scanplan.recordings import driver_messages, messages

_SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 8: 8}
_COUNT = st.integers(0, 2**32 - 1) | st.integers(0, 40)
_FIELD = st.builds(
    SimpleNamespace,
    name=st.sampled_from(["x", "y", "z", "intensity", "time", "t", ""]),
    offset=_COUNT,
    datatype=st.integers(0, 9),
    count=st.sampled_from([0, 1, 3, 2**31]),
)
_PLAIN = [SimpleNamespace(name=n, offset=4 * i, datatype=7, count=1) for i, n in enumerate("xyz")]
_CLOUD = st.builds(
    SimpleNamespace,
    height=_COUNT,
    width=_COUNT,
    fields=st.lists(_FIELD, max_size=6) | st.just(_PLAIN),
    is_bigendian=st.booleans(),
    point_step=_COUNT | st.just(12),
    row_step=_COUNT,
    data=st.binary(max_size=600).map(lambda data: np.frombuffer(data, np.uint8)),
)
_NUMBER = st.floats(width=32)
_LASER = st.builds(
    SimpleNamespace,
    angle_min=_NUMBER,
    angle_max=_NUMBER,
    angle_increment=_NUMBER | st.floats(-0.125, 0.125, width=32),
    time_increment=_NUMBER,
    scan_time=_NUMBER,
    range_min=_NUMBER,
    range_max=_NUMBER,
    ranges=st.lists(_NUMBER, max_size=40).map(lambda r: np.array(r, np.float32)),
    intensities=st.just(np.zeros(0, np.float32)),
)
_NUMBERS = st.lists(_NUMBER, max_size=4).map(lambda values: np.array(values, np.float32))
_ECHOES = st.lists(st.builds(SimpleNamespace, echoes=_NUMBERS), max_size=40)
_MULTI_ECHO = st.builds(
    lambda laser, ranges: SimpleNamespace(**(vars(laser) | {"ranges": ranges})), _LASER, _ECHOES
)
_XYZ = dict.fromkeys("xyz", _NUMBER)
_TIMED = st.builds(SimpleNamespace, offset_time=_COUNT, **_XYZ)
_LIVOX = st.builds(SimpleNamespace, point_num=_COUNT, points=st.lists(_TIMED, max_size=9))
_CHANNEL = st.builds(
    SimpleNamespace, name=st.sampled_from(["time", "t", "intensity", ""]), values=_NUMBERS
)
_OLD_CLOUD = st.builds(
    SimpleNamespace,
    points=st.lists(st.builds(SimpleNamespace, **_XYZ), max_size=4),
    channels=st.lists(_CHANNEL, max_size=3),
)


def try_messages(tally, n_each):
    """Judge so many clouds and laser scans: points of three coordinates each, or one line."""
    _try_drawn(tally, n_each, "odd PointCloud2", _CLOUD, messages.read_point_cloud)
    _try_drawn(tally, n_each, "odd LaserScan", _LASER, messages.read_laser_scan)
    read_echoes = driver_messages.read_multi_echo
    _try_drawn(tally, n_each, "odd MultiEchoLaserScan", _MULTI_ECHO, read_echoes)
    _try_drawn(tally, n_each, "odd CustomMsg", _LIVOX, driver_messages.read_livox)
    _try_drawn(tally, n_each, "odd PointCloud", _OLD_CLOUD, driver_messages.read_old_point_cloud)


def _try_drawn(tally, n_drawn, group, strategy, read):
    def try_message(message):
        judge(Case(group, repr(message)[:120], lambda: read(message), _is_cloud), tally)

    drawn = settings(
        max_examples=n_drawn,
        deadline=None,
        database=None,
        derandomize=True,
        suppress_health_check=list(HealthCheck),
    )
    drawn(given(strategy)(try_message))()


def _is_cloud(found):
    xyz_m, times = found
    return xyz_m.ndim == 2 and xyz_m.shape[1] == 3 and (times is None or len(times) == len(xyz_m))
