"""Points of .ply and .pcd files that are tables of numbers, of any size, some at a time."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings.integrity import pcd_size, ply_size, text_lines
from scanplan.recordings.messages import TIME_FIELDS
from scanplan.types import Array, FloatArray

_BLOCK = 2**18  # points at a time: 8 MB of most
_AXES = ("x", "y", "z")
_ORDER = {"binary_big_endian": ">"}
"""The order of bytes, where it is not the other one."""


@dataclass(frozen=True)
class PointTable:
    """A file whose points are rows of numbers.

    Attributes
    ----------
    path : pathlib.Path
    is_text : bool
    begin : int
        The first byte of the first row.
    n_points : int
        As its header states them.
    fields : tuple of (str, str, int)
        Name, numpy's type, and how many of it a point has.
    """

    path: Path
    is_text: bool
    begin: int
    n_points: int
    fields: tuple[tuple[str, str, int], ...]


def describe_table(path: Path) -> PointTable | None:
    """Return what a .ply or .pcd states of its points.

    None where they are no table: packed, with lists, or behind other elements.

    Raises
    ------
    StageError
        If its header cannot be read or states more than the file holds, or its points have no x, y,
        z of a type of numbers.
    """
    if path.suffix.lower() == ".ply":
        of_ply = ply_size.read_ply_header(path)
        if of_ply.n_before or not all(kind for _, kind in of_ply.types):
            return None
        order, numpy_types = _ORDER.get(of_ply.form, "<"), ply_size.NUMPY_TYPES
        fields = tuple((name, f"{order}{numpy_types[kind]}", 1) for name, kind in of_ply.types)
        header = of_ply
    else:
        header = pcd_size.read_pcd_header(path)
        if header.form == pcd_size.PACKED:
            return None
        fields = tuple((name, f"<{kind}", count) for name, kind, count in header.fields)
    names = [name for name, _, _ in fields]
    if not set(_AXES) <= set(names):
        raise StageError(
            f"{path}: its points have no x, y, z but {', '.join(names)}; write it again"
        )
    if not all(_is_number(kind) for _, kind, _ in fields):
        raise StageError(f"{path}: damaged: its fields are of no known type; write it again")
    is_text = header.form in (pcd_size.TEXT, ply_size.TEXT)
    return PointTable(path, is_text, header.begin, header.n_points, fields)


def read_blocks(table: PointTable) -> Iterator[FloatArray]:
    """Yield the points (n, 3) float64 of a table, as it has them.

    Raises
    ------
    StageError
        If it is damaged.
    """
    return (_stack_axes(rows) for rows in _read_rows(table, ()))


def read_whole(table: PointTable) -> tuple[FloatArray, Array | None]:
    """Return the points (n, 3) float64 and their times (n,) as recorded, or None without any.

    Raises
    ------
    StageError
        If it is damaged.
    """
    there = {name for name, _, _ in table.fields}
    times = [name for name in TIME_FIELDS if name in there][:1]
    blocks = list(_read_rows(table, times))
    xyz_m = np.concatenate([np.empty((0, 3)), *map(_stack_axes, blocks)])
    if not times:
        return xyz_m, None
    kind = np.dtype(_row_type(table, times)[times[0]].base).newbyteorder("=")
    of_blocks = [rows[times[0]].reshape(-1) for rows in blocks]
    return xyz_m, np.concatenate([np.empty(0, kind), *of_blocks]).astype(kind)


def say_cut_short(path: Path, n_stated: int, n_there: int) -> StageError:
    """Return the refusal of a file that states more points, or fewer, than it holds."""
    return StageError(
        f"{path}: damaged: states {n_stated} points, {n_there} can be read; write it again"
    )


def _is_number(kind: str) -> bool:
    try:
        return np.dtype(kind).kind in "fiu"
    except TypeError:
        return False


def _stack_axes(rows: Array) -> FloatArray:
    columns = [rows[axis].reshape(len(rows), -1)[:, 0] for axis in _AXES]
    return np.column_stack([column.astype(np.float64) for column in columns])


def _row_type(table: PointTable, further: list[str] | tuple[str, ...]) -> np.dtype:
    """Return the type of a point: x, y, z and further fields by name, which may repeat."""
    wanted = {*_AXES, *further}
    fields = []
    for number, (name, kind, count) in enumerate(table.fields):
        is_first = name in wanted
        wanted.discard(name)
        fields.append((name if is_first else f"_{number}", kind, (count,)))
    return np.dtype(fields)


def _read_rows(table: PointTable, further: list[str] | tuple[str, ...]) -> Iterator[Array]:
    """Yield rows of all fields, or of text those that are wanted, whose coordinates are float64."""
    row = _row_type(table, further)
    with table.path.open("rb") as file:
        file.seek(table.begin)
        for first in range(0, table.n_points, _BLOCK):
            n_rows = min(_BLOCK, table.n_points - first)
            if table.is_text:
                rows = _read_lines(table, file, row, first, n_rows)
            else:
                rows = np.fromfile(file, row, n_rows)
            if len(rows) != n_rows:
                raise say_cut_short(table.path, table.n_points, first + len(rows))
            yield rows


def _read_lines(
    table: PointTable, file: BinaryIO, row: np.dtype, first: int, n_lines: int
) -> Array:
    """Return rows of text, fewer than asked for at its end."""
    begins = np.cumsum([0, *(count for _, _, count in table.fields)]).tolist()
    names = [name for name in row.names or () if not name.startswith("_")]
    places = [begins[(row.names or ()).index(name)] for name in names]
    kinds = ["f8" if name in _AXES else row[name].base for name in names]
    lines = text_lines.take_lines(file, n_lines, str(table.path))
    try:
        # it warns of no lines
        form = np.dtype(list(zip(names, kinds, strict=True)))
        rows = np.loadtxt(lines, form, usecols=places, ndmin=1) if lines else np.empty(0, form)
    except ValueError:
        rows = None
    if rows is None or len(rows) != len(lines):
        raise StageError(
            f"{table.path}: damaged: one of the {n_lines} lines from point {first} on is no"
            " point; write it again"
        )
    return rows
