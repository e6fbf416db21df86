"""ROS 1 and ROS 2 bags through rosbags: messages of chosen topics, every failure in one line.

Each connection is decoded by the definition it carries itself, so that a bad definition on another
topic does not matter; without one, by the standard definitions of the ROS release.
"""

import errno
import tempfile
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from rosbags import rosbag1, rosbag2
from rosbags.interfaces import Connection
from rosbags.rosbag1.reader import decompressors
from rosbags.serde import SerdeError
from rosbags.typesys import Stores
from rosbags.typesys.store import Typestore

from scanplan.errors import StageError
from scanplan.recordings import topics, typestores
from scanplan.recordings.integrity import fault_words, file_kind, stated_counts, unpacking
from scanplan.recordings.messages import read_header
from scanplan.recordings.rosbag1_messages import StoredMessage, iterate_messages
from scanplan.recordings.salvage.salvaged_reader import SalvagedReader
from scanplan.store import sqlite_paths
from scanplan.types import FilePath

RawMessage = bytes | StoredMessage
BagMessage = tuple[Connection, int, RawMessage]
"""A message's connection, its time of receipt in nanoseconds, and its content, not decoded."""

_FIRST_LINE_BYTES = 64
SoundReader = rosbag1.Reader | rosbag2.Reader
"""What reads a recording that has to be whole."""

_URI_CHARACTERS = frozenset("#?%")


@contextmanager
def open_bag(
    path: FilePath, *, ros2_release: str = "humble", salvage: bool = False
) -> Iterator["Bag"]:
    """Open one recording.

    Parameters
    ----------
    path : path-like
        A .bag, .db3 or .mcap file, or a rosbag2 folder.
    ros2_release : str
        Whose message definitions hold where a ROS 2 recording carries none.
    salvage : bool
        Whether to read what is whole of a damaged recording, message by message.

    Yields
    ------
    Bag

    Raises
    ------
    StageError
        If the recording is damaged or of another kind, or the release is unknown.
    """
    path = Path(path)
    store = typestores.release_store(ros2_release)
    is_ros2 = path.suffix != ".bag" or path.is_dir()
    with ExitStack() as stack:
        with _explain_faults(path, part=fault_words.INDEX):
            file_kind.check_kind(path)
            reader = SalvagedReader(path) if salvage else _choose_reader(path, is_ros2, stack)
            stack.enter_context(reader)
            bag = Bag(path, reader, store if is_ros2 else Stores.ROS1_NOETIC, ros2=is_ros2)
        yield bag


def _choose_reader(path: Path, is_ros2: bool, stack: ExitStack) -> SoundReader:
    """Return rosbags' reader of a recording, not opened."""
    place = _openable_name(path, stack)
    if path.is_dir():
        unpacking.check_room(path)
    if is_ros2:
        return rosbag2.Reader(place)
    with path.open("rb") as file:
        # rosbags looks for the end of the first line, however far off
        if b"\n" not in file.read(_FIRST_LINE_BYTES):
            raise ValueError("does not begin as a ROS 1 bag does")
    return rosbag1.Reader(place)


