"""What a recording states of itself, against what of it can be read."""

from __future__ import annotations

from binascii import crc32
from collections import Counter
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rosbags import rosbag1, rosbag2
from rosbags.interfaces import Connection
from rosbags.rosbag1.reader import Header, RecordType
from rosbags.rosbag2.reader import DirectoryReader
from rosbags.rosbag2.storage_mcap import McapReader

if TYPE_CHECKING:
    from rosbags.rosbag2.reader import ReaderProtocol

Reader = rosbag1.Reader | rosbag2.Reader


def count_stated_messages(reader: Reader) -> Counter[str]:
    """Return the messages of each topic that an open recording states to hold.

    ROS 1 bags state it by chunk and list the messages in an index; mcap files by topic, rosbag2
    folders once more in metadata.yaml; databases count. Where two disagree the larger counts.

    Raises
    ------
    ValueError
        If it states more in all than of its topics together: some are not listed.
    """
    stated = Counter({name: topic.msgcount for name, topic in reader.topics.items()})
    if isinstance(reader, rosbag1.Reader):
        return stated | _count_by_topic(reader.connections)
    in_files: Counter[str] = Counter()
    for storage in _storages_of(reader):
        listed = _count_by_topic(storage.connections)
        total = storage.metadata.message_count
        if total > listed.total():
            raise ValueError(f"{total} messages are stated, {listed.total()} of its topics")
        in_files += listed
    return stated | in_files


def count_bytes_behind(reader: Reader) -> int:
    """Return how many bytes of a ROS 1 bag are behind its index, where nobody looks for any."""
    if not isinstance(reader, rosbag1.Reader) or reader.bio is None or not reader.chunk_infos:
        return 0
    reader.bio.seek(0)
    reader.bio.readline()
    index_begin = Header.read(reader.bio, RecordType.BAGHEADER).get_uint64("index_pos")
    reader.bio.seek(index_begin)
    for _ in reader.connections:
        reader.read_connection()
    for _ in reader.chunk_infos:
        reader.read_chunk_info()
    return reader.path.stat().st_size - reader.bio.tell()


def check_checksums(reader: Reader) -> None:
    """Check what rosbags does not: the checksum of each mcap file's summary, where it has one.

    Raises
    ------
    ValueError
        If one does not fit.
    """
    storages = () if isinstance(reader, rosbag1.Reader) else _storages_of(reader)
    for storage in storages:
        if isinstance(storage, McapReader) and storage.bio is not None:
            # the footer is the last record: magic bytes, checksum, place of the summary before it
            storage.bio.seek(-28, 2)
            tail = storage.bio.read()
            summary, checksum = int.from_bytes(tail[:8], "little"), tail[16:20]
            storage.bio.seek(summary)
            covered = storage.bio.read()[:-12]
            if summary and any(checksum) and crc32(covered).to_bytes(4, "little") != checksum:
                raise ValueError(
                    f"the summary of {Path(str(storage.path)).name} does not fit its checksum"
                )


def find_lost_messages(
    came: Mapping[str, int], stated: Mapping[str, int], names: Collection[str]
) -> str | None:
    """Return which topic has fewer messages than the recording states, in words; None if none."""
    for name in sorted(names):
        if came.get(name, 0) < stated.get(name, 0):
            return f"topic {name}: {came.get(name, 0)} of its {stated[name]} messages can be read"
    return None


def _storages_of(reader: rosbag2.Reader) -> list[ReaderProtocol]:
    storage = reader.storage
    return storage.storages if isinstance(storage, DirectoryReader) else [storage]


def _count_by_topic(connections: Collection[Connection]) -> Counter[str]:
    counts: Counter[str] = Counter()
    for connection in connections:
        counts[connection.topic] += connection.msgcount
    return counts
