"""Time the extractors by scan and the selection by number of scans (thesis, figures 5.8, 5.10)."""

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np

from scanplan.extraction import extractors
from scanplan.extraction.extractors import EXTRACTORS
from scanplan.plan.faces.merging import MergeSettings
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath, Settings
from thesis import thesis_schemas, timing
from thesis.claim_measures import (
    BUILDING,
    PLAIN,
    PLAIN_CLUSTERS,
    SAMPLED,
    UNSAMPLED,
)

_EXTRACTORS = {PLAIN_CLUSTERS: "thesis_cluster_ransac", PLAIN: "thesis_iterative_ransac"}
"""Task to its extractor, and whose settings it has."""
_FEWER = 5  # times as few scans, where a call for every number of points is long


def time_stages(
    scans: FilePath,
    registration: FilePath,
    built: FilePath,
    segments: FilePath,
    output: FilePath,
    *,
    walls: Mapping[str, Settings],
    hulls: Settings,
    n_clusters: Sequence[int],
    timed_scans: int,
    merge: Settings,
    whole: bool,
) -> None:
    """Write run times of hulls and of cluster RANSAC, and of all else that is claimed of a drive.

    That is iterative RANSAC as in the thesis, both extractors on fewer points, orders, and merging.
    They differ from run to run.

    Parameters
    ----------
    scans, registration, built, segments : path-like
        scans.parquet, registration.parquet, hulls.parquet and walls/cluster_ransac.parquet.
    output : path-like
        thesis/times.parquet, to write.
    walls : dict of str to dict
        Extractor to its settings, among others.
    hulls : dict
        `sample_size`, `radius` and `seed` of `hulls.make_cluster_hulls`.
    timed_scans : int
        On how many scans, spread over the survey, extractors are timed; thinned scans on a part of
        these.
    merge : dict
        See `merging.MergeSettings`.
    whole : bool
        Whether to time what is claimed of a drive alone, too.
    """
    store = tables.ScanStore(scans)
    timed_ids = timing.spread_rows(store.scan_ids, timed_scans)
    # of the same number for every seed: calls of milliseconds are not steady
    hull_ids = timing.spread_rows(store.scan_ids, 18)
    most = [max(n_clusters)]
    unsampled = {**hulls, "sample_size": np.iinfo(np.int32).max}
    times = [
        timing.time_clusters(BUILDING, store, hull_ids, sorted(n_clusters), **hulls),
        timing.time_clusters(SAMPLED, store, hull_ids, most, **hulls),
        timing.time_clusters(UNSAMPLED, store, hull_ids, most, **unsampled),
    ]
    for task in _EXTRACTORS if whole else [PLAIN_CLUSTERS]:
        name = _EXTRACTORS[task]
        own = extractors.select_settings(EXTRACTORS[name].settings, walls[name])
        finder = extractors.WallFinder(EXTRACTORS[name], own, store.planar)
        times.append(timing.time_extractor(task, finder, store, timed_ids, registration))
        if whole:
            few_ids = timing.spread_rows(timed_ids, max(timed_scans // _FEWER, 2))
            times.append(timing.time_by_points(task, finder, store, few_ids, registration))
    if whole:
        columns = tables.read_table(built, schemas.HULLS)
        found = tables.read_table(segments, schemas.WALLS, allow_empty=True)
        times.append(timing.time_selection(columns, timing.list_sizes(len(store.scan_ids))))
        times.append(timing.time_merging(found, MergeSettings(**merge)))
    rows = list(log.report_progress(chain.from_iterable(times), "time_stages", unit="times"))
    rows.sort(key=lambda row: (row["task"], row["size"], row["item"]))
    times_columns = {name: [row[name] for row in rows] for name in thesis_schemas.TIMES.columns}
    tables.write_table(output, thesis_schemas.TIMES, times_columns)
    total_s = sum(row["seconds"] for row in rows)
    log.log_line(f"time_stages: {len(rows)} times, {total_s:.0f} s in all")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        time_stages(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.hulls,
            snakemake.input.segments,
            snakemake.output.times,
            walls=snakemake.params.walls,
            hulls=snakemake.params.hulls,
            n_clusters=snakemake.params.n_clusters,
            timed_scans=snakemake.params.timed_scans,
            merge=snakemake.params.merge,
            whole=snakemake.params.whole,
        )
