"""Reading and writing the tables between the stages, as Parquet.

Every file carries the name and version of its schema and page checksums, and is checked against the
schema on write and on read. `schemas` lists the columns.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
import pyarrow as pa

from scanplan.errors import StageError
from scanplan.store import arrow_arrays, parquet, schemas
from scanplan.types import Array, FilePath, FloatArray

RERUN_ALL = "delete the results of this dataset and run again"
"""What to do where tables are not of one run."""


def write_table(
    path: FilePath,
    schema: schemas.Schema,
    columns: Mapping[str, Array | Sequence[object]],
    *,
    allow_empty: bool = False,
    notes: Mapping[str, str] | None = None,
    made_of: str = "",
) -> None:
    """Write a table, whole or not at all.

    Parameters
    ----------
    columns : dict of str to (n,) array-like
        Exactly the schema's columns.
    allow_empty : bool
        Whether zero rows are an answer (no wall found) and not a mistake.
    notes : dict of str to str, optional
        What the file says beside its rows, by name; see `read_note`.
    made_of : str
        Digest of the recordings, which tables of a dataset that has poses take from there.

    Raises
    ------
    ValueError
        If the columns do not fit the schema or are not sorted as it says.
    StageError
        If there are no rows and that is not allowed.
    """
    if set(columns) != set(schema.columns):
        raise ValueError(
            f"{schema.name}: columns {sorted(columns)} instead of {sorted(schema.columns)}"
        )
    form = parquet.arrow_schema(schema)
    arrays = [arrow_arrays.to_arrow(columns[n], form.field(n).type) for n in schema.columns]
    table = pa.Table.from_arrays(arrays, schema=form)
    parquet.check_rows(table, schema, path, allow_empty, ValueError)
    with parquet.open_writer(path, schema, notes, made_of=made_of) as write_rows:
        write_rows(table)


def read_table(
    path: FilePath,
    schema: schemas.Schema,
    columns: Sequence[str] | None = None,
    *,
    allow_empty: bool = False,
) -> dict[str, Array]:
    """Read a table that another stage wrote.

    Parameters
    ----------
    columns : sequence of str, optional
        Only these columns; all of them by default.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
        `binary` and `string` columns as object arrays.

    Raises
    ------
    StageError
        If the file is missing, damaged, of another schema or version, unsorted or (unless allowed)
        empty.
    """
    with parquet.open_file(path, schema) as file:
        table = file.read(columns=None if columns is None else list(columns))
    parquet.check_rows(table, schema, path, allow_empty, StageError)
    return {name: arrow_arrays.to_numpy(table[name]) for name in table.column_names}


def no_rows(schema: schemas.Schema) -> dict[str, Array]:
    """Return the columns of a table of a schema that has no rows."""
    table = parquet.arrow_schema(schema).empty_table()
    return {name: arrow_arrays.to_numpy(table[name]) for name in table.column_names}


def read_note(path: FilePath, schema: schemas.Schema, name: str) -> str:
    """Return what a table says beside its rows under a name; nothing where it says nothing.

    Raises
    ------
    StageError
        If the file is missing, damaged or of another schema or version.
    """
    return read_notes(path, schema).get(name, "")


def read_notes(path: FilePath, schema: schemas.Schema) -> dict[str, str]:
    """Return all that a table says beside its rows, by name; raises as `read_note`."""
    with parquet.open_file(path, schema) as file:
        return parquet.read_notes(file, path)


@contextmanager
def open_scan_writer(
    path: FilePath,
    *,
    planar: bool,
    schema: schemas.Schema = schemas.SCANS,
    allow_empty: bool = False,
) -> Iterator[Callable[[int, FloatArray], None]]:
    """Write scans one by one, each a row group of its own.

    Parameters
    ----------
    planar : bool
        Whether the sensor measures in one plane only (a 2-D laser scanner); kept in the file for
        later stages.
    schema : Schema
        Of which scans and in which frame: by default the registered ones in the map.

    Yields
    ------
    callable
        `write(scan_id, xyz_m)` with increasing `scan_id` and (n, 3) float coordinates, n >= 1.

    Raises
    ------
    StageError
        If no scan was written and that is not allowed: the file does not appear.
    """
    last: int | None = None
    extra = {"planar": json.dumps(bool(planar))}
    # of points lz4 saves as much as zstd, and takes half the time to write and to read
    with parquet.open_writer(path, schema, extra, compression="lz4") as write_rows:

        def write_scan(scan_id: int, xyz_m: FloatArray) -> None:
            nonlocal last
            if len(xyz_m) == 0 or (last is not None and scan_id <= last):
                raise ValueError(f"scan {scan_id} after {last} with {len(xyz_m)} points")
            last = scan_id
            xyz_m = np.asarray(xyz_m, np.float32)
            columns = [np.full(len(xyz_m), scan_id, np.int32), *xyz_m.T]
            form = parquet.arrow_schema(schema)
            arrays = [
                arrow_arrays.to_arrow(column, field.type)
                for column, field in zip(columns, form, strict=True)
            ]
            rows = pa.Table.from_arrays(arrays, schema=form)
            write_rows(rows, row_group_size=len(rows))

        yield write_scan
        if last is None and not allow_empty:
            raise StageError(
                f"{path}: no scan was kept, so there is nothing to go on with; see the stage's log"
            )


class ScanStore:
    """The registered scans of a dataset, read one at a time.

    Parameters
    ----------
    schema : Schema
        As `open_scan_writer` wrote it.

    Attributes
    ----------
    scan_ids : (n,) int32, increasing
    n_points : (n,) int64
    planar : bool
        Whether the sensor measures in one plane only.
    """

    def __init__(
        self, path: FilePath, schema: schemas.Schema = schemas.SCANS, *, allow_empty: bool = False
    ) -> None:
        self.path = path
        self._schema = schema
        with parquet.open_file(path, schema) as file, parquet.explain_damage(path):
            metadata = self._footer = file.metadata
            groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
            ids = [group.column(0).statistics for group in groups]
            self.planar = bool(json.loads(parquet.read_notes(file, path)["planar"]))
            self.scan_ids = np.array([group.min for group in ids], np.int32)
        self.n_points = np.array([group.num_rows for group in groups], np.int64)
        if len(self.scan_ids) == 0 and not allow_empty:
            raise StageError(f"{path}: holds no scan; {parquet.RERUN}")
        if (np.diff(self.scan_ids) <= 0).any() or any(group.min != group.max for group in ids):
            raise StageError(
                f"{path}: does not hold its scans one by one in order; {parquet.RERUN}"
            )

    def read(self, scan_id: int) -> FloatArray:
        """Return one scan's points, (n, 3) float32, map frame."""
        return next(self.scans([scan_id]))[1]

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m) of all scans or of those asked for, in the order asked for.

        Yields
        ------
        scan_id : int
        xyz_m : (n, 3) float32

        Raises
        ------
        StageError
            If a scan is asked for that is not there, or one has no points, or points that are no
            numbers.
        """
        group = {int(s): i for i, s in enumerate(self.scan_ids)}
        wanted = self.scan_ids.tolist() if scan_ids is None else map(int, scan_ids)
        with parquet.open_file(self.path, self._schema, self._footer) as file:
            for scan_id in wanted:
                if scan_id not in group:
                    raise StageError(
                        f"{self.path}: has no scan {scan_id}, which other tables name; {RERUN_ALL}"
                    )
                # three columns are read before threads have begun
                table = file.read_row_group(group[scan_id], schemas.XYZ, use_threads=False)
                xyz_m = np.column_stack([arrow_arrays.to_numpy(c) for c in table.columns])
                if len(xyz_m) == 0 or not np.isfinite(xyz_m).all():
                    raise StageError(
                        f"{self.path}: scan {scan_id} has no points, or some that are no numbers;"
                        f" {parquet.RERUN}"
                    )
                yield scan_id, xyz_m
