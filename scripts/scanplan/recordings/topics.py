"""Which topics of a recording carry the clouds and the poses: by type, in doubt by the config."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from scanplan.errors import StageError

POINT_CLOUD = "sensor_msgs/msg/PointCloud2"
LASER_SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
MULTI_ECHO = "sensor_msgs/msg/MultiEchoLaserScan"
OLD_POINT_CLOUD = "sensor_msgs/msg/PointCloud"
LIVOX = tuple(
    f"{package}/msg/CustomMsg"
    for package in ("livox_ros_driver", "livox_ros_driver2", "livox_interfaces")
)
LASERS = (LASER_SCAN, MULTI_ECHO)
CLOUDS = (POINT_CLOUD, LASER_SCAN)
DRIVERS_CLOUDS = (MULTI_ECHO, OLD_POINT_CLOUD, *LIVOX)
"""Taken where none of `CLOUDS` has messages: drivers often publish both."""
_MADE_BY = {
    "velodyne_msgs/msg/VelodyneScan": "velodyne_pointcloud",
    "ouster_ros/msg/PacketMsg": "os_cloud of ouster_ros",
    "ouster_sensor_msgs/msg/PacketMsg": "os_cloud of ouster_ros",
    "hesai_ros_driver/msg/UdpFrame": "hesai_ros_driver (source_type 3)",
    "pandar_msgs/msg/PandarScan": "nebula or the Pandar driver",
    "rslidar_msg/msg/RslidarPacket": "rslidar_sdk (msg_source 2)",
    "rslidar_msgs/msg/rslidarScan": "rslidar_sdk (msg_source 2)",
}
"""Drivers' packets, and which node makes clouds of them."""
POSES = ("geometry_msgs/msg/PoseWithCovarianceStamped", "geometry_msgs/msg/PoseStamped", ODOMETRY)
PATH = "nav_msgs/msg/Path"
"""All poses so far in each message; planners' have the same type."""
TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
# what operators and planners send to a robot has the types of what a localiser reports
_COMMANDS = ("initialpose", "goal", "goal_pose", "plan", "global_plan", "local_plan")


@dataclass(frozen=True)
class Topic:
    """A topic's name, message type and number of messages."""

    name: str
    msgtype: str
    count: int

    def __str__(self) -> str:
        return f"{self.name} ({self.msgtype}, {self.count})"


def merge_topics(topics: Iterable[Topic], where: str) -> list[Topic]:
    """Add up the topics of several recordings.

    Parameters
    ----------
    where : str
        What they belong to, for the error.

    Returns
    -------
    list of Topic
        One of each name, sorted.

    Raises
    ------
    StageError
        If one that could be needed has two types.
    """
    merged: dict[str, Topic] = {}
    for topic in topics:
        before = merged.get(topic.name, Topic(topic.name, topic.msgtype, 0))
        msgtypes = {before.msgtype, topic.msgtype}
        if len(msgtypes) > 1 and msgtypes & {*CLOUDS, *DRIVERS_CLOUDS, *POSES, PATH}:
            raise StageError(
                f"{where}: topic {topic.name} is {before.msgtype} here and {topic.msgtype} there;"
                " split the dataset into one folder each"
            )
        merged[topic.name] = Topic(topic.name, before.msgtype, before.count + topic.count)
    return [merged[name] for name in sorted(merged)]


def choose_cloud_topic(topics: Sequence[Topic], wanted: str | None, where: str) -> Topic:
    """Choose the topic of the clouds.

    Parameters
    ----------
    wanted : str or None
        The config's `input.cloud_topic`.
    where : str
        The dataset, for errors.

    Returns
    -------
    Topic

    Raises
    ------
    StageError
        If there is none, more than one and none wanted, or it has no messages.
    """
    of_drivers = [t for t in topics if t.msgtype in DRIVERS_CLOUDS]
    candidates = [t for t in topics if t.msgtype in CLOUDS]
    if wanted or not any(topic.count for topic in candidates):
        candidates += of_drivers
    if wanted:
        return _named(candidates, wanted, where, "input.cloud_topic")
    filled = [t for t in candidates if t.count]
    if not candidates:
        packets = [f"{t}: {_MADE_BY[t.msgtype]}" for t in topics if t.msgtype in _MADE_BY]
        remedy = "record the laser scanner too"
        if packets:
            remedy = (
                f"play it into the node that makes clouds of its packets ({', '.join(packets)}),"
                " and record these"
            )
        raise StageError(
            f"{where}: no cloud topic (PointCloud2, LaserScan, MultiEchoLaserScan, Livox's"
            f" CustomMsg or PointCloud) to make a plan of; topics: {_list(topics)}; {remedy}"
        )
    if not filled:
        raise StageError(
            f"{where}: zero messages on {_list(candidates)}; record again with the sensor running"
        )
    return _only(
        filled,
        where,
        "input.cloud_topic, or give it those of one robot's scanners as a list [A, B]",
    )


