"""The ROS messages of a laser sensor's driver."""

import numpy as np

from scanplan.lab.simulation.survey_messages import TYPE, RosMessage, make_header

_CLOUD_TOPIC, _LASER_TOPIC = "/velodyne_points", "/scan"
_CLOUD_FRAME, _LASER_FRAME = "velodyne", "laser"
# the layout of velodyne_pointcloud's PointXYZIRT; the numbers are sensor_msgs/PointField's datatypes
_POINT = {"x": ("<f4", 0, 7), "y": ("<f4", 4, 7), "z": ("<f4", 8, 7), "intensity": ("<f4", 12, 7)}
_POINT |= {"ring": ("<u2", 16, 4), "time": ("<f4", 18, 7)}
_POINT_DTYPE = np.dtype(
    {
        "names": list(_POINT),
        "formats": [form for form, _, _ in _POINT.values()],
        "offsets": [offset for _, offset, _ in _POINT.values()],
        "itemsize": 22,
    }
)


def encode_scans(t_ns, sensor, taken):
    """Give the scans of a survey as their sensor's driver does.

    Parameters
    ----------
    t_ns : (n,) int64
    sensor : sensors.Sensor
    taken : iterable of sweeps.SimulatedScan

    Yields
    ------
    Message
        `sensor_msgs/PointCloud2`, or `sensor_msgs/LaserScan` from a 2-D scanner.
    """
    give = _clouds if sensor.increment_rad is None else _laser_scans
    yield from give(np.asarray(t_ns).tolist(), sensor, taken)


def sensor_frame(sensor):
    """Return the name of the frame that a sensor's scans are in."""
    return _CLOUD_FRAME if sensor.increment_rad is None else _LASER_FRAME


def _clouds(t_ns, sensor, taken):
    """Dense unordered clouds, the Velodyne driver's; the stamp is the last firing's and `time` runs up to 0."""
    form = TYPE["sensor_msgs/msg/PointField"]
    fields = [
        form(name=name, offset=at, datatype=code, count=1) for name, (_, at, code) in _POINT.items()
    ]
    for seq, (stamp_ns, scan) in enumerate(zip(t_ns, taken, strict=True)):
        points = _points(sensor, scan)
        content = TYPE["sensor_msgs/msg/PointCloud2"](
            header=make_header(seq, stamp_ns, sensor_frame(sensor)),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=False,
            point_step=_POINT_DTYPE.itemsize,
            row_step=points.nbytes,
            data=points.view(np.uint8) if len(points) else np.empty(0, np.uint8),
            is_dense=True,
        )
        yield RosMessage(stamp_ns, _CLOUD_TOPIC, content)


def _points(sensor, scan):
    """The returns of a scan as records, in the order fired."""
    ray = np.flatnonzero(np.isfinite(scan.range_m))
    column, beam = np.divmod(ray, len(sensor.ring))
    points = np.empty(len(ray), _POINT_DTYPE)
    xyz_m = sensor.direction.reshape(-1, 3).take(ray, axis=0) * scan.range_m.take(ray)[:, None]
    points["x"], points["y"], points["z"] = xyz_m.T
    points["intensity"], points["ring"] = scan.intensity.take(ray), sensor.ring[beam]
    points["time"] = sensor.time_s[column]
    return points


def _laser_scans(t_ns, sensor, taken):
    """Scans of a plane; the stamp is the first beam's, a beam that does not come back is infinite (REP 117)."""
    first = float(np.arctan2(sensor.direction[0, 0, 1], sensor.direction[0, 0, 0]))
    first = first if first <= 0 else -np.pi
    for seq, (stamp_ns, scan) in enumerate(zip(t_ns, taken, strict=True)):
        range_m = scan.range_m[:, 0]
        content = TYPE["sensor_msgs/msg/LaserScan"](
            header=make_header(seq, stamp_ns, sensor_frame(sensor)),
            angle_min=first,
            angle_max=first + (len(range_m) - 1) * sensor.increment_rad,
            angle_increment=sensor.increment_rad,
            time_increment=float(sensor.time_s[1] - sensor.time_s[0]),
            scan_time=sensor.period_s,
            range_min=sensor.min_range_m,
            range_max=sensor.max_range_m,
            ranges=np.where(np.isnan(range_m), np.float32(np.inf), range_m),
            intensities=np.where(np.isnan(range_m), np.float32(0), scan.intensity[:, 0]),
        )
        yield RosMessage(stamp_ns, _LASER_TOPIC, content)
