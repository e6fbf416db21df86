"""ROS messages to arrays: headers, PointCloud2 of any layout, LaserScan, poses, transforms.

A message is any object with the fields of the ROS definition. No loop runs over points.
"""

import struct
import sys
from typing import Any

import numpy as np

from scanplan.errors import StageError
from scanplan.types import Array, FloatArray

_POINT_FIELD_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
TIME_FIELDS = ("time", "t", "timestamp", "offset_time", "time_stamp")
"""Names that drivers give to the time of a point."""
_A_LITTLE_M = 0.002  # what drivers take off range_max that it may not be taken for a return
_NOISE_M = 0.05  # of simulated ranges, which are clipped at range_max or go beyond
_FEWEST_PILED = 5  # beams: fewer may end at a surface
_SPAN_SLACK = 0.02  # of angles that drivers round to a degree; lasers see 60 degrees and more


def read_header(raw: bytes, *, ros2: bool) -> tuple[int, str]:
    """Read stamp and frame of a serialised message that starts with a std_msgs/Header.

    The rest of it is not decoded.

    Parameters
    ----------
    raw : bytes-like
        ROS 1 serialisation, or CDR with its four bytes of encapsulation.

    Returns
    -------
    t_ns : int
    frame : str
        Without leading slash.

    Raises
    ------
    struct.error, UnicodeDecodeError
        If the bytes are too short or no text.
    """
    order = ">" if ros2 and raw[1] == 0 else "<"
    seconds, nanoseconds, length = struct.unpack_from(order + ("iII" if ros2 else "III"), raw, 4)
    if 16 + length > len(raw):
        raise struct.error(f"frame name of {length} bytes in a message of {len(raw)}")
    frame = bytes(raw[16 : 16 + length]).rstrip(b"\0").decode()
    return seconds * 10**9 + nanoseconds, clean_frame_name(frame)


def clean_frame_name(text: str) -> str:
    """Return a frame id without the leading slash of early ROS 1."""
    # every message has its own: of a million poses that is one
    return sys.intern(text.lstrip("/"))


def stamp_to_ns(stamp: Any) -> int:
    """Return a builtin_interfaces/Time as nanoseconds."""
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def pose_to_row(pose: Any) -> list[float]:
    """Return a geometry_msgs/Pose or Transform as [x, y, z, qx, qy, qz, qw]."""
    if hasattr(pose, "position"):
        place = pose.position
        turn = pose.orientation
    else:
        place = pose.translation
        turn = pose.rotation
    return [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]


