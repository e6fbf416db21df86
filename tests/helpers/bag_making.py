"""ROS bags of every kind, written for tests: messages by a `Maker`, and a small standard survey."""

import sqlite3
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

START_NS = 1_700_000_000 * 10**9
KINDS = (
    "ros1",
    "ros1_bz2",
    "ros1_lz4",
    "sqlite3",
    "sqlite3_bare",
    "sqlite3_message",
    "sqlite3_file",
    "mcap",
    "mcap_zstd",
)
LIVOX_CLOUD = (
    "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
)
LIVOX_POINT = "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\n" + "".join(
    f"uint8 {name}\n" for name in ("reflectivity", "tag", "line")
)
NUMPY_TYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}


class Maker:
    """Messages and bags of one kind.

    `ros1`, `ros1_bz2`, `ros1_lz4` are .bag files; the others rosbag2 folders: `sqlite3_bare`
    carries no message definitions, `_message` and `_file` are compressed by message or by file,
    `mcap_zstd` in chunks.
    """

    def __init__(self, kind="ros1"):
        self.kind = kind
        self.ros2 = not kind.startswith("ros1")
        self.store = get_typestore(Stores.ROS2_HUMBLE if self.ros2 else Stores.ROS1_NOETIC)
        if not self.ros2:
            transforms = "geometry_msgs/TransformStamped[] transforms"
            self.store.register(get_types_from_msg(transforms, "tf2_msgs/msg/TFMessage"))
        for package in ("livox_ros_driver", "livox_ros_driver2"):
            point = f"MSG: {package}/CustomPoint\n{LIVOX_POINT}"
            text = f"{LIVOX_CLOUD}CustomPoint[] points\n{'=' * 80}\n{point}"
            self.store.register(get_types_from_msg(text, f"{package}/msg/CustomMsg"))

    def make(self, msgtype, **fields):
        return self.store.types[msgtype](**fields)

    def stamp(self, t_ns):
        return self.make(
            "builtin_interfaces/msg/Time", sec=int(t_ns // 10**9), nanosec=int(t_ns % 10**9)
        )

    def header(self, t_ns, frame):
        sequence = {} if self.ros2 else {"seq": 0}
        return self.make("std_msgs/msg/Header", **sequence, stamp=self.stamp(t_ns), frame_id=frame)

    def cloud(self, t_ns, xyz_m, frame="lidar", **overrides):
        """A PointCloud2 of float32 x, y, z; `overrides` replace fields of the message."""
        parts = point_cloud2(np.asarray(xyz_m), **overrides)
        parts.fields = [
            self.make("sensor_msgs/msg/PointField", **vars(field)) for field in parts.fields
        ]
        return self.make(
            "sensor_msgs/msg/PointCloud2", header=self.header(t_ns, frame), **vars(parts)
        )

    def laser(self, t_ns, ranges, frame="laser", **overrides):
        return self.make(
            "sensor_msgs/msg/LaserScan",
            header=self.header(t_ns, frame),
            **vars(laser_scan(ranges, **overrides)),
        )

    def multi_echo(self, t_ns, ranges, frame="laser"):
        """A MultiEchoLaserScan of the first echoes given, NaN for none, each with one behind it."""
        echoes = [[] if np.isnan(first) else [first, first + 1.0] for first in ranges]
        values = vars(laser_scan(ranges)) | {
            "ranges": [self._echo(each) for each in echoes],
            "intensities": [],
        }
        msgtype = "sensor_msgs/msg/MultiEchoLaserScan"
        return self.make(msgtype, header=self.header(t_ns, frame), **values)

    def _echo(self, ranges):
        return self.make("sensor_msgs/msg/LaserEcho", echoes=np.array(ranges, np.float32))

    def livox(self, t_ns, xyz_m, offset_ns, package="livox_ros_driver2", frame="lidar"):
        """A CustomMsg of points (n, 3), each so many nanoseconds after the stamp."""
        rows = zip(np.asarray(xyz_m, float).tolist(), map(int, offset_ns), strict=True)
        points = [
            self.make(
                f"{package}/msg/CustomPoint",
                **{"offset_time": ns, "reflectivity": 0, "tag": 0, "line": 0},
                **dict(zip("xyz", xyz, strict=True)),
            )
            for xyz, ns in rows
        ]
        return self.make(
            f"{package}/msg/CustomMsg",
            header=self.header(t_ns, frame),
            timebase=int(t_ns),
            point_num=len(points),
            lidar_id=0,
            rsvd=np.zeros(3, np.uint8),
            points=points,
        )

    def old_cloud(self, t_ns, xyz_m, time_s, frame="lidar"):
        """A PointCloud of points (n, 3) with a channel of times."""
        points = [
            self.make("geometry_msgs/msg/Point32", **dict(zip("xyz", xyz, strict=True)))
            for xyz in np.asarray(xyz_m, float).tolist()
        ]
        times = self.make(
            "sensor_msgs/msg/ChannelFloat32", name="time", values=np.asarray(time_s, np.float32)
        )
        return self.make(
            "sensor_msgs/msg/PointCloud",
            header=self.header(t_ns, frame),
            points=points,
            channels=[times],
        )

    def pose(self, xyz, quat):
        place = self.make(
            "geometry_msgs/msg/Point", **dict(zip("xyz", map(float, xyz), strict=True))
        )
        turn = self.make(
            "geometry_msgs/msg/Quaternion", **dict(zip("xyzw", map(float, quat), strict=True))
        )
        return self.make("geometry_msgs/msg/Pose", position=place, orientation=turn)

    def amcl(self, t_ns, xyz, quat=(0, 0, 0, 1), frame="map"):
        with_covariance = self.make(
            "geometry_msgs/msg/PoseWithCovariance",
            pose=self.pose(xyz, quat),
            covariance=np.zeros(36),
        )
        msgtype = "geometry_msgs/msg/PoseWithCovarianceStamped"
        return self.make(msgtype, header=self.header(t_ns, frame), pose=with_covariance)

    def pose_stamped(self, t_ns, xyz, quat=(0, 0, 0, 1), frame="map"):
        return self.make(
            "geometry_msgs/msg/PoseStamped",
            header=self.header(t_ns, frame),
            pose=self.pose(xyz, quat),
        )

    def odometry(self, t_ns, xyz, quat=(0, 0, 0, 1), frame="odom", child="base_link"):
        zero = self.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        twist = self.make("geometry_msgs/msg/Twist", linear=zero, angular=zero)
        return self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(t_ns, frame),
            child_frame_id=child,
            pose=self.amcl(t_ns, xyz, quat).pose,
            twist=self.make(
                "geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)
            ),
        )

    def path(self, t_ns, poses, frame="camera_init"):
        """A Path of (t_ns, xyz, quat) poses."""
        stamped = [self.pose_stamped(*pose, frame=frame) for pose in poses]
        return self.make("nav_msgs/msg/Path", header=self.header(t_ns, frame), poses=stamped)

    def transforms(self, *items):
        """A TFMessage of (t_ns, parent, child, xyz, quat) items."""
        return self.make(
            "tf2_msgs/msg/TFMessage", transforms=[self._transform(*item) for item in items]
        )

    def text(self, text="hello"):
        return self.make("std_msgs/msg/String", data=text)

    def write(self, path, entries):
        """Write (topic, receive_ns, message) entries.

        `path` without suffix. Returns the recording's path.
        """
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        return (self._write2 if self.ros2 else self._write1)(path, entries)

    def _transform(self, t_ns, parent, child, xyz=(0, 0, 0), quat=(0, 0, 0, 1)):
        return self.make(
            "geometry_msgs/msg/TransformStamped",
            header=self.header(t_ns, parent),
            child_frame_id=child,
            transform=self.make(
                "geometry_msgs/msg/Transform",
                translation=self.make(
                    "geometry_msgs/msg/Vector3", **dict(zip("xyz", map(float, xyz), strict=True))
                ),
                rotation=self.pose((0, 0, 0), quat).orientation,
            ),
        )

    def _write1(self, path, entries):
        path = path.with_name(path.name + ".bag")
        writer = rosbag1.Writer(path)
        if "_" in self.kind:
            writer.set_compression(writer.CompressionFormat[self.kind.split("_")[1].upper()])
        with writer:
            self._fill(writer, entries, self.store.serialize_ros1)
        return path

    def _write2(self, path, entries):
        plugin = (
            rosbag2.StoragePlugin.MCAP
            if self.kind.startswith("mcap")
            else rosbag2.StoragePlugin.SQLITE3
        )
        writer = rosbag2.Writer(path, version=9, storage_plugin=plugin)
        modes = {"sqlite3_message": "MESSAGE", "sqlite3_file": "FILE", "mcap_zstd": "STORAGE"}
        if self.kind in modes:
            writer.set_compression(
                rosbag2.CompressionMode[modes[self.kind]], rosbag2.CompressionFormat.ZSTD
            )
        with writer:
            self._fill(writer, entries, self.store.serialize_cdr)
        if self.kind == "sqlite3_bare":
            for file in path.glob("*.db3"):
                database = sqlite3.connect(file)
                with database:
                    database.execute("DELETE FROM message_definitions")
                database.close()
        return path

    def _fill(self, writer, entries, serialize):
        connections = {}
        for topic, receive_ns, message in entries:
            key = topic, message.__msgtype__
            if key not in connections:
                connections[key] = writer.add_connection(
                    topic, message.__msgtype__, typestore=self.store
                )
            writer.write(connections[key], int(receive_ns), serialize(message, message.__msgtype__))


