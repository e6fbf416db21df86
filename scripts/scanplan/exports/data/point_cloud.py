"""Registered points as a LAZ file."""

import struct
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

import laspy
import numpy as np
from laspy.vlrs.known import GeoKeyDirectoryVlr

from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.types import Array, BoolArray, FilePath, FloatArray, IntArray

ScanPoints = tuple[int, FloatArray, Array | None]
"""scan_id, points (n, 3) float32 in metres, map frame, and their colours (n, 3) uint16, if any."""


def write_laz(
    path: FilePath,
    scans: Iterable[ScanPoints],
    cell_m: float,
    t_ns: int,
    site: Site = NOWHERE,
    *,
    coloured: bool = False,
) -> tuple[int, int]:
    """Write the points of scans, thinned.

    Parameters
    ----------
    path : path-like
        Where there is no file yet.
    scans : iterable of ScanPoints
        Read one at a time.
    cell_m : float, >= 0
        Of all points in a cube of this edge the first is kept; all are at 0.
    t_ns : int
        When the survey was made, Unix time: the day that the file says it was made.
    site : Site
        Where the map lies.
    coloured : bool
        Whether points have colours; those of a scan without any are black.

    Returns
    -------
    n_points, n_kept : int

    Notes
    -----
    LAS 1.4, point format 6 (with colours 7), with the extra dimension `scan_id`. Coordinates are
    rounded to a millimetre; they are the map frame's, no system on earth is stated, but where the
    map lies in one: then they are its, of point format 1 (3), which states it by its number.
    """
    cells = _SeenCells(cell_m)
    n_points = n_kept = 0
    with (
        Path(path).open("w+b") as stream,
        laspy.LasWriter(
            stream,
            _header(t_ns, site, coloured=coloured),
            do_compress=True,
            laz_backend=laspy.LazBackend.Lazrs,
        ) as file,
    ):
        for scan_id, xyz_m, rgb in scans:
            is_kept = cells.add(xyz_m)
            kept_m = xyz_m[is_kept]
            record = laspy.ScaleAwarePointRecord.zeros(len(kept_m), header=file.header)
            record.x, record.y = site.place(kept_m[:, :2].astype(float)).T
            record.z = kept_m[:, 2].astype(float) + (site.height_m if site.is_placed else 0.0)
            record["scan_id"] = np.full(len(kept_m), scan_id, np.uint32)
            record["return_number"] = record["number_of_returns"] = np.ones(len(kept_m), np.uint8)
            if rgb is not None and coloured:
                record["red"], record["green"], record["blue"] = rgb[is_kept].T
            file.write_points(record)
            n_points += len(xyz_m)
            n_kept += len(kept_m)
    return n_points, n_kept


def _header(t_ns: int, site: Site, *, coloured: bool) -> laspy.LasHeader:
    # from format 6 on a system is stated as text, which only its registry has
    plain, with_colours = (1, 3) if site.is_placed else (6, 7)
    header = laspy.LasHeader(point_format=with_colours if coloured else plain, version="1.4")
    if site.epsg is not None:
        header.vlrs.append(_state_system(site.epsg))
    header.add_extra_dim(laspy.ExtraBytesParams("scan_id", "u4", "scan of the recording"))
    # metres that coordinates are rounded to: less than any scanner's noise
    header.scales = np.full(3, 0.001)
    # numbers of 32 bits do not reach from the Equator
    header.offsets = np.array([round(site.east_m), round(site.north_m), 0.0])
    header.generating_software = "scanplan"
    header.creation_date = datetime.fromtimestamp(t_ns // 10**9, UTC).date()
    return header


def _state_system(epsg: int) -> GeoKeyDirectoryVlr:
    """Return the number of a projected system of metres as keys of GeoTIFF."""
    keys = {1024: 1, 3072: epsg, 3076: 9001}
    directory = [1, 1, 0, len(keys)]
    for key, value in keys.items():
        directory += [key, 0, 1, value]
    stated = GeoKeyDirectoryVlr()
    stated.parse_record_data(struct.pack(f"<{len(directory)}H", *directory))
    return stated


class _SeenCells:
    """Cubes that points were in.

    They are kept as sorted runs of falling length, so that to add many scans takes hardly more
    than to sort all.
    """

    def __init__(self, cell_m: float) -> None:
        self._cell_m = cell_m
        self._runs: list[IntArray] = []

    def add(self, xyz_m: FloatArray) -> BoolArray:
        """Return which points (n,) are the first in their cubes, of those that were added."""
        is_first = np.zeros(len(xyz_m), bool)
        if self._cell_m == 0:
            return ~is_first
        keys, firsts = np.unique(self._keys(xyz_m), return_index=True)
        for run in self._runs:
            places = np.searchsorted(run, keys).clip(max=len(run) - 1)
            is_new = run[places] != keys
            keys, firsts = keys[is_new], firsts[is_new]
        is_first[firsts] = True
        if len(keys):
            self._runs.append(keys)
        while len(self._runs) > 1 and len(self._runs[-2]) < 2 * len(self._runs[-1]):
            last = self._runs.pop()
            self._runs[-1] = np.union1d(self._runs[-1], last)
        return is_first

    def _keys(self, xyz_m: FloatArray) -> IntArray:
        """Return a number for the cube of each point, 21 bits of each coordinate."""
        cells = np.floor(xyz_m / self._cell_m).astype(np.int64) & (1 << 21) - 1
        return cells @ np.array([1 << 42, 1 << 21, 1], np.int64)
