"""Measure how much wall every scan shows, and where, without extracting walls."""

from collections.abc import Mapping
from functools import partial
from typing import Any

from scanplan.selection import persistence, wall_cells
from scanplan.stage import log
from scanplan.stage.per_registered_scan import map_registered_scans
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath


def observe_walls(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    settings: Mapping[str, Any],
    threads: int = 1,
    chunk: str | None = None,
) -> None:
    """Write the table of observed wall of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        observations.parquet, to write.
    settings : dict
        Keywords of `wall_cells.WallCellSettings`.
    chunk : str, optional
        Which scans, see `per_scan.read_chunk_ids`; all by default.
    """
    own = wall_cells.WallCellSettings(**settings)
    store = tables.ScanStore(scans)
    known = registered_scans.read_registered_scans(registration, store)
    sensors_m = registered_scans.sensor_positions(store.scan_ids, known, scans, registration)
    axes_deg = wall_cells.choose_axes_deg(store, sensors_m, own)
    scan_ids, observations = map_registered_scans(
        partial(wall_cells.observe_wall_cells, settings=own, axes_deg=axes_deg),
        scans,
        registration,
        label="observe_walls",
        threads=threads,
        chunk=chunk,
    )
    columns = wall_cells.observation_columns(scan_ids, observations)
    # what other scans show there may be in another chunk: that is for `gather_chunks`
    if chunk is None and store.planar:
        columns = persistence.weigh_by_persistence(columns, known)
    tables.write_table(output, schemas.OBSERVATIONS, columns, allow_empty=True)
    mean_m = columns["length_m"].sum() / len(observations)
    n_blind = sum(len(observation["length_m"]) == 0 for observation in observations)
    log.log_line(
        f"observe_walls: {len(observations):,} scans, {mean_m:.1f} m of wall a scan,"
        f" {n_blind:,} show none; cells turned by {axes_deg} degrees"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        observe_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.observations,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
            chunk=snakemake.wildcards.get("chunk"),
        )
