"""Parquet files of a schema: opened, written and checked."""

import errno
import itertools
import json
from binascii import crc32
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from scanplan.errors import MORE_MEMORY, StageError, lacks_memory
from scanplan.store import arrow_arrays, atomic, lineage
from scanplan.store.lineage import MADE_OF
from scanplan.store.schemas import Schema
from scanplan.types import Array, FilePath

RERUN = "delete it and run again"

_MAGIC = b"PAR1"
_N_ROWS = "scanplan_rows"
_OF_OLDER_VERSIONS = ("scanplan_notes_crc32", "scanplan_counts_rows")
_STATED = frozenset({"table", "version", "counted", "notes_crc32", MADE_OF})
_OWN_NOTES = ("scanplan", "geo", "ARROW:schema", _N_ROWS, *_OF_OLDER_VERSIONS)


def arrow_schema(schema: Schema) -> pa.Schema:
    """Return the schema as Arrow's; no cell may be empty."""
    return pa.schema(
        [pa.field(n, pa.type_for_alias(t), nullable=False) for n, t in schema.columns.items()]
    )


@contextmanager
def open_writer(
    path: FilePath,
    schema: Schema,
    extra: Mapping[str, str] | None = None,
    *,
    compression: str = "zstd",
    made_of: str = "",
) -> Iterator[Callable[..., None]]:
    """Write a file of a schema, whole or not at all, with further metadata.

    It states how many rows were written to it, so that ones that another program took out are
    missed; and what recordings it was made of: `made_of`, or what the poses of its dataset state.

    Yields
    ------
    callable
        `write_rows(table, row_group_size=None)`, for one table after the other.
    """
    notes = dict(extra or {})
    if not (made_of or schema.outlives):
        made_of = lineage.find_made_of(path)[1]
    own = _file_metadata(schema, notes, made_of)
    form = arrow_schema(schema).with_metadata(own | notes)
    floats = [n for n, t in schema.columns.items() if t.startswith("float")]
    with (
        atomic.replace_file(path) as temporary,
        pq.ParquetWriter(
            temporary,
            form,
            compression=compression,
            write_page_checksum=True,
            use_dictionary=False,
            column_encoding=dict.fromkeys(floats, "BYTE_STREAM_SPLIT"),
        ) as writer,
    ):
        n_rows = 0

        def write_rows(table: pa.Table, row_group_size: int | None = None) -> None:
            nonlocal n_rows
            n_rows += len(table)
            writer.write_table(table, row_group_size=row_group_size)

        yield write_rows
        writer.add_key_value_metadata({_N_ROWS: str(n_rows)})


def _file_metadata(schema: Schema, notes: Mapping[str, str], made_of: str) -> dict[str, str]:
    """Return the file's own metadata: our schema, and the description that GeoParquet asks for."""
    # programs that write a table anew keep that rows are counted, and not the number itself
    stated = {**_identity(schema), "counted": True, "notes_crc32": _checksum(notes)}
    if made_of:
        stated[MADE_OF] = made_of
    metadata = {"scanplan": json.dumps(stated)}
    if schema.geometry:
        column = {"encoding": "WKB", "geometry_types": [], "crs": None}
        metadata["geo"] = json.dumps(
            {"version": "1.1.0", "primary_column": "geometry", "columns": {"geometry": column}}
        )
    return metadata


def _identity(schema: Schema) -> dict[str, object]:
    return {"table": schema.name, "version": schema.version}


def _checksum(notes: Mapping[str, str]) -> str:
    """Return the checksum of a file's further metadata, which Parquet's own do not cover."""
    return f"{crc32(json.dumps(notes, sort_keys=True).encode()):08x}"


def _read_statement(file: pq.ParquetFile) -> dict[str, object]:
    """Return what a file says of itself; empty if it is none of ours."""
    return json.loads((file.metadata.metadata or {}).get(b"scanplan", b"{}"))


def read_notes(file: pq.ParquetFile, path: FilePath) -> dict[str, str]:
    """Return a file's further metadata, without its schema's.

    Raises
    ------
    StageError
        If they do not fit their checksum.
    """
    with explain_damage(path):
        stated = {k.decode(): v.decode() for k, v in (file.metadata.metadata or {}).items()}
        checksum = _read_statement(file).get("notes_crc32")
    notes = {k: v for k, v in stated.items() if k not in _OWN_NOTES}
    # files of older versions state theirs elsewhere, or have none
    if checksum not in (None, _checksum(notes)):
        raise StageError(f"{path}: damaged (its notes do not fit their checksum); {RERUN}")
    return notes


