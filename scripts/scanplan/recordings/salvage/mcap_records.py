"""mcap files read record by record, without their summary.

A chunk counts as whole where it fits its checksum; one without (checksums are optional), and
messages outside of chunks, where sizes fit and records follow one another. Format: mcap.dev/spec.
"""

import re
import struct
from binascii import crc32
from collections import Counter
from collections.abc import Container
from enum import IntEnum
from functools import partial
from pathlib import Path

from rosbags.interfaces import Connection, ConnectionExtRosbag2
from rosbags.rosbag2 import storage_mcap

from scanplan.recordings.salvage.found import (
    DAMAGE,
    Buffer,
    FoundMessage,
    FoundRecords,
    Packed,
    walk_records,
)

_MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")
_MESSAGE_HEAD = struct.Struct("<HIQQ")
_CHUNK_HEAD = struct.Struct("<QQQII")
# an opcode, and a size below 2^40: the first bytes of a chunk, a channel, a schema or a message
_LIKELY_RECORD = re.compile(rb"[\x03-\x06].{5}\0\0\0", re.DOTALL)
_FORMS = (b"", b"lz4", b"zstd")


def find_mcap_records(path: Path) -> FoundRecords:
    """Return the records of an mcap file that are whole.

    Raises
    ------
    ValueError
        If its profile is not ros2.
    """
    found = FoundRecords(path)
    reading = _Reading(found)
    data = found.data
    reading.walk(data, None, len(_MAGIC))
    if data[: len(_MAGIC)] != _MAGIC or data[-len(_MAGIC) :] != _MAGIC or not reading.has_footer:
        found.note_gap()
    found.connections = reading.describe_channels()
    found.stated = reading.stated | reading.listed
    return found


class _Opcode(IntEnum):
    """What a record is; those that no message depends on are not named."""

    HEADER = 0x01
    FOOTER = 0x02
    SCHEMA = 0x03
    CHANNEL = 0x04
    MESSAGE = 0x05
    CHUNK = 0x06
    MESSAGE_INDEX = 0x07
    STATISTICS = 0x0B
    DATA_END = 0x0F


_OPCODES = range(_Opcode.HEADER, _Opcode.DATA_END + 1)


