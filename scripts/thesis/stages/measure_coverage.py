"""Measure what hulls cover, by number of clusters and against what scans truly see."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import shapely

from scanplan.lab.evaluation import truth_file
from scanplan.selection import hulls
from scanplan.stage import log, per_scan
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from thesis import coverage, thesis_schemas


def measure_coverage(
    scans: FilePath,
    built: FilePath,
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    clusters: FilePath,
    areas: FilePath,
    *,
    n_clusters: Sequence[int],
    sampling: Settings,
    max_range_m: float,
    threads: int = 1,
) -> None:
    """Write how covered area grows with every number of clusters, and each scan's areas.

    These are the thesis's claims of 3.3.2 and 5.2.

    Parameters
    ----------
    scans, built, registration, truth, true_poses : path-like
        scans.parquet, hulls.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    clusters, areas : path-like
        thesis/clusters.parquet and thesis/areas.parquet, to write.
    n_clusters : sequence of int
        The numbers of clusters to compare.
    sampling : dict
        `n_clusters`, `sample_size`, `radius` and `seed` of `hulls.make_cluster_hulls`, as for
        `built`.
    max_range_m : float
        How far a scan can see.
    """
    others = {name: value for name, value in sampling.items() if name != "n_clusters"}
    growth = coverage.cluster_growth_columns(scans, n_clusters, threads=threads, **others)
    tables.write_table(clusters, thesis_schemas.CLUSTERS, growth)
    registered = registered_scans.read_registered_scans(registration)
    poses = truth_file.read_true_poses(true_poses)
    places_m = truth_file.interpolate_true_poses(poses, registered.t_ns, true_poses)[:, :2, 3]
    faces = truth_file.read_true_faces(truth)
    seen_areas = coverage.seen_polygons(faces, places_m, max_range_m=max_range_m)
    columns = tables.read_table(built, schemas.HULLS)
    _, full_hulls = hulls.scan_full_hulls(columns)
    _, cluster_hulls = hulls.scan_polygons(columns)
    measures = {
        "seen_m2": shapely.area(seen_areas),
        "full_hull_m2": shapely.area(full_hulls),
        "cluster_hull_m2": shapely.area(cluster_hulls),
        "full_hull_iou": coverage.polygon_iou(full_hulls, seen_areas),
        "cluster_hull_iou": coverage.polygon_iou(cluster_hulls, seen_areas),
    }
    strays = per_scan.map_scans(
        partial(coverage.stray_area_columns, **sampling),
        scans,
        label="measure_coverage, a stray return",
        threads=threads,
    )
    for name in ("full_hull_stray_m2", "cluster_hull_stray_m2"):
        measures[name] = np.concatenate([of_scan[name] for of_scan in strays])
    tables.write_table(areas, thesis_schemas.AREAS, {"scan_id": registered.scan_ids, **measures})
    medians = ", ".join(f"{np.median(values):.2f} {name}" for name, values in measures.items())
    log.log_line(f"measure_coverage: {len(registered.scan_ids)} scans, median {medians}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_coverage(
            snakemake.input.scans,
            snakemake.input.hulls,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.clusters,
            snakemake.output.areas,
            n_clusters=snakemake.params.n_clusters,
            sampling=snakemake.params.hulls,
            max_range_m=snakemake.params.max_range_m,
            threads=snakemake.threads,
        )
