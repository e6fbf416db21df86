"""Rows of a rosbag2 database read page by page, without its trees.

SQLite has no checksums: a row counts as whole where its header fits its table, and the pages that
its content goes on in are there, each of one row alone, and end where its size says. Format:
sqlite.org/fileformat2.
"""

import struct
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag2,
    MessageDefinition,
    MessageDefinitionFormat,
)

from scanplan.recordings.salvage.found import (
    DAMAGE,
    Buffer,
    FoundMessage,
    FoundRecords,
)

_MAGIC = b"SQLite format 3\0"
_LEAF = b"\x0d"
_FILE_HEAD = struct.Struct(">16sH2xB7xI68x")
"""Of a file: magic bytes, size of a page, unused bytes at its end, and number of pages."""
_DEFINITION_FORMATS = {
    "ros2msg": MessageDefinitionFormat.MSG,
    "ros2idl": MessageDefinitionFormat.IDL,
}
Value = None | int | str | bytes


class _Row(NamedTuple):
    """A row: its number, the serial types of its columns, and where its content lies."""

    number: int
    types: tuple[int, ...]
    begin: int
    pieces: tuple[tuple[int, int], ...]


def find_sqlite_records(path: Path) -> FoundRecords:
    """Return the rows of a rosbag2 database that are whole."""
    found = FoundRecords(path)
    found.is_checked = False
    if len(found.data) > _FILE_HEAD.size:
        _Pages(found).gather()
    else:
        found.note_gap()
    return found


