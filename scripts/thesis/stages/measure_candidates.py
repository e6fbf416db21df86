"""Measure how many candidates RANSAC with removal of inliers finds for a wall (thesis, 5.3)."""

from scanplan.lab.evaluation import truth_file
from scanplan.stage import log, per_registered_scan
from scanplan.store import tables
from scanplan.types import FilePath, Settings
from thesis import thesis_schemas, timing, wall_candidates


def measure_candidates(
    scans: FilePath,
    registration: FilePath,
    truth: FilePath,
    output: FilePath,
    *,
    walls: Settings,
    n_scans: int,
) -> None:
    """Write the candidates of some scans, spread over the survey, by model and inlier band.

    Parameters
    ----------
    scans, registration, truth : path-like
        scans.parquet, registration.parquet and truth.geojson.
    output : path-like
        thesis/candidates.parquet, to write.
    walls : dict
        Of `thesis_ransac.ThesisIterativeSettings`.
    """
    store = tables.ScanStore(scans)
    scan_ids = timing.spread_rows(store.scan_ids, n_scans)
    sensors = per_registered_scan.sensor_keywords(scan_ids, scans, registration)
    faces_m = truth_file.read_true_faces(truth).inner_m
    counted = wall_candidates.count_candidates(store, scan_ids, sensors, faces_m, walls)
    rows = sorted(counted, key=lambda row: (row["model"], row["inlier_m"], row["scan_id"]))
    columns = {name: [row[name] for row in rows] for name in thesis_schemas.CANDIDATES.columns}
    tables.write_table(output, thesis_schemas.CANDIDATES, columns)
    log.log_line(f"measure_candidates: {len(scan_ids)} scans, {sum(columns['candidates']):,} found")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_candidates(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.output.candidates,
            walls=snakemake.params.walls,
            n_scans=snakemake.params.n_scans,
        )
