"""Draw convex hulls round the clusters of every scan's points."""

import numpy as np

from scanplan import chunks, schemas, stagelog, tables
from scanplan.selection import hulls


def build_hulls(scans, output, *, n_clusters, sample_size, seed, threads):
    """Write the table of hulls of a table of scans."""
    parts = chunks.map_scans(
        hulls.cluster_hulls,
        scans,
        label="build_hulls",
        threads=threads,
        n_clusters=n_clusters,
        sample_size=sample_size,
        seed=seed,
    )
    columns = hulls.concatenated(parts)
    tables.write(output, schemas.HULLS, columns)
    n_degenerate = np.count_nonzero(columns["area_m2"] == 0)
    mean_m2 = columns["area_m2"].sum() / len(parts)
    stagelog.say(
        f"build_hulls: {len(parts):,} scans, {len(columns['cluster']):,} hulls, {n_degenerate:,} degenerate,"
        f" {mean_m2:.1f} m2 a scan"
    )


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        build_hulls(
            snakemake.input.scans,
            snakemake.output.hulls,
            **snakemake.params.settings,
            threads=snakemake.threads,
        )
