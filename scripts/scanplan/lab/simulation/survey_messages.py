"""The ROS messages of a rover: what its localiser, its wheels and its mounting would send."""

from dataclasses import dataclass

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from scanplan.geometry import se3

POSE_TOPIC, ODOMETRY_TOPIC, TRANSFORM_TOPIC, STATIC_TOPIC = (
    "/amcl_pose",
    "/odom",
    "/tf",
    "/tf_static",
)
MAP_FRAME, ODOM_FRAME, BASE_FRAME = "map", "odom", "base_link"
# contents have ROS1's types, which hold all that ROS2's do
ROS1_STORE = get_typestore(Stores.ROS1_NOETIC)
# rosbags' own selection of ROS1 types lacks it
ROS1_STORE.register(
    get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage")
)
TYPE = ROS1_STORE.types


@dataclass(frozen=True)
class RosMessage:
    """A message, its topic, its type and when it is recorded (nanoseconds since the epoch)."""

    t_ns: int
    topic: str
    content: object

    @property
    def msgtype(self):
        """Its ROS type, as in sensor_msgs/msg/PointCloud2."""
        return self.content.__msgtype__


def encode_belief(start_ns, believed):
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
        encode_localiser_poses(ticks_ns[believed.update], believed.map_from_base, **stated),
        encode_odometry(ticks_ns, believed.odom_from_base),
        encode_transforms(ticks_ns, ODOM_FRAME, BASE_FRAME, believed.odom_from_base),
        encode_transforms(
            corrected_ns, MAP_FRAME, ODOM_FRAME, correction, ahead_ns=believed.ahead_ns
        ),
    ]


def encode_localiser_poses(t_ns, map_from_base, *, noise_m, noise_rad):
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
        content = TYPE["geometry_msgs/msg/PoseWithCovarianceStamped"](
            header=make_header(seq, stamp_ns, MAP_FRAME),
            pose=TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=covariance),
        )
        yield RosMessage(stamp_ns, POSE_TOPIC, content)


def encode_odometry(t_ns, odom_from_base):
    """Give summed-up wheel motion as `nav_msgs/Odometry`; the velocity is the mean since the message before.

    Parameters
    ----------
    t_ns : (n,) int64
    odom_from_base : (n, 4, 4) float64

    Yields
    ------
    Message
    """
    form, vector = TYPE["nav_msgs/msg/Odometry"], TYPE["geometry_msgs/msg/Vector3"]
    unknown = np.zeros(36)
    velocity = _velocity(np.asarray(t_ns), odom_from_base).tolist()
    for seq, (stamp_ns, pose) in enumerate(_poses(t_ns, odom_from_base)):
        forward, left, turn = velocity[seq]
        twist = TYPE["geometry_msgs/msg/Twist"](
            linear=vector(forward, left, 0.0), angular=vector(0.0, 0.0, turn)
        )
        content = form(
            header=make_header(seq, stamp_ns, ODOM_FRAME),
            child_frame_id=BASE_FRAME,
            pose=TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=unknown),
            twist=TYPE["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=unknown),
        )
        yield RosMessage(stamp_ns, ODOMETRY_TOPIC, content)


def encode_transforms(t_ns, parent, child, parent_from_child, *, ahead_ns=0, topic=TRANSFORM_TOPIC):
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
    vector, turn = TYPE["geometry_msgs/msg/Vector3"], TYPE["geometry_msgs/msg/Quaternion"]
    motion, stamped = (
        TYPE["geometry_msgs/msg/Transform"],
        TYPE["geometry_msgs/msg/TransformStamped"],
    )
    form = TYPE["tf2_msgs/msg/TFMessage"]
    for sent_ns, xyz_m, quat in _rows(t_ns, parent_from_child):
        moved = motion(translation=vector(*xyz_m), rotation=turn(*quat))
        stamp = make_header(0, sent_ns + ahead_ns, parent)
        content = form(transforms=[stamped(header=stamp, child_frame_id=child, transform=moved)])
        yield RosMessage(sent_ns, topic, content)


def encode_mounting(t_ns, base_from_sensor, sensor_frame):
    """Give the sensor's place on the rover as the one message of /tf_static."""
    return encode_transforms(
        [t_ns], BASE_FRAME, sensor_frame, base_from_sensor[None], topic=STATIC_TOPIC
    )


def make_header(seq, stamp_ns, frame_id):
    """Return a `std_msgs/Header`."""
    stamp = TYPE["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return TYPE["std_msgs/msg/Header"](seq=seq, stamp=stamp, frame_id=frame_id)


def _poses(t_ns, pose):
    """Stamps with poses as `geometry_msgs/Pose`."""
    form, point = TYPE["geometry_msgs/msg/Pose"], TYPE["geometry_msgs/msg/Point"]
    rotation = TYPE["geometry_msgs/msg/Quaternion"]
    for stamp_ns, xyz_m, quat in _rows(t_ns, pose):
        yield stamp_ns, form(position=point(*xyz_m), orientation=rotation(*quat))


def _rows(t_ns, pose):
    xyz_m, quat = se3.split_pose(pose)
    return zip(np.asarray(t_ns).tolist(), xyz_m.tolist(), quat.tolist(), strict=True)


def _velocity(t_ns, pose):
    """Mean velocity (n, 3) in the base's frame over the step to each pose: forward, left, turn; zero at the start."""
    step = se3.invert_pose(pose[:-1]) @ pose[1:]
    moved = np.column_stack([step[:, :2, 3], se3.pose_yaw_rad(step)])
    return np.vstack([np.zeros(3), moved / (np.diff(t_ns) / 1e9)[:, None]])
