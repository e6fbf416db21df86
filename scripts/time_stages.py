"""Time the extractors scan by scan and the selection by number of scans (thesis, figures 5.8 and 5.10)."""

from scanplan.extraction.extractors import EXTRACTORS, Extractor
from scanplan.lab.thesis import plain_ransac, timing
from scanplan.lab.thesis.claim_measures import ITERATIVE, OURS, PLAIN, PLAIN_CLUSTERS
from scanplan.stage import log
from scanplan.store import schemas, tables

_PLAIN = Extractor(plain_ransac.PlainRansacSettings, plain_ransac.extract_plain)
_EXTRACTORS = {PLAIN_CLUSTERS: (EXTRACTORS[OURS], OURS), PLAIN: (_PLAIN, ITERATIVE)}
_CLUSTERED, _THINNED = 3, 8  # a call for every number of clusters, or of points, is long
_SELECTION_SIZES = (10, 20, 30, 45, 60, 90, 130, 180, 270, 400, 600, 900, 1300)


def time_stages(scans, registration, built, output, *, walls, hulls, n_clusters, timed_scans):
    """Write run times of cluster and iterative RANSAC as in the thesis, and of hulls and orders.

    They differ from run to run.

    Parameters
    ----------
    scans, registration, built : path-like
        scans.parquet, registration.parquet and hulls.parquet.
    output : path-like
        thesis/times.parquet, to write.
    walls : dict of str to dict
        Extractor to the keywords of its settings.
    hulls : dict
        `sample_size` and `seed` of `hulls.make_cluster_hulls`.
    n_clusters : sequence of int
    timed_scans : int
        On how many scans, spread over the survey; clusters and thinned scans on a part of these.
    """
    store, placed = tables.ScanStore(scans), tables.read_table(registration, schemas.REGISTRATION)
    columns = tables.read_table(built, schemas.HULLS)
    chosen, n = timing.spread_rows(store.scan_ids, timed_scans), len(store.scan_ids)
    sizes = [size for size in _SELECTION_SIZES if size < n] + [n]
    some, few = (
        timing.spread_rows(chosen, max(timed_scans // part, 2)) for part in (_CLUSTERED, _THINNED)
    )
    rows = [
        *timing.time_selection(columns, sizes),
        *timing.time_clusters(store, some, sorted(n_clusters), **hulls),
    ]
    for name, (method, settings) in _EXTRACTORS.items():
        how = walls[settings] | plain_ransac.LIFTED, registration
        timed = timing.time_extractor(name, method, store, placed, chosen, *how)
        rows += log.report_progress(timed, f"time_stages {name}", total=len(chosen))
        rows += timing.time_by_points(name, method, store, placed, few, *how)
    rows.sort(key=lambda row: (row["task"], row["size"], row["item"]))
    tables.write_table(
        output, schemas.TIMES, {name: [row[name] for row in rows] for name in schemas.TIMES.columns}
    )
    log.log_line(
        f"time_stages: {len(rows)} times, {sum(row['seconds'] for row in rows):.0f} s in all"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        time_stages(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.hulls,
            snakemake.output.times,
            walls=snakemake.params.walls,
            hulls=snakemake.params.hulls,
            n_clusters=snakemake.params.n_clusters,
            timed_scans=snakemake.params.timed_scans,
        )
