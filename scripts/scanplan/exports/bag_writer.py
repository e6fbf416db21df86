"""Recordings to write: a ROS 1 bag, or one file of a ROS 2 one."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosbags import rosbag1, rosbag2
from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.typesys import Stores

from scanplan.recordings import typestores

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.typesys.store import Typestore

# contents have ROS1's types, which hold all that ROS2's do
ROS1_STORE = typestores.standard_store(Stores.ROS1_NOETIC)
_ROS2_STORE = typestores.standard_store(Stores.ROS2_HUMBLE)
_ROS2_STORAGE = {".db3": rosbag2.StoragePlugin.SQLITE3, ".mcap": rosbag2.StoragePlugin.MCAP}
_FOREVER = QosTime(2147483647, 4294967295)  # rmw's infinite duration


class BagWriter:
    """Writes messages, each topic's connection made with its first message.

    Attributes
    ----------
    ros2 : bool
    """

    def __init__(
        self,
        # the writers of ROS 1 and ROS 2 take connections of their own kinds and share no type
        writer: Any,
        store: "Typestore",
        serialise: Callable[[Any, str], bytes | memoryview],
        *,
        ros2: bool,
    ) -> None:
        self.ros2 = ros2
        self._writer = writer
        self._store = store
        self._serialise = serialise
        self._connections: dict[str, Connection] = {}

    def write_message(
        self, t_ns: int, topic: str, msgtype: str, content: Any, *, is_latched: bool = False
    ) -> None:
        """Write a message, an object with ROS 1's fields, recorded at a time."""
        raw = self._serialise(content, msgtype)
        self.write_raw(t_ns, topic, msgtype, raw, is_latched=is_latched)

    def write_raw(
        self,
        t_ns: int,
        topic: str,
        msgtype: str,
        raw: bytes | memoryview,
        *,
        is_latched: bool = False,
    ) -> None:
        """Write a message that is serialised as this kind of recording has it."""
        if topic not in self._connections:
            options = _ros2_options(is_latched) if self.ros2 else {"latching": int(is_latched)}
            self._connections[topic] = self._writer.add_connection(
                topic, msgtype, typestore=self._store, **options
            )
        self._writer.write(self._connections[topic], t_ns, raw)

    def convert(self, raw: bytes, msgtype: str, *, is_ros2: bool) -> bytes | memoryview:
        """Return a serialised message of a standard type as this kind of recording has it.

        Raises
        ------
        KeyError
            If the type is none of the standard ones.
        """
        if is_ros2 == self.ros2:
            return raw
        if is_ros2:
            return _ROS2_STORE.cdr_to_ros1(raw, msgtype)
        return _ROS2_STORE.ros1_to_cdr(raw, msgtype)


@contextmanager
def open_bag_writer(path: Path) -> Iterator[BagWriter]:
    """Open a recording to write.

    Parameters
    ----------
    path : pathlib.Path
        A .bag file is written for ROS 1; a .db3 or .mcap file for ROS 2, one file without the
        folder and metadata.yaml around it.

    Yields
    ------
    BagWriter

    Raises
    ------
    ValueError
        If the suffix is another.
    """
    if path.suffix == ".bag":
        with rosbag1.Writer(path) as writer:
            yield BagWriter(writer, ROS1_STORE, ROS1_STORE.serialize_ros1, ros2=False)
    elif path.suffix in _ROS2_STORAGE:
        storage = _ROS2_STORAGE[path.suffix]
        # the writer makes a folder; the file in it is complete without the rest
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".recording") as folder:
            bag = Path(folder, "survey")
            newest = rosbag2.Writer.VERSION_LATEST
            with rosbag2.Writer(bag, version=newest, storage_plugin=storage) as writer:
                yield BagWriter(writer, _ROS2_STORE, _ROS2_STORE.serialize_cdr, ros2=True)
            (bag / f"survey{path.suffix}").replace(path)
    else:
        raise ValueError(f"{path}: a recording ends in .bag, .db3 or .mcap")


def _ros2_options(is_latched: bool) -> dict[str, Any]:
    """Return the quality of service that a ROS 2 publisher offers: reliable.

    Messages are kept for late subscribers where a ROS 1 publisher would latch.
    """
    quality = Qos(
        history=QosHistory.KEEP_LAST,
        # ASSUME the depth that ROS 2 publishers take by default
        depth=1 if is_latched else 10,
        reliability=QosReliability.RELIABLE,
        durability=QosDurability.TRANSIENT_LOCAL if is_latched else QosDurability.VOLATILE,
        deadline=_FOREVER,
        lifespan=_FOREVER,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_FOREVER,
        avoid_ros_namespace_conventions=False,
    )
    return {"offered_qos_profiles": [quality]}
