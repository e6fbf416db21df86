"""Build the visibility polygon of every scan: the free space that it looked through."""

from collections.abc import Mapping
from functools import partial
from typing import Any

from scanplan.rays import visibility_polygon
from scanplan.stage import log
from scanplan.stage.per_registered_scan import map_registered_scans
from scanplan.store import schemas, tables
from scanplan.types import FilePath


def build_visibility(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    settings: Mapping[str, Any],
    threads: int = 1,
    chunk: str | None = None,
) -> None:
    """Write the table of visibility polygons of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        visibility.parquet, to write.
    settings : dict
        Keywords of `visibility_polygon.VisibilitySettings`.
    chunk : str, optional
        Which scans, see `per_scan.read_chunk_ids`; all by default.
    """
    _, polygons = map_registered_scans(
        partial(
            visibility_polygon.scan_free_space,
            settings=visibility_polygon.VisibilitySettings(**settings),
        ),
        scans,
        registration,
        label="build_visibility",
        threads=threads,
        chunk=chunk,
    )
    columns = visibility_polygon.visibility_columns(polygons)
    tables.write_table(output, schemas.VISIBILITY, columns)
    mean_m2 = columns["area_m2"].mean()
    log.log_line(
        f"build_visibility: {len(polygons):,} scans, {mean_m2:.1f} m2 of free space a scan"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        build_visibility(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.visibility,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
            chunk=snakemake.wildcards.get("chunk"),
        )
