"""Messages of an uncompressed ROS 1 bag, read one by one from where its index says they lie.

Most of a recording is clouds, of which one in five is registered and none is needed for the poses:
a message that is not asked for is not read, where rosbags' own reader of whole chunks (1 MB and
more) reads all of it every time. Measured on a bag of 2.2 GB: 1.0 s of CPU instead of 2.1 s, and
the disk is spared. The price is that `bags` hands over what rosbags keeps for itself: its file
(`bio`), and its tables of chunks and indexes.
"""

import io
import os
import struct
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from rosbags.rosbag1.reader import RecordType


class StoredMessage:
    """A message that lies in a file.

    Attributes
    ----------
    head : bytes
        Its first bytes, some kilobytes, or all of it if it has fewer.
    """

    __slots__ = ("_file", "_place", "_size", "head")

    def __init__(self, file: int, place: int, size: int, head: bytes) -> None:
        self._file = file
        self._place = place
        self._size = size
        self.head = head

    def read(self) -> bytes:
        """Return all of its bytes.

        Raises
        ------
        ValueError
            If the file ends before it does.
        """
        if len(self.head) == self._size:
            return self.head
        data = os.pread(self._file, self._size, self._place)
        if len(data) != self._size:
            raise ValueError(f"message of {self._size} bytes is cut short to {len(data)}")
        return data


def iterate_messages(
    file: int,
    chunks: Mapping[int, tuple[int, int]],
    indexes: Mapping[int, Sequence[tuple[int, int, int]]],
    n_unread: int = 0,
) -> Iterator[tuple[int, int, StoredMessage | bytes]]:
    """Iterate over messages in the order of their recording.

    Parameters
    ----------
    file : int
        Descriptor of the open bag.
    chunks : dict of int to (int, int)
        Where the data of a chunk, named by its position, begin, and their number of bytes.
    indexes : dict of int to list of (time_ns, chunk, offset)
        For each connection by its id, sorted.
    n_unread : int
        So many at the beginning are told by the index alone, and come as no bytes.

    Yields
    ------
    connection_id : int
    time_ns : int
        When it was recorded.
    message : StoredMessage or bytes

    Raises
    ------
    ValueError, struct.error, KeyError
        If the index leads to no message, or one reaches beyond its chunk.
    """
    blocks = _Blocks(file)
    entries = iter(sorted((entry, number) for number, index in indexes.items() for entry in index))
    for (time_ns, _, _), number in islice(entries, n_unread):
        yield number, time_ns, b""
    for (time_ns, chunk, offset), _ in entries:
        begin, size = chunks[chunk]
        connection_id, place, length, head = _read_record(blocks, begin + offset)
        if place + length > begin + size:
            raise ValueError(f"message of {length} bytes reaches beyond its chunk")
        yield connection_id, time_ns, StoredMessage(file, place, length, head)


class _Blocks:
    """A file read in blocks: small messages lie together, a dozen between two clouds.

    Parameters
    ----------
    file : int
        Its descriptor.
    """

    def __init__(self, file: int) -> None:
        self._file = file
        self._begin = 0
        self._block = b""

    def read_from(self, place: int, at_least: int) -> bytes:
        """Return some kilobytes from a place on, those of the last call where they reach so far."""
        skipped = place - self._begin
        if not 0 <= skipped <= len(self._block) - at_least:
            self._block = os.pread(self._file, io.DEFAULT_BUFFER_SIZE, place)
            self._begin = place
            skipped = 0
        return self._block[skipped:]


def _read_record(blocks: _Blocks, place: int) -> tuple[int, int, int, bytes]:
    """Read the message record at a place, or behind the descriptions of connections there.

    Returns
    -------
    connection_id, place, length : int
        Where the message begins, and its number of bytes.
    head : bytes
        Its first bytes.
    """
    while True:
        # an eighth holds the record's header and the message's own, and all of a small one
        block = blocks.read_from(place, io.DEFAULT_BUFFER_SIZE // 8)
        (header_size,) = struct.unpack_from("<I", block)
        fields = _read_fields(block, 4, 4 + header_size)
        (length,) = struct.unpack_from("<I", block, 4 + header_size)
        begin = 8 + header_size
        if fields[b"op"] == bytes([RecordType.MSGDATA]):
            (connection_id,) = struct.unpack("<I", fields[b"conn"])
            if begin + length > len(block):
                block = blocks.read_from(place, io.DEFAULT_BUFFER_SIZE)
            return connection_id, place + begin, length, block[begin : begin + length]
        if fields[b"op"] != bytes([RecordType.CONNECTION]):
            raise ValueError("the index leads to no message")
        place += begin + length


def _read_fields(block: bytes, start: int, end: int) -> dict[bytes, bytes]:
    """Return the fields of a record's header, from start to end of a block."""
    fields = {}
    while start < end:
        (size,) = struct.unpack_from("<I", block, start)
        name, _, value = block[start + 4 : start + 4 + size].partition(b"=")
        fields[name] = value
        start += 4 + size
    return fields
