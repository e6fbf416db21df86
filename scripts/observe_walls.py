"""Measure how much wall every scan shows, and where, without extracting walls."""

from scanplan import chunks, schemas, stagelog, tables
from scanplan.extraction import walls
from scanplan.selection import wallcells


def observe_walls(scans, registration, output, *, settings, threads=1):
    """Write the table of observed wall of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        observations.parquet, to write.
    settings : dict
        Keywords of `wallcells.Settings`.
    threads : int
    """
    store = tables.ScanStore(scans)
    observed = chunks.map_scans(
        wallcells.observe,
        scans,
        label="observe_walls",
        threads=threads,
        per_scan=walls.sensor_positions(tables.read(registration, schemas.REGISTRATION), store.scan_ids, registration),
        planar=store.planar,
        settings=wallcells.Settings(**settings),
    )
    columns = wallcells.table(store.scan_ids, observed)
    tables.write(output, schemas.OBSERVATIONS, columns, allow_empty=True)
    mean_m = columns["length_m"].sum() / len(observed)
    blind = sum(len(part["length_m"]) == 0 for part in observed)
    stagelog.say(f"observe_walls: {len(observed):,} scans, {mean_m:.1f} m of wall a scan, {blind:,} show none")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        observe_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.observations,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