class _Pages:
    """The pages of a database, and what is gathered of their rows."""

    def __init__(self, found: FoundRecords) -> None:
        self._found = found
        self._data = found.data
        self._page_size, unused, self._stated_pages = _read_file_head(found)
        self._usable = self._page_size - unused
        # of a page that is cut off, some rows may be whole
        self._n_pages = -(-len(found.data) // self._page_size)
        self._claimed: Counter[int] = Counter()
        self._rows: dict[int, FoundMessage] = {}
        self._chains: dict[int, list[int]] = {}
        self._topics: dict[int, tuple[Value, ...]] = {}
        self._definitions: dict[Value, MessageDefinition] = {}

    def gather(self) -> None:
        """Go through all pages for messages, topics and definitions."""
        found = self._found
        if len(self._data) % self._page_size or self._stated_pages != self._n_pages:
            found.note_gap()
        for page in range(self._n_pages):
            self._take_page(page)
        doubled = {page for page, count in self._claimed.items() if count > 1}
        is_whole = {n: doubled.isdisjoint(self._chains[n]) for n in self._rows}
        found.messages = [self._rows[n] for n in sorted(self._rows) if is_whole[n]]
        for number, (name, kind, encoding) in self._topics.items():
            definition = self._definitions.get(
                kind, MessageDefinition(MessageDefinitionFormat.NONE, "")
            )
            extra = ConnectionExtRosbag2(str(encoding), [])
            found.connections[number] = Connection(
                number, str(name), str(kind), definition, "", 0, extra, None
            )
        self._note_gaps([n for n in sorted(self._rows) if is_whole[n]])

    def _note_gaps(self, numbers: list[int]) -> None:
        """Note where rows are missing: the numbers of a recording's rows have no gaps."""
        pairs = enumerate(zip([0, *numbers], numbers, strict=False))
        missing = [row for row, (before, number) in pairs if number != before + 1]
        # what no number tells of may lie behind them all
        at_end = [len(numbers)] if self._found.breaks else []
        self._found.breaks = missing + at_end

    def _take_page(self, page: int) -> None:
        """Take the rows of a page; one that is no leaf of a table has none."""
        start = page * self._page_size
        head = start + (_FILE_HEAD.size if page == 0 else 0)
        if self._data[head : head + 1] != _LEAF:
            return
        end = min(start + self._page_size, len(self._data))
        (count,) = struct.unpack(">H", self._data[head + 3 : head + 5].ljust(2, b"\0"))
        for place in range(head + 8, min(head + 8 + 2 * count, end - 1), 2):
            (cell,) = struct.unpack_from(">H", self._data, place)
            try:
                if not place < start + cell < end:
                    raise ValueError("a cell lies outside of its page")
                self._take_row(self._read_row(start + cell, end))
            except DAMAGE:
                self._found.note_gap()

    def _take_row(self, row: _Row) -> None:
        """Take a row by its form: of a message, a topic or a definition; others are left out."""
        types = row.types
        n_texts = sum(map(_is_text, types))
        is_message = len(types) == 4 and not n_texts and types[0] == 0 and types[1] and types[2]
        if is_message and types[3] >= 12:
            self._take_message(row)
        elif types[0] == 0 and len(types) in (4, 5, 6) and n_texts == len(types) - 1:
            self._take_texts(row)

    def _take_message(self, row: _Row) -> None:
        topic, t_ns, size = self._read_integers(row)
        pieces = _skip(row.pieces, row.begin, size)
        if row.number in self._rows:
            raise ValueError(f"row {row.number} is there twice")
        self._rows[row.number] = FoundMessage(topic, t_ns, None, pieces)
        self._chains[row.number] = [begin // self._page_size for begin, _ in row.pieces[1:]]
        self._claimed.update(self._chains[row.number])

    def _read_integers(self, row: _Row) -> tuple[int, int, int]:
        """Return a message's topic and time, and the size of its content."""
        begin, _ = row.pieces[0]
        place = begin + row.begin
        values = []
        for kind in row.types[1:3]:
            size = _content_size(kind)
            value = int.from_bytes(self._data[place : place + size], "big", signed=True)
            values.append(value if size else kind - 8)
            place += size
        return values[0], values[1], _content_size(row.types[3])

    def _take_texts(self, row: _Row) -> None:
        content = b"".join(self._data[begin : begin + size] for begin, size in row.pieces)
        place = row.begin
        texts = []
        for kind in row.types[1:]:
            size = _content_size(kind)
            texts.append(content[place : place + size].decode("utf-8"))
            place += size
        if texts[1] in _DEFINITION_FORMATS:
            definition = MessageDefinition(_DEFINITION_FORMATS[texts[1]], texts[2])
            self._definitions.setdefault(texts[0], definition)
        elif texts[2] == "cdr" and texts[0].isprintable():
            self._topics.setdefault(row.number, tuple(texts[:3]))

    def _read_row(self, place: int, end: int) -> _Row:
        """Read a cell's head, and find where all of its content lies.

        Raises
        ------
        ValueError
            If a size does not fit.
        """
        size, place = _read_varint(self._data, place)
        number, place = _read_varint(self._data, place)
        local = self._local_size(size)
        if size > len(self._data):
            raise ValueError(f"a row of {size} bytes is larger than the file")
        if place + local + (4 if local < size else 0) > end:
            raise ValueError("a cell reaches beyond its page")
        head_size, after = _read_varint(self._data, place)
        types = []
        while after < place + head_size:
            kind, after = _read_varint(self._data, after)
            types.append(kind)
        if after != place + head_size or head_size > local or not types:
            raise ValueError("a row's head has another size than it states")
        if head_size + sum(map(_content_size, types)) != size:
            raise ValueError("a row has another size than its columns")
        overflow = list(self._read_overflow(place + local, size - local))
        return _Row(number, tuple(types), head_size, ((place, local), *overflow))

    def _local_size(self, size: int) -> int:
        """Return how much of a row of so many bytes lies in its leaf."""
        usable = self._usable
        least = (usable - 12) * 32 // 255 - 23
        if size <= usable - 35:
            return size
        fitting = least + (size - least) % (usable - 4)
        return fitting if fitting <= usable - 35 else least

    def _read_overflow(self, place: int, size: int) -> Iterator[tuple[int, int]]:
        """Yield where the content of a row goes on."""
        while size > 0:
            (page,) = struct.unpack_from(">I", self._data, place)
            if not 1 < page <= self._n_pages:
                raise ValueError("a row goes on beyond the file")
            place = (page - 1) * self._page_size
            part = min(size, self._usable - 4)
            if place + 4 + part > len(self._data):
                raise ValueError("a row goes on beyond the file")
            yield place + 4, part
            size -= part
            if size == 0 and struct.unpack_from(">I", self._data, place) != (0,):
                raise ValueError("a row goes on beyond its size")


def _skip(
    pieces: tuple[tuple[int, int], ...], skipped: int, size: int
) -> tuple[tuple[int, int], ...]:
    """Return the last `size` bytes of some pieces, whose first one begins with a row's head."""
    surplus = sum(length for _, length in pieces) - size
    begin, length = pieces[0]
    if not skipped <= surplus <= length:
        raise ValueError("a row's content does not begin where it states")
    first = (begin + surplus, length - surplus)
    return tuple(piece for piece in (first, *pieces[1:]) if piece[1])


def _read_file_head(found: FoundRecords) -> tuple[int, int, int]:
    """Return a page's size and unused bytes, and how many there are, as the file states.

    Where its head is damaged, SQLite's own default, which rosbag2 leaves as it is.
    """
    magic, size, unused, n_pages = _FILE_HEAD.unpack_from(found.data)
    size = 2**16 if size == 1 else size
    if magic == _MAGIC and size >= 512 and size & (size - 1) == 0:
        return size, unused, n_pages
    found.note_gap()
    return 4096, 0, 0


def _is_text(kind: int) -> bool:
    """Return whether a column of a serial type is a text; blobs have the even ones."""
    return kind > 12 and kind % 2 == 1


def _content_size(kind: int) -> int:
    """Return how many bytes a column of a serial type takes.

    Raises
    ------
    KeyError
        If it is neither null, integer, text nor blob.
    """
    if kind >= 12:
        return (kind - 12) // 2
    return {0: 0, 1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8, 8: 0, 9: 0}[kind]


def _read_varint(data: Buffer, place: int) -> tuple[int, int]:
    """Return an integer of up to nine bytes, and where it ends."""
    value = 0
    for n in range(8):
        byte = data[place + n]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, place + n + 1
    return value << 8 | data[place + 8], place + 9
