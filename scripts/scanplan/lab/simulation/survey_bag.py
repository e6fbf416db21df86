"""A rover's recording, written as a ROS 1 bag or a ROS 2 one."""

import heapq
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
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

from scanplan.lab.simulation.survey_messages import (
    POSE_TOPIC,
    ROS1_STORE,
    STATIC_TOPIC,
    RosMessage,
)
from scanplan.store import atomic
from scanplan.types import FilePath

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.typesys.store import Typestore

# a recording starts then, so that the same seed gives the same bytes
EPOCH_NS = int(np.datetime64("2024-01-01", "ns").astype(np.int64))
_LATCHED = (POSE_TOPIC, STATIC_TOPIC)
_ROS2_STORAGE = {".db3": rosbag2.StoragePlugin.SQLITE3, ".mcap": rosbag2.StoragePlugin.MCAP}
_QUEUE_DEPTH = 10  # ASSUME the depth that ROS 2 publishers take by default
_FOREVER = QosTime(2147483647, 4294967295)  # rmw's infinite duration


def write_survey_bag(path: FilePath, *streams: Iterable[RosMessage]) -> None:
    """Write a recording, whole or not at all.

    ASSUME every message is recorded when it is sent; a real recorder is some milliseconds later.

    Parameters
    ----------
    path : path-like
        A .bag file is written for ROS 1; a .db3 or .mcap file for ROS 2, one file without the
        folder and metadata.yaml around it.
    *streams : iterable of survey_messages.RosMessage
        Each in the order of its times; merged by them as they come, so that no stream is held in
        memory.

    Raises
    ------
    ValueError
        If the suffix is another.
    """
    with atomic.replace_file(path) as temporary, _open_recorder(temporary) as record:
        for message in heapq.merge(*streams, key=lambda message: message.t_ns):
            record(message)


@contextmanager
def _open_recorder(path: Path) -> Iterator["_Recorder"]:
    if path.suffix == ".bag":
        with rosbag1.Writer(path) as writer:
            yield _Recorder(writer, ROS1_STORE, ROS1_STORE.serialize_ros1, _ros1_options)
    elif path.suffix in _ROS2_STORAGE:
        store = get_typestore(Stores.ROS2_HUMBLE)
        storage = _ROS2_STORAGE[path.suffix]
        # the writer makes a folder; the file in it is complete without the rest
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".recording") as folder:
            bag = Path(folder, "survey")
            newest = rosbag2.Writer.VERSION_LATEST
            with rosbag2.Writer(bag, version=newest, storage_plugin=storage) as writer:
                yield _Recorder(writer, store, store.serialize_cdr, _ros2_options)
            (bag / f"survey{path.suffix}").replace(path)
    else:
        raise ValueError(f"{path}: a recording ends in .bag, .db3 or .mcap")


class _Recorder:
    """Writes messages, each topic's connection made with its first message."""

    def __init__(
        self,
        # the writers of ROS 1 and ROS 2 take connections of their own kinds and share no type
        writer: Any,
        store: "Typestore",
        serialise: Callable[[Any, str], bytes | memoryview],
        options: Callable[[bool], dict[str, Any]],
    ):
        self._writer = writer
        self._store = store
        self._serialise = serialise
        self._options = options
        self._connections: dict[str, Connection] = {}

    def __call__(self, message: RosMessage) -> None:
        if message.topic not in self._connections:
            options = self._options(message.topic in _LATCHED)
            self._connections[message.topic] = self._writer.add_connection(
                message.topic, message.msgtype, typestore=self._store, **options
            )
        raw = self._serialise(message.content, message.msgtype)
        self._writer.write(self._connections[message.topic], message.t_ns, raw)


def _ros1_options(is_latched: bool) -> dict[str, Any]:
    return {"latching": int(is_latched)}


def _ros2_options(is_latched: bool) -> dict[str, Any]:
    """Return the quality of service that a ROS 2 publisher offers: reliable.

    Messages are kept for late subscribers where a ROS 1 publisher would latch.
    """
    quality = Qos(
        history=QosHistory.KEEP_LAST,
        depth=1 if is_latched else _QUEUE_DEPTH,
        reliability=QosReliability.RELIABLE,
        durability=QosDurability.TRANSIENT_LOCAL if is_latched else QosDurability.VOLATILE,
        deadline=_FOREVER,
        lifespan=_FOREVER,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_FOREVER,
        avoid_ros_namespace_conventions=False,
    )
    return {"offered_qos_profiles": [quality]}