@contextmanager
def open_file(
    path: FilePath, schema: Schema, footer: pq.FileMetaData | None = None
) -> Iterator[pq.ParquetFile]:
    """Open a file of a schema to read it.

    Parameters
    ----------
    footer : pyarrow.parquet.FileMetaData, optional
        The file's own, as it was checked when the file was opened before; it is not read again.

    Raises
    ------
    StageError
        If it is missing, damaged or of another schema or version, or memory is not enough for it.
    """
    try:
        with pq.ParquetFile(path, metadata=footer, page_checksum_verification=True) as file:
            if footer is None:
                with explain_damage(path):
                    _check_schema(file, schema, path)
            yield file
    except FileNotFoundError:
        raise StageError(f"{path}: does not exist; run the stage that makes it") from None
    except (pa.ArrowException, MemoryError, OSError, UnicodeDecodeError) as error:
        if lacks_memory(error) or getattr(error, "errno", None) == errno.ENOMEM:
            # a damaged length asks for more than there is, too
            fault = f"not enough memory to read it ({error}): {MORE_MEMORY}"
            raise StageError(f"{path}: {fault}; with memory to spare, {RERUN}") from None
        raise StageError(f"{path}: damaged ({error}); {RERUN}") from None


@contextmanager
def explain_damage(path: FilePath) -> Iterator[None]:
    """Turn what reading a damaged footer raises, which has no checksum, into one line."""
    try:
        yield
    except (ValueError, LookupError, AttributeError, TypeError) as error:
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        raise StageError(f"{path}: damaged ({reason}); {RERUN}") from None


def _check_schema(file: pq.ParquetFile, schema: Schema, path: FilePath) -> None:
    stated = _read_statement(file)
    identity = {key: stated.get(key) for key in _identity(schema)}
    if identity != _identity(schema) or not _STATED.issuperset(stated):
        raise StageError(
            f"{path}: is {identity if stated else 'no table of scanplan'}, expected {schema.name}"
            f" version {schema.version}; {RERUN}"
        )
    if not schema.outlives:
        lineage.check_made_of(path, str(stated.get(MADE_OF, "")))
    if not file.schema_arrow.equals(arrow_schema(schema)):
        raise StageError(
            f"{path}: columns {file.schema_arrow.names} are not those of {schema.name}; {RERUN}"
        )
    _check_row_counts(file, path)
    _check_places(file, path)


def _check_row_counts(file: pq.ParquetFile, path: FilePath) -> None:
    """Refuse a file whose parts hold other numbers of rows than stated: some would be lost."""
    whole = file.metadata
    of_parts = sum(whole.row_group(i).num_rows for i in range(whole.num_row_groups))
    if of_parts != whole.num_rows:
        raise StageError(
            f"{path}: damaged (states {whole.num_rows} rows, its parts {of_parts}); {RERUN}"
        )
    stated = {k.decode(): v.decode() for k, v in whole.metadata.items()}
    # nor do those of older versions count here
    n_written = stated.get(_N_ROWS, "an unknown number of")
    if "counted" in _read_statement(file) and n_written != str(of_parts):
        raise StageError(
            f"{path}: was written with {n_written} rows, holds {of_parts}: another program has"
            f" changed it; {RERUN}"
        )


def _check_places(file: pq.ParquetFile, path: FilePath) -> None:
    """Refuse a file whose columns share bytes: one would be read for another, checksums and all."""
    groups = [file.metadata.row_group(i) for i in range(file.metadata.num_row_groups)]
    chunks = [g.column(j) for g in groups for j in range(g.num_columns) if g.num_rows]
    # a dictionary lies before the pages that refer to it
    begins = [min(filter(None, (c.dictionary_page_offset, c.data_page_offset))) for c in chunks]
    spans = zip(begins, (chunk.total_compressed_size for chunk in chunks), strict=True)
    n_magic = len(_MAGIC)
    # behind the footer stand its length, in as many bytes as the mark has, and the mark again
    footer = Path(path).stat().st_size - 2 * n_magic - file.metadata.serialized_size
    places = [(0, n_magic), *sorted(spans), (footer, 0)]
    for (begin, size), (end, _) in itertools.pairwise(places):
        if begin + size > end:
            raise StageError(
                f"{path}: damaged (its footer states {size} bytes at {begin}, the next at {end});"
                f" {RERUN}"
            )


def check_rows(
    table: pa.Table,
    schema: Schema,
    path: FilePath,
    allow_empty: bool,
    error: type[Exception],
) -> None:
    """Raise `error` if the rows of a table are not sorted as its schema says or have empty cells.

    Raises
    ------
    StageError
        If there are no rows and that is not allowed.
    """
    if table.num_rows == 0 and not allow_empty:
        raise StageError(f"{path}: no rows to work on; see the log of the stage that makes it")
    if any(column.null_count for column in table.columns):
        raise error(f"{path}: empty cells in a table of {schema.name}")
    keys = [arrow_arrays.to_numpy(table[c]) for c in schema.sorted_by if c in table.column_names]
    if len(keys) == len(schema.sorted_by) and not _strictly_sorted(keys):
        raise error(
            f"{path}: rows of {schema.name} are not sorted by {', '.join(schema.sorted_by)}"
        )


def _strictly_sorted(keys: list[Array]) -> bool:
    if len(keys[0]) < 2:
        return True
    order = np.lexsort(keys[::-1])
    same = np.all([key[1:] == key[:-1] for key in keys], axis=0)
    return bool(np.all(order == np.arange(len(order))) and not same.any())
