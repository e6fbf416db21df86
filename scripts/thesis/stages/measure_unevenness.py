"""Measure what uneven sampling does to a random order and to the area-based one (thesis, 5.2)."""

import pandas as pd

from scanplan.lab.evaluation import truth_file
from scanplan.selection import hulls
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from thesis import thesis_schemas, unevenness


def measure_unevenness(
    scans: FilePath,
    built: FilePath,
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    *,
    sampling: Settings,
    max_range_m: float,
    n_selected: int,
) -> None:
    """Write how much true wall the first scans see when a crowd's were taken 1, 5 and 20 times.

    Parameters
    ----------
    scans, built, registration, truth, true_poses : path-like
        scans.parquet, hulls.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        thesis/unevenness.parquet, to write.
    sampling : dict
        `n_clusters`, `sample_size`, `radius` and `seed` of `hulls.make_cluster_hulls`.
    max_range_m : float
        How far a scan can see.
    n_selected : int
        Size of the subsets.
    """
    store = tables.ScanStore(scans)
    registered = registered_scans.read_registered_scans(registration)
    poses = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(poses, registered.t_ns, true_poses)
    sight = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    seen, length_m = unevenness.view_cells(truth_file.read_true_faces(truth), placed, sight)
    crowds = unevenness.draw_crowds(placed[:, :2, 3], sampling["seed"])
    rows = sorted({row for crowd in crowds for row in crowd.tolist()})
    clouds = log.report_progress(
        store.scans(registered.scan_ids[rows]), "measure_unevenness", total=len(rows)
    )
    n_copies = max(unevenness.REPEATS) - 1
    repeated = {
        row: unevenness.copy_hulls(scan_id, xyz_m, n_copies=n_copies, **sampling)
        for row, (scan_id, xyz_m) in zip(rows, clouds, strict=True)
    }
    _, polygons = hulls.scan_polygons(tables.read_table(built, schemas.HULLS))
    columns = unevenness.unevenness_columns(
        seen, length_m, polygons, repeated, crowds, n_selected=n_selected
    )
    tables.write_table(output, thesis_schemas.UNEVENNESS, columns)
    _, lost = unevenness.lost_shares(pd.DataFrame(columns))
    most = lost.iloc[-1]
    log.log_line(
        f"measure_unevenness: {len(rows)} scans repeated, lost {most[unevenness.RANDOM]:.1%} at"
        f" random, {most[unevenness.AREA]:.1%} by area"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_unevenness(
            snakemake.input.scans,
            snakemake.input.hulls,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.unevenness,
            sampling=snakemake.params.hulls,
            max_range_m=snakemake.params.max_range_m,
            n_selected=snakemake.params.n_selected,
        )
