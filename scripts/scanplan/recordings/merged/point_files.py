"""The points of files, whatever their format, some at a time."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from scanplan.recordings import las_points
from scanplan.recordings.merged import table_points
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


_READERS: dict[str, Callable[[Path], Iterator[FloatArray]]] = {
    **dict.fromkeys((".las", ".laz"), _read_las),
    ".ply": table_points.read_ply_blocks,
    ".pcd": table_points.read_pcd_blocks,
}
