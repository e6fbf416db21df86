"""The wall segments of many registered scans, as one table."""

import time
from collections.abc import Iterable, Mapping
from functools import partial

from scanplan.errors import StageError
from scanplan.extraction import known_segments, map_tilt, segments
from scanplan.extraction.extractors import EXTRACTORS, make_wall_finder
from scanplan.stage import log, witnesses
from scanplan.stage.per_registered_scan import sensor_keywords
from scanplan.stage.per_scan import map_scans
from scanplan.store import schemas, tables
from scanplan.store.doubts import NO_DOUBT, Doubts
from scanplan.store.registered_scans import read_registered_scans
from scanplan.types import FilePath, FloatArray, IntArray, Settings


def write_survey_walls(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    stage: str,
    extractor: str,
    settings: Settings,
    scan_ids: IntArray | None = None,
    known: Iterable[FilePath] = (),
    code: str = "",
    threads: int = 1,
) -> None:
    """Write the wall segments of registered scans.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        A table of `schemas.WALLS`, to write.
    stage : str
        Its name, for the log.
    extractor : str
        A key of `EXTRACTORS`.
    settings : dict
        Of that extractor's class of settings, and `max_rmse_m` where it drops clutter.
    scan_ids : (n,) int, increasing, optional
        Which scans; all by default.
    known : iterable of path-like
        Tables of walls: the segments of scans that they have of the same points, by the same code
        and settings, are taken from them.
    code : str
        What names that code.

    Raises
    ------
    StageError
        If there is no such extractor, or a scan has no pose, or no points.
    """
    started = time.perf_counter()
    if extractor not in EXTRACTORS:
        raise StageError(
            f"extractor {extractor}: is not known; choose one of {', '.join(EXTRACTORS)}"
        )
    store = tables.ScanStore(scans)
    read_registered_scans(registration, store)
    wanted = store.scan_ids if scan_ids is None else scan_ids
    sensors = sensor_keywords(store.scan_ids, scans, registration)
    earlier = known_segments.KnownSegments(known)
    found = map_scans(
        partial(
            known_segments.find_unknown_segments,
            recipe=known_segments.digest_recipe(extractor, settings, code),
            finder=make_wall_finder(EXTRACTORS[extractor], settings, planar=store.planar),
        ),
        scans,
        label=f"{stage} {extractor}",
        threads=threads,
        scan_ids=wanted,
        per_scan={i: {**sensors[i], "known": earlier.list_digests(i)} for i in wanted.tolist()},
    )
    told = NO_DOUBT if store.planar else _tell_tilt(stage, store, sensors)
    columns = earlier.complete(wanted, found)
    notes = known_segments.note_digests(wanted, found) | told.as_notes()
    tables.write_table(output, schemas.WALLS, columns, allow_empty=True, notes=notes)
    took_ms = 1e3 * (time.perf_counter() - started)
    summary = segments.summarise_segments(columns, len(wanted), took_ms)
    n_known = sum(new is None for _, new in found)
    reused = f", {n_known:,} of the scans known from before" if n_known else ""
    log.log_line(f"{stage}: {extractor}, {summary}{reused}")


def _tell_tilt(
    stage: str, store: tables.ScanStore, sensors: Mapping[int, Mapping[str, FloatArray]]
) -> Doubts:
    """Return what there is to tell of a map that is tilted, and log it."""
    sample_ids = map_tilt.sample_scan_ids(store.scan_ids.tolist())
    sample = ((store.read(i), sensors[i]["sensor_xyz_m"]) for i in sample_ids)
    return Doubts(findings=tuple(witnesses.tell(stage, [map_tilt.measure_tilt(sample)])))
