"""A damaged recording as rosbags would read a sound one: what is whole of it, and what is lost."""

import shutil
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import ExitStack, suppress
from operator import attrgetter
from pathlib import Path

from backports import zstd
from rosbags.interfaces import Connection

from scanplan.errors import StageError
from scanplan.project.yaml_file import read_yaml
from scanplan.recordings.integrity import unpacking
from scanplan.recordings.salvage.found import DAMAGE, FoundMessage, FoundRecords
from scanplan.recordings.salvage.mcap_records import find_mcap_records
from scanplan.recordings.salvage.rosbag1_records import find_rosbag1_records
from scanplan.recordings.salvage.sqlite_records import find_sqlite_records

_FINDERS = {
    ".bag": find_rosbag1_records,
    ".mcap": find_mcap_records,
    ".db3": find_sqlite_records,
}
_ITS_END = "its end"
_PACKED = ".zstd"


class SalvagedReader:
    """What is whole of a recording.

    Attributes
    ----------
    connections : list of rosbags.interfaces.Connection
        Each of one file, with the messages found of it; `owner` is its `FoundRecords`.
    start_time : int
        Of the first message found; the largest int64 if there is none.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.connections: list[Connection] = []
        self.start_time = 2**63 - 1
        self._stack = ExitStack()
        self._files: list[FoundRecords] = []
        self._unreadable: set[tuple[str, int]] = set()

    def __enter__(self) -> "SalvagedReader":
        with ExitStack() as stack:
            for file in _list_storages(self.path):
                found = _find_records(file, stack)
                stack.callback(found.close)
                self._files.append(found)
            self._stack = stack.pop_all()
        for found in self._files:
            counts = Counter(message.connection for message in found.messages)
            self.connections += [
                connection._replace(msgcount=counts[number], owner=found)
                for number, connection in found.connections.items()
            ]
            times = [message.t_ns for message in found.messages]
            self.start_time = min([self.start_time, *times])
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def messages(
        self, connections: Collection[Connection]
    ) -> Iterator[tuple[Connection, int, bytes]]:
        """Iterate over (connection, receive time, content), file after file, by time in each."""
        for found in self._files:
            of_file = {c.id: c for c in connections if c.owner is found}
            wanted = (m for m in found.messages if m.connection in of_file)
            for message in sorted(wanted, key=attrgetter("t_ns")):
                yield of_file[message.connection], message.t_ns, _unpack(found.read(message))

    def note_unreadable(self, topic: str, t_ns: int) -> None:
        """Note that a message, though found, is none of its type."""
        self._unreadable.add((topic, t_ns))

    def describe_loss(self) -> str:
        """Return what is lost, by topic and time, in words; nothing where nothing is."""
        lost = self._count_lost()
        spans = [span for found in self._files for span in self._list_spans(found)]
        if not lost and not spans:
            return ""
        topics = [f"{n:,} of {stated:,} of {topic}" for topic, (n, stated) in sorted(lost.items())]
        # the list of what a recording holds lies at its end
        is_cut = bool(spans) and spans[-1][1] == _ITS_END and not _read_stated_counts(self.path)
        none = "no message is known to be lost"
        if is_cut:
            none = "how many messages are lost is not known"
        counted = f"messages are lost: {', '.join(topics)}" if topics else none
        places = "one place" if len(spans) == 1 else f"{len(spans)} places"
        where = f"; it is damaged at {places}, {spans[0][0]} to {spans[-1][1]}" if spans else ""
        unknown = self._count_unknown()
        nameless = f"; {unknown:,} messages are of topics that are lost" if unknown else ""
        altered = (
            ""
            if all(found.is_checked for found in self._files)
            else "; it has no checksums of its messages, so that one that was hit may be altered"
        )
        return f"{self.path}: from a damaged recording, {counted}{nameless}{where}{altered}"

    def _count_lost(self) -> dict[str, tuple[int, int]]:
        """Return, of the topics with messages lost, their number and that of all."""
        came: Counter[str] = Counter()
        stated: Counter[str] = Counter()
        for connection in self.connections:
            came[connection.topic] += connection.msgcount
            counts: Counter[int] = connection.owner.stated  # type: ignore[attr-defined]
            stated[connection.topic] += counts[connection.id]
        stated |= _read_stated_counts(self.path) | came
        came -= Counter(topic for topic, _ in self._unreadable)
        return {t: (stated[t] - came[t], stated[t]) for t in stated if stated[t] > came[t]}

    def _count_unknown(self) -> int:
        return sum(
            message.connection not in found.connections
            for found in self._files
            for message in found.messages
        )

    def _list_spans(self, found: FoundRecords) -> list[tuple[str, str]]:
        """Return between which seconds of the recording each damage of a file lies, in words."""
        spans = []
        for place in found.breaks:
            before, after = found.messages[:place][-1:], found.messages[place:][:1]
            first = f"from {self._time_in_words(before[0])}" if before else "from its beginning"
            last = self._time_in_words(after[0]) if after else _ITS_END
            spans.append((first, last))
        return spans

    def _time_in_words(self, message: FoundMessage) -> str:
        return f"{(message.t_ns - self.start_time) / 1e9:.1f} s"


def _list_storages(path: Path) -> list[Path]:
    """Return the files that hold the messages of a recording, in their order."""
    if not path.is_dir():
        return [path]
    files = [file for file in path.iterdir() if file.name.removesuffix(_PACKED).endswith(".db3")]
    files += [file for file in path.iterdir() if file.name.removesuffix(_PACKED).endswith(".mcap")]
    if not files:
        raise StageError(f"{path}: no .db3 or .mcap is left of it; copy it again from the robot")
    # run_2 comes before run_10
    return sorted(files, key=lambda file: (len(file.name), file.name))


def find_records(file: Path) -> FoundRecords:
    """Return the records of a .bag, .mcap or .db3 file that are whole."""
    return _FINDERS[file.suffix](file)


def _find_records(file: Path, stack: ExitStack) -> FoundRecords:
    if file.suffix == _PACKED:
        file, is_whole = _unpack_file(file, stack)
    else:
        is_whole = True
    found = find_records(file)
    if not is_whole:
        found.note_gap()
    return found


def _unpack_file(file: Path, stack: ExitStack) -> tuple[Path, bool]:
    """Unpack a file as far as it goes; return where, and whether that is all of it."""
    unpacking.check_room(file.parent)
    target = Path(stack.enter_context(tempfile.TemporaryDirectory()), file.stem)
    with target.open("wb") as unpacked, zstd.open(file, "rb") as packed:
        try:
            shutil.copyfileobj(packed, unpacked)
        except (zstd.ZstdError, EOFError):
            return target, False
    return target, True


def _unpack(content: bytes) -> bytes:
    """Return a message's content, unpacked where it is packed by itself."""
    # what is not packed begins with the two zeros or the zero and one of its encoding
    if content[:4] != unpacking.ZSTD_MAGIC:
        return content
    with suppress(*DAMAGE):
        return unpacking.unpack_bytes(content, form="zstd")
    return b""


def _read_stated_counts(path: Path) -> Counter[str]:
    """Return the messages of each topic that metadata.yaml states; none where it cannot be read."""
    if not (path / "metadata.yaml").is_file():
        return Counter()
    try:
        stated = read_yaml(path / "metadata.yaml")["rosbag2_bagfile_information"]
        topics = stated["topics_with_message_count"]
        return Counter({t["topic_metadata"]["name"]: int(t["message_count"]) for t in topics})
    except (StageError, LookupError, TypeError, ValueError):
        return Counter()
