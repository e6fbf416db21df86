"""The ROS messages of a rover: what its sensor's driver, its localiser, its wheels and its mounting would send."""

from dataclasses import dataclass

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from scanplan import se3

CLOUD_TOPIC, LASER_TOPIC, POSE_TOPIC, ODOMETRY_TOPIC = "/velodyne_points", "/scan", "/amcl_pose", "/odom"
TRANSFORM_TOPIC, STATIC_TOPIC = "/tf", "/tf_static"
MAP_FRAME, ODOM_FRAME, BASE_FRAME = "map", "odom", "base_link"
_CLOUD_FRAME, _LASER_FRAME = "velodyne", "laser"
# contents have ROS1's types, which hold all that ROS2's do
ROS1_STORE = get_typestore(Stores.ROS1_NOETIC)
# rosbags' own selection of ROS1 types lacks it
ROS1_STORE.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage"))
_TYPE = ROS1_STORE.types
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


@dataclass(frozen=True)
class Message:
    """A message, its topic, its type and when it is recorded (nanoseconds since the epoch)."""

    t_ns: int
    topic: str
    content: object

    @property
    def msgtype(self):
        """Its ROS type, as in sensor_msgs/msg/PointCloud2."""
        return self.content.__msgtype__


def scans(t_ns, sensor, taken):
    """Give the scans of a survey as their sensor's driver does.

    Parameters
    ----------
    t_ns : (n,) int64
    sensor : sensors.Sensor
    taken : iterable of sweeps.Scan

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
    form = _TYPE["sensor_msgs/msg/PointField"]
    fields = [form(name=name, offset=at, datatype=code, count=1) for name, (_, at, code) in _POINT.items()]
    for seq, (stamp_ns, scan) in enumerate(zip(t_ns, taken, strict=True)):
        points = _points(sensor, scan)
        content = _TYPE["sensor_msgs/msg/PointCloud2"](
            header=_header(seq, stamp_ns, sensor_frame(sensor)),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=False,
            point_step=_POINT_DTYPE.itemsize,
            row_step=points.nbytes,
            data=points.view(np.uint8) if len(points) else np.empty(0, np.uint8),
            is_dense=True,
        )
        yield Message(stamp_ns, CLOUD_TOPIC, content)


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
        content = _TYPE["sensor_msgs/msg/LaserScan"](
            header=_header(seq, stamp_ns, sensor_frame(sensor)),
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
        yield Message(stamp_ns, LASER_TOPIC, content)


def belief(start_ns, believed):
    """Give all that wheels and localiser send over a drive.

    Parameters
    ----------
    start_ns : int
        When the drive starts.
    believed : localisation.Belief

    Returns
    -------
    list of iterables of Message
        /amcl_pose, /odom, and on /tf odom to base and map to odom.
    """
    ticks_ns = start_ns + believed.t_ns
    stated = {"noise_m": believed.deviation_m, "noise_rad": believed.deviation_rad}
    corrected_ns, correction = ticks_ns[believed.transform], believed.map_from_odom
    return [
        localiser_poses(ticks_ns[believed.update], believed.map_from_base, **stated),
        odometry(ticks_ns, believed.odom_from_base),
        transforms(ticks_ns, ODOM_FRAME, BASE_FRAME, believed.odom_from_base),
        transforms(corrected_ns, MAP_FRAME, ODOM_FRAME, correction, ahead_ns=believed.ahead_ns),
    ]


def localiser_poses(t_ns, map_from_base, *, noise_m, noise_rad):
    """Give a localiser's poses as `geometry_msgs/PoseWithCovarianceStamped`; AMCL fills x, y and heading alone.

    Parameters
    ----------
    t_ns : (n,) int64
    map_from_base : (n, 4, 4) float64
    noise_m, noise_rad : float
        Standard deviations the localiser states.

    Yields
    ------
    Message
    """
    covariance = np.diag([noise_m**2, noise_m**2, 0, 0, 0, noise_rad**2]).ravel()
    for seq, (stamp_ns, pose) in enumerate(_poses(t_ns, map_from_base)):
        content = _TYPE["geometry_msgs/msg/PoseWithCovarianceStamped"](
            header=_header(seq, stamp_ns, MAP_FRAME),
            pose=_TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=covariance),
        )
        yield Message(stamp_ns, POSE_TOPIC, content)


def odometry(t_ns, odom_from_base):
    """Give summed-up wheel motion as `nav_msgs/Odometry`; the velocity is the mean since the message before.

    Parameters
    ----------
    t_ns : (n,) int64
    odom_from_base : (n, 4, 4) float64

    Yields
    ------
    Message
    """
    form, vector = _TYPE["nav_msgs/msg/Odometry"], _TYPE["geometry_msgs/msg/Vector3"]
    unknown = np.zeros(36)
    velocity = _velocity(np.asarray(t_ns), odom_from_base).tolist()
    for seq, (stamp_ns, pose) in enumerate(_poses(t_ns, odom_from_base)):
        forward, left, turn = velocity[seq]
        twist = _TYPE["geometry_msgs/msg/Twist"](linear=vector(forward, left, 0.0), angular=vector(0.0, 0.0, turn))
        content = form(
            header=_header(seq, stamp_ns, ODOM_FRAME),
            child_frame_id=BASE_FRAME,
            pose=_TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=unknown),
            twist=_TYPE["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=unknown),
        )
        yield Message(stamp_ns, ODOMETRY_TOPIC, content)


def transforms(t_ns, parent, child, parent_from_child, *, ahead_ns=0, topic=TRANSFORM_TOPIC):
    """Give transforms as `tf2_msgs/TFMessage`, one a message.

    Parameters
    ----------
    t_ns : (n,) int64
        When each is sent.
    parent, child : str
        Frames.
    parent_from_child : (n, 4, 4) float64
    ahead_ns : int
        How much later than its sending each is stamped, as AMCL stamps map to odom by its transform_tolerance.
    topic : str

    Yields
    ------
    Message
    """
    vector, turn = _TYPE["geometry_msgs/msg/Vector3"], _TYPE["geometry_msgs/msg/Quaternion"]
    motion, stamped = _TYPE["geometry_msgs/msg/Transform"], _TYPE["geometry_msgs/msg/TransformStamped"]
    form = _TYPE["tf2_msgs/msg/TFMessage"]
    for sent_ns, xyz_m, quat in _rows(t_ns, parent_from_child):
        moved = motion(translation=vector(*xyz_m), rotation=turn(*quat))
        header = _header(0, sent_ns + ahead_ns, parent)
        content = form(transforms=[stamped(header=header, child_frame_id=child, transform=moved)])
        yield Message(sent_ns, topic, content)


def mounting(t_ns, base_from_sensor, sensor):
    """Give the sensor's place on the rover as the one message of /tf_static."""
    return transforms([t_ns], BASE_FRAME, sensor_frame(sensor), base_from_sensor[None], topic=STATIC_TOPIC)


def _header(seq, stamp_ns, frame_id):
    stamp = _TYPE["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return _TYPE["std_msgs/msg/Header"](seq=seq, stamp=stamp, frame_id=frame_id)


def _poses(t_ns, pose):
    """Stamps with poses as `geometry_msgs/Pose`."""
    form, point = _TYPE["geometry_msgs/msg/Pose"], _TYPE["geometry_msgs/msg/Point"]
    rotation = _TYPE["geometry_msgs/msg/Quaternion"]
    for stamp_ns, xyz_m, quat in _rows(t_ns, pose):
        yield stamp_ns, form(position=point(*xyz_m), orientation=rotation(*quat))


def _rows(t_ns, pose):
    xyz_m, quat = se3.position_quaternion(pose)
    return zip(np.asarray(t_ns).tolist(), xyz_m.tolist(), quat.tolist(), strict=True)


def _velocity(t_ns, pose):
    """Mean velocity (n, 3) in the base's frame over the step to each pose: forward, left, turn; zero at the start."""
    step = se3.inverse(pose[:-1]) @ pose[1:]
    moved = np.column_stack([step[:, :2, 3], se3.yaw_rad(step)])
    return np.vstack([np.zeros(3), moved / (np.diff(t_ns) / 1e9)[:, None]])
