"""Measure the walls that the first scans of every ordering show against the true ones (thesis, section 5.1)."""

from pathlib import Path

from scanplan.lab.evaluation import oracle, pose_errors, truth_file, wall_findings, wall_metrics
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables

_SIGHT = "sight"


def evaluate_walls(
    walls,
    selections,
    registration,
    truth,
    true_poses,
    output,
    aligned,
    best,
    *,
    max_range_m,
    bitmap_cell_m,
):
    """Write how well every ordering and extractor does, and the orders that one who knows the truth would take.

    Parameters
    ----------
    walls, selections : list of path-like
        walls/<extractor>.parquet and selection/<method>.parquet; the names tell extractor and method.
    registration, truth, true_poses : path-like
        registration.parquet, truth.geojson and truth_poses.tum.
    output, aligned, best : path-like
        evaluation/walls.parquet, with the walls where they are in the map: the localiser's frame is that of the truth;
        evaluation/walls_aligned.parquet, the same after the rigid motion that best brings the registered scans to
        where they truly were taken; evaluation/oracle.parquet. To write.
    max_range_m : float
        How far a scan can see.
    bitmap_cell_m : float
    """
    scans, poses = (
        registered_scans.read_registered_scans(registration),
        truth_file.read_true_poses(true_poses),
    )
    placed = truth_file.interpolate_true_poses(poses, scans.t_ns, true_poses)
    sight = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    floor = wall_findings.observe_truth(
        truth_file.read_true_faces(truth), placed, truth_file.true_pose_matrices(poses), sight=sight
    )
    orders = {
        Path(path).stem: registered_scans.read_order_rows(path, scans, registration)
        for path in selections
    }
    orders[_SIGHT] = oracle.order_by_truth(floor.seen, floor.cells.length_m).order
    shown = {
        Path(path).stem: registered_scans.read_wall_segments(path, scans, registration)
        for path in walls
    }
    drawn = {
        e: wall_findings.place_segments(w, scans.scan_ids, scans.map_from_sensor, placed)
        for e, w in shown.items()
    }
    motion = pose_errors.fit_alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    moved = {
        extractor: wall_findings.move_segments(lines, motion) for extractor, lines in drawn.items()
    }
    ceilings = {}
    for path, lines in ((output, drawn), (aligned, moved)):
        measured, ceilings[path] = wall_metrics.measure_orders(floor, orders, lines, bitmap_cell_m)
        tables.write_table(path, schemas.EVALUATION, measured)
        for line in wall_metrics.summarise_wall_measures(measured):
            log.log_line(f"evaluate_walls: {Path(path).stem}, {line}")
    tables.write_table(best, schemas.ORACLE, oracle.oracle_columns(ceilings[output], scans))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_walls(
            *(
                snakemake.input[name]
                for name in ("walls", "selections", "registration", "truth", "true_poses")
            ),
            *(snakemake.output[name] for name in ("walls", "aligned", "oracle")),
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
