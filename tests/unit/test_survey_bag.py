"""The recording, read back with rosbags alone."""

import numpy as np
import pytest
from rosbags.rosbag1 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from scanplan.lab.simulation import (
    rover,
    scan_messages,
    sensor_models,
    sensors,
    survey_bag,
    survey_messages,
)
from scanplan.lab.simulation.sweeps import SimulatedScan
from scanplan.recordings import bags

# as ROS noetic itself gives them (rosmsg md5)
MD5 = {
    "sensor_msgs/msg/PointCloud2": "1158d486dd51d683ce2f1be655c3c181",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "953b798c0f514ff060a53a3498ce6246",
    "nav_msgs/msg/Odometry": "cd5e73d190d741a2f92e81eda573aca7",
    "tf2_msgs/msg/TFMessage": "94810edda583a504dfda3829e70d7eec",
}
T_NS = survey_bag.EPOCH_NS + np.array([0, 100_000_000, 200_000_000])
POSES = rover.planar_poses([[1, 2], [1.5, 2], [1.5, 2.5]], [0.0, 0.0, np.pi / 2])
COMMON = sensors.Turning(rate_hz=10.0, sweep=True, min_range_m=0.3, max_range_m=30.0)
LIDAR, LASER = sensor_models.make_vlp16(4, COMMON), sensors.make_laser(5, 180.0, COMMON)


def scan_of(n_returns, shape=(4, 16)):
    """The first rays come back, the i-th from 1 + i metres."""
    i = np.arange(np.prod(shape), dtype=np.float32).reshape(shape)
    return SimulatedScan(np.where(i < n_returns, 1 + i, np.float32(np.nan)), 80 + 0 * i)


SCANS = [scan_of(n) for n in (3, 0, 20)]
TIME_S = np.float32([-0.075, -0.05])


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
    survey_bag.write_survey_bag(
        path,
        scan_messages.encode_scans(T_NS, LIDAR, SCANS),
        survey_messages.encode_mounting(
            T_NS[0] - 20_000_000,
            rover.mount_sensor(height_m=0.4, forward_m=0.1, yaw_deg=90.0),
            "velodyne",
        ),
        survey_messages.encode_localiser_poses(
            T_NS + 30_000_000, POSES, noise_m=0.05, noise_rad=0.02
        ),
        survey_messages.encode_odometry(T_NS + 10_000_000, POSES),
        survey_messages.encode_transforms(
            T_NS + 10_000_000, "map", "odom", POSES, ahead_ns=500_000_000
        ),
    )


def on(messages, topic):
    return [message for connection, _, message in messages if connection.topic == topic]


def test_types_are_those_of_ros_and_maps_are_latched(messages):
    connections = {c.topic: c for c, _, _ in messages}
    assert {c.msgtype: c.digest for c in connections.values()} == MD5
    assert {topic for topic, c in connections.items() if c.ext.latching} == {
        "/amcl_pose",
        "/tf_static",
    }


def test_messages_are_in_order_and_recorded_at_their_stamps(messages):
    stamps = [t for _, t, _ in messages]
    assert len(stamps) == 13 and stamps == sorted(stamps)
    for connection, t_ns, message in messages:
        header = (
            message.transforms[0].header if connection.topic.startswith("/tf") else message.header
        )
        ahead_ns = 500_000_000 if connection.topic == "/tf" else 0
        assert header.stamp.sec * 10**9 + header.stamp.nanosec == t_ns + ahead_ns
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
    for cloud, n in zip(clouds, (3, 0, 20), strict=True):
        assert (cloud.header.frame_id, cloud.height, cloud.width) == ("velodyne", 1, n)
        assert (cloud.point_step, cloud.row_step, len(cloud.data), cloud.is_dense) == (
            22,
            22 * n,
            22 * n,
            True,
        )
        rows = cloud.data.reshape(n, 22)
        xyz_m = LIDAR.direction.reshape(-1, 3)[:n] * (1 + np.arange(n, dtype=np.float32))[:, None]
        np.testing.assert_array_equal(rows[:, :12].copy().view("<f4"), xyz_m)
        assert (rows[:, 12:16].copy().view("<f4") == 80).all()
        np.testing.assert_array_equal(
            rows[:, 16:18].copy().view("<u2")[:, 0], np.tile(LIDAR.ring, 2)[:n]
        )
        np.testing.assert_array_equal(
            rows[:, 18:].copy().view("<f4")[:, 0], np.repeat(TIME_S, 16)[:n]
        )