def point_cloud2(xyz_m, **overrides):
    """The fields of a PointCloud2 of (n, 3) float32 points, or of a structured array."""
    if xyz_m.dtype.names is None:
        points = np.zeros(len(xyz_m), [("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
        points["x"], points["y"], points["z"] = xyz_m.reshape(-1, 3).T
    else:
        points = xyz_m
    height, width = points.shape if points.ndim == 2 else (1, len(points))
    fields = []
    for name in points.dtype.names:
        base, offset = points.dtype.fields[name][:2]
        element, shape = base.subdtype or (base, (1,))
        fields.append(
            SimpleNamespace(
                name=name,
                offset=offset,
                datatype=NUMPY_TYPES[element.str[1:]],
                count=int(np.prod(shape)),
            )
        )
    big = any(points.dtype.fields[name][0].base.byteorder == ">" for name in points.dtype.names)
    values = {
        "height": height,
        "width": width,
        "fields": fields,
        "is_bigendian": big,
        "point_step": points.dtype.itemsize,
        "row_step": width * points.dtype.itemsize,
        "data": np.frombuffer(points.tobytes(), np.uint8),
        "is_dense": True,
    }
    return SimpleNamespace(**(values | overrides))


def laser_scan(ranges, **overrides):
    """The fields of a LaserScan, without header, of beams all around."""
    ranges = np.asarray(ranges, np.float32)
    values = {
        "angle_min": 0.0,
        "angle_max": 2 * np.pi,
        "angle_increment": 2 * np.pi / max(len(ranges), 1),
        "time_increment": 0.0,
        "scan_time": 0.1,
        "range_min": 0.1,
        "range_max": 30.0,
        "ranges": ranges,
        "intensities": np.zeros(0, np.float32),
    }
    return SimpleNamespace(**(values | overrides))


def room_points(n=60):
    """Points on the walls of a 6 m x 4 m x 2 m room, seen from its middle; the same every time."""
    rng = np.random.default_rng(4)
    points = rng.uniform(-1, 1, (n, 3)) * (3, 2, 1)
    points[::2, 0] = np.sign(points[::2, 0]) * 3
    points[1::2, 1] = np.sign(points[1::2, 1]) * 2
    return points.astype(np.float32)


def survey(maker, *, n_scans=10, start_ns=START_NS, first=0, pose_of=None):
    """Entries of a survey: clouds at 10 Hz, poses of AMCL at 20 Hz, 0.1 m a scan along x.

    The poses begin 0.05 s before the first cloud and end 0.05 s after the last.
    """
    pose_of = pose_of or maker.amcl
    entries = []
    for i in range(2 * n_scans + 1):
        t_ns = start_ns + (i - 1) * 50_000_000
        entries.append(("/amcl_pose", t_ns, pose_of(t_ns, (first * 0.1 + (i - 1) * 0.05, 0, 0))))
    for i in range(n_scans):
        t_ns = start_ns + i * 100_000_000
        entries.append(
            (
                "/points",
                t_ns + 1_000_000,
                maker.cloud(t_ns, room_points() + np.float32(i + first) / 100),
            )
        )
    return sorted(entries, key=lambda entry: entry[1])
