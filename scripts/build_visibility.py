"""Draw the free space that every scan looked through."""

from scanplan.extraction import segments
from scanplan.rays import visibility_polygon
from scanplan.stage import log, per_scan
from scanplan.store import schemas, tables


def build_visibility(scans, registration, output, *, settings, threads=1):
    """Write the table of visibility polygons of a table of scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        visibility.parquet, to write.
    settings : dict
        Keywords of `visibility_polygon.VisibilitySettings`.
    threads : int
    """
    store = tables.ScanStore(scans)
    rows = per_scan.map_scans(
        visibility_polygon.scan_free_space,
        scans,
        label="build_visibility",
        threads=threads,
        per_scan=segments.sensor_keywords(
            tables.read_table(registration, schemas.REGISTRATION), store.scan_ids, registration
        ),
        planar=store.planar,
        settings=visibility_polygon.VisibilitySettings(**settings),
    )
    columns = visibility_polygon.visibility_columns(rows)
    tables.write_table(output, schemas.VISIBILITY, columns)
    log.log_line(
        f"build_visibility: {len(rows):,} scans, {columns['area_m2'].mean():.1f} m2 of free space a scan"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        build_visibility(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.visibility,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
