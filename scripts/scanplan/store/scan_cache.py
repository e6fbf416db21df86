"""Clouds put aside in a temporary file, so that a recording is read once and memory does not grow with its length."""

from contextlib import contextmanager
from pathlib import Path

import numpy as np

from scanplan.store import atomic

_POINT = np.dtype((np.float32, 3))


class ScanCache:
    """Clouds in the order in which they are added, and read back by their number from 0.

    Parameters
    ----------
    path : pathlib.Path
    file : binary file, open for writing
    """

    def __init__(self, path, file):
        self.path = path
        self._file = file
        self._end = [0]

    def __len__(self):
        return len(self._end) - 1

    def add(self, xyz_m):
        """Put the points (n, 3) of one more cloud aside, as float32."""
        self._file.write(np.ascontiguousarray(xyz_m, np.float32))
        self._end.append(self._end[-1] + len(xyz_m))

    def part(self, numbers):
        """Return what another process needs to read the clouds of these numbers: an iterable Part.

        Everything added so far is on disk then.
        """
        self._file.flush()
        return ScanCachePart(str(self.path), [(self._end[i], self._end[i + 1]) for i in numbers])


class ScanCachePart:
    """Some clouds of a spool: iterating reads them from its file one at a time, (n, 3) float32."""

    def __init__(self, path, ranges):
        self._path, self._ranges = path, ranges

    def __len__(self):
        return len(self._ranges)

    def __iter__(self):
        with Path(self._path).open("rb") as file:
            for start, end in self._ranges:
                file.seek(start * _POINT.itemsize)
                yield np.fromfile(file, np.float32, 3 * (end - start)).reshape(-1, 3)


@contextmanager
def open_scan_cache(path):
    """Open a Spool in a temporary file beside `path`; it is gone afterwards."""
    with (
        atomic.scratch_file(Path(path).with_suffix(".spool")) as temporary,
        temporary.open("wb") as file,
    ):
        yield ScanCache(temporary, file)
