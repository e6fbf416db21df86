"""Temporary files of clouds: recordings are read once, memory does not grow with their length."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import numpy as np

from scanplan.store import atomic
from scanplan.types import FilePath, FloatArray

POINT = np.dtype((np.float32, 3))


class ScanCache:
    """Clouds that are read back by their number, from 0 in the order in which they were added.

    Parameters
    ----------
    file : binary file, open for writing
    """

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self.path = path
        self._file = file
        self._ranges: list[tuple[int, int]] = []

    def __len__(self) -> int:
        return len(self._ranges)

    def add(self, xyz_m: FloatArray) -> None:
        """Append the points (n, 3) of one more cloud, as float32."""
        self._file.write(np.ascontiguousarray(xyz_m, np.float32).data)
        start = self._ranges[-1][1] if self._ranges else 0
        self._ranges.append((start, start + len(xyz_m)))

    def take(self, numbers: Iterable[int]) -> "ScanCache":
        """Return a cache of some of these clouds, numbered anew, to read only."""
        taken = ScanCache(self.path, self._file)
        taken._ranges = [self._ranges[i] for i in numbers]
        return taken

    def part(self, numbers: Iterable[int]) -> "ScanCachePart":
        """Return an iterable over the clouds of these numbers, which other processes can read too.

        Everything added so far is on disk then.
        """
        self._file.flush()
        return ScanCachePart(str(self.path), [self._ranges[i] for i in numbers])


class ScanCachePart:
    """Some clouds of a cache: iterating reads them from its file one at a time, (n, 3) float32.

    Parameters
    ----------
    ranges : list of (int, int)
        First point of each cloud, and the one behind its last.
    """

    def __init__(self, path: str, ranges: list[tuple[int, int]]) -> None:
        self._path = path
        self._ranges = ranges

    def __len__(self) -> int:
        return len(self._ranges)

    def __iter__(self) -> Iterator[FloatArray]:
        with Path(self._path).open("rb") as file:
            for start, end in self._ranges:
                file.seek(start * POINT.itemsize)
                yield np.fromfile(file, np.float32, 3 * (end - start)).reshape(-1, 3)


@contextmanager
def open_scan_cache(path: FilePath) -> Iterator[ScanCache]:
    """Open a ScanCache in a temporary file beside `path`; it is removed afterwards."""
    with (
        atomic.scratch_file(Path(path).with_suffix(".spool")) as temporary,
        temporary.open("wb") as file,
    ):
        yield ScanCache(temporary, file)
