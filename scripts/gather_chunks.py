"""Join the tables of chunks of a survey's scans to the one that a single job would write."""

from collections.abc import Sequence

import numpy as np

from scanplan.extraction import known_segments
from scanplan.selection import persistence
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath

_SCHEMAS = {
    schema.name: schema
    for schema in (schemas.OBSERVATIONS, schemas.VISIBILITY, schemas.HULLS, schemas.WALLS)
}
_MAY_BE_EMPTY = (schemas.OBSERVATIONS, schemas.WALLS)


def gather_chunks(
    chunks: Sequence[FilePath],
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    table: str,
) -> None:
    """Write the table of all scans.

    Parameters
    ----------
    chunks : sequence of path-like
        Tables of chunks of the scans, in the order of the scans.
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        The table of all of them, to write.
    table : str
        Name of their schema: `observations`, `visibility`, `hulls` or `walls`.
    """
    schema = _SCHEMAS[table]
    allow_empty = schema in _MAY_BE_EMPTY
    parts = [tables.read_table(chunk, schema, allow_empty=allow_empty) for chunk in chunks]
    columns = {name: np.concatenate([part[name] for part in parts]) for name in schema.columns}
    if schema is schemas.OBSERVATIONS and tables.ScanStore(scans).planar:
        known = registered_scans.read_registered_scans(registration)
        columns = persistence.weigh_by_persistence(columns, known)
    notes = known_segments.join_notes([tables.read_notes(chunk, schema) for chunk in chunks])
    tables.write_table(output, schema, columns, allow_empty=allow_empty, notes=notes)
    n_rows = len(columns["scan_id"])
    log.log_line(f"gather_chunks: {n_rows:,} rows of {table} from {len(parts)} chunks")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        gather_chunks(
            snakemake.input.chunks,
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.gathered,
            table=snakemake.wildcards.get("table", "walls"),
        )
