"""A rover's recording, written as a ROS1 bag or a ROS2 one."""

import heapq
import tempfile
from contextlib import contextmanager
from pathlib import Path

from rosbags import rosbag1, rosbag2
from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.typesys import Stores, get_typestore

from scanplan.lab.simulation.survey_messages import POSE_TOPIC, ROS1_STORE, STATIC_TOPIC
from scanplan.store import atomic

# 2024-01-01 00:00:00 UTC: a recording starts then, so that the same seed gives the same bytes
EPOCH_NS = 1_704_067_200 * 10**9
_LATCHED = (POSE_TOPIC, STATIC_TOPIC)
_ROS2_STORAGE = {".db3": rosbag2.StoragePlugin.SQLITE3, ".mcap": rosbag2.StoragePlugin.MCAP}
_FOREVER = QosTime(2147483647, 4294967295)


def write_survey_bag(path, *streams):
    """Write a recording, whole or not at all.

    ASSUME every message is recorded when it is sent; a real recorder is some milliseconds later.

    Parameters
    ----------
    path : path-like
        A .bag file is written for ROS1; a .db3 or .mcap file for ROS2, one file without the folder and metadata.yaml
        around it.
    *streams : iterable of survey_messages.RosMessage
        Each in the order of its times; merged by them as they come, so that no stream is held in memory.

    Raises
    ------
    ValueError
        If the suffix is another.
    """
    with atomic.replace_file(path) as temporary, _recorder(temporary) as record:
        for message in heapq.merge(*streams, key=lambda message: message.t_ns):
            record(message)


@contextmanager
def _recorder(path):
    if path.suffix == ".bag":
        with rosbag1.Writer(path) as writer:
            yield _Recorder(
                writer,
                ROS1_STORE,
                ROS1_STORE.serialize_ros1,
                lambda latched: {"latching": int(latched)},
            )
    elif path.suffix in _ROS2_STORAGE:
        store = get_typestore(Stores.ROS2_HUMBLE)
        # the writer makes a folder; the file in it is complete without the rest
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".recording") as folder:
            made = Path(folder, "survey")
            with rosbag2.Writer(
                made, version=9, storage_plugin=_ROS2_STORAGE[path.suffix]
            ) as writer:
                yield _Recorder(writer, store, store.serialize_cdr, _quality)
            (made / f"survey{path.suffix}").replace(path)
    else:
        raise ValueError(f"{path}: a recording ends in .bag, .db3 or .mcap")


class _Recorder:
    """Writes messages, each topic's connection made with its first message."""

    def __init__(self, writer, store, serialise, options):
        self._writer, self._store, self._serialise, self._options = (
            writer,
            store,
            serialise,
            options,
        )
        self._connections = {}

    def __call__(self, message):
        if message.topic not in self._connections:
            options = self._options(message.topic in _LATCHED)
            self._connections[message.topic] = self._writer.add_connection(
                message.topic, message.msgtype, typestore=self._store, **options
            )
        raw = self._serialise(message.content, message.msgtype)
        self._writer.write(self._connections[message.topic], message.t_ns, raw)


def _quality(latched):
    """What a ROS2 publisher offers: reliable, and kept for those who subscribe late where a ROS1 one would latch."""
    return {
        "offered_qos_profiles": [
            Qos(
                history=QosHistory.KEEP_LAST,
                depth=1 if latched else 10,
                reliability=QosReliability.RELIABLE,
                durability=QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE,
                deadline=_FOREVER,
                lifespan=_FOREVER,
                liveliness=QosLiveliness.AUTOMATIC,
                liveliness_lease_duration=_FOREVER,
                avoid_ros_namespace_conventions=False,
            )
        ]
    }
