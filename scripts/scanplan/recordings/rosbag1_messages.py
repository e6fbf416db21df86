"""Messages of an uncompressed ROS 1 bag, read one by one from where its index says they lie.

Most of a recording is clouds, of which one in five is registered and none is needed for the poses: what is not asked
for is not read, where a reader of whole chunks (1 MB and more) would read all of it every time.
"""

import heapq
import os
import struct

_AHEAD = 1024
_MESSAGE, _CONNECTION = 2, 7


class StoredMessage:
    """A message that lies in a file.

    Attributes
    ----------
    head : bytes
        Its first bytes, a kilobyte or so, or all of it if it has fewer.
    """

    __slots__ = ("_file", "_place", "_size", "head")

    def __init__(self, file, place, size, head):
        self._file, self._place, self._size, self.head = file, place, size, head

    def read(self):
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


def iterate_messages(file, chunks, indexes):
    """Iterate over messages in the order of their recording.

    Parameters
    ----------
    file : int
        Descriptor of the open bag.
    chunks : dict of int to (int, int)
        Where the data of a chunk, named by its position, begin, and their number of bytes.
    indexes : list of list of (time_ns, chunk, offset)
        For each connection, sorted.

    Yields
    ------
    connection_id : int
    time_ns : int
        When it was recorded.
    message : Stored

    Raises
    ------
    ValueError, struct.error, KeyError
        If the index leads to no message, or one reaches beyond its chunk.
    """
    for time_ns, chunk, offset in heapq.merge(*indexes):
        begin, size = chunks[chunk]
        connection_id, place, length, head = _record(file, begin + offset)
        if place + length > begin + size:
            raise ValueError(f"message of {length} bytes reaches beyond its chunk")
        yield connection_id, time_ns, StoredMessage(file, place, length, head)


def _record(file, place):
    """Read the message record at a place, or behind the descriptions of connections there."""
    while True:
        block = os.pread(file, _AHEAD, place)
        (header_size,) = struct.unpack_from("<I", block)
        fields = _fields(block, 4, 4 + header_size)
        (length,) = struct.unpack_from("<I", block, 4 + header_size)
        begin = 8 + header_size
        if fields[b"op"] == bytes([_MESSAGE]):
            (connection_id,) = struct.unpack("<I", fields[b"conn"])
            return connection_id, place + begin, length, block[begin : begin + length]
        if fields[b"op"] != bytes([_CONNECTION]):
            raise ValueError("the index leads to no message")
        place += begin + length


def _fields(block, at, end):
    fields = {}
    while at < end:
        (size,) = struct.unpack_from("<I", block, at)
        name, _, value = block[at + 4 : at + 4 + size].partition(b"=")
        fields[name] = value
        at += 4 + size
    return fields
