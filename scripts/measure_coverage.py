"""Measure what hulls cover: by number of clusters, and against what a scan truly sees (thesis, 3.3.2 and 5.2)."""

import numpy as np
import shapely

from scanplan.lab.evaluation import truth_file
from scanplan.lab.thesis import cluster_growth, seen_area
from scanplan.selection import hulls
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables


def measure_coverage(
    scans, built, registration, truth, true_poses, clusters, areas,
    *, n_clusters, sample_size, seed, max_range_m, threads=1,
):  # fmt: skip
    """Write how the covered area grows with every number of clusters, and each scan's areas.

    Parameters
    ----------
    scans, built, registration, truth, true_poses : path-like
        scans.parquet, hulls.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    clusters, areas : path-like
        thesis/clusters.parquet and thesis/areas.parquet, to write.
    n_clusters : sequence of int
    sample_size, seed : int
        See `hulls.make_cluster_hulls`.
    max_range_m : float
        How far a scan can see.
    threads : int
    """
    grown = cluster_growth.cluster_growth_columns(
        scans, n_clusters, sample_size=sample_size, seed=seed, threads=threads
    )
    tables.write_table(clusters, schemas.CLUSTERS, grown)
    poses, found = (
        truth_file.read_true_poses(true_poses),
        registered_scans.read_registered_scans(registration),
    )
    places_m = truth_file.interpolate_true_poses(poses, found.t_ns, true_poses)[:, :2, 3]
    seen = seen_area.seen_polygons(
        truth_file.read_true_faces(truth), places_m, max_range_m=max_range_m
    )
    columns = tables.read_table(built, schemas.HULLS)
    kinds = {
        "full_hull": hulls.scan_full_hulls(columns)[1],
        "cluster_hull": hulls.scan_polygons(columns)[1],
    }
    measured = {"scan_id": found.scan_ids, "seen_m2": shapely.area(seen)}
    measured |= {f"{kind}_m2": shapely.area(polygons) for kind, polygons in kinds.items()}
    measured |= {
        f"{kind}_iou": seen_area.polygon_iou(polygons, seen) for kind, polygons in kinds.items()
    }
    tables.write_table(areas, schemas.AREAS, measured)
    median = [
        f"{np.median(values):.2f} {name}" for name, values in measured.items() if name != "scan_id"
    ]
    log.log_line(f"measure_coverage: {len(found.scan_ids)} scans, median {', '.join(median)}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_coverage(
            *(
                snakemake.input[name]
                for name in ("scans", "hulls", "registration", "truth", "true_poses")
            ),
            snakemake.output.clusters,
            snakemake.output.areas,
            n_clusters=snakemake.params.n_clusters,
            sample_size=snakemake.params.hulls["sample_size"],
            seed=snakemake.params.hulls["seed"],
            max_range_m=snakemake.params.max_range_m,
            threads=snakemake.threads,
        )
