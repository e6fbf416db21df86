"""Measure the walls of every ordering's first scans against the true ones (thesis, section 5.1)."""

from collections.abc import Sequence
from pathlib import Path

from scanplan.lab.evaluation import pose_errors, true_plan, truth_file, wall_findings
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath
from thesis import thesis_schemas
from thesis.comparison import oracle, order_metrics

_SIGHT = "sight"


def evaluate_walls(
    walls: Sequence[FilePath],
    selections: Sequence[FilePath],
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    aligned: FilePath,
    best: FilePath,
    *,
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write how well every ordering and extractor does, and the oracle's orders.

    Parameters
    ----------
    walls, selections : list of path-like
        walls/<extractor>.parquet and selection/<method>.parquet, named after extractor and method.
    registration, truth, true_poses : path-like
        registration.parquet, truth.geojson and truth_poses.tum.
    output, aligned, best : path-like
        evaluation/walls.parquet, with the walls where they are in the map: the localiser's frame is
        that of the truth; evaluation/walls_aligned.parquet, the same after the rigid motion that
        best brings the registered scans to where they truly were taken; evaluation/oracle.parquet,
        the orders that one who knows the truth would take. To write.
    max_range_m : float
        How far a scan can see.
    """
    scans = registered_scans.read_registered_scans(registration)
    poses = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(poses, scans.t_ns, true_poses)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth),
        placed,
        truth_file.true_pose_matrices(poses),
        sight=truth_file.read_sensor_view(truth, max_range_m=max_range_m),
        rooms=true_plan.read_true_plan(truth).entered_rooms,
    )
    orders = {
        Path(path).stem: registered_scans.read_order_rows(path, scans, registration)
        for path in selections
    }
    orders[_SIGHT] = oracle.order_by_truth(floor.seen, floor.cells.length_m).order
    motion = pose_errors.fit_alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    drawn, moved = {}, {}
    for path in walls:
        extractor = Path(path).stem
        columns = registered_scans.read_wall_segments(path, scans, registration)
        drawn[extractor] = wall_findings.place_segments(
            columns, scans.scan_ids, scans.map_from_sensor, placed
        )
        moved[extractor] = wall_findings.move_segments(drawn[extractor], motion)
    measures, best_orders = order_metrics.measure_orders(floor, orders, drawn, bitmap_cell_m)
    aligned_measures, _ = order_metrics.measure_orders(floor, orders, moved, bitmap_cell_m)
    for path, table in ((output, measures), (aligned, aligned_measures)):
        columns = {name: table[name].to_numpy() for name in table}
        tables.write_table(path, schemas.EVALUATION, columns)
        for line in order_metrics.summarise_wall_measures(table):
            log.log_line(f"evaluate_walls: {Path(path).stem}, {line}")
    tables.write_table(best, thesis_schemas.ORACLE, oracle.oracle_columns(best_orders, scans))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_walls(
            snakemake.input.walls,
            snakemake.input.selections,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.walls,
            snakemake.output.aligned,
            snakemake.output.oracle,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
