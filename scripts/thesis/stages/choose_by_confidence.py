"""Choose scans by the confidence of the walls so far, and measure what they show (thesis, 6)."""

import numpy as np

from scanplan.lab.evaluation import truth_file, wall_findings
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath
from thesis.beyond import confidence
from thesis.comparison import order_metrics

_METHOD, _EXTRACTOR = "confidence", "cluster_ransac"


def choose_by_confidence(
    observations: FilePath,
    walls: FilePath,
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    *,
    cell_m: float,
    sigma_m: float,
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write how well the first scans do, as evaluation/walls.parquet has it of other orders.

    Parameters
    ----------
    observations, walls, registration, truth, true_poses : path-like
        observations.parquet, walls/cluster_ransac.parquet (of which the walls of scans that are
        chosen are looked up, of no other), registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        thesis/confidence.parquet, to write.
    cell_m, sigma_m, max_range_m, bitmap_cell_m : float
        Edge of the cells of observations; what the place of a scan's wall may be off by; how far a
        scan can see; edge of a bitmap's cell.
    """
    scans = registered_scans.read_registered_scans(registration)
    columns = registered_scans.read_wall_segments(walls, scans, registration)
    ends_m = np.column_stack([columns[name] for name in ("x0_m", "y0_m", "x1_m", "y1_m")])
    normal = np.column_stack([columns["nx"], columns["ny"]])
    begins = np.searchsorted(columns["scan_id"], scans.scan_ids)
    ends = np.searchsorted(columns["scan_id"], scans.scan_ids, side="right")

    def extract(row: int) -> confidence.Walls:
        own = slice(begins[row], ends[row])
        return confidence.Walls(ends_m[own].reshape(-1, 2, 2), normal[own])

    views = confidence.view_cells_of(
        tables.read_table(observations, schemas.OBSERVATIONS, allow_empty=True),
        scans.scan_ids,
        cell_m,
    )
    order = confidence.order_by_confidence(views, extract, sigma_m=sigma_m, near_m=cell_m)
    poses = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(poses, scans.t_ns, true_poses)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth),
        placed,
        truth_file.true_pose_matrices(poses),
        sight=truth_file.read_sensor_view(truth, max_range_m=max_range_m),
    )
    drawn = wall_findings.place_segments(columns, scans.scan_ids, scans.map_from_sensor, placed)
    measures, _ = order_metrics.measure_orders(
        floor, {_METHOD: order}, {_EXTRACTOR: drawn}, bitmap_cell_m
    )
    tables.write_table(
        output, schemas.EVALUATION, {name: measures[name].to_numpy() for name in measures}
    )
    for line in order_metrics.summarise_wall_measures(measures):
        log.log_line(f"choose_by_confidence: {line}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        choose_by_confidence(
            snakemake.input.observations,
            snakemake.input.walls,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.confidence,
            **snakemake.params.cells,
            sigma_m=snakemake.params.sigma_m,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.evaluation,
        )
