"""Measure how much wall every scan shows, and where, without extracting walls."""

from scanplan.extraction import segments
from scanplan.selection import wall_cells
from scanplan.stage import log, per_scan
from scanplan.store import schemas, tables


def observe_walls(scans, registration, output, *, settings, threads=1):
    """Write the table of observed wall of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        observations.parquet, to write.
    settings : dict
        Keywords of `wall_cells.WallCellSettings`.
    threads : int
    """
    store = tables.ScanStore(scans)
    observed = per_scan.map_scans(
        wall_cells.observe_wall_cells,
        scans,
        label="observe_walls",
        threads=threads,
        per_scan=segments.sensor_keywords(
            tables.read_table(registration, schemas.REGISTRATION), store.scan_ids, registration
        ),
        planar=store.planar,
        settings=wall_cells.WallCellSettings(**settings),
    )
    columns = wall_cells.observation_columns(store.scan_ids, observed)
    tables.write_table(output, schemas.OBSERVATIONS, columns, allow_empty=True)
    mean_m = columns["length_m"].sum() / len(observed)
    blind = sum(len(part["length_m"]) == 0 for part in observed)
    log.log_line(
        f"observe_walls: {len(observed):,} scans, {mean_m:.1f} m of wall a scan, {blind:,} show none"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        observe_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.observations,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
