"""Time the extractors by scan and the selection by number of scans (thesis, figures 5.8, 5.10)."""

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np

from scanplan.extraction.extractors import EXTRACTORS
from scanplan.lab.thesis import timing
from scanplan.lab.thesis.claim_measures import (
    BUILDING,
    PLAIN,
    PLAIN_CLUSTERS,
    SAMPLED,
    UNSAMPLED,
)
from scanplan.plan.faces.merging import MergeSettings
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath, Settings

_EXTRACTORS = {PLAIN_CLUSTERS: "thesis_cluster_ransac", PLAIN: "thesis_iterative_ransac"}
"""Task to its extractor, and whose settings it has."""
_FEWER = 5  # times as few scans, where a call for every number of clusters or points is long


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
) -> None:
    """Write run times of cluster and iterative RANSAC as in the thesis, and of hulls and orders.

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
    n_clusters : sequence of int
    timed_scans : int
        On how many scans, spread over the survey; clusters and thinned scans on a part of these.
    merge : dict
        See `merging.MergeSettings`.
    """
    store = tables.ScanStore(scans)
    columns = tables.read_table(built, schemas.HULLS)
    n_scans = len(store.scan_ids)
    # even steps of a power law
    sizes = np.unique(np.geomspace(min(10, n_scans), n_scans, 14).round().astype(int)).tolist()
    timed_ids = timing.spread_rows(store.scan_ids, timed_scans)
    few_ids = timing.spread_rows(timed_ids, max(timed_scans // _FEWER, 2))
    most = [max(n_clusters)]
    unsampled = {**hulls, "sample_size": np.iinfo(np.int32).max}
    times = [
        timing.time_selection(columns, sizes),
        timing.time_clusters(BUILDING, store, few_ids, sorted(n_clusters), **hulls),
        timing.time_clusters(SAMPLED, store, few_ids, most, **hulls),
        timing.time_clusters(UNSAMPLED, store, few_ids, most, **unsampled),
        timing.time_merging(
            tables.read_table(segments, schemas.WALLS, allow_empty=True), MergeSettings(**merge)
        ),
    ]
    for task, name in _EXTRACTORS.items():
        calls = (task, EXTRACTORS[name], store)
        of_task = (walls[name], registration)
        times.append(timing.time_extractor(*calls, timed_ids, *of_task))
        times.append(timing.time_by_points(*calls, few_ids, *of_task))
    rows = list(log.report_progress(chain.from_iterable(times), "time_stages", unit="times"))
    rows.sort(key=lambda row: (row["task"], row["size"], row["item"]))
    times_columns = {name: [row[name] for row in rows] for name in schemas.TIMES.columns}
    tables.write_table(output, schemas.TIMES, times_columns)
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
        )
