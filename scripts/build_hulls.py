"""Draw convex hulls round the clusters of every scan's points."""

from functools import partial

import numpy as np

from scanplan.selection import hulls
from scanplan.stage import log, per_scan
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath, Settings


def build_hulls(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    settings: Settings,
    threads: int,
    chunk: str | None = None,
) -> None:
    """Write the table of hulls of scans, or of a chunk of them; all registered must be there.

    `settings` are keywords of `hulls.make_cluster_hulls`.
    """
    registered_scans.read_registered_scans(registration, tables.ScanStore(scans))
    parts = per_scan.map_scans(
        partial(hulls.make_cluster_hulls, **settings),
        scans,
        label="build_hulls",
        threads=threads,
        scan_ids=per_scan.read_chunk_ids(scans, chunk),
    )
    columns = hulls.concatenate_hulls(parts)
    tables.write_table(output, schemas.HULLS, columns)
    is_hull = columns["cluster"] != hulls.OUTLIERS
    area_m2 = columns["area_m2"][is_hull]
    mean_m2 = area_m2.sum() / len(parts)
    outliers = columns["n_points"][~is_hull].sum() / columns["n_points"].sum()
    log.log_line(
        f"build_hulls: {len(parts):,} scans, {len(area_m2):,} hulls,"
        f" {np.count_nonzero(area_m2 == 0):,} degenerate, {mean_m2:.1f} m2 a scan,"
        f" {outliers:.1%} of the points left out"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        build_hulls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.hulls,
            settings=snakemake.params.settings,
            threads=snakemake.threads,
            chunk=snakemake.wildcards.get("chunk"),
        )