def read_point_cloud(message: Any) -> tuple[FloatArray, Array | None]:
    """Read the coordinates and per-point times of a sensor_msgs/PointCloud2.

    Parameters
    ----------
    message : PointCloud2
        Any order, offset, type and byte order of fields, padded points and rows.

    Returns
    -------
    xyz_m : (n, 3) float32
    time_raw : (n,) or None
        The first of `TIME_FIELDS` that there is, as recorded.

    Raises
    ------
    StageError
        If x, y or z is missing, the layout contradicts itself, or the data are shorter than
        declared.
    """
    if message.width * message.height == 0:
        return np.empty((0, 3), np.float32), None
    records = _view_records(message)
    xyz_m = np.empty((records.size, 3), np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        for column, name in enumerate("xyz"):
            xyz_m[:, column] = records[name].reshape(-1)
    names = records.dtype.names or ()
    times = [name for name in TIME_FIELDS if name in names]
    return xyz_m, records[times[0]].reshape(-1).copy() if times else None


def read_laser_scan(message: Any) -> tuple[FloatArray, FloatArray | None]:
    """Turn a sensor_msgs/LaserScan into points of the plane z = 0.

    Returns
    -------
    xyz_m : (n, 3) float32
        One point a beam; NaN where the beam came back from outside [range_min, range_max).
    time_raw : (n,) float64 or None
        Seconds since the first beam; None if `time_increment` is not positive, or infinite.

    Raises
    ------
    StageError
        If the angles of the beams are not given, those of more than one turn, or others than those
        of the first beam and the last say.
    """
    return read_ranges(message, np.asarray(message.ranges, np.float64).reshape(-1))


def read_ranges(message: Any, range_m: FloatArray) -> tuple[FloatArray, FloatArray | None]:
    """Turn ranges (n,) of a message with angles as a LaserScan's into points: see there."""
    beam = np.arange(len(range_m))
    with np.errstate(over="ignore", invalid="ignore"):
        angle_rad = message.angle_min + beam * message.angle_increment
    is_one_way = len(range_m) > 1 and message.angle_increment == 0
    if is_one_way or not np.isfinite(angle_rad).all():
        raise StageError(
            f"angle_min {message.angle_min}, angle_increment {message.angle_increment}"
            " give no directions"
        )
    # some drivers overlap by a few beams; degrees are off by 57
    if len(range_m) and np.ptp(angle_rad) > 1.1 * 2 * np.pi:
        raise StageError(
            f"angle_increment {message.angle_increment:g} rad turns {len(range_m)} beams by"
            f" {np.ptp(angle_rad):.1f} rad, more than once around: the message wants radians,"
            " these may be degrees"
        )
    _check_span(message, len(range_m))
    limit_m = _find_limit_m(range_m, message.range_max if message.range_max > 0 else np.inf)
    range_m = np.where((range_m >= message.range_min) & (range_m < limit_m), range_m, np.nan)
    xyz_m = np.column_stack([range_m * np.cos(angle_rad), range_m * np.sin(angle_rad), range_m * 0])
    step_s = float(message.time_increment)
    return xyz_m.astype(np.float32), beam * step_s if 0 < step_s < np.inf else None


def _find_limit_m(range_m: FloatArray, most_m: float) -> float:
    """Return the range from which on beams (n,) did not return.

    `range_max` itself is what many drivers report then; some a little less, simulators with noise
    about it. Surfaces do not end so many beams at the very end of what a sensor measures.
    """
    beyond = range_m[(range_m >= most_m) & np.isfinite(range_m)]
    # a code is the same in all beams, and says nothing of those before it
    is_noisy = len(beyond) >= _FEWEST_PILED and np.ptp(beyond) > 0
    for less_m, n_least in ((_A_LITTLE_M, 0), (_NOISE_M, len(beyond) / 4 if is_noisy else np.inf)):
        n_below = np.count_nonzero((range_m >= most_m - less_m) & (range_m < most_m))
        n_before = np.count_nonzero((range_m >= most_m - 2 * less_m) & (range_m < most_m)) - n_below
        if n_below >= max(n_least, _FEWEST_PILED) and n_below > 2 * n_before:
            return most_m - less_m
    return most_m


def _check_span(message: Any, n_beams: int) -> None:
    """Refuse a scan whose angle from the first beam to the last is stated in two ways.

    Drivers count a beam more or less, or leave the last angle out: as zero, or as the first.
    """
    stated_rad = float(message.angle_max) - float(message.angle_min)
    turned_rad = (n_beams - 1) * float(message.angle_increment)
    is_stated = n_beams > 1 and message.angle_max not in (0, message.angle_min)
    most_rad = _SPAN_SLACK * abs(stated_rad) + 2 * abs(float(message.angle_increment))
    if is_stated and np.isfinite(stated_rad) and abs(turned_rad - stated_rad) > most_rad:
        raise StageError(
            f"angle_min {message.angle_min:g} to angle_max {message.angle_max:g} are"
            f" {stated_rad:.3g} rad, {n_beams} beams of angle_increment"
            f" {message.angle_increment:g} turn by {turned_rad:.3g}: one of them is wrong; correct"
            " the driver's settings, or leave these messages out"
        )


def _view_records(message: Any) -> Array:
    """View the data of a PointCloud2 as (height, width) records; nothing is copied or allocated."""
    width = int(message.width)
    height = int(message.height)
    step = int(message.point_step)
    row_step = int(message.row_step) if height > 1 else width * step
    if step == 0 or row_step < width * step:
        raise StageError(
            f"point_step {step}, row_step {message.row_step} cannot hold {width} points a row"
        )
    needed = (height - 1) * row_step + width * step
    data = np.ascontiguousarray(message.data).view(np.uint8)
    if len(data) < needed:
        raise StageError(
            f"{width} x {height} points need {needed} bytes, but {len(data)} are there"
        )
    return np.ndarray((height, width), _point_type(message, step), data, strides=(row_step, step))


def _point_type(message: Any, step: int) -> np.dtype[np.void]:
    order = ">" if message.is_bigendian else "<"
    fields = {}
    for field in message.fields:
        fields.setdefault(field.name, field)  # of two fields of one name the first counts
    if missing := [name for name in "xyz" if name not in fields]:
        names = ", ".join(sorted(filter(None, fields))) or "none"
        raise StageError(f"no field {', '.join(missing)} in the cloud; its fields are: {names}")
    wanted = [fields[name] for name in ("x", "y", "z", *TIME_FIELDS) if name in fields]
    for field in wanted:
        size = int(_POINT_FIELD_TYPES.get(field.datatype, "x0")[1])
        if not size or field.offset + size > step:
            raise StageError(
                f"field {field.name}: type {field.datatype} at {field.offset}"
                f" in points of {step} bytes"
            )
    names = [field.name for field in wanted]
    formats = [order + _POINT_FIELD_TYPES[field.datatype] for field in wanted]
    offsets = [field.offset for field in wanted]
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": step})
