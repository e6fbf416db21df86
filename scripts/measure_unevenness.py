"""Measure what a survey that was sampled unevenly does to a random order and to the area-based one (thesis, 5.2)."""

from scanplan import schemas, stagelog, tables
from scanplan.evaluation import registered, truthfile
from scanplan.selection import hulls
from scanplan.thesis import unevenness


def measure_unevenness(scans, built, registration, truth, true_poses, output, *, sampling, max_range_m, n_selected):
    """Write how much true wall the first scans see when those of a crowd were taken once, 5 and 20 times.

    Parameters
    ----------
    scans, built, registration, truth, true_poses : path-like
        scans.parquet, hulls.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        thesis/unevenness.parquet, to write.
    sampling : dict
        `n_clusters`, `sample_size` and `seed` of `hulls.cluster_hulls`.
    max_range_m : float
        How far a scan can see.
    n_selected : int
        Size of the subsets.
    """
    store, found = tables.ScanStore(scans), registered.read(registration)
    placed = truthfile.poses_at(truthfile.read_poses(true_poses), found.t_ns, true_poses)
    sight = truthfile.read_sight(truth, max_range_m=max_range_m)
    seen, length_m = unevenness.view(truthfile.read_faces(truth), placed, sight)
    crowds = unevenness.crowds(placed[:, :2, 3], sampling["seed"])
    repeated, chosen = {}, sorted({row for crowd in crowds for row in crowd.tolist()})
    taken = stagelog.progress(store.scans(found.scan_ids[chosen]), "measure_unevenness", total=len(chosen))
    for row, (scan_id, xyz_m) in zip(chosen, taken, strict=True):
        repeated[row] = unevenness.copies(scan_id, xyz_m, n_copies=max(unevenness.REPEATS) - 1, **sampling)
    polygons = hulls.scan_polygons(tables.read(built, schemas.HULLS))[1]
    columns = unevenness.table(seen, length_m, polygons, repeated, crowds, n_selected=n_selected, seed=sampling["seed"])
    tables.write(output, schemas.UNEVENNESS, columns)
    random, area = (unevenness.lost(columns, order)[1][-1] for order in (unevenness.RANDOM, unevenness.AREA))
    stagelog.say(f"measure_unevenness: {len(chosen)} scans repeated, lost {random:.1%} at random, {area:.1%} by area")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        measure_unevenness(
            *(snakemake.input[name] for name in ("scans", "hulls", "registration", "truth", "true_poses")),
            snakemake.output.unevenness,
            sampling={name: snakemake.params.hulls[name] for name in ("n_clusters", "sample_size", "seed")},
            max_range_m=snakemake.params.max_range_m,
            n_selected=snakemake.params.n_selected,
        )
