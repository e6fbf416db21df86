"""The ROS messages of a rover: those of its localiser, its odometry and its extrinsics."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from scanplan.exports import bag_writer
from scanplan.geometry import se3
from scanplan.lab.simulation.localisation import Belief
from scanplan.types import FloatArray, IntArray

if TYPE_CHECKING:
    from rosbags.typesys.store import Msg, MsgType

POSE_TOPIC = "/amcl_pose"
ODOMETRY_TOPIC = "/odom"
TRANSFORM_TOPIC = "/tf"
STATIC_TOPIC = "/tf_static"
MAP_FRAME = "map"
ODOM_FRAME = "odom"
BASE_FRAME = "base_link"
TYPE = bag_writer.ROS1_STORE.types


@dataclass(frozen=True)
class RosMessage:
    """A message, its topic, and when it is recorded (nanoseconds since the epoch)."""

    t_ns: int
    topic: str
    content: "MsgType"

    @property
    def msgtype(self) -> str:
        """Its ROS type, as in sensor_msgs/msg/PointCloud2."""
        return self.content.__msgtype__


def encode_belief(start_ns: int, belief: Belief, *, localised: bool) -> list[Iterator[RosMessage]]:
    """Encode all that wheels and localiser send over a drive.

    Parameters
    ----------
    start_ns : int
        When the drive starts.
    localised : bool
        Whether there is a localiser.

    Returns
    -------
    list of iterators of RosMessage
        /odom and on /tf odom to base; of a localiser /amcl_pose, and on /tf map to odom.
    """
    ticks_ns = start_ns + belief.t_ns
    wheels = [
        encode_odometry(ticks_ns, belief.odom_from_base),
        encode_transforms(ticks_ns, ODOM_FRAME, BASE_FRAME, belief.odom_from_base),
    ]
    if not localised:
        return wheels
    return [
        encode_localiser_poses(
            ticks_ns[belief.update],
            belief.map_from_base,
            noise_m=belief.deviation_m,
            noise_rad=belief.deviation_rad,
        ),
        *wheels,
        encode_transforms(
            ticks_ns[belief.transform],
            MAP_FRAME,
            ODOM_FRAME,
            belief.map_from_odom,
            ahead_ns=belief.ahead_ns,
        ),
    ]


def encode_localiser_poses(
    t_ns: IntArray, map_from_base: FloatArray, *, noise_m: ArrayLike, noise_rad: ArrayLike
) -> Iterator[RosMessage]:
    """Encode a localiser's poses as `geometry_msgs/PoseWithCovarianceStamped`.

    AMCL fills the covariances of x, y and heading alone.

    Parameters
    ----------
    t_ns : (n,) int64
    map_from_base : (n, 4, 4) float64
    noise_m, noise_rad : float or (n,) float
        Standard deviations that the localiser states.

    Yields
    ------
    RosMessage
    """
    deviation = np.zeros((len(map_from_base), 6))
    deviation[:, :2] = np.reshape(noise_m, (-1, 1))
    deviation[:, 5] = noise_rad
    for seq, (stamp_ns, pose) in enumerate(_encode_poses(t_ns, map_from_base)):
        covariance = np.diag(deviation[seq] ** 2).ravel()
        content = TYPE["geometry_msgs/msg/PoseWithCovarianceStamped"](
            header=make_header(seq, stamp_ns, MAP_FRAME),
            pose=TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=covariance),
        )
        yield RosMessage(stamp_ns, POSE_TOPIC, content)


def encode_odometry(t_ns: IntArray, odom_from_base: FloatArray) -> Iterator[RosMessage]:
    """Encode wheel odometry as `nav_msgs/Odometry`.

    The velocity is the mean since the message before.

    Parameters
    ----------
    t_ns : (n,) int64
    odom_from_base : (n, 4, 4) float64

    Yields
    ------
    RosMessage
    """
    vector = TYPE["geometry_msgs/msg/Vector3"]
    unknown = np.zeros(36)  # the 6 x 6 covariance of a driver that states none
    velocity = _velocity(np.asarray(t_ns), odom_from_base).tolist()
    for seq, (stamp_ns, pose) in enumerate(_encode_poses(t_ns, odom_from_base)):
        forward, left, turn = velocity[seq]
        twist = TYPE["geometry_msgs/msg/Twist"](
            linear=vector(forward, left, 0.0), angular=vector(0.0, 0.0, turn)
        )
        content = TYPE["nav_msgs/msg/Odometry"](
            header=make_header(seq, stamp_ns, ODOM_FRAME),
            child_frame_id=BASE_FRAME,
            pose=TYPE["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=unknown),
            twist=TYPE["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=unknown),
        )
        yield RosMessage(stamp_ns, ODOMETRY_TOPIC, content)


def encode_transforms(
    t_ns: IntArray,
    parent: str,
    child: str,
    parent_from_child: FloatArray,
    *,
    ahead_ns: int = 0,
    topic: str = TRANSFORM_TOPIC,
) -> Iterator[RosMessage]:
    """Encode transforms as `tf2_msgs/TFMessage`, one a message.

    Parameters
    ----------
    t_ns : (n,) int64
        When each is sent.
    parent, child : str
        Frames.
    parent_from_child : (n, 4, 4) float64
    ahead_ns : int
        How much later than its sending each is stamped, as AMCL stamps map to odom by its
        transform_tolerance.

    Yields
    ------
    RosMessage
    """
    vector = TYPE["geometry_msgs/msg/Vector3"]
    quaternion = TYPE["geometry_msgs/msg/Quaternion"]
    for sent_ns, xyz_m, quat in _pose_rows(t_ns, parent_from_child):
        transform = TYPE["geometry_msgs/msg/Transform"](
            translation=vector(*xyz_m), rotation=quaternion(*quat)
        )
        stamped: Msg = TYPE["geometry_msgs/msg/TransformStamped"](
            header=make_header(0, sent_ns + ahead_ns, parent),
            child_frame_id=child,
            transform=transform,
        )
        yield RosMessage(sent_ns, topic, TYPE["tf2_msgs/msg/TFMessage"](transforms=[stamped]))


def encode_mounting(
    t_ns: int, base_from_sensor: FloatArray, sensor_frame: str
) -> Iterator[RosMessage]:
    """Encode the sensor's extrinsics as the one message of /tf_static."""
    return encode_transforms(
        np.array([t_ns]), BASE_FRAME, sensor_frame, base_from_sensor[None], topic=STATIC_TOPIC
    )


