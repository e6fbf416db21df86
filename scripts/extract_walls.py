"""Extract the wall segments that each scan shows (thesis, sections 3.4 and 5.3)."""

import time
from collections.abc import Mapping

from scanplan.errors import StageError
from scanplan.extraction import map_tilt, segments
from scanplan.extraction.extractors import (
    EXTRACTORS,
    find_wall_segments,
    select_limits,
    select_settings,
)
from scanplan.stage import log
from scanplan.stage.per_registered_scan import sensor_keywords
from scanplan.stage.per_scan import map_scans
from scanplan.store import schemas, tables
from scanplan.types import FilePath, FloatArray, Settings


def extract_walls(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    extractor: str,
    settings: Settings,
    threads: int = 1,
) -> None:
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
        Of that extractor's class of settings; of `furniture.FurnitureLimits`, too, where it drops
        furniture.
    threads : int
    """
    started = time.perf_counter()
    if extractor not in EXTRACTORS:
        raise StageError(
            f"extractor {extractor}: is not known; choose one of {', '.join(EXTRACTORS)}"
        )
    method = EXTRACTORS[extractor]
    store = tables.ScanStore(scans)
    sensors = sensor_keywords(store.scan_ids, scans, registration)
    wall_segments = map_scans(
        find_wall_segments,
        scans,
        label=f"extract_walls {extractor}",
        threads=threads,
        per_scan=sensors,
        planar=store.planar,
        extractor=method,
        settings=select_settings(method.settings, settings),
        limits=select_limits(method, settings),
    )
    if not store.planar:
        _warn_of_tilt(store, sensors)
    columns = segments.segment_columns(store.scan_ids, wall_segments)
    tables.write_table(output, schemas.WALLS, columns, allow_empty=True)
    took_ms = 1e3 * (time.perf_counter() - started)
    summary = segments.summarise_segments(columns, len(store.scan_ids), took_ms)
    log.log_line(f"extract_walls: {extractor}, {summary}")


def _warn_of_tilt(store: tables.ScanStore, sensors: Mapping[int, Mapping[str, FloatArray]]) -> None:
    """Log a warning if the map is tilted."""
    sample_ids = map_tilt.sample_scan_ids(store.scan_ids.tolist())
    sample = ((store.read(i), sensors[i]["sensor_xyz_m"]) for i in sample_ids)
    if warning := map_tilt.tilt_warning(sample):
        log.log_line(f"extract_walls: {warning}")


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
