"""Measure what hulls cover: by number of clusters, and against what a scan truly sees (thesis, 3.3.2 and 5.2)."""

import numpy as np
import shapely

from scanplan import schemas, stagelog, tables
from scanplan.evaluation import registered, truthfile
from scanplan.selection import hulls
from scanplan.thesis import clustergrowth, seenarea


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
        See `hulls.cluster_hulls`.
    max_range_m : float
        How far a scan can see.
    threads : int
    """
    grown = clustergrowth.table(scans, n_clusters, sample_size=sample_size, seed=seed, threads=threads)
    tables.write(clusters, schemas.CLUSTERS, grown)
    poses, found = truthfile.read_poses(true_poses), registered.read(registration)
    places_m = truthfile.poses_at(poses, found.t_ns, true_poses)[:, :2, 3]
    seen = seenarea.polygons(truthfile.read_faces(truth), places_m, max_range_m=max_range_m)
    columns = tables.read(built, schemas.HULLS)
    kinds = {"full_hull": hulls.scan_full_hulls(columns)[1], "cluster_hull": hulls.scan_polygons(columns)[1]}
    measured = {"scan_id": found.scan_ids, "seen_m2": shapely.area(seen)}
    measured |= {f"{kind}_m2": shapely.area(polygons) for kind, polygons in kinds.items()}
    measured |= {f"{kind}_iou": seenarea.shared(polygons, seen) for kind, polygons in kinds.items()}
    tables.write(areas, schemas.AREAS, measured)
    median = [f"{np.median(values):.2f} {name}" for name, values in measured.items() if name != "scan_id"]
    stagelog.say(f"measure_coverage: {len(found.scan_ids)} scans, median {', '.join(median)}")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        measure_coverage(
            *(snakemake.input[name] for name in ("scans", "hulls", "registration", "truth", "true_poses")),
            snakemake.output.clusters,
            snakemake.output.areas,
            n_clusters=snakemake.params.n_clusters,
            sample_size=snakemake.params.hulls["sample_size"],
            seed=snakemake.params.hulls["seed"],
            max_range_m=snakemake.params.max_range_m,
            threads=snakemake.threads,
        )
