"""The bag, read back with rosbags alone."""

import dataclasses

import numpy as np
import pytest
from rosbags.rosbag1 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from scanplan import rover, surveybag
from scanplan.raycast import Returns

# as ROS noetic itself gives them (rosmsg md5)
MD5 = {
    "sensor_msgs/msg/PointCloud2": "1158d486dd51d683ce2f1be655c3c181",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "953b798c0f514ff060a53a3498ce6246",
    "nav_msgs/msg/Odometry": "cd5e73d190d741a2f92e81eda573aca7",
    "tf2_msgs/msg/TFMessage": "94810edda583a504dfda3829e70d7eec",
}
T_NS = surveybag.EPOCH_NS + np.array([0, 100_000_000, 200_000_000])
POSES = rover.planar_poses([[1, 2], [1.5, 2], [1.5, 2.5]], [0.0, 0.0, np.pi / 2])
SCANS = [
    Returns(np.full((n, 3), [1.5, -2.25, 0.125], np.float32), np.full(n, 80, np.float32), np.arange(n, dtype=np.uint16))
    for n in (3, 0, 5)
]


@pytest.fixture(scope="module")
def messages(tmp_path_factory):
    path = tmp_path_factory.mktemp("bag") / "survey.bag"
    write(path)
    with Reader(path) as reader:
        store = get_typestore(Stores.ROS1_NOETIC)
        for connection in reader.connections:
            store.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
        return [(c, t, store.deserialize_ros1(raw, c.msgtype)) for c, t, raw in reader.messages()]


def write(path):
    surveybag.write(
        path,
        surveybag.clouds(T_NS, SCANS),
        surveybag.mounting(T_NS[0] - 20_000_000, rover.planar_poses([[0.1, 0]], [np.pi / 2], 0.4)[0]),
        surveybag.localiser_poses(T_NS + 30_000_000, POSES, noise_m=0.05, noise_rad=0.02),
        surveybag.odometry(T_NS + 10_000_000, POSES),
    )


def on(messages, topic):
    return [message for connection, _, message in messages if connection.topic == topic]


def test_types_are_those_of_ros_and_maps_are_latched(messages):
    connections = {c.topic: c for c, _, _ in messages}
    assert {c.msgtype: c.digest for c in connections.values()} == MD5
    assert {topic for topic, c in connections.items() if c.ext.latching} == {"/amcl_pose", "/tf_static"}


def test_messages_are_in_order_and_recorded_at_their_stamps(messages):
    stamps = [t for _, t, _ in messages]
    assert len(stamps) == 10 and stamps == sorted(stamps)
    for connection, t_ns, message in messages:
        header = message.transforms[0].header if connection.topic == "/tf_static" else message.header
        assert header.stamp.sec * 10**9 + header.stamp.nanosec == t_ns
    assert [m.header.seq for m in on(messages, "/velodyne_points")] == [0, 1, 2]


def test_clouds_are_a_velodyne_drivers(messages):
    clouds = on(messages, "/velodyne_points")
    layout = [(f.name, f.offset, f.datatype, f.count) for f in clouds[0].fields]
    assert layout == [
        ("x", 0, 7, 1),
        ("y", 4, 7, 1),
        ("z", 8, 7, 1),
        ("intensity", 12, 7, 1),
        ("ring", 16, 4, 1),
        ("time", 18, 7, 1),
    ]
    for cloud, scan in zip(clouds, SCANS, strict=True):
        n = len(scan.ring)
        assert (cloud.header.frame_id, cloud.height, cloud.width) == ("velodyne", 1, n)
        assert (cloud.point_step, cloud.row_step, len(cloud.data), cloud.is_dense) == (22, 22 * n, 22 * n, True)
        rows = cloud.data.reshape(n, 22)
        np.testing.assert_array_equal(rows[:, :12].copy().view("<f4"), scan.xyz_m)
        np.testing.assert_array_equal(rows[:, 12:16].copy().view("<f4")[:, 0], scan.intensity)
        np.testing.assert_array_equal(rows[:, 16:18].copy().view("<u2")[:, 0], scan.ring)
        assert not rows[:, 18:].any()


def test_poses_are_amcls(messages):
    for message, pose in zip(on(messages, "/amcl_pose"), POSES, strict=True):
        position, turn = message.pose.pose.position, message.pose.pose.orientation
        assert message.header.frame_id == "map"
        np.testing.assert_allclose([position.x, position.y, position.z], pose[:3, 3])
        np.testing.assert_allclose(2 * np.arctan2(turn.z, turn.w), np.arctan2(pose[1, 0], pose[0, 0]), atol=1e-12)
        covariance = message.pose.covariance.reshape(6, 6)
        np.testing.assert_allclose(covariance, np.diag([0.0025, 0.0025, 0, 0, 0, 0.0004]))


def test_odometry_has_its_velocity(messages):
    first, second, third = on(messages, "/odom")
    assert (first.header.frame_id, first.child_frame_id) == ("odom", "base_link")
    assert (first.twist.twist.linear.x, second.twist.twist.linear.x) == (0, pytest.approx(5.0))
    assert third.twist.twist.angular.z == pytest.approx(np.pi / 2 / 0.1)


def test_the_mount_is_told_once(messages):
    (message,) = on(messages, "/tf_static")
    (mount,) = message.transforms
    shift, turn = mount.transform.translation, mount.transform.rotation
    assert (mount.header.frame_id, mount.child_frame_id) == ("base_link", "velodyne")
    np.testing.assert_allclose([shift.x, shift.y, shift.z], [0.1, 0, 0.4])
    np.testing.assert_allclose([turn.x, turn.y, turn.z, turn.w], [0, 0, np.sqrt(0.5), np.sqrt(0.5)])


def test_bag_is_replaced_whole_or_left_alone(tmp_path):
    path = tmp_path / "survey.bag"
    write(path)
    before = path.read_bytes()
    write(path)
    assert path.read_bytes() == before

    broken = dataclasses.replace(SCANS[0], intensity=np.zeros(99, np.float32))
    with pytest.raises(ValueError, match="broadcast"):
        surveybag.write(path, surveybag.clouds(T_NS, [SCANS[0], broken, SCANS[2]]))
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]