def make_header(seq: int, stamp_ns: int, frame_id: str) -> "MsgType":
    """Return a `std_msgs/Header`."""
    stamp = TYPE["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return TYPE["std_msgs/msg/Header"](seq=seq, stamp=stamp, frame_id=frame_id)


def _encode_poses(t_ns: IntArray, poses: FloatArray) -> Iterator[tuple[int, "MsgType"]]:
    """Yield stamps with poses as `geometry_msgs/Pose`."""
    point = TYPE["geometry_msgs/msg/Point"]
    quaternion = TYPE["geometry_msgs/msg/Quaternion"]
    for stamp_ns, xyz_m, quat in _pose_rows(t_ns, poses):
        yield (
            stamp_ns,
            TYPE["geometry_msgs/msg/Pose"](position=point(*xyz_m), orientation=quaternion(*quat)),
        )


def _pose_rows(t_ns: IntArray, poses: FloatArray) -> Iterator[tuple[int, list[float], list[float]]]:
    """Return stamps, positions and quaternions as Python's own numbers, a pose a row."""
    xyz_m, quat = se3.split_pose(poses)
    return zip(np.asarray(t_ns).tolist(), xyz_m.tolist(), quat.tolist(), strict=True)


def _velocity(t_ns: IntArray, poses: FloatArray) -> FloatArray:
    """Return the mean velocity (n, 3) over the step to each pose, zero at the start.

    Forward, left and turn, in the base's frame.
    """
    step = se3.invert_pose(poses[:-1]) @ poses[1:]
    moved = np.column_stack([step[:, :2, 3], se3.pose_yaw_rad(step)])
    return np.vstack([np.zeros(3), moved / (np.diff(t_ns) / 1e9)[:, None]])
