"""Draw the thesis's figures 5.8 to 5.12 from the drive."""

from pathlib import Path

import numpy as np

from scanplan.exports import drawing
from scanplan.lab.thesis import drive_figures
from scanplan.lab.thesis.claim_measures import ITERATIVE, OURS, SUBSET
from scanplan.report import figures, top_view
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables


def draw_thesis_drive(scans, registration, selection, walls, times, outputs):
    """Write the figures as SVG.

    Parameters
    ----------
    scans, registration, selection, times : path-like
        scans.parquet, registration.parquet, selection/cluster_hull.parquet and thesis/times.parquet.
    walls : dict of str to path-like
        Extractor to its table.
    outputs : list of path-like
        figure_<number>.svg, to write.
    """
    store, measured = tables.ScanStore(scans), tables.read_table(times, schemas.TIMES)
    found = log.report_progress(store.scans(), "draw_thesis_drive", total=len(store.scan_ids))
    points_m = top_view.sample_points(found, len(store.scan_ids))
    poses, shown = (
        tables.read_table(registration, schemas.REGISTRATION),
        {e: _shown(path) for e, path in walls.items()},
    )
    order = tables.read_table(selection, schemas.SELECTION)["scan_id"]
    few_m, all_m = (
        figures.sensor_positions(poses, ids) for ids in (order[:SUBSET], store.scan_ids)
    )
    few = {e: lines_m[np.isin(scan_id, order[:SUBSET])] for e, (scan_id, lines_m) in shown.items()}
    made = {
        "figure_5_8": drive_figures.draw_selection_times(measured),
        "figure_5_9": drive_figures.draw_places_figure(points_m, all_m, few_m),
        "figure_5_10": drive_figures.draw_times_figure(measured),
        "figure_5_11": drive_figures.draw_drive_walls(points_m, few, few_m),
        "figure_5_12": drive_figures.draw_drive_walls(
            points_m, {e: lines_m for e, (_, lines_m) in shown.items()}, all_m
        ),
    }
    for path in outputs:
        atomic.write_text(path, drawing.format_svg(made[Path(path).stem]))
    log.log_line(f"draw_thesis_drive: {len(outputs)} figures")


def _shown(path):
    columns = tables.read_table(path, schemas.WALLS, allow_empty=True)
    ends = np.column_stack([columns[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")])
    return columns["scan_id"], ends.reshape(-1, 2, 2)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_thesis_drive(
            *(snakemake.input[name] for name in ("scans", "registration", "cluster_hull")),
            {extractor: snakemake.input[extractor] for extractor in (OURS, ITERATIVE)},
            snakemake.input.times,
            snakemake.output.figures,
        )
