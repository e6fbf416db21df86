"""ROS 1 bags read record by record, without their index.

A bag has no checksums: a record counts as whole where its fields fill its header, it fits into the
file or its chunk, and no other record begins within a message; a compressed chunk where it unpacks
to the size that it states. Format: wiki.ros.org/Bags/Format/2.0.
"""

import re
import struct
from collections import Counter
from functools import partial
from pathlib import Path
from typing import NamedTuple

from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag1,
    MessageDefinition,
    MessageDefinitionFormat,
)
from rosbags.rosbag1.reader import RecordType
from rosbags.typesys.msg import normalize_msgtype

from scanplan.recordings.salvage.found import (
    DAMAGE,
    Buffer,
    FoundMessage,
    FoundRecords,
    Packed,
    walk_records,
)

_OPCODE_FIELD = re.compile(rb"\x04\0\0\0op=[\x02-\x07]")
_NEEDED = {
    RecordType.MSGDATA: {b"conn": 4, b"time": 8},
    RecordType.BAGHEADER: {b"index_pos": 8},
    RecordType.IDXDATA: {b"conn": 4, b"count": 4},
    RecordType.CHUNK: {b"compression": None, b"size": 4},
    RecordType.CHUNK_INFO: {b"chunk_pos": 8, b"count": 4},
    RecordType.CONNECTION: {b"conn": 4, b"topic": None},
}
"""The fields that a record of each kind has, and their sizes; None: any."""
_BESIDE_CHUNKS = frozenset(RecordType) - {RecordType.MSGDATA, RecordType.CONNECTION}
_TYPE_NAME = re.compile(rb"\w+(/msg)?/\w+")
_MAGIC = b"#ROSBAG V2.0\n"


class _Record(NamedTuple):
    kind: RecordType
    fields: dict[bytes, bytes]
    begin: int
    size: int

    @property
    def end(self) -> int:
        return self.begin + self.size


def find_rosbag1_records(path: Path) -> FoundRecords:
    """Return the records of a ROS 1 bag that are whole."""
    found = FoundRecords(path)
    counts = _Counts(Counter(), Counter())
    _walk(found, counts, found.data, None, len(_MAGIC))
    # a bag whose recorder was stopped in time ends with its index, which counts all
    if found.data[: len(_MAGIC)] != _MAGIC or not counts.of_chunks:
        found.note_gap()
    found.stated = counts.of_chunks | counts.of_indexes
    return found


class _Counts(NamedTuple):
    """Messages by connection: of what the end of the bag says of chunks, of what follows each."""

    of_chunks: Counter[int]
    of_indexes: Counter[int]


def _walk(
    found: FoundRecords, counts: _Counts, data: Buffer, part: Packed | None, begin: int
) -> None:
    take = partial(_take_record, found, counts, data, part)
    walk_records(found, take, partial(_find_record, data), begin, len(data))


def _take_record(
    found: FoundRecords, counts: _Counts, data: Buffer, part: Packed | None, place: int
) -> int:
    """Take a record, and return where the next one begins."""
    record = _read_record(data, place)
    if record.kind is RecordType.CHUNK:
        return _take_chunk(found, counts, record)
    if record.end > len(data):
        raise ValueError(f"a record of {record.size} bytes is cut short")
    if record.kind is RecordType.MSGDATA:
        _take_message(found, data, part, record)
    elif record.kind is RecordType.CONNECTION:
        _take_connection(found, data, record)
    elif record.kind is RecordType.IDXDATA:
        (connection,) = struct.unpack("<I", record.fields[b"conn"])
        (count,) = struct.unpack("<I", record.fields[b"count"])
        if record.size == count * 12:
            counts.of_indexes[connection] += count
            entries = struct.iter_unpack("<III", data[record.begin : record.end])
            listed = {(s * 10**9 + ns, _skip_header(found, place)) for s, ns, place in entries}
            found.keep_listed(connection, listed)
    elif record.kind is RecordType.CHUNK_INFO:
        pairs = struct.iter_unpack("<II", data[record.begin : record.end])
        for connection, count in pairs:
            counts.of_chunks[connection] += count
    return record.end


def _take_chunk(found: FoundRecords, counts: _Counts, chunk: _Record) -> int:
    """Take what a chunk holds; what is not compressed is gone through as part of the file."""
    form = chunk.fields[b"compression"].decode("ascii")
    if form == "none":
        return chunk.begin
    (size,) = struct.unpack("<I", chunk.fields[b"size"])
    part = Packed(chunk.begin, chunk.end, size, form)
    try:
        records = found.unpack(part) if chunk.end <= len(found.data) else b""
        if len(records) != size:
            raise ValueError(f"a chunk of {chunk.size} bytes is cut short")
    except DAMAGE:
        found.note_gap()
        found.last_part = None
        # lz4 leaves what it cannot pack as it was: such messages are not taken for whole ones
        return _find_record(found.data, chunk.begin, kinds=_BESIDE_CHUNKS)
    found.last_part = part
    _walk(found, counts, records, part, 0)
    return chunk.end


