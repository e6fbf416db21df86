"""Compressed parts of recordings, unpacked into the memory that they state and no more.

A few kilobytes can unpack to more than any memory holds. rosbags unpacks whatever comes; here it is
given functions that stop.
"""

import bz2
import io
import shutil
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Protocol

from backports import zstd
from lz4.frame import LZ4FrameDecompressor
from rosbags import rosbag1, rosbag2
from rosbags.rosbag1.reader import Header, RecordType, decompressors
from rosbags.rosbag2 import storage_mcap

from scanplan.errors import StageError

MOST_UNPACKED_BYTES = 2**29
"""A chunk and a message are a few megabytes, 10 million points of 48 bytes below this."""

ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
"""What every frame of zstd begins with (RFC 8878); no message in CDR does."""


class _Unpacker(Protocol):
    @property
    def eof(self) -> bool | None: ...
    @property
    def unused_data(self) -> bytes | bytearray | None: ...
    def decompress(self, data: bytes, /, max_length: int) -> bytes: ...


_UNPACKERS: dict[str, Callable[[], _Unpacker]] = {
    "bz2": bz2.BZ2Decompressor,
    "lz4": LZ4FrameDecompressor,
    "zstd": zstd.ZstdDecompressor,
}


def unpack_bytes(data: bytes, size: int | None = None, *, form: str) -> bytes:
    """Unpack a part of a recording.

    Parameters
    ----------
    size : int, optional
        The number of bytes that it is to have, where the recording states it.
    form : str
        bz2, lz4 or zstd.

    Raises
    ------
    ValueError
        If it has another size, or one above `MOST_UNPACKED_BYTES`, stated or not.
    """
    most = MOST_UNPACKED_BYTES if size is None else size
    if most > MOST_UNPACKED_BYTES:
        raise ValueError(
            f"{len(data)} bytes are said to unpack to {size}, above {MOST_UNPACKED_BYTES}"
        )
    unpacked = b"".join(_unpack_frames(data, most + 1, form))
    if len(unpacked) > most:
        raise ValueError(f"{len(data)} bytes unpack to more than {most}")
    if size is not None and len(unpacked) != size:
        raise ValueError(f"{len(data)} bytes unpack to {len(unpacked)} instead of {size}")
    return unpacked


def _unpack_frames(data: bytes, most: int, form: str) -> Iterator[bytes]:
    """Yield what one frame after the other unpacks to, until there are enough bytes."""
    while data and most > 0:
        frame = _UNPACKERS[form]()
        part = frame.decompress(data, max_length=most)
        most -= len(part)
        yield part
        if not frame.eof and most > 0:
            raise ValueError(f"{len(data)} bytes of {form} are cut short")
        data = bytes(frame.unused_data or b"")


# rosbags looks the functions of an mcap file up by name whenever it reads a chunk
storage_mcap.DECOMPRESSORS.update(
    {form: partial(unpack_bytes, form=form) for form in ("lz4", "zstd")}
)


def limit_unpacking(
    reader: rosbag1.Reader | rosbag2.Reader,
) -> Callable[[bytes], bytes] | None:
    """Have an open recording unpacked to the sizes that it states, and no further.

    Returns
    -------
    callable or None
        What each message is still to be unpacked by, where they are compressed one by one.
    """
    if isinstance(reader, rosbag1.Reader):
        _limit_chunks(reader)
        return None
    if reader.compression_mode != "message":
        return None
    # rosbags would unpack them itself, whatever comes
    reader.storage.metadata = reader.storage.metadata._replace(compression_mode=None)
    return partial(unpack_bytes, form="zstd")


def _limit_chunks(reader: rosbag1.Reader) -> None:
    for place, chunk in reader.chunks.items():
        for form in ("bz2", "lz4"):
            if chunk.decompressor is decompressors[form]:
                size = _stated_size(reader, place)
                unpack = partial(unpack_bytes, size=size, form=form)
                reader.chunks[place] = chunk._replace(decompressor=unpack)


def _stated_size(reader: rosbag1.Reader, place: int) -> int:
    if reader.bio is None:
        raise ValueError(f"{reader.path}: is not open")
    reader.bio.seek(place)
    return Header.read(reader.bio, RecordType.CHUNK).get_uint32("size")


def check_room(folder: Path) -> None:
    """Refuse a rosbag2 folder whose files, each compressed as a whole, unpack to more than fits.

    Raises
    ------
    StageError
    """
    needed = sum(_read_frame_size(file) for file in folder.glob("*.zstd"))
    place = tempfile.gettempdir()
    free = shutil.disk_usage(place).free
    if needed > free:
        raise StageError(
            f"{folder}: unpacks to {needed / 1e9:.1f} GB, and {place} has {free / 1e9:.1f} GB left;"
            " make room there, or set TMPDIR to a folder with more"
        )


def _read_frame_size(file: Path) -> int:
    """Return what a compressed file says that it unpacks to; 0 where it says nothing."""
    with file.open("rb") as packed:
        head = packed.read(io.DEFAULT_BUFFER_SIZE)
    try:
        return zstd.get_frame_info(head).decompressed_size or 0
    except zstd.ZstdError:
        return 0
