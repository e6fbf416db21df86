"""A rover's recording, written as the ROS1 bag that its driver, localiser and wheels would have left."""

import heapq
from dataclasses import dataclass

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from scanplan import atomic, se3

# 2024-01-01 00:00:00 UTC: a recording starts then, so that the same seed gives the same bytes
EPOCH_NS = 1_704_067_200 * 10**9
CLOUD_TOPIC, POSE_TOPIC, ODOMETRY_TOPIC, STATIC_TOPIC = "/velodyne_points", "/amcl_pose", "/odom", "/tf_static"
MAP_FRAME, ODOM_FRAME, BASE_FRAME, SENSOR_FRAME = "map", "odom", "base_link", "velodyne"
_STORE = get_typestore(Stores.ROS1_NOETIC)
# rosbags' own selection of ROS1 types lacks it
_STORE.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage"))
_TYPE = _STORE.types
_LATCHED = (POSE_TOPIC, STATIC_TOPIC)
_TOPICS = {
    STATIC_TOPIC: "tf2_msgs/msg/TFMessage",
    CLOUD_TOPIC: "sensor_msgs/msg/PointCloud2",
    POSE_TOPIC: "geometry_msgs/msg/PoseWithCovarianceStamped",
    ODOMETRY_TOPIC: "nav_msgs/msg/Odometry",
}
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
    """A message, its topic and its stamp (nanoseconds since the epoch)."""

    t_ns: int
    topic: str
    content: object


def write(path, *streams):
    """Write a bag, whole or not at all.

    ASSUME every message is recorded at its header's stamp; a real recorder is some milliseconds later.

    Parameters
    ----------
    path : path-like
    *streams : iterable of Message
        Each in the order of its stamps; merged by them as they come, so that no stream is held in memory.
    """
    with atomic.replacing(path) as temporary, Writer(temporary) as writer:
        connections = {
            topic: writer.add_connection(topic, form, typestore=_STORE, latching=int(topic in _LATCHED))
            for topic, form in _TOPICS.items()
        }
        for message in heapq.merge(*streams, key=lambda message: message.t_ns):
            raw = _STORE.serialize_ros1(message.content, _TOPICS[message.topic])
            writer.write(connections[message.topic], message.t_ns, raw)


def clouds(t_ns, scans):
    """Give scans as `sensor_msgs/PointCloud2`, dense and unordered as the Velodyne driver's.

    The field `time`, a point's moment after the stamp, is 0 throughout: the scans are not distorted.

    Parameters
    ----------
    t_ns : (n,) int64
    scans : iterable of raycast.Returns

    Yields
    ------
    Message
    """
    form = _TYPE["sensor_msgs/msg/PointField"]
    fields = [form(name=name, offset=at, datatype=code, count=1) for name, (_, at, code) in _POINT.items()]
    for seq, (stamp_ns, scan) in enumerate(zip(np.asarray(t_ns).tolist(), scans, strict=True)):
        points = np.zeros(len(scan.xyz_m), _POINT_DTYPE)
        points["x"], points["y"], points["z"] = scan.xyz_m.T
        points["intensity"], points["ring"] = scan.intensity, scan.ring
        content = _TYPE["sensor_msgs/msg/PointCloud2"](
            header=_header(seq, stamp_ns, SENSOR_FRAME),
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
    for seq, (stamp_ns, pose) in enumerate(_poses(t_ns, odom_from_base)):
        linear, angular = _velocity(t_ns, odom_from_base, seq)
        twist = _TYPE["geometry_msgs/msg/Twist"](linear=vector(*linear), angular=vector(*angular))
        content = form(
            header=_header(seq, stamp_ns, ODOM_FRAME),
            child_frame_id=BASE_FRAME,
            pose=_TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=unknown),
            twist=_TYPE["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=unknown),
        )
        yield Message(stamp_ns, ODOMETRY_TOPIC, content)


def mounting(t_ns, base_from_sensor):
    """Give the sensor's place on the rover as the one message of /tf_static: a list of one Message."""
    xyz_m, quat = se3.position_quaternion(base_from_sensor)
    transform = _TYPE["geometry_msgs/msg/TransformStamped"](
        header=_header(0, int(t_ns), BASE_FRAME),
        child_frame_id=SENSOR_FRAME,
        transform=_TYPE["geometry_msgs/msg/Transform"](
            translation=_TYPE["geometry_msgs/msg/Vector3"](*xyz_m.tolist()),
            rotation=_TYPE["geometry_msgs/msg/Quaternion"](*quat.tolist()),
        ),
    )
    return [Message(int(t_ns), STATIC_TOPIC, _TYPE["tf2_msgs/msg/TFMessage"](transforms=[transform]))]


def _header(seq, stamp_ns, frame_id):
    stamp = _TYPE["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return _TYPE["std_msgs/msg/Header"](seq=seq, stamp=stamp, frame_id=frame_id)


def _poses(t_ns, pose):
    """Stamps with poses as `geometry_msgs/Pose`."""
    form, point = _TYPE["geometry_msgs/msg/Pose"], _TYPE["geometry_msgs/msg/Point"]
    rotation = _TYPE["geometry_msgs/msg/Quaternion"]
    xyz_m, quat = se3.position_quaternion(pose)
    for stamp_ns, p, q in zip(np.asarray(t_ns).tolist(), xyz_m.tolist(), quat.tolist(), strict=True):
        yield stamp_ns, form(position=point(*p), orientation=rotation(*q))


def _velocity(t_ns, pose, i):
    """Mean velocity in the base's frame over the step to row `i`: linear (3,), angular (3,); zero at the start."""
    if i == 0:
        return np.zeros(3), np.zeros(3)
    seconds = (t_ns[i] - t_ns[i - 1]) / 1e9
    step = se3.inverse(pose[i - 1]) @ pose[i]
    return step[:3, 3] / seconds, np.array([0.0, 0.0, float(se3.yaw_rad(step))]) / seconds