class _Reading:
    """What is gathered while a file is gone through."""

    def __init__(self, found: FoundRecords) -> None:
        self.found = found
        self.has_footer = False
        self.stated: Counter[int] = Counter()
        self.listed: Counter[int] = Counter()
        self._checked_to = 0
        self._schemas: dict[int, storage_mcap.Schema] = {}
        self._channels: dict[int, tuple[int, str, str, bytes]] = {}

    def walk(self, data: Buffer, part: Packed | None, begin: int) -> None:
        """Take the records of a file, or those of a chunk."""
        end = len(data)
        take = partial(self._take_record, data, part, end)
        walk_records(self.found, take, partial(_find_record, data, end=end), begin, end)

    def describe_channels(self) -> dict[int, Connection]:
        """Return the channels as connections, those with a schema that was not found left out."""
        return {
            number: Connection(
                number,
                topic,
                self._schemas[schema].name,
                storage_mcap.get_msgdef(self._schemas[schema]),
                "",
                0,
                ConnectionExtRosbag2(encoding, []),
                None,
            )
            for number, (schema, topic, encoding, _) in self._channels.items()
            if schema in self._schemas and self._schemas[schema].encoding in ("ros2msg", "ros2idl")
        }

    def _take_record(self, data: Buffer, part: Packed | None, end: int, place: int) -> int:
        """Take a record, and return where the next one begins."""
        if part is None and place == end - len(_MAGIC) and data[place:end] == _MAGIC:
            return end
        opcode, begin, size = _read_head(data, place)
        after = begin + size
        if opcode == _Opcode.CHUNK:
            return self._take_chunk(data, begin, size)
        if after > end:
            raise ValueError(f"a record of {size} bytes is cut short")
        if opcode == _Opcode.MESSAGE:
            self._take_message(data, part, end, begin, size)
        elif opcode in (_Opcode.SCHEMA, _Opcode.CHANNEL):
            self._take_description(opcode, data[begin:after])
        elif opcode == _Opcode.MESSAGE_INDEX:
            channel, length = struct.unpack_from("<HI", data, begin)
            _require(size == 6 + length and length % 16 == 0, "an index of messages")
            self.listed[channel] += length // 16
            listed = struct.iter_unpack("<QQ", data[begin + 6 : after])
            heads = _HEAD.size + _MESSAGE_HEAD.size
            self.found.keep_listed(channel, {(t_ns, place + heads) for t_ns, place in listed})
        elif opcode == _Opcode.STATISTICS:
            self.stated |= _read_statistics(data[begin:after])
        elif opcode == _Opcode.HEADER:
            (length,) = struct.unpack_from("<I", data, begin)
            profile = data[begin + 4 : begin + 4 + length]
            if profile in (b"", b"ros1"):
                raise _ProfileError("Profile is not ros2.")
        elif opcode == _Opcode.FOOTER:
            _require(size == 20, "a footer")
            self.has_footer = True
        else:
            # nothing else is asked of what no message depends on
            _require(_is_followed(data, after, end), "a record")
        return after

    def _take_chunk(self, data: Buffer, begin: int, size: int) -> int:
        _, _, unpacked_size, checksum, length = _CHUNK_HEAD.unpack_from(data, begin)
        inner = begin + _CHUNK_HEAD.size
        form = data[inner : inner + length] if length <= max(map(len, _FORMS)) else b"?"
        (packed_size,) = struct.unpack_from("<Q", data, inner + length)
        inner += length + 8
        _require(form in _FORMS and inner + packed_size == begin + size, "a chunk")
        if form == b"":
            # of one that is cut short, or has no checksum, each message is asked by itself, and
            # what follows the last of them may lie elsewhere than the chunk's size says
            stop = inner + packed_size
            is_checked = checksum != 0 and stop <= len(data)
            if not is_checked or crc32(data[inner:stop]) == checksum:
                self._checked_to = stop if is_checked else inner
                return inner
            self.found.note_gap()
            return stop
        part = Packed(inner, inner + packed_size, unpacked_size, form.decode())
        try:
            _require(part.end <= len(data), "a chunk")
            records = self.found.unpack(part)
            _require(not checksum or crc32(records) == checksum, "a chunk's checksum")
        except DAMAGE:
            self.found.note_gap()
            self.found.last_part = None
            is_sized = _is_followed(data, part.end, len(data), records=2)
            return part.end if is_sized else _find_record(data, inner, len(data), (_Opcode.CHUNK,))
        self.found.last_part = part
        self.found.is_checked &= checksum != 0
        self.walk(records, part, 0)
        return part.end

    def _take_message(
        self, data: Buffer, part: Packed | None, end: int, begin: int, size: int
    ) -> None:
        _require(size >= _MESSAGE_HEAD.size, "a message")
        channel, _, t_ns, _ = _MESSAGE_HEAD.unpack_from(data, begin)
        after = begin + size
        # a stated size that is too large would take what follows for a part of the message
        if not _is_followed(data, after, end) and _find_record(data, begin, end) < after:
            raise ValueError("another record begins within a message")
        content = begin + _MESSAGE_HEAD.size
        self.found.is_checked &= part is not None or after <= self._checked_to
        place = ((content, after - content),)
        self.found.messages.append(FoundMessage(channel, t_ns, part, place))

    def _take_description(self, opcode: int, content: bytes) -> None:
        """Take a schema or a channel; the first of a number counts, the summary repeats them."""
        (number,) = struct.unpack_from("<H", content)
        if opcode == _Opcode.SCHEMA:
            texts = _read_strings(content, 2, 3)
            name, encoding = (text.decode("ascii") for text in texts[:2])
            schema = storage_mcap.Schema(number, name, encoding, texts[2].decode("utf-8"))
            self._schemas.setdefault(number, schema)
        else:
            (schema_number,) = struct.unpack_from("<H", content, 2)
            topic, encoding, metadata = _read_strings(content, 4, 3)
            _require(topic.decode("utf-8").isprintable(), "a channel")
            channel = schema_number, topic.decode("utf-8"), encoding.decode("ascii"), metadata
            self._channels.setdefault(number, channel)


