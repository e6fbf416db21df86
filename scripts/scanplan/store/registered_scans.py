"""The registered scans of a dataset: ids, stamps, poses, and the rows of other tables' scans."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from scanplan.errors import StageError
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import covariance_matrices, pose_matrices
from scanplan.types import Array, Columns, FilePath, FloatArray, IntArray


class ScanReader(Protocol):
    """Registered scans as a `tables.ScanStore` reads them."""

    @property
    def planar(self) -> bool:
        """Whether the sensor measures in one plane only."""
        ...

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans or of those asked for."""
        ...


@dataclass(frozen=True)
class RegisteredScans:
    """The scans that registration kept.

    Attributes
    ----------
    scan_ids : (n,) int32, increasing
    t_ns : (n,) int64
    map_from_sensor : (n, 4, 4) float64
        As registered.
    covariance : (n, 3, 3) float64
        Of x, y and heading, metres and radians, as far as the poses err against each other; NaN
        where they were not optimised together.
    """

    scan_ids: IntArray
    t_ns: IntArray
    map_from_sensor: FloatArray
    covariance: FloatArray


def read_registered_scans(path: FilePath, store: tables.ScanStore | None = None) -> RegisteredScans:
    """Read the kept scans of a registration.parquet.

    Parameters
    ----------
    store : ScanStore, optional
        Their points; where given, those of every scan must be there, so that none is lost in
        silence.

    Raises
    ------
    StageError
        If there is none, or one has no pose, or one of them no points in the store.
    """
    scans = select_kept_scans(tables.read_table(path, schemas.REGISTRATION), path)
    if store is not None and len(lacking := np.setdiff1d(scans.scan_ids, store.scan_ids)):
        raise StageError(
            f"{store.path}: lacks scan {lacking[0]} of {path} ({len(lacking)} such scans);"
            f" {tables.RERUN_ALL}"
        )
    return scans


def select_kept_scans(columns: Columns, path: FilePath) -> RegisteredScans:
    """Return the kept scans of a table of registration that was read from `path`.

    Raises
    ------
    StageError
        If there is none, or one has no pose.
    """
    kept = _select_rows(columns, columns["kept"])
    pose = pose_matrices(kept)
    n_unknown = np.count_nonzero(~np.isfinite(pose).all(axis=(1, 2)))
    if len(pose) == 0 or n_unknown:
        raise StageError(
            f"{path}: {len(pose)} scans are kept, {n_unknown} of them without a pose;"
            f" {tables.RERUN_ALL}"
        )
    return RegisteredScans(kept["scan_id"], kept["t_ns"], pose, covariance_matrices(kept))


def read_prior_poses(path: FilePath, scans: RegisteredScans, origin: FilePath) -> FloatArray:
    """Return map_from_sensor (n, 4, 4) of the scans as the localiser gave it, from a poses.parquet.

    Raises
    ------
    StageError
        If a scan has no pose there: the tables at `path` and `origin` are of different runs.
    """
    columns = tables.read_table(path, schemas.POSES)
    known = _select_rows(columns, columns["covered"])
    return pose_matrices(known)[_join(scans.scan_ids, known["scan_id"], origin, path)]


def rows_of_scans(
    scan_ids: IntArray, scans: RegisteredScans, path: FilePath, origin: FilePath
) -> IntArray:
    """Return the rows of scans by their scan_ids.

    Parameters
    ----------
    scan_ids : (k,) int
    path, origin : path-like
        Where the scan_ids and the registered scans come from, for the message.

    Returns
    -------
    (k,) int64

    Raises
    ------
    StageError
        If one is not kept: the tables at `path` and `origin` are of different runs.
    """
    return _join(scan_ids, scans.scan_ids, path, origin)


def sensor_positions(
    scan_ids: IntArray, scans: RegisteredScans, path: FilePath, origin: FilePath
) -> FloatArray:
    """Return where the sensor was, (k, 3) in the map frame, at the scans of `rows_of_scans`."""
    return scans.map_from_sensor[rows_of_scans(scan_ids, scans, path, origin), :3, 3]


def sensor_places(registration: Columns, scan_ids: IntArray) -> FloatArray:
    """Return where the sensor stood in scans, in the order asked for.

    Parameters
    ----------
    registration : dict of str to (n,) array
        Of a table of registration.
    scan_ids : (k,) int

    Returns
    -------
    (k, 2) float64, map frame

    Raises
    ------
    StageError
        If a scan was not kept: the tables are of different runs.
    """
    scans = select_kept_scans(registration, "registration")
    return sensor_positions(scan_ids, scans, "selection", "registration")[:, :2]


def read_order_rows(path: FilePath, scans: RegisteredScans, origin: FilePath) -> IntArray:
    """Return the rows of the scans in the order of a selection/<method>.parquet."""
    ordering = tables.read_table(path, schemas.SELECTION, ["rank", "scan_id"])
    return rows_of_scans(ordering["scan_id"], scans, path, origin)


def read_wall_segments(
    path: FilePath, scans: RegisteredScans, origin: FilePath
) -> dict[str, Array]:
    """Return the columns of a walls/<extractor>.parquet, of kept scans alone.

    There may be no row.
    """
    columns = tables.read_table(path, schemas.WALLS, allow_empty=True)
    rows_of_scans(columns["scan_id"], scans, path, origin)
    return columns


def _select_rows(columns: Columns, rows: Array) -> dict[str, Array]:
    return {name: values[rows] for name, values in columns.items()}


def _join(scan_ids: IntArray, known_ids: IntArray, path: FilePath, origin: FilePath) -> IntArray:
    """Return the rows (k,) of scans of `path` in the increasing ids with a pose in `origin`."""
    unknown = np.setdiff1d(scan_ids, known_ids)
    if len(unknown):
        raise StageError(
            f"{origin}: no pose of scan {unknown[0]} of {path} ({len(unknown)} such scans);"
            f" {tables.RERUN_ALL}"
        )
    return np.searchsorted(known_ids, scan_ids)
