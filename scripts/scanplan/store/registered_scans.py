"""The registered scans of a dataset as the evaluation needs them: rows in the order of their scan_ids."""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.store import schemas, tables

_RERUN = "delete the results of this dataset and run again"


@dataclass(frozen=True)
class RegisteredScans:
    """The scans that registration kept.

    Attributes
    ----------
    scan_ids : (n,) int32, increasing
    t_ns : (n,) int64
    map_from_sensor : (n, 4, 4) float64
        As registered.
    """

    scan_ids: np.ndarray
    t_ns: np.ndarray
    map_from_sensor: np.ndarray


def read_registered_scans(path):
    """Read the kept scans of a registration.parquet.

    Raises
    ------
    StageError
        If there is none, or one has no pose.
    """
    columns = tables.read_table(path, schemas.REGISTRATION)
    columns = {name: values[columns["kept"]] for name, values in columns.items()}
    pose = _matrices(columns)
    lost = np.count_nonzero(~np.isfinite(pose).all(axis=(1, 2)))
    if len(pose) == 0 or lost:
        raise StageError(
            f"{path}: {len(pose)} scans are kept, {lost} of them without a pose; {_RERUN}"
        )
    return RegisteredScans(columns["scan_id"], columns["t_ns"], pose)


def read_prior_poses(path, scans, origin):
    """Return map_from_sensor (n, 4, 4) of the scans as the localiser gave it, from a poses.parquet.

    Raises
    ------
    StageError
        If a scan has no pose there: the tables at `path` and `origin` are of different runs.
    """
    columns = tables.read_table(path, schemas.POSES)
    columns = {name: values[columns["covered"]] for name, values in columns.items()}
    row = np.searchsorted(columns["scan_id"], scans.scan_ids)
    known = np.isin(scans.scan_ids, columns["scan_id"])
    if not known.all():
        raise StageError(
            f"{path}: no pose of scan {scans.scan_ids[~known][0]}, which {origin} keeps; {_RERUN}"
        )
    return _matrices(columns)[row]


def rows_of_scans(scan_ids, scans, path, origin):
    """Return the rows of scans by their scan_ids.

    Raises
    ------
    StageError
        If one is not kept: the tables at `path` and `origin` are of different runs.
    """
    unknown = np.setdiff1d(scan_ids, scans.scan_ids)
    if len(unknown):
        raise StageError(
            f"{path}: scan {unknown[0]} is none of the {len(scans.scan_ids)} kept in {origin}; {_RERUN}"
        )
    return np.searchsorted(scans.scan_ids, scan_ids)


def read_order_rows(path, scans, origin):
    """Return the rows of the scans in the order of a selection/<method>.parquet."""
    return rows_of_scans(
        tables.read_table(path, schemas.SELECTION, ["rank", "scan_id"])["scan_id"],
        scans,
        path,
        origin,
    )


def read_wall_segments(path, scans, origin):
    """Return the columns of a walls/<extractor>.parquet, of kept scans alone; there may be no row."""
    columns = tables.read_table(path, schemas.WALLS, allow_empty=True)
    rows_of_scans(columns["scan_id"], scans, path, origin)
    return columns


def oracle_columns(best, scans):
    """Return the `oracle.OracleOrder` of every extractor as the columns of `schemas.ORACLE`."""
    n = len(scans.scan_ids)
    orders = [best[extractor] for extractor in sorted(best)]
    return {
        "extractor": np.repeat(sorted(best), n),
        "rank": np.tile(np.arange(1, n + 1), len(best)),
        "scan_id": np.concatenate([scans.scan_ids[order.order] for order in orders]),
        "gain_m": np.concatenate([order.gain_m for order in orders]),
        "found_m": np.concatenate([np.cumsum(order.gain_m) for order in orders]),
    }


def _matrices(columns):
    return se3.pose_matrix(
        *(np.column_stack([columns[c] for c in names]) for names in (schemas.XYZ, schemas.QUAT))
    )
