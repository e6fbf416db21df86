"""Measure the walls that the first scans of every ordering show against the true ones (thesis, section 5.1)."""

from pathlib import Path

from scanplan import schemas, stagelog, tables
from scanplan.evaluation import findings, oracle, poseerrors, registered, truthfile, wallevaluation

_SIGHT = "sight"


def evaluate_walls(
    walls, selections, registration, truth, true_poses, output, aligned, best, *, max_range_m, bitmap_cell_m
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
    scans, poses = registered.read(registration), truthfile.read_poses(true_poses)
    placed = truthfile.poses_at(poses, scans.t_ns, true_poses)
    sight = truthfile.read_sight(truth, max_range_m=max_range_m)
    floor = findings.look(truthfile.read_faces(truth), placed, truthfile.matrices(poses), sight=sight)
    orders = {Path(path).stem: registered.order(path, scans, registration) for path in selections}
    orders[_SIGHT] = oracle.greedy_order(floor.seen, floor.cells.length_m).order
    shown = {Path(path).stem: registered.walls(path, scans, registration) for path in walls}
    drawn = {e: findings.segments(w, scans.scan_ids, scans.map_from_sensor, placed) for e, w in shown.items()}
    motion = poseerrors.alignment(scans.map_from_sensor[:, :3, 3], placed[:, :3, 3])
    moved = {extractor: findings.moved(lines, motion) for extractor, lines in drawn.items()}
    ceilings = {}
    for path, lines in ((output, drawn), (aligned, moved)):
        measured, ceilings[path] = wallevaluation.table(floor, orders, lines, bitmap_cell_m)
        tables.write(path, schemas.EVALUATION, measured)
        for line in wallevaluation.summary(measured):
            stagelog.say(f"evaluate_walls: {Path(path).stem}, {line}")
    tables.write(best, schemas.ORACLE, registered.ordered(ceilings[output], scans))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        evaluate_walls(
            *(snakemake.input[name] for name in ("walls", "selections", "registration", "truth", "true_poses")),
            *(snakemake.output[name] for name in ("walls", "aligned", "oracle")),
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.settings,
        )