class _ProfileError(Exception):
    """The file is sound, and of another profile."""


def _require(is_sound: object, what: str) -> None:
    if not is_sound:
        raise ValueError(f"{what} is damaged")


def _read_head(data: Buffer, place: int) -> tuple[int, int, int]:
    """Return a record's opcode, where its content begins, and its size."""
    if place + _HEAD.size > len(data):
        raise ValueError("the data end within a record")
    opcode, size = _HEAD.unpack_from(data, place)
    _require(opcode in _OPCODES, "a record")
    return opcode, place + _HEAD.size, size


def _read_strings(content: bytes, place: int, count: int) -> list[bytes]:
    """Read strings, each behind its length."""
    texts = []
    for _ in range(count):
        (length,) = struct.unpack_from("<I", content, place)
        place += 4 + length
        _require(place <= len(content), "a text")
        texts.append(content[place - length : place])
    return texts


def _read_statistics(content: bytes) -> Counter[int]:
    """Return the messages of each channel that the summary states; none if they do not add up."""
    (total,) = struct.unpack_from("<Q", content)
    (length,) = struct.unpack_from("<I", content, 42)
    _require(46 + length == len(content), "a summary")
    counts = Counter(dict(struct.iter_unpack("<HQ", content[46:])))
    return counts if counts.total() == total else Counter()


def _is_followed(data: Buffer, place: int, end: int, records: int = 1) -> bool:
    """Return whether so many records that fit follow one another at a place, or the data end."""
    for _ in range(records):
        if place == end:
            return True
        try:
            opcode, begin, size = _read_head(data, place)
        except ValueError:
            return False
        place = begin + size
        if place > end:
            return opcode == _Opcode.CHUNK
    return True


def _find_record(data: Buffer, place: int, end: int, opcodes: Container[int] = _OPCODES) -> int:
    """Return where the first record from a place on begins; `end` if there is none."""
    for mark in _LIKELY_RECORD.finditer(data, place, end):
        # marks may overlap: the search goes on behind the whole of each, so all of its bytes count
        for begin in range(mark.start(), mark.end()):
            if data[begin] in opcodes and _is_record(data, begin, end):
                return begin
    return end


def _is_record(data: Buffer, place: int, end: int) -> bool:
    """Return whether a record that is worth to go on at begins at a place.

    Three numbers that must agree are asked of each, so that points are hardly taken for one.
    """
    try:
        opcode, begin, size = _read_head(data, place)
        content = data[begin : begin + min(size, _CHUNK_HEAD.size + 16)]
        if opcode == _Opcode.CHUNK:
            length = _CHUNK_HEAD.unpack_from(content)[-1]
            (packed_size,) = struct.unpack_from("<Q", content, _CHUNK_HEAD.size + length)
            return size == _CHUNK_HEAD.size + length + 8 + packed_size
        if begin + size > end:
            return False
        if opcode == _Opcode.MESSAGE:
            _, _, logged_ns, published_ns = _MESSAGE_HEAD.unpack_from(content)
            # it was published not more than some days before, and not in the first of 1970
            is_one_time = logged_ns >> 48 == published_ns >> 48 > 0
            return is_one_time and _is_followed(data, begin + size, end)
        if opcode in (_Opcode.SCHEMA, _Opcode.CHANNEL):
            texts = _read_strings(data[begin : begin + size], 2 * (opcode - 2), 3)
            lengths = (len(text) + 4 for text in texts)
            return 2 * (opcode - 2) + sum(lengths) == size and _is_followed(data, begin + size, end)
    except DAMAGE:
        pass
    return False