def _take_message(found: FoundRecords, data: Buffer, part: Packed | None, record: _Record) -> None:
    # bz2 has checksums of what it packs
    found.is_checked &= part is not None and part.form == "bz2"
    (connection,) = struct.unpack("<I", record.fields[b"conn"])
    seconds, nanoseconds = struct.unpack("<II", record.fields[b"time"])
    if nanoseconds >= 10**9:
        raise ValueError(f"a message was received at {nanoseconds} ns of a second")
    # a stated size that is too large would take what follows for a part of the message
    if not _is_followed(data, record.end) and _find_record(data, record.begin) < record.end:
        raise ValueError(f"another record begins within {record.size} bytes of a message")
    t_ns = seconds * 10**9 + nanoseconds
    found.messages.append(FoundMessage(connection, t_ns, part, ((record.begin, record.size),)))


def _take_connection(found: FoundRecords, data: Buffer, record: _Record) -> None:
    (number,) = struct.unpack("<I", record.fields[b"conn"])
    stated = _read_fields(data, record.begin, record.end)
    topic = record.fields[b"topic"].decode("utf-8")
    if not _TYPE_NAME.fullmatch(stated[b"type"]) or not topic.isprintable():
        raise ValueError("a connection has no name of a type")
    found.connections.setdefault(
        number,
        Connection(
            number,
            topic,
            normalize_msgtype(stated[b"type"].decode("ascii")),
            MessageDefinition(
                MessageDefinitionFormat.MSG,
                stated.get(b"message_definition", b"").decode("utf-8", "replace"),
            ),
            "",
            0,
            ConnectionExtRosbag1(None, None),
            None,
        ),
    )


def _read_record(data: Buffer, place: int) -> _Record:
    """Read the header of the record at a place; its content may reach beyond the data.

    Raises
    ------
    ValueError, struct.error
        If there is none.
    """
    (header_size,) = _unpack_uint32(data, place)
    begin = place + 4
    if begin + header_size + 4 > len(data):
        raise ValueError("a header is cut short")
    fields = _read_fields(data, begin, begin + header_size)
    kind = RecordType(fields[b"op"][0])
    for name, size in _NEEDED[kind].items():
        if name not in fields or size not in (None, len(fields[name])):
            raise ValueError(f"a header has no field {name.decode()}")
    (size,) = _unpack_uint32(data, begin + header_size)
    return _Record(kind, fields, begin + header_size + 4, size)


def _read_fields(data: Buffer, begin: int, end: int) -> dict[bytes, bytes]:
    fields = {}
    while begin < end:
        (size,) = _unpack_uint32(data, begin)
        if size == 0 or begin + 4 + size > end:
            raise ValueError("a field reaches beyond its header")
        name, equals, value = data[begin + 4 : begin + 4 + size].partition(b"=")
        if not equals:
            raise ValueError("a field has no name")
        fields[name] = value
        begin += 4 + size
    return fields


def _unpack_uint32(data: Buffer, place: int) -> tuple[int]:
    if place + 4 > len(data):
        raise ValueError("the data end within a size")
    return struct.unpack_from("<I", data, place)


def _is_followed(data: Buffer, place: int) -> bool:
    """Return whether the data end at a place, or a record begins there."""
    if place == len(data):
        return True
    try:
        _read_record(data, place)
    except (ValueError, LookupError):
        return False
    return True


def _skip_header(found: FoundRecords, place: int) -> int:
    """Return where the content of a message begins whose record in the last part is at a place."""
    if found.last_part is None:
        return place
    data = found.unpack(found.last_part)
    try:
        record = _read_record(data, place)
    except (ValueError, LookupError):
        return -1
    # the description of a connection may stand before its first message
    return _skip_header(found, record.end) if record.kind is RecordType.CONNECTION else record.begin


def _find_record(
    data: Buffer, place: int, kinds: frozenset[RecordType] = frozenset(RecordType)
) -> int:
    """Return where the first record from a place on begins; the end of the data if there is none.

    Its field `op` is searched for; before it in the header lie at most the fields of its kind.
    """
    for mark in _OPCODE_FIELD.finditer(data, place):
        # of a message or a chunk at most 41 bytes stand before it, of a topic's name more
        first = max(place, mark.start() - 64)
        for begin in range(mark.start() - 4, first - 1, -1):
            (header_size,) = _unpack_uint32(data, begin)
            is_header = begin + 4 + header_size >= mark.end() and _is_followed(data, begin)
            if is_header and RecordType(mark[0][-1]) in kinds:
                return begin
    return len(data)
