"""ROS 1 and ROS 2 bags through rosbags: the messages of chosen topics, every failure told in one line.

Each connection is decoded by the definition it carries itself, so that a bad definition on another topic does not
matter; without one, by the standard definitions of the ROS release.
"""

import tempfile
from contextlib import ExitStack, contextmanager
from pathlib import Path

from rosbags import rosbag1, rosbag2
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.rosbag1.reader import decompressors
from rosbags.serde import SerdeError
from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)

from scanplan.errors import StageError
from scanplan.recordings import rosbag1_messages, topics
from scanplan.recordings.messages import read_header
from scanplan.stage import log

_URI_CHARACTERS = frozenset("#?%")
_IDL_SEPARATOR = "=" * 80 + "\n"


@contextmanager
def open_bag(path, *, ros2_release="humble"):
    """Open one recording.

    Parameters
    ----------
    path : path-like
        A .bag, .db3 or .mcap file, or a rosbag2 folder.
    ros2_release : str
        Whose message definitions hold where a ROS 2 recording carries none.

    Yields
    ------
    Bag

    Raises
    ------
    StageError
        If the recording is damaged or of another kind, or the release is unknown.
    """
    path, store = Path(path), _release_store(ros2_release)
    with ExitStack() as stack:
        with _told(path):
            ros2 = path.suffix != ".bag" or path.is_dir()
            reader = (rosbag2 if ros2 else rosbag1).Reader(_openable(path, stack))
            stack.enter_context(reader)
        yield Bag(path, reader, ros2, store if ros2 else Stores.ROS1_NOETIC)


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

    def __init__(self, path, reader, ros2, default_store):
        self.path = path
        self.ros2 = ros2
        self.start_ns = reader.start_time
        self.topics = [topics.Topic(c.topic, c.msgtype, c.msgcount) for c in reader.connections]
        self._reader = reader
        self._default_store = default_store
        self._typestores = {}

    def messages(self, names):
        """Iterate over the messages of some topics in the order of recording.

        Parameters
        ----------
        names : collection of str

        Yields
        ------
        connection
            With `topic` and `msgtype`; for `decode`.
        receive_ns : int
        raw : bytes or rosbag1_messages.StoredMessage
            For `header` and `decode`; what is given to neither may not even be read.
        """
        connections = [c for c in self._reader.connections if c.topic in names]
        if not connections:  # rosbags takes an empty choice for all
            return
        source = (
            self._plain_messages(connections)
            if self._is_plain()
            else self._reader.messages(connections)
        )
        while True:
            with _told(self.path):
                item = next(source, None)
            if item is None:
                return
            yield item

    def header(self, connection, raw):
        """Return the header stamp and the frame of a message without decoding the rest."""
        with _told(self.path, connection.topic):
            return read_header(
                raw.head if isinstance(raw, rosbag1_messages.StoredMessage) else raw, ros2=self.ros2
            )

    def decode(self, connection, raw):
        """Return a message as an object with the fields of its definition."""
        with _told(self.path, connection.topic):
            store = self._typestore(connection)
            raw = raw.read() if isinstance(raw, rosbag1_messages.StoredMessage) else raw
            return (store.deserialize_cdr if self.ros2 else store.deserialize_ros1)(
                raw, connection.msgtype
            )

    def _is_plain(self):
        return not self.ros2 and all(
            c.decompressor is decompressors["none"] for c in self._reader.chunks.values()
        )

    def _plain_messages(self, connections):
        """What rosbags' own iterator gives, without reading the chunks around."""
        chunks = {position: (c.datapos, c.datasize) for position, c in self._reader.chunks.items()}
        indexes, by_id = self._reader.indexes, {c.id: c for c in connections}
        found = rosbag1_messages.iterate_messages(
            self._reader.bio.fileno(), chunks, [indexes[number] for number in by_id]
        )
        return ((by_id[number], time_ns, stored) for number, time_ns, stored in found)

    def _typestore(self, connection):
        key = (connection.msgtype, connection.msgdef)
        if key not in self._typestores:
            self._typestores[key] = _own_store(connection, self.path) or _standard_store(
                self._default_store
            )
        return self._typestores[key]


def _own_store(connection, path):
    """Return a type store of the connection's own definition, or None where it has none that can be used."""
    definition = connection.msgdef
    if definition.format == MessageDefinitionFormat.NONE or not definition.data.strip():
        return None
    try:
        store = get_typestore(Stores.EMPTY)
        if definition.format == MessageDefinitionFormat.MSG:
            store.register(get_types_from_msg(definition.data, connection.msgtype))
        else:
            for part in filter(None, definition.data.split(_IDL_SEPARATOR)):
                store.register(
                    get_types_from_idl(part.split("\n", 1)[1] if part.startswith("IDL: ") else part)
                )
        store.get_msgdef(connection.msgtype)
    except (TypesysError, KeyError, IndexError, SyntaxError) as error:
        reason = " ".join(str(error).split())[:80]
        log.log_line(
            f"{path}: definition of {connection.topic} unusable ({reason}), the standard one is taken"
        )
        return None
    return store


def _standard_store(store):
    """Return the type store of a release, with the transforms that the one of ROS 1 lacks."""
    typestore = get_typestore(store)
    for msgtype in topics.TRANSFORMS:
        if msgtype not in typestore.fielddefs:
            typestore.register(
                get_types_from_msg("geometry_msgs/TransformStamped[] transforms", msgtype)
            )
    return typestore


def _release_store(release):
    known = [s.value.removeprefix("ros2_") for s in Stores if s.value.startswith("ros2_")]
    if release not in known:
        raise StageError(
            f"input.ros2_release: {release} is unknown; choose one of {', '.join(known)}"
        )
    return Stores(f"ros2_{release}")


def _openable(path, stack):
    """Return a name of the recording that SQLite, which is given an unescaped URI, can open."""
    inside = [file for file in path.iterdir() if ".db3" in file.name] if path.is_dir() else []
    if odd := [file for file in inside if _URI_CHARACTERS & set(file.name)]:
        raise StageError(
            f"{odd[0]}: SQLite cannot open names with #, ? or %; rename it, in metadata.yaml too"
        )
    if not _URI_CHARACTERS & set(str(path)) or path.suffix in (".bag", ".mcap"):
        return path
    link = Path(
        stack.enter_context(tempfile.TemporaryDirectory()),
        f"recording{path.suffix if path.is_file() else ''}",
    )
    link.symlink_to(path.resolve())
    return link


@contextmanager
def _told(path, topic=None):
    """Turn whatever rosbags, SQLite or a decompressor raises on bad data into one line with a remedy."""
    try:
        yield
    except StageError:
        raise
    except Exception as error:
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        where = f"{path}: topic {topic}" if topic else str(path)
        raise StageError(f"{where}: cannot be read ({reason}); {_remedy(path, error)}") from error


def _remedy(path, error):
    reason = str(error)
    if isinstance(error, SerdeError):
        return "the message is damaged, or (ROS 2) set input.ros2_release to the release that recorded it"
    if isinstance(error, KeyError):
        return "it describes a topic in a way that is not known; copy the clouds, poses and tf to a bag of their own"
    if "rofile is not" in reason:
        return "only mcap files of the profile ros2 are read; convert it to a ROS 2 or ROS 1 bag"
    if path.suffix == ".bag":
        return "try `rosbag reindex` on a copy, or copy it again from the robot"
    if path.suffix == ".mcap":
        return "try `mcap recover` on it, or copy it again from the robot"
    return "try `ros2 bag reindex` on the folder or `sqlite3 FILE .recover`, or copy it again from the robot"
