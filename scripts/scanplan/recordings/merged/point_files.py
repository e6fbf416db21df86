"""The points of files, whatever their format, some at a time."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import las_points, scan_folder, table_points
from scanplan.types import FloatArray


def list_sources(paths: Sequence[Path]) -> list[Callable[[], Iterator[FloatArray]]]:
    """Return what reads each of .las, .laz, .ply and .pcd files.

    Raises
    ------
    StageError
        When it is asked for points, if a file is damaged.
    """
    return [partial(_READERS[path.suffix.lower()], path) for path in paths]


def _read_las(path: Path) -> Iterator[FloatArray]:
    for block in las_points.list_blocks(path):
        yield block.read().xyz_m


def _read_table(path: Path) -> Iterator[FloatArray]:
    table = table_points.describe_table(path)
    if table is not None:
        return table_points.read_blocks(table)
    if path.suffix.lower() == ".ply":
        raise StageError(
            f"{path}: its header is not that of a cloud of points: these stand first, with x, y, z"
            " and no lists; write it again"
        )
    return iter([scan_folder.read_cloud_file(path)[0].astype(np.float64)])


_READERS: dict[str, Callable[[Path], Iterator[FloatArray]]] = {
    **dict.fromkeys((".las", ".laz"), _read_las),
    **dict.fromkeys((".ply", ".pcd"), _read_table),
}
