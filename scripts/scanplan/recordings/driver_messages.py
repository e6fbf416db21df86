"""Clouds in drivers' own messages to arrays: several echoes, Livox's points, PointCloud of old.

A message is any object with the fields of its definition.
"""

from typing import Any

import numpy as np

from scanplan.recordings.messages import TIME_FIELDS, read_ranges
from scanplan.types import Array, FloatArray

LIVOX_DEFINITION = """\
std_msgs/Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
CustomPoint[] points
================================================================================
MSG: {package}/CustomPoint
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
"""
"""Of CustomMsg in Livox's drivers, for recordings that carry none."""


def read_multi_echo(message: Any) -> tuple[FloatArray, FloatArray | None]:
    """Turn the first echoes of a sensor_msgs/MultiEchoLaserScan into points, as of a LaserScan.

    Beams without an echo are NaN; errors are those of `messages.read_laser_scan`.
    """
    first = [beam.echoes[0] if len(beam.echoes) else np.nan for beam in message.ranges]
    return read_ranges(message, np.array(first, np.float64))


def read_livox(message: Any) -> tuple[FloatArray, Array]:
    """Read a CustomMsg of livox_ros_driver: xyz_m (n, 3) float32, nanoseconds since its stamp (n,).

    Points at the origin are beams without a return: NaN.
    """
    points = message.points
    rows = [(point.x, point.y, point.z) for point in points]
    xyz_m = np.array(rows, np.float32).reshape(-1, 3)
    xyz_m[~xyz_m.any(axis=1)] = np.nan
    return xyz_m, np.array([point.offset_time for point in points], np.uint32)


def read_old_point_cloud(message: Any) -> tuple[FloatArray, Array | None]:
    """Read a sensor_msgs/PointCloud: xyz_m (n, 3) float32, and a channel of times (n,) or None."""
    xyz_m = np.array([(point.x, point.y, point.z) for point in message.points], np.float32)
    channels = {channel.name: channel.values for channel in message.channels}
    times = [np.asarray(channels[name]) for name in TIME_FIELDS if name in channels]
    is_timed = bool(times) and len(times[0]) == len(xyz_m)
    return xyz_m.reshape(-1, 3), times[0] if is_timed else None
