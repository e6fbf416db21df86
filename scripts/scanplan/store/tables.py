"""Reading and writing the tables between the stages, as Parquet.

Every file carries the name and version of its schema and page checksums, and is checked against the schema on write
and on read. `schemas` lists the columns.
"""

import json
from contextlib import contextmanager

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from scanplan.errors import StageError
from scanplan.store import atomic, schemas


def write_table(path, schema, columns, *, allow_empty=False):
    """Write a table, whole or not at all.

    Parameters
    ----------
    path : path-like
    schema : Schema
    columns : dict of str to (n,) array-like
        Exactly the schema's columns.
    allow_empty : bool
        Whether zero rows are an answer (no wall found) and not a mistake.

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
    table = pa.table(
        {n: pa.array(columns[n], type=_arrow(schema).field(n).type) for n in schema.columns}
    )
    _check_rows(table, schema, path, allow_empty, ValueError)
    with _writer(path, schema) as writer:
        writer.write_table(table.cast(_arrow(schema)))


def read_table(path, schema, columns=None, *, allow_empty=False):
    """Read a table that another stage wrote.

    Parameters
    ----------
    path : path-like
    schema : Schema
    columns : sequence of str, optional
        Only these columns; all of them by default.
    allow_empty : bool

    Returns
    -------
    dict of str to (n,) numpy.ndarray
        `binary` and `string` columns as object arrays.

    Raises
    ------
    StageError
        If the file is missing, damaged, of another schema or version, unsorted or (unless allowed) empty.
    """
    with _opened(path, schema) as file:
        table = file.read(columns=None if columns is None else list(columns))
    _check_rows(table, schema, path, allow_empty, StageError)
    return {name: table[name].to_numpy() for name in table.column_names}


@contextmanager
def open_scan_writer(path, *, planar):
    """Write the registered scans one by one, each a row group of its own.

    Parameters
    ----------
    path : path-like
    planar : bool
        Whether the sensor measures in one plane only (a 2-D laser scanner); kept in the file for later stages.

    Yields
    ------
    callable
        `write(scan_id, xyz_m)` with increasing `scan_id` and (n, 3) float map coordinates, n >= 1.

    Raises
    ------
    StageError
        If no scan was written: the file does not appear.
    """
    last = None
    with _writer(path, schemas.SCANS, {"planar": json.dumps(bool(planar))}) as writer:

        def write_scan(scan_id, xyz_m):
            nonlocal last
            if len(xyz_m) == 0 or (last is not None and scan_id <= last):
                raise ValueError(f"scan {scan_id} after {last} with {len(xyz_m)} points")
            last = scan_id
            xyz_m = np.asarray(xyz_m, np.float32)
            columns = [np.full(len(xyz_m), scan_id, np.int32), *xyz_m.T.copy()]
            rows = pa.Table.from_arrays(
                [pa.array(c) for c in columns], schema=_arrow(schemas.SCANS)
            )
            writer.write_table(rows, row_group_size=len(rows))

        yield write_scan
        if last is None:
            raise StageError(
                f"{path}: no scan was kept, so there is nothing to go on with; see the stage's log"
            )


class ScanStore:
    """The registered scans of a dataset, read one at a time.

    Attributes
    ----------
    scan_ids : (n,) int32, increasing
    planar : bool
        Whether the sensor measures in one plane only.
    """

    def __init__(self, path):
        self.path = path
        with _opened(path, schemas.SCANS) as file:
            metadata = file.metadata
            groups = [
                metadata.row_group(i).column(0).statistics for i in range(metadata.num_row_groups)
            ]
            self.planar = bool(json.loads(metadata.metadata[b"planar"]))
        self.scan_ids = np.array([g.min for g in groups], np.int32)
        if len(self.scan_ids) == 0:
            raise StageError(f"{path}: holds no scan; delete it and run again")
        if (np.diff(self.scan_ids) <= 0).any() or any(g.min != g.max for g in groups):
            raise StageError(
                f"{path}: does not hold its scans one by one in order; delete it and run again"
            )

    def read(self, scan_id):
        """Return one scan's points, (n, 3) float32, map frame."""
        return next(self.scans([scan_id]))[1]

    def scans(self, scan_ids=None):
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans or of those asked for, in the order asked for.

        Raises
        ------
        ValueError
            If a scan is asked for that is not there.
        """
        group = {int(s): i for i, s in enumerate(self.scan_ids)}
        with _opened(self.path, schemas.SCANS) as file:
            for scan_id in self.scan_ids.tolist() if scan_ids is None else map(int, scan_ids):
                if scan_id not in group:
                    raise ValueError(f"{self.path}: no scan {scan_id}")
                table = file.read_row_group(group[scan_id])
                yield scan_id, np.column_stack([table[c].to_numpy() for c in ("x_m", "y_m", "z_m")])


def _arrow(schema):
    return pa.schema(
        [pa.field(n, pa.type_for_alias(t), nullable=False) for n, t in schema.columns.items()]
    )


@contextmanager
def _writer(path, schema, extra=None):
    metadata = {
        "scanplan": json.dumps({"table": schema.name, "version": schema.version}),
        **(extra or {}),
    }
    if schema.geometry:
        metadata["geo"] = json.dumps(
            {
                "version": "1.1.0",
                "primary_column": "geometry",
                "columns": {"geometry": {"encoding": "WKB", "geometry_types": [], "crs": None}},
            }
        )
    floats = [n for n, t in schema.columns.items() if t.startswith("float")]
    options = {
        "compression": "zstd",
        "write_page_checksum": True,
        "use_dictionary": False,
        "column_encoding": dict.fromkeys(floats, "BYTE_STREAM_SPLIT"),
    }
    schema_arrow = _arrow(schema).with_metadata(metadata)
    with (
        atomic.replace_file(path) as temporary,
        pq.ParquetWriter(temporary, schema_arrow, **options) as writer,
    ):
        yield writer


@contextmanager
def _opened(path, schema):
    remedy = "delete it and run again"
    try:
        with pq.ParquetFile(path, page_checksum_verification=True) as file:
            stated = json.loads((file.metadata.metadata or {}).get(b"scanplan", b"{}"))
            if stated != {"table": schema.name, "version": schema.version}:
                raise StageError(
                    f"{path}: is {stated or 'no table of scanplan'}, expected {schema.name}"
                    f" version {schema.version}; {remedy}"
                )
            if not file.schema_arrow.equals(_arrow(schema)):
                raise StageError(
                    f"{path}: columns {file.schema_arrow.names} are not those of {schema.name}; {remedy}"
                )
            yield file
    except FileNotFoundError:
        raise StageError(f"{path}: does not exist; run the stage that makes it") from None
    except (pa.ArrowException, OSError) as error:
        raise StageError(f"{path}: damaged ({error}); {remedy}") from None


def _check_rows(table, schema, path, allow_empty, error):
    if table.num_rows == 0 and not allow_empty:
        raise StageError(f"{path}: no rows to work on; see the log of the stage that makes it")
    if any(column.null_count for column in table.columns):
        raise error(f"{path}: empty cells in a table of {schema.name}")
    keys = [table[c].to_numpy() for c in schema.sorted_by if c in table.column_names]
    if len(keys) == len(schema.sorted_by) and not _strictly_sorted(keys):
        raise error(
            f"{path}: rows of {schema.name} are not sorted by {', '.join(schema.sorted_by)}"
        )


def _strictly_sorted(keys):
    order = np.lexsort(keys[::-1])
    same = (
        np.all([k[1:] == k[:-1] for k in keys], axis=0) if len(keys[0]) > 1 else np.array([False])
    )
    return bool(np.all(order == np.arange(len(order))) and not same.any())