class Bag:
    """An open recording.

    Attributes
    ----------
    path : pathlib.Path
    ros2 : bool
    start_ns : int
        Receive time of the first message; the largest int64 if there is none.
    topics : list of Topic
        One entry per connection.
    """

    def __init__(
        self, path: Path, reader: SoundReader | SalvagedReader, default_store: Stores, *, ros2: bool
    ) -> None:
        self.path = path
        self.ros2 = ros2
        self.start_ns = reader.start_time
        self.topics = [topics.Topic(c.topic, c.msgtype, c.msgcount) for c in reader.connections]
        self._reader = reader
        self._default_store = default_store
        self._typestores: dict[tuple[str, Any], Typestore] = {}
        self._typestore_of: dict[int, tuple[Connection, Typestore]] = {}
        self._unpack: Callable[[bytes], bytes] | None = None
        self._stated: Mapping[str, int] = {}
        self._n_behind = 0
        if not isinstance(reader, SalvagedReader):
            self._unpack = unpacking.limit_unpacking(reader)
            stated_counts.check_checksums(reader)
            self._n_behind = stated_counts.count_bytes_behind(reader)
            self._stated = stated_counts.count_stated_messages(reader)

    def messages(self, names: Collection[str], *, n_unread: int = 0) -> Iterator[BagMessage]:
        """Iterate over the messages of some topics in the order of recording.

        Parameters
        ----------
        n_unread : int
            So many at the beginning are only counted: where an index tells them, they come as no
            bytes.

        Yields
        ------
        connection
            With `topic` and `msgtype`; for `decode`.
        receive_ns : int
        raw : bytes or rosbag1_messages.StoredMessage
            For `header` and `decode`; what is given to neither may not even be read.

        Raises
        ------
        StageError
            If a message cannot be read, or, at the end, fewer came than the recording states.
        """
        connections = [c for c in self._reader.connections if c.topic in names]
        if not connections:  # rosbags takes an empty choice for all
            return
        came: Counter[str] = Counter()
        # what its reader does with a message is not raised in here
        with _explain_faults(self.path):
            for item in self._iterate(connections, n_unread):
                came[item[0].topic] += 1
                yield item
        if fault := stated_counts.find_lost_messages(came, self._stated, names):
            raise StageError(f"{self.path}: {fault}; {_remedy_of_storage(self.path)}")

    def describe_loss(self) -> str:
        """Return what of a salvaged recording is lost, or lies behind the end of another.

        Messages that are none of their type count once they were iterated over.
        """
        reader = self._reader
        if isinstance(reader, SalvagedReader):
            return reader.describe_loss()
        if self._n_behind <= 0:
            return ""
        return (
            f"{self.path}: {self._n_behind:,} bytes behind the index of this bag are not read; if"
            " they are another bag make each a file of its own, else write it again"
        )

    def header(self, connection: Connection, raw: RawMessage) -> tuple[int, str]:
        """Return the header stamp and the frame of a message without decoding the rest."""
        with _explain_faults(self.path, connection.topic):
            head = raw.head if isinstance(raw, StoredMessage) else raw
            return read_header(head, ros2=self.ros2)

    def decode(self, connection: Connection, raw: RawMessage) -> Any:
        """Return a message as an object with the fields of its definition."""
        with _explain_faults(self.path, connection.topic):
            store = self._typestore(connection)
            data = raw.read() if isinstance(raw, StoredMessage) else raw
            deserialize = store.deserialize_cdr if self.ros2 else store.deserialize_ros1
            return deserialize(data, connection.msgtype)

    def _iterate(self, connections: list[Connection], n_unread: int) -> Iterator[BagMessage]:
        reader = self._reader
        if isinstance(reader, SalvagedReader):
            return self._iterate_salvaged(reader, connections)
        if isinstance(reader, rosbag1.Reader) and is_uncompressed(reader):
            return _iterate_uncompressed(reader, connections, n_unread)
        if self._unpack is None:
            return reader.messages(connections)
        unpack = self._unpack
        return ((c, time_ns, unpack(raw)) for c, time_ns, raw in reader.messages(connections))

    def _iterate_salvaged(
        self, reader: SalvagedReader, connections: list[Connection]
    ) -> Iterator[BagMessage]:
        """Iterate over the messages that can be decoded; without checksums that alone is told."""
        for connection, time_ns, raw in reader.messages(connections):
            try:
                self.decode(connection, raw)
            except StageError:
                reader.note_unreadable(connection.topic, time_ns)
            else:
                yield connection, time_ns, raw

    def _typestore(self, connection: Connection) -> Typestore:
        # a definition of some kilobytes takes longer to look up than a message to decode
        known, store = self._typestore_of.get(connection.id, (None, None))
        if known is connection and store is not None:
            return store
        key = (connection.msgtype, connection.msgdef)
        if key not in self._typestores:
            own = typestores.own_store(connection, self.path)
            self._typestores[key] = own or typestores.standard_store(self._default_store)
        self._typestore_of[connection.id] = connection, self._typestores[key]
        return self._typestores[key]


