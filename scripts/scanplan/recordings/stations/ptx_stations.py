"""Stations in PTX files, as Leica's programs write them: text, a scan after the other."""

from collections.abc import Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings.integrity import text_lines
from scanplan.recordings.stations.station_scans import Block, Station
from scanplan.types import FloatArray

_BLOCK = 2**17  # lines at a time
_HEADER_LINES = (1, 1, 3, 3, 3, 3, 4, 4, 4, 4)
"""Numbers in each: columns, rows, the scanner's place and axes, and the transformation."""
_LONGEST_LINE = 1024  # bytes, of seven numbers
_LEAST_LINE = 6  # bytes: `0 0 0` and its end
_POINT = (0, 1, 2)
_COLOUR = (4, 5, 6)  # behind the intensity, 0 to 255
_SHADES = 257  # of 16 bits to one of 8


class _Header(NamedTuple):
    """What stands above a scan; points are in the sensor's frame but where they were moved."""

    n_points: int
    world_from_sensor: FloatArray
    sensor_from_points: FloatArray


def list_ptx_stations(path: Path) -> list[Station]:
    """Return the scans of a file.

    It is gone through once, as nothing says where its scans begin.

    Raises
    ------
    StageError
        If a header is none, or lines are missing.
    """
    stations: list[Station] = []
    with path.open("rb") as file:
        while (header := _read_header(file, f"{path}: scan {len(stations)}")) is not None:
            name = f"{path}: scan {len(stations)}"
            begin = file.tell()
            left = path.stat().st_size - begin
            is_there = header.n_points * _LEAST_LINE <= left + 1  # the last line may have no end
            lines = text_lines.iterate_lines(file, name)
            n_lines = sum(1 for _ in islice(lines, header.n_points)) if is_there else left
            if n_lines < header.n_points:
                raise StageError(
                    f"{name}: damaged: states {header.n_points} points, and {left} bytes are behind"
                    " it; copy or export it again"
                )
            read = partial(_read_blocks, path, begin, name, header)
            has_colours = _has_colours(path, begin)
            stations.append(Station(name, header.world_from_sensor, read, has_colours))
    return stations


def _has_colours(path: Path, begin: int) -> bool:
    """Return whether the first point of a scan has a colour."""
    with path.open("rb") as file:
        file.seek(begin)
        return len(file.readline(_LONGEST_LINE).split()) > max(_COLOUR)


def _read_header(file: BinaryIO, name: str) -> _Header | None:
    """Return the header that a file goes on with; None at its end."""
    line = file.readline(_LONGEST_LINE)
    while line and not line.strip():
        line = file.readline(_LONGEST_LINE)
    if not line:
        return None
    rows = []
    for number, n_numbers in enumerate(_HEADER_LINES, 1):
        try:
            row = [float(word) for word in line.split()]
            is_count = n_numbers > 1 or row[0] == abs(int(row[0]))
            if len(row) != n_numbers or not is_count:
                raise ValueError("numbers of another line")
        except (ValueError, IndexError, OverflowError):
            raise StageError(
                f"{name}: damaged: line {number} of its header is to have {n_numbers} numbers and"
                f" is {line[:40]!r}; export it again as PTX"
            ) from None
        rows.append(row)
        line = file.readline(_LONGEST_LINE) if number < len(_HEADER_LINES) else b""
    return _place_scan(rows)


def _place_scan(rows: list[list[float]]) -> _Header:
    n_points = int(rows[0][0]) * int(rows[1][0])
    world_from_points = np.array(rows[6:]).T
    of_scanner = np.eye(4)
    of_scanner[:3] = np.column_stack([*np.array(rows[3:6]), rows[2]])
    if not np.array_equal(world_from_points, np.eye(4)) or not np.isfinite(of_scanner).all():
        return _Header(n_points, world_from_points, np.eye(4))
    # points that were moved to the world already: the scanner's place alone says where it stood
    return _Header(n_points, of_scanner, se3.invert_pose(of_scanner))


def _read_blocks(
    path: Path, begin: int, name: str, header: _Header, coloured: bool
) -> Iterator[Block]:
    """Yield points (n, 3) of a scan in its own frame, NaN where a beam did not return."""
    left = header.n_points
    columns = _POINT + _COLOUR if coloured else _POINT
    with path.open("rb") as file:
        file.seek(begin)
        while left > 0:
            n_lines = min(left, _BLOCK)
            try:
                values = np.loadtxt(
                    text_lines.take_lines(file, n_lines, name), usecols=columns, ndmin=2
                )
            except ValueError:
                values = np.empty((0, 3))
            if len(values) != n_lines:
                words = "x y z intensity" + (" red green blue" if coloured else "")
                raise StageError(
                    f"{name}: damaged: one of the {n_lines} lines from point"
                    f" {header.n_points - left} on is no point `{words}`; export it again"
                )
            xyz_m = values[:, :3]
            xyz_m[~xyz_m.any(axis=1)] = np.nan
            rgb = None
            if coloured:
                levels = np.clip(np.nan_to_num(values[:, 3:]), 0, 255)
                rgb = (_SHADES * levels.round()).astype(np.uint16)
            yield se3.transform_points(header.sensor_from_points, xyz_m), rgb
            left -= n_lines
