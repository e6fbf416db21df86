"""A drive of eight scans through a hall, recorded, and the messages of recordings read back."""

from pathlib import Path

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from helpers import bag_making
from scanplan.project import dataset_files

N_SCANS = 8
STEP_NS = 100_000_000


def seen_from(place, seed):
    """Points on the walls and the floor of a hall of 6 m by 4 m by 2.5 m."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 1, (3000, 3)) * (6, 4, 2.5)
    side = rng.integers(0, 5, len(points))
    for s, (axis, value) in enumerate([(0, 0), (0, 6), (1, 0), (1, 4), (2, 0)]):
        points[side == s, axis] = value
    return (points - place).astype(np.float32)


def ranges_from(place):
    """Ranges of 720 level beams to the walls of the hall, those of `bag_making.laser_scan`."""
    scan = bag_making.laser_scan(np.zeros(720))
    angle = scan.angle_min + np.arange(720) * scan.angle_increment
    towards = np.column_stack([np.cos(angle), np.sin(angle)])
    with np.errstate(divide="ignore"):
        to_walls = np.where(towards > 0, (6, 4) - place[:2], -place[:2]) / towards
    return to_walls.min(axis=1)


def record(folder, kind, planar=False):
    """A drive of eight scans: AMCL's poses, odometry on /tf, extrinsics on /tf_static."""
    maker = bag_making.Maker(kind)
    entries = [("/tf_static", bag_making.START_NS - 1, maker.transforms(
        (bag_making.START_NS - 1, "base_link", "lidar", (0, 0, 0.5), (0, 0, 0, 1))
    ))]  # fmt: skip
    for i in range(-3, N_SCANS + 3):
        t_ns = bag_making.START_NS + i * STEP_NS
        place = np.array([1 + 0.1 * i, 2, 0])
        odom = (t_ns, "odom", "base_link", tuple(place - 1), (0, 0, 0, 1))
        entries.append(("/tf", t_ns, maker.transforms(odom)))
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, tuple(place))))
        if 0 <= i < N_SCANS and planar:
            scan = maker.laser(t_ns, ranges_from(place), frame="lidar")
            entries.append(("/scan", t_ns + 1, scan))
        elif 0 <= i < N_SCANS:
            cloud = maker.cloud(t_ns, seen_from(place + np.array([0, 0, 0.5]), i))
            entries.append(("/points", t_ns + 1, cloud))
    maker.write(folder / "run", entries)
    return dataset_files.find_files(folder)


def messages_of(path, topic):
    """Read the messages of a topic with the standard types, without the recording's own."""
    store = get_typestore(Stores.ROS1_NOETIC if is_ros1(path) else Stores.ROS2_HUMBLE)
    with AnyReader([Path(path)], default_typestore=store) as reader:
        connections = [c for c in reader.connections if c.topic == topic]
        decode = store.deserialize_ros1 if is_ros1(path) else store.deserialize_cdr
        return [
            (t_ns, decode(raw, connection.msgtype))
            for connection, t_ns, raw in reader.messages(connections)
        ]


def is_ros1(path):
    return str(path).endswith(".bag")
