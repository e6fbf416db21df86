"""Points of .las and .laz files, a block at a time."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import laspy
import numpy as np

from scanplan.errors import StageError
from scanplan.types import FloatArray

_BLOCK = 2**20  # points at a time: 40 MB of most formats
_MOST_A_BYTE = 100  # points: of equal ones packed to nothing hardly as many
_PLACE = struct.Struct("<q")
_TABLE = struct.Struct("<II")
"""What the table of a .laz begins with: its version, and how many chunks it is of."""
_SIZES = struct.Struct("<94xHII")
"""What a header begins with: its length, where points begin, how many records lie in between."""
_RECORD = 54  # bytes of a record that is empty
_COARSEST_M = 1.0  # that coordinates are rounded to: no scanner's
_FARTHEST_M = 1e8  # of a country's coordinates: more than the way round the Earth


class LasPoints(NamedTuple):
    """Some points of a file: coordinates (n, 3) as it has them, and times (n,) or None."""

    xyz_m: FloatArray
    time_s: FloatArray | None


class LasBlock(NamedTuple):
    """Which points of which file."""

    path: Path
    begin: int
    n_points: int

    def read(self) -> LasPoints:
        """Return the points.

        Raises
        ------
        StageError
            If they cannot be read.
        """
        try:
            with laspy.open(self.path, laz_backend=laspy.LazBackend.Lazrs) as file:
                file.seek(self.begin)
                points = file.read_points(self.n_points)
                xyz_m = np.column_stack([np.asarray(points[axis], float) for axis in "xyz"])
                names = set(file.header.point_format.dimension_names)
                time_s = np.asarray(points["gps_time"], float) if "gps_time" in names else None
        # laspy and lazrs have no common kind of error
        except Exception as error:
            raise _damaged(self.path, error) from None
        if len(xyz_m) != self.n_points:
            raise StageError(
                f"{self.path}: damaged: {self.n_points} points are to follow point {self.begin},"
                f" and {len(xyz_m)} do; copy or export it again"
            )
        return LasPoints(xyz_m, time_s)


def list_blocks(path: Path) -> Iterator[LasBlock]:
    """Yield the blocks of a file.

    Raises
    ------
    StageError
        If its header cannot be read, or states more points than the file holds.
    """
    length = path.stat().st_size
    _check_records(path)
    try:
        with laspy.open(path, laz_backend=laspy.LazBackend.Lazrs) as file:
            header = file.header
            is_packed = header.are_points_compressed
            begin, size = header.offset_to_point_data, header.point_format.size
            n_points = header.point_count
    except Exception as error:
        raise _damaged(path, error) from None
    scales_m, origin_m = np.asarray(header.scales), np.asarray(header.offsets)
    is_scaled = ((scales_m > 0) & (scales_m <= _COARSEST_M)).all()
    if not is_scaled or not (np.abs(origin_m) < _FARTHEST_M).all():
        raise _damaged(path, f"coordinates are steps of {scales_m} from {origin_m}")
    needed = n_points / _MOST_A_BYTE if is_packed else n_points * size
    if is_packed and begin + needed <= length:
        needed = _count_chunks(path, begin, length) * size  # each begins with a point as it is
    if begin + needed > length:
        raise StageError(
            f"{path}: damaged: states {n_points} points of {size} bytes from byte {begin} on, and"
            f" has {length} bytes; copy or export it again"
        )
    for first in range(0, n_points, _BLOCK):
        yield LasBlock(path, first, min(_BLOCK, n_points - first))


def _check_records(path: Path) -> None:
    """Refuse more records than lie before the points: each is read, where there is nothing, too."""
    with path.open("rb") as file:
        begun = file.read(_SIZES.size)
    if len(begun) < _SIZES.size:
        raise _damaged(path, f"{len(begun)} bytes are no header")
    size, begin, n_records = _SIZES.unpack(begun)
    if size + n_records * _RECORD > begin:
        raise _damaged(path, f"states {n_records} records before byte {begin}, where points begin")


def _count_chunks(path: Path, begin: int, length: int) -> int:
    """Return how many chunks the table of a .laz states, whose place stands before the points."""
    with path.open("rb") as file:
        try:
            file.seek(begin)
            (place,) = _PLACE.unpack(file.read(_PLACE.size))
            if place == -1:  # a writer that cannot go back states it at the end
                file.seek(length - _PLACE.size)
                (place,) = _PLACE.unpack(file.read(_PLACE.size))
            file.seek(place)
            return _TABLE.unpack(file.read(_TABLE.size))[1]
        except (struct.error, OSError, ValueError, OverflowError) as error:
            raise _damaged(path, error) from None


def _damaged(path: Path, error: Exception | str) -> StageError:
    reason = " ".join(str(error).split())[:100] or type(error).__name__
    return StageError(f"{path}: damaged ({reason}); copy or export it again")
