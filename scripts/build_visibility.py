"""Draw the free space that every scan looked through."""

from scanplan import chunks, schemas, stagelog, tables
from scanplan.extraction import walls
from scanplan.selection import visibilitypolygon


def build_visibility(scans, registration, output, *, settings, threads=1):
    """Write the table of visibility polygons of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        visibility.parquet, to write.
    settings : dict
        Keywords of `visibilitypolygon.Settings`.
    threads : int
    """
    store = tables.ScanStore(scans)
    rows = chunks.map_scans(
        visibilitypolygon.free_space,
        scans,
        label="build_visibility",
        threads=threads,
        per_scan=walls.sensor_positions(tables.read(registration, schemas.REGISTRATION), store.scan_ids, registration),
        planar=store.planar,
        settings=visibilitypolygon.Settings(**settings),
    )
    columns = visibilitypolygon.table(rows)
    tables.write(output, schemas.VISIBILITY, columns)
    stagelog.say(f"build_visibility: {len(rows):,} scans, {columns['area_m2'].mean():.1f} m2 of free space a scan")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        build_visibility(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.visibility,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
