"""Measure what a survey that was sampled unevenly does to a random order and to the area-based one (thesis, 5.2)."""

from scanplan.lab.evaluation import truth_file
from scanplan.lab.thesis import unevenness
from scanplan.selection import hulls
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables


def measure_unevenness(
    scans, built, registration, truth, true_poses, output, *, sampling, max_range_m, n_selected
):
    """Write how much true wall the first scans see when those of a crowd were taken once, 5 and 20 times.

    Parameters
    ----------
    scans, built, registration, truth, true_poses : path-like
        scans.parquet, hulls.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        thesis/unevenness.parquet, to write.
    sampling : dict
        `n_clusters`, `sample_size` and `seed` of `hulls.make_cluster_hulls`.
    max_range_m : float
        How far a scan can see.
    n_selected : int
        Size of the subsets.
    """
    store, found = tables.ScanStore(scans), registered_scans.read_registered_scans(registration)
    placed = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(true_poses), found.t_ns, true_poses
    )
    sight = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    seen, length_m = unevenness.view_cells(truth_file.read_true_faces(truth), placed, sight)
    crowds = unevenness.draw_crowds(placed[:, :2, 3], sampling["seed"])
    repeated, chosen = {}, sorted({row for crowd in crowds for row in crowd.tolist()})
    taken = log.report_progress(
        store.scans(found.scan_ids[chosen]), "measure_unevenness", total=len(chosen)
    )
    for row, (scan_id, xyz_m) in zip(chosen, taken, strict=True):
        repeated[row] = unevenness.copy_hulls(
            scan_id, xyz_m, n_copies=max(unevenness.REPEATS) - 1, **sampling
        )
    polygons = hulls.scan_polygons(tables.read_table(built, schemas.HULLS))[1]
    columns = unevenness.unevenness_columns(
        seen, length_m, polygons, repeated, crowds, n_selected=n_selected, seed=sampling["seed"]
    )
    tables.write_table(output, schemas.UNEVENNESS, columns)
    random, area = (
        unevenness.lost_shares(columns, order)[1][-1]
        for order in (unevenness.RANDOM, unevenness.AREA)
    )
    log.log_line(
        f"measure_unevenness: {len(chosen)} scans repeated, lost {random:.1%} at random, {area:.1%} by area"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_unevenness(
            *(
                snakemake.input[name]
                for name in ("scans", "hulls", "registration", "truth", "true_poses")
            ),
            snakemake.output.unevenness,
            sampling={
                name: snakemake.params.hulls[name] for name in ("n_clusters", "sample_size", "seed")
            },
            max_range_m=snakemake.params.max_range_m,
            n_selected=snakemake.params.n_selected,
        )
