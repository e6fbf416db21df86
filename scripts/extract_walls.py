"""Find the wall segments that each scan shows (thesis, sections 3.4 and 5.3)."""

import time

from scanplan.errors import StageError
from scanplan.extraction import map_tilt, segments
from scanplan.extraction.extractors import EXTRACTORS
from scanplan.stage import log
from scanplan.stage.per_registered_scan import sensor_keywords
from scanplan.stage.per_scan import map_scans
from scanplan.store import schemas, tables


def extract_walls(scans, registration, output, *, extractor, settings, threads=1):
    """Write the walls of every registered scan.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        walls/<extractor>.parquet, to write.
    extractor : str
        A key of `EXTRACTORS`.
    settings : dict
        Keywords of that extractor's `Settings`.
    threads : int
    """
    if extractor not in EXTRACTORS:
        raise StageError(
            f"extractor {extractor}: is not known; choose one of {', '.join(EXTRACTORS)}"
        )
    method, store, started = EXTRACTORS[extractor], tables.ScanStore(scans), time.perf_counter()
    every_scan = {"planar": store.planar, "settings": method.settings(**settings)}
    per_scan = sensor_keywords(store.scan_ids, scans, registration)
    found = map_scans(
        method.extract,
        scans,
        label=f"extract_walls {extractor}",
        threads=threads,
        per_scan=per_scan,
        **every_scan,
    )
    looked_at = (
        (store.read(i), per_scan[i]["sensor_xyz_m"])
        for i in map_tilt.sample_scan_ids(store.scan_ids.tolist())
    )
    if not store.planar and (tilted := map_tilt.tilt_warning(looked_at)):
        log.log_line(f"extract_walls: {tilted}")
    columns = segments.segment_columns(store.scan_ids, found)
    tables.write_table(output, schemas.WALLS, columns, allow_empty=True)
    took_ms = 1e3 * (time.perf_counter() - started)
    log.log_line(
        f"extract_walls: {extractor}, {segments.summarise_segments(columns, len(store.scan_ids), took_ms)}"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        extract_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.walls,
            extractor=snakemake.wildcards.extractor,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
        )
