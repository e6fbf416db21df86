"""Stations in E57 files (ASTM E2807), as laser scanners and surveyors' programs write them."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings.integrity import e57_header
from scanplan.recordings.stations.station_scans import Station
from scanplan.types import FloatArray

_BLOCK = 2**18  # points at a time: 8 MB of doubles
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_INVALID = {_CARTESIAN: "cartesianInvalidState", _SPHERICAL: "sphericalInvalidState"}


def list_e57_stations(path: Path) -> list[Station]:
    """Return the scans of a file that have points.

    Raises
    ------
    StageError
        If the file is damaged, or a scan has no coordinates.
    """
    stations = []
    for number, scan in enumerate(e57_header.read_scans(path)):
        if scan.n_points == 0:
            continue
        name = f"{path}: scan {number}"
        axes = next((a for a in (_CARTESIAN, _SPHERICAL) if set(a) <= set(scan.fields)), None)
        if axes is None:
            raise StageError(
                f"{name} has no coordinates; its fields are: {', '.join(scan.fields)}; export it"
                " again"
            )
        invalid = _INVALID[axes]
        fields = (*axes, invalid) if invalid in scan.fields else axes
        read = partial(_read_blocks, path, number, name, scan.n_points, fields)
        stations.append(Station(name, scan.world_from_sensor, read))
    return stations


def _read_blocks(
    path: Path, number: int, name: str, n_points: int, fields: tuple[str, ...]
) -> Iterator[FloatArray]:
    """Yield points (n, 3) of a scan in its own frame, NaN where they are marked as invalid."""
    from pye57 import libe57

    n_read = 0
    try:
        file = libe57.ImageFile(str(path), "r")
        columns = {field: np.empty(_BLOCK) for field in fields}
        buffers = libe57.VectorSourceDestBuffer()
        for field, column in columns.items():
            buffers.append(libe57.SourceDestBuffer(file, field, column, _BLOCK, True, True))
        reader = file.root()["data3D"][number]["points"].reader(buffers)
        while n := reader.read():
            n_read += n
            yield _to_points({field: column[:n] for field, column in columns.items()})
        reader.close()
        file.close()
    except libe57.E57Exception as error:
        raise StageError(
            f"{name}: damaged ({_first_words(str(error))}); copy or export it again"
        ) from None
    if n_read != n_points:
        raise StageError(
            f"{name}: damaged: states {n_points} points, {n_read} can be read; export it again"
        )


def _to_points(columns: dict[str, FloatArray]) -> FloatArray:
    names = list(columns)
    values = np.column_stack([columns[name] for name in names[:3]])
    if names[0] == _SPHERICAL[0]:
        range_m, azimuth, elevation = values.T
        level_m = range_m * np.cos(elevation)
        values = np.column_stack(
            [level_m * np.cos(azimuth), level_m * np.sin(azimuth), range_m * np.sin(elevation)]
        )
    if len(names) > 3:
        # 1: only the direction is known, 2: nothing is
        values[columns[names[3]] != 0] = np.nan
    return values


def _first_words(text: str) -> str:
    """Return the reason in the library's report of several lines."""
    return text.partition("\n")[0].rpartition("exception: ")[2][:100]
