"""What is found in one damaged file: its connections, where its messages lie, where it has gaps."""

import mmap
import struct
from collections import Counter
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from backports import zstd
from rosbags.interfaces import Connection

from scanplan.recordings.integrity import unpacking

Buffer = bytes | mmap.mmap
"""Bytes that can be indexed and searched: an unpacked chunk, or a whole file."""

DAMAGE = (
    ValueError,
    LookupError,
    OSError,
    RuntimeError,
    EOFError,
    MemoryError,
    struct.error,
    zstd.ZstdError,
)
"""What reading damaged bytes raises: too few of them, impossible sizes, checksums that differ."""


class Packed(NamedTuple):
    """A compressed part of a file: where it lies, and the size and the form that it states."""

    begin: int
    end: int
    size: int
    form: str


class FoundMessage(NamedTuple):
    """Where a message lies: a part (None: the file itself), and its pieces there in order."""

    connection: int
    t_ns: int
    part: Packed | None
    pieces: tuple[tuple[int, int], ...]


class FoundRecords:
    """The records of one file that are whole.

    Attributes
    ----------
    path : pathlib.Path
    data : bytes or mmap.mmap
    connections : dict of int to rosbags.interfaces.Connection
    messages : list of FoundMessage
        In the order of the file; some may be of connections that were not found.
    stated : Counter of int
        How many messages of each connection the file states, as far as that can be read.
    is_checked : bool
        Whether all messages found fit checksums: of others, bytes may be changed unnoticed.
    gaps : list of int
        How many messages were found before each place that is damaged.
    last_part : Packed or None
        The last one, which an index that follows is of; None where that is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.data: Buffer = b""
        with path.open("rb") as file:
            if path.stat().st_size:
                self.data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self.connections: dict[int, Connection] = {}
        self.messages: list[FoundMessage] = []
        self.stated: Counter[int] = Counter()
        self.is_checked = True
        self.breaks: list[int] = []
        self.last_part: Packed | None = None
        # chunks of one time lie side by side and are read alternately
        self._unpacked = lru_cache(maxsize=4)(self._unpack)

    def note_gap(self) -> None:
        """Note that the file is damaged behind the last message found."""
        if self.breaks[-1:] != [len(self.messages)]:
            self.breaks.append(len(self.messages))

    def keep_listed(self, connection: int, listed: set[tuple[int, int]]) -> None:
        """Drop what the last part seems to hold of a connection, and its own index does not list.

        A compressed part that is damaged may unpack to the size that it states, and to messages
        that nobody sent.

        Parameters
        ----------
        listed : set of (int, int)
            Time, and place in the part, of each message.
        """
        part = self.last_part
        if part is None:
            return
        first = len(self.messages)
        while first and self.messages[first - 1].part == part:
            first -= 1
        kept = [
            message
            for message in self.messages[first:]
            if message.connection != connection or (message.t_ns, message.pieces[0][0]) in listed
        ]
        if len(kept) < len(self.messages) - first:
            self.messages[first:] = kept
            self.breaks = [min(place, len(self.messages)) for place in self.breaks]
            self.note_gap()

    def unpack(self, part: Packed) -> bytes:
        """Return what a part unpacks to.

        Raises
        ------
        Any of `DAMAGE`
            If it does not unpack to what it states.
        """
        return self._unpacked(part)

    def read(self, message: FoundMessage) -> bytes:
        """Return a message's bytes."""
        source = self.data if message.part is None else self._unpacked(message.part)
        return b"".join(source[begin : begin + size] for begin, size in message.pieces)

    def close(self) -> None:
        """Let go of the file."""
        self._unpacked.cache_clear()
        if isinstance(self.data, mmap.mmap):
            self.data.close()

    def _unpack(self, part: Packed) -> bytes:
        packed = self.data[part.begin : part.end]
        return unpacking.unpack_bytes(packed, part.size, form=part.form)


def walk_records(
    found: FoundRecords,
    take: Callable[[int], int],
    find_next: Callable[[int], int],
    begin: int,
    end: int,
) -> None:
    """Take one record after the other, and after a damaged one go on at the next that is whole.

    Parameters
    ----------
    take : callable
        Takes the record at a place, and returns where the next one begins.
    find_next : callable
        Returns the first place, from one on, at which a whole record begins; `end` if none.
    """
    place = begin
    while place < end:
        try:
            place = take(place)
        except DAMAGE:
            found.note_gap()
            place = find_next(place + 1)
