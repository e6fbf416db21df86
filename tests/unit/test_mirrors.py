"""A mirror on a wall, and a room behind a door: which of them shows the room before it again."""

from types import SimpleNamespace

import numpy as np
import pytest

from helpers import floorplan_making
from scanplan.validation import mirrors

WIDE_M, DEEP_M = 6.0, 4.0
# the wall at x = 0 ends where the mirror begins; the others are whole
FACES = ((0, 3, 0, 4, -1), (0, 0, WIDE_M, 0, -1), (WIDE_M, 0, WIDE_M, DEEP_M, -1))


def rays_of(returns_m, sensor_m):
    xyz_m = np.column_stack([returns_m, np.zeros(len(returns_m))]).astype(np.float32)
    return SimpleNamespace(
        xyz_m=xyz_m,
        scan=np.zeros(len(xyz_m), int),
        sensors_m=np.array([[*sensor_m, 0.0]]),
    )


def room_returns(depth_m):
    """Returns of the far wall and of a side wall."""
    along = np.linspace(0.05, DEEP_M - 0.05, 300)
    far = np.column_stack([np.full(300, depth_m), along])
    side = np.column_stack([np.linspace(0.6, depth_m, 300), np.full(300, DEEP_M)])
    return np.concatenate([far, side])


def measure(behind_m, track_m=((2.0, 2.0),)):
    """Of a room of 6 m, and what rays through x = 0 show behind it."""
    sensor_m = (2.0, 2.0)
    crossing_y_m = sensor_m[1] + (behind_m[:, 1] - sensor_m[1]) * 2 / (2 - behind_m[:, 0])
    through = behind_m[(crossing_y_m > 0.2) & (crossing_y_m < 2.9)]
    rays = rays_of(np.concatenate([room_returns(WIDE_M), through]), sensor_m)
    plan = floorplan_making.bare(FACES)
    share, where = mirrors.measure_mirrored_share(plan, rays, np.array(track_m))
    return share, where, len(through) / len(rays.xyz_m)


def test_rays_that_a_mirror_sends_back_are_counted():
    share, where, expected = measure(room_returns(WIDE_M) * [-1, 1])
    assert share == pytest.approx(expected) and share > 0.2
    assert where.startswith("x = 0.0 m")


def test_a_room_of_another_depth_is_no_mirror_image():
    share, where, _ = measure(room_returns(3.0) * [-1, 1])
    assert share == 0 and where == ""


def test_where_the_sensor_went_there_is_no_mirror():
    share, _, _ = measure(room_returns(WIDE_M) * [-1, 1], ((2.0, 2.0), (-4.0, 2.0)))
    assert share == 0