def is_uncompressed(reader: rosbag1.Reader) -> bool:
    """Return whether the messages of a ROS 1 bag can be read one by one from its file."""
    return all(c.decompressor is decompressors["none"] for c in reader.chunks.values())


def _iterate_uncompressed(
    reader: rosbag1.Reader, connections: list[Connection], n_unread: int
) -> Iterator[BagMessage]:
    """Iterate like rosbags' own reader, without reading the chunks around the messages."""
    if reader.bio is None:
        raise ValueError(f"{reader.path}: is not open")
    chunks = {position: (c.datapos, c.datasize) for position, c in reader.chunks.items()}
    by_id = {connection.id: connection for connection in connections}
    indexes = {number: reader.indexes[number] for number in by_id}
    messages = iterate_messages(reader.bio.fileno(), chunks, indexes, n_unread)
    return ((by_id[number], time_ns, stored) for number, time_ns, stored in messages)


def _openable_name(path: Path, stack: ExitStack) -> Path:
    """Return a name of the recording that SQLite, which is given an unescaped URI, can open."""
    databases = [file for file in path.iterdir() if ".db3" in file.name] if path.is_dir() else []
    for file in databases:
        if _URI_CHARACTERS & set(file.name):
            raise StageError(
                f"{file}: SQLite cannot open names with #, ? or %; rename it, in metadata.yaml too"
            )
    for file in [path] if path.suffix == ".db3" else databases:
        sqlite_paths.check_sqlite_path(file, "move the recording")
    if not _URI_CHARACTERS & set(str(path)) or path.suffix in (".bag", ".mcap"):
        return path
    folder = stack.enter_context(tempfile.TemporaryDirectory())
    link = Path(folder, f"recording{path.suffix if path.is_file() else ''}")
    link.symlink_to(path.resolve())
    return link


class _explain_faults:  # noqa: N801 -- a context like those of functions, entered for every message
    """Turn whatever rosbags, SQLite or a decompressor raises on bad data into one line."""

    __slots__ = ("_part", "_path", "_topic")

    def __init__(
        self, path: Path, topic: str | None = None, *, part: str = fault_words.MESSAGES
    ) -> None:
        self._path = path
        self._topic = topic
        self._part = part

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if not isinstance(error, Exception) or isinstance(error, StageError):
            return
        reason = fault_words.describe_fault(self._path, error, self._part)
        where = f"{self._path}: topic {self._topic}" if self._topic else str(self._path)
        remedy = _remedy(self._path, error)
        raise StageError(f"{where}: cannot be read ({reason}); {remedy}") from error


def _remedy(path: Path, error: Exception) -> str:
    if not path.exists():
        return "put it back; the same command goes on from here"
    if isinstance(error, SerdeError):
        return (
            "the message is damaged, or (ROS 2) set input.ros2_release to the release that"
            " recorded it"
        )
    if isinstance(error, KeyError) and path.suffix != ".bag":
        return (
            "it describes a topic in a way that is not known;"
            " copy the clouds, poses and tf to a bag of their own"
        )
    if "rofile is not" in str(error):
        return "only mcap files of the profile ros2 are read; convert it to a ROS 2 or ROS 1 bag"
    if isinstance(error, OSError) and error.errno == errno.ENOSPC:
        return (
            f"make room in {tempfile.gettempdir()}, or set TMPDIR to a folder with more; it is"
            " unpacked there"
        )
    return _remedy_of_storage(path)


def _remedy_of_storage(path: Path) -> str:
    files = [path, *path.iterdir()] if path.is_dir() else [path]
    if path.suffix == ".bag":
        tool = "`rosbag reindex` on a copy"
    elif any(".mcap" in file.suffixes for file in files):
        tool = "`mcap recover` on it"
    else:
        tool = "`ros2 bag reindex` on the folder or `sqlite3 FILE .recover`"
    return (
        f"try {tool}, or copy it again from the robot, or set input.salvage: true to read what is"
        " whole of it"
    )
