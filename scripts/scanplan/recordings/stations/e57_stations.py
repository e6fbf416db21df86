"""Stations in E57 files (ASTM E2807), as laser scanners and surveyors' programs write them."""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings.integrity import e57_header
from scanplan.recordings.stations.station_scans import Block, Station
from scanplan.types import Array, FloatArray

_BLOCK = 2**18  # points at a time: 8 MB of doubles
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_INVALID = {_CARTESIAN: "cartesianInvalidState", _SPHERICAL: "sphericalInvalidState"}
_NO_COLOUR = "isColorInvalid"
_WHITE = np.iinfo(np.uint16).max


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
        read = partial(_read_blocks, path, number, name, scan, fields)
        has_colours = scan.colour_limits is not None
        stations.append(Station(name, scan.world_from_sensor, read, has_colours))
    return stations


def _read_blocks(
    path: Path,
    number: int,
    name: str,
    scan: e57_header.E57Scan,
    fields: tuple[str, ...],
    coloured: bool,
) -> Iterator[Block]:
    """Yield points (n, 3) of a scan in its own frame, NaN where they are marked as invalid.

    Parameters
    ----------
    fields : tuple of str
        Three coordinates and, where there is one, what says that they are none.
    coloured : bool
        Whether to yield their colours, too.
    """
    from pye57 import libe57

    shades = e57_header.COLOURS if coloured else ()
    marks = (_NO_COLOUR,) if coloured and _NO_COLOUR in scan.fields else ()
    n_read = 0
    try:
        file = libe57.ImageFile(str(path), "r")
        columns = {field: np.empty(_BLOCK) for field in (*fields, *shades, *marks)}
        buffers = libe57.VectorSourceDestBuffer()
        for field, column in columns.items():
            buffers.append(libe57.SourceDestBuffer(file, field, column, _BLOCK, True, True))
        reader = file.root()["data3D"][number]["points"].reader(buffers)
        while n := reader.read():
            n_read += n
            read = {field: column[:n] for field, column in columns.items()}
            rgb = _to_colours(read, scan) if coloured else None
            yield _to_points({field: read[field] for field in fields}), rgb
        reader.close()
        file.close()
    except libe57.E57Exception as error:
        raise StageError(
            f"{name}: damaged ({_first_words(str(error))}); copy or export it again"
        ) from None
    if n_read != scan.n_points:
        raise StageError(
            f"{name}: damaged: states {scan.n_points} points, {n_read} can be read; export it again"
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


def _to_colours(columns: Mapping[str, FloatArray], scan: e57_header.E57Scan) -> Array:
    """Return colours (n, 3) uint16 of what lies between the limits that the file states."""
    values = np.column_stack([columns[name] for name in e57_header.COLOURS])
    low, high = np.asarray(scan.colour_limits).T
    share = np.clip((values - low) / np.where(high > low, high - low, 1.0), 0, 1)
    rgb = np.round(np.nan_to_num(share) * _WHITE).astype(np.uint16)
    if _NO_COLOUR in columns:
        rgb[columns[_NO_COLOUR] != 0] = 0
    return rgb


def _first_words(text: str) -> str:
    """Return the reason in the library's report of several lines."""
    return text.partition("\n")[0].rpartition("exception: ")[2][:100]