def test_transforms_are_stamped_ahead_and_recorded_when_sent(messages):
    for message, pose in zip(on(messages, "/tf"), POSES, strict=True):
        (motion,) = message.transforms
        assert (motion.header.frame_id, motion.child_frame_id) == ("map", "odom")
        np.testing.assert_allclose(
            [motion.transform.translation.x, motion.transform.translation.y], pose[:2, 3]
        )


@pytest.mark.parametrize("name", ["scan.bag", "scan.db3", "scan.mcap"])
def test_a_laser_scanner_gives_laser_scans(tmp_path, name):
    survey_bag.write_survey_bag(
        tmp_path / name,
        scan_messages.encode_scans(T_NS, LASER, [scan_of(n, (5, 1)) for n in (5, 0, 2)]),
    )
    with bags.open_bag(tmp_path / name) as bag:
        full, empty, some = (
            bag.decode(connection, raw) for connection, _, raw in bag.messages(["/scan"])
        )
    assert full.header.frame_id == "laser"
    angles = [full.angle_min, full.angle_max, full.angle_increment]
    np.testing.assert_allclose(angles, np.radians([-90, 90, 45]), rtol=1e-6)
    times = [full.time_increment, full.scan_time, full.range_min, full.range_max]
    np.testing.assert_allclose(times, [0.1 / 8, 0.1, 0.3, 30.0], rtol=1e-6)
    np.testing.assert_array_equal(full.ranges, [1, 2, 3, 4, 5])
    assert np.isinf(empty.ranges).all() and not empty.intensities.any()
    np.testing.assert_array_equal(some.ranges, [1, 2, np.inf, np.inf, np.inf])
    assert sorted(tmp_path.iterdir()) == [tmp_path / name]


@pytest.mark.parametrize("name", ["survey.db3", "survey.mcap"])
def test_ros2_recordings_hold_the_same(tmp_path, messages, name):
    write(tmp_path / name)
    with bags.open_bag(tmp_path / name) as bag:
        found = [
            (c.topic, t_ns, bag.decode(c, raw))
            for c, t_ns, raw in bag.messages([t.name for t in bag.topics])
        ]
    assert [(topic, t) for topic, t, _ in found] == [(c.topic, t) for c, t, _ in messages]
    for (topic, _, ros2), (_, _, ros1) in zip(found, messages, strict=True):
        if topic == "/velodyne_points":
            np.testing.assert_array_equal(ros2.data, ros1.data)
    write(tmp_path / f"again_{name}")
    assert (tmp_path / name).read_bytes() == (tmp_path / f"again_{name}").read_bytes()


def test_a_recording_of_another_kind_is_no_recording(tmp_path):
    with pytest.raises(ValueError, match=r"\.bag, \.db3 or \.mcap"):
        write(tmp_path / "survey.zip")
    assert not list(tmp_path.iterdir())


def test_poses_are_amcls(messages):
    for message, pose in zip(on(messages, "/amcl_pose"), POSES, strict=True):
        position, turn = message.pose.pose.position, message.pose.pose.orientation
        assert message.header.frame_id == "map"
        np.testing.assert_allclose([position.x, position.y, position.z], pose[:3, 3])
        np.testing.assert_allclose(
            2 * np.arctan2(turn.z, turn.w), np.arctan2(pose[1, 0], pose[0, 0]), atol=1e-12
        )
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

    broken = SimulatedScan(SCANS[0].range_m, np.zeros(1, np.float32))
    with pytest.raises(IndexError):
        survey_bag.write_survey_bag(
            path, scan_messages.encode_scans(T_NS, LIDAR, [SCANS[0], broken, SCANS[2]])
        )
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]
