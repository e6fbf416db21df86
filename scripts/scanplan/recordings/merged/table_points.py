"""Points of .ply and .pcd files of any size, some at a time."""

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import scan_folder
from scanplan.recordings.integrity import pcd_size, ply_size
from scanplan.types import FloatArray

_BLOCK = 2**18  # points at a time: 8 MB of most
_AXES = ("x", "y", "z")
_ORDER = {"binary_little_endian": "<", "binary_big_endian": ">", "binary": "<"}


def read_ply_blocks(path: Path) -> Iterator[FloatArray]:
    """Yield the points (n, 3) of a .ply, as it has them.

    Raises
    ------
    StageError
        If it is damaged, or of a form that is not read.
    """
    header = ply_size.read_ply_header(path)
    names = [name for name, _ in header.types]
    has_list = not all(kind for _, kind in header.types)
    if header.n_before or has_list or not set(_AXES) <= set(names):
        raise StageError(
            f"{path}: its header is not that of a cloud of points: these stand first, with x, y, z"
            " and no lists; write it again"
        )
    if header.form == ply_size.TEXT:
        columns = [names.index(axis) for axis in _AXES]
        return _read_lines(path, header.begin, header.n_points, columns)
    kinds = [(kind, 1) for kind in (ply_size.NUMPY_TYPES[kind] for _, kind in header.types)]
    row = _row_type(path, names, kinds, _ORDER[header.form])
    return _read_rows(path, header.begin, header.n_points, row)


def read_pcd_blocks(path: Path) -> Iterator[FloatArray]:
    """Yield the points (n, 3) of a .pcd, as it has them.

    Raises
    ------
    StageError
        If it is damaged, has no x, y, z, or is packed and unpacks to too much.
    """
    header = pcd_size.read_pcd_header(path)
    names = [name for name, _, _ in header.fields]
    if not set(_AXES) <= set(names):
        raise StageError(
            f"{path}: its points have no x, y, z but {', '.join(names)}; write it again"
        )
    if header.form == pcd_size.PACKED:
        return iter([scan_folder.read_cloud_file(path)[0].astype(np.float64)])
    if header.form == pcd_size.TEXT:
        begins = np.cumsum([0, *(count for _, _, count in header.fields)]).tolist()
        columns = [begins[names.index(axis)] for axis in _AXES]
        return _read_lines(path, header.begin, header.n_points, columns)
    kinds = [(kind, count) for _, kind, count in header.fields]
    row = _row_type(path, names, kinds, _ORDER[header.form])
    return _read_rows(path, header.begin, header.n_points, row)


def _row_type(
    path: Path, names: Sequence[str], kinds: Sequence[tuple[str, int]], order: str
) -> np.dtype:
    """Return the type of a point, its fields but x, y, z without their names, which may repeat."""
    fields = []
    for number, (name, (kind, count)) in enumerate(zip(names, kinds, strict=True)):
        is_axis = name in _AXES and name not in names[:number]
        fields.append((name if is_axis else f"_{number}", f"{order}{kind}", (count,)))
    try:
        row = np.dtype(fields)
    except (TypeError, ValueError):
        row = np.dtype("V")
    if row.names is None or any(kind[0] not in "fiu" for kind, _ in kinds):
        raise StageError(f"{path}: damaged: its fields are of no known type; write it again")
    return row


def _read_rows(path: Path, begin: int, n_points: int, row: np.dtype) -> Iterator[FloatArray]:
    with path.open("rb") as file:
        file.seek(begin)
        for first in range(0, n_points, _BLOCK):
            n_rows = min(_BLOCK, n_points - first)
            rows = np.fromfile(file, row, n_rows)
            if len(rows) != n_rows:
                raise scan_folder.say_cut_short(path, n_points, first + len(rows))
            yield np.column_stack([rows[axis][:, 0].astype(np.float64) for axis in _AXES])


def _read_lines(
    path: Path, begin: int, n_points: int, columns: Sequence[int]
) -> Iterator[FloatArray]:
    with path.open("rb") as file:
        file.seek(begin)
        for first in range(0, n_points, _BLOCK):
            n_lines = min(_BLOCK, n_points - first)
            lines = list(islice(file, n_lines))
            if len(lines) != n_lines:
                raise scan_folder.say_cut_short(path, n_points, first + len(lines))
            try:
                xyz_m = np.loadtxt(lines, usecols=columns, ndmin=2)
            except ValueError:
                xyz_m = np.empty((0, 3))
            if len(xyz_m) != n_lines:
                raise StageError(
                    f"{path}: damaged: one of the {n_lines} lines from point {first} on is no"
                    " point; write it again"
                )
            yield xyz_m
