"""The ROS messages of a laser sensor's driver."""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from scanplan.lab.simulation.sensors import Sensor, turn_directions
from scanplan.lab.simulation.survey_messages import TYPE, RosMessage, make_header
from scanplan.lab.simulation.sweeps import SimulatedScan
from scanplan.types import Array, FloatArray, IntArray

if TYPE_CHECKING:
    from rosbags.typesys.store import Msg

_CLOUD_TOPIC = "/velodyne_points"
_LASER_TOPIC = "/scan"
_CLOUD_FRAME = "velodyne"
_LASER_FRAME = "laser"
# velodyne_pointcloud's PointXYZIRT: form, offset in bytes, datatype of sensor_msgs/PointField
_POINT = {
    "x": ("<f4", 0, 7),
    "y": ("<f4", 4, 7),
    "z": ("<f4", 8, 7),
    "intensity": ("<f4", 12, 7),
    "ring": ("<u2", 16, 4),
    "time": ("<f4", 18, 7),
}
POINT_DTYPE = np.dtype(
    {
        "names": list(_POINT),
        "formats": [form for form, _, _ in _POINT.values()],
        "offsets": [offset for _, offset, _ in _POINT.values()],
        "itemsize": 22,  # bytes of a PointXYZIRT
    }
)


def encode_scans(
    t_ns: IntArray, sensor: Sensor, scans: Iterable[SimulatedScan]
) -> Iterator[RosMessage]:
    """Encode the scans of a survey as their sensor's driver does.

    Parameters
    ----------
    t_ns : (n,) int64

    Yields
    ------
    RosMessage
        `sensor_msgs/PointCloud2`, or `sensor_msgs/LaserScan` from a 2-D scanner.
    """
    stamps_ns = np.asarray(t_ns).tolist()
    if sensor.increment_rad is None:
        yield from _encode_clouds(stamps_ns, sensor, scans)
    else:
        yield from _encode_laser_scans(stamps_ns, sensor, sensor.increment_rad, scans)


def sensor_frame(sensor: Sensor) -> str:
    """Return the name of the frame that a sensor's scans are in."""
    return _CLOUD_FRAME if sensor.increment_rad is None else _LASER_FRAME


def _encode_clouds(
    t_ns: list[int], sensor: Sensor, scans: Iterable[SimulatedScan]
) -> Iterator[RosMessage]:
    """Yield dense unordered clouds, stamped with their last firing; `time` runs up to 0."""
    form = TYPE["sensor_msgs/msg/PointField"]
    offset = {str(name): field[1] for name, field in (POINT_DTYPE.fields or {}).items()}
    fields: list[Msg] = [
        form(name=name, offset=offset[name], datatype=code, count=1)
        for name, (_, _, code) in _POINT.items()
    ]
    for seq, (stamp_ns, scan) in enumerate(zip(t_ns, scans, strict=True)):
        points = _points(sensor, turn_directions(sensor, seq), scan)
        content = TYPE["sensor_msgs/msg/PointCloud2"](
            header=make_header(seq, stamp_ns, sensor_frame(sensor)),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=False,
            point_step=POINT_DTYPE.itemsize,
            row_step=points.nbytes,
            data=points.view(np.uint8) if len(points) else np.empty(0, np.uint8),
            is_dense=True,
        )
        yield RosMessage(stamp_ns, _CLOUD_TOPIC, content)


def _points(sensor: Sensor, direction: FloatArray, scan: SimulatedScan) -> Array:
    """Return the returns of a scan as records, in the order fired; `direction` as its turn's."""
    ray = np.flatnonzero(np.isfinite(scan.range_m))
    column, beam = np.divmod(ray, len(sensor.ring))
    points = np.empty(len(ray), POINT_DTYPE)
    xyz_m = direction.reshape(-1, 3).take(ray, axis=0) * scan.range_m.take(ray)[:, None]
    points["x"], points["y"], points["z"] = xyz_m.T
    points["intensity"] = scan.intensity.take(ray)
    points["ring"] = sensor.ring[beam]
    points["time"] = sensor.time_s[column]
    return points


def _encode_laser_scans(
    t_ns: list[int], sensor: Sensor, increment_rad: float, scans: Iterable[SimulatedScan]
) -> Iterator[RosMessage]:
    """Yield scans of a plane, stamped with their first beam; a lost beam is infinite (REP 117)."""
    first_rad = float(np.arctan2(sensor.direction[0, 0, 1], sensor.direction[0, 0, 0]))
    # a whole turn begins at 180 degrees, which is -180
    first_rad = first_rad if first_rad <= 0 else -np.pi
    for seq, (stamp_ns, scan) in enumerate(zip(t_ns, scans, strict=True)):
        range_m = scan.range_m[:, 0]
        content = TYPE["sensor_msgs/msg/LaserScan"](
            header=make_header(seq, stamp_ns, sensor_frame(sensor)),
            angle_min=first_rad,
            angle_max=first_rad + (len(range_m) - 1) * increment_rad,
            angle_increment=increment_rad,
            time_increment=float(sensor.time_s[1] - sensor.time_s[0]),
            scan_time=sensor.period_s,
            range_min=sensor.min_range_m,
            range_max=sensor.max_range_m,
            ranges=np.where(np.isnan(range_m), np.float32(np.inf), range_m),
            intensities=np.where(np.isnan(range_m), np.float32(0), scan.intensity[:, 0]),
        )
        yield RosMessage(stamp_ns, _LASER_TOPIC, content)
