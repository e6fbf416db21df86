"""How the area that an ordering covers grows, scan by scan, with every number of clusters (thesis, figure 5.7)."""

import numpy as np

from scanplan.selection import area_greedy, hulls
from scanplan.stage import per_scan


def cluster_growth_columns(scans_path, n_clusters, *, sample_size, seed, threads=1):
    """Return the columns of `schemas.CLUSTERS`: greedy orders of all scans by their clusters' hulls.

    Parameters
    ----------
    scans_path : path-like
        scans.parquet.
    n_clusters : sequence of int
        The numbers of clusters to compare, in any order.
    sample_size, seed : int
        See `hulls.make_cluster_hulls`.
    threads : int

    Returns
    -------
    dict of str to numpy.ndarray
        Rows by number of clusters, then by rank.
    """
    parts = [
        _growth(scans_path, n, threads, sample_size=sample_size, seed=seed)
        for n in sorted(n_clusters)
    ]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _growth(scans_path, n_clusters, threads, **sampling):
    label = f"measure_coverage, {n_clusters} clusters"
    parts = per_scan.map_scans(
        hulls.make_cluster_hulls,
        scans_path,
        label=label,
        threads=threads,
        n_clusters=n_clusters,
        **sampling,
    )
    scan_ids, polygons = hulls.scan_polygons(hulls.concatenate_hulls(parts))
    order, rank = area_greedy.order_by_area(polygons), np.arange(1, len(scan_ids) + 1)
    covered = {"scan_id": scan_ids[order.order], "covered_m2": order.covered}
    return {"n_clusters": np.full(len(rank), n_clusters), "rank": rank, **covered}