def leave_other_robots(topics: Sequence[Topic], cloud: Topic) -> list[Topic]:
    """Return the topics without those of other robots than the one that has a cloud's topic.

    A namespace beside one of the cloud's is another robot's where poses or transforms in both are
    called alike and of one type: /robot2 beside /robot1 for /robot1/points, as both have odom or
    tf. A second scanner has neither.
    """
    placing = (*POSES, PATH, *TRANSFORMS)
    known = {(t.name.lstrip("/"), t.msgtype) for t in topics if t.msgtype in placing}
    own = cloud.name.lstrip("/").split("/")[:-1]
    others = set()
    for topic in topics:
        *above, _ = topic.name.lstrip("/").split("/")
        for depth in range(min(len(above), len(own))):
            if above[depth] == own[depth]:
                continue
            rest = topic.name.lstrip("/").split("/")[depth + 1 :]
            if ("/".join([*own[: depth + 1], *rest]), topic.msgtype) in known:
                others.add("/".join(above[: depth + 1]) + "/")
            break
    return [t for t in topics if not t.name.lstrip("/").startswith(tuple(others))]


def choose_pose_topic(topics: Sequence[Topic], wanted: str | None, where: str) -> Topic | None:
    """Choose the topic of the poses: the first type of `POSES` that occurs, else tf, else a path.

    Parameters and errors are those of `choose_cloud_topic`, with `input.pose_topic`.

    Returns
    -------
    Topic or None
        Of a type of `POSES`, of `TRANSFORMS` if the poses come from tf, or `PATH`; None if no poses
        are recorded.
    """
    tf = [t for t in topics if t.msgtype in TRANSFORMS and not is_static_tf(t)]
    candidates = [t for t in topics if t.msgtype in (*POSES, PATH)] + tf
    if wanted:
        return _named(candidates, wanted, where, "input.pose_topic")
    filled = [t for t in candidates if t.count and _last_part(t) not in _COMMANDS]
    for msgtypes in (*((pose,) for pose in POSES), TRANSFORMS, (PATH,)):
        of_type = [t for t in filled if t.msgtype in msgtypes]
        if of_type:
            return _only(of_type, where, "input.pose_topic")
    return None


def describe_missing_poses(topics: Sequence[Topic], where: str) -> str:
    """Return that a recording has no poses, as the begin of a line on what to do."""
    return (
        f"{where}: no pose topic with messages (PoseWithCovarianceStamped, PoseStamped, Odometry,"
        f" /tf or Path); topics: {_list(topics)}"
    )


def is_static_tf(topic: Topic) -> bool:
    """Return whether a topic of transforms is /tf_static, in whatever namespace."""
    return _last_part(topic) == "tf_static"


def _last_part(topic: Topic) -> str:
    return topic.name.rsplit("/", 1)[-1]


def _named(candidates: Sequence[Topic], wanted: str, where: str, key: str) -> Topic:
    for topic in candidates:
        if topic.name.lstrip("/") == wanted.lstrip("/"):
            if topic.count == 0:
                raise StageError(f"{where}: zero messages on {topic}; set {key} to another topic")
            return topic
    raise StageError(f"{where}: no topic {wanted}; set {key} to one of: {_list(candidates)}")


def _only(candidates: Sequence[Topic], where: str, key: str) -> Topic:
    if len(candidates) > 1:
        raise StageError(
            f"{where}: {len(candidates)} topics come into question: {_list(candidates)};"
            f" choose by {key}"
        )
    return candidates[0]


def _list(topics: Sequence[Topic]) -> str:
    return ", ".join(map(str, topics)) or "none"
