"""Draw the thesis's figures 5.8 to 5.12 from the drive."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from scanplan.lab.evaluation import length_metrics
from scanplan.report import top_view
from scanplan.stage import figure_files, log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath
from thesis import thesis_schemas
from thesis.claim_measures import ITERATIVE, OURS
from thesis.figures import drive_figures
from thesis.stated_claims import Sizes


def draw_thesis_drive(
    scans: FilePath,
    registration: FilePath,
    selection: FilePath,
    walls: Mapping[str, FilePath],
    times: FilePath,
    outputs: Sequence[FilePath],
) -> None:
    """Write the figures as SVG.

    Parameters
    ----------
    scans, registration, selection, times : path-like
        scans.parquet, registration.parquet, selection/cluster_hull.parquet and
        thesis/times.parquet.
    walls : dict of str to path-like
        Extractor to its table.
    outputs : list of path-like
        figure_<number>.svg, to write.
    """
    store = tables.ScanStore(scans)
    run_times = pd.DataFrame(tables.read_table(times, thesis_schemas.TIMES))
    n_scans = len(store.scan_ids)
    clouds = log.report_progress(store.scans(), "draw_thesis_drive", total=n_scans)
    points_m = top_view.sample_points(clouds, n_scans)
    poses = tables.read_table(registration, schemas.REGISTRATION)
    subset_ids = tables.read_table(selection, schemas.SELECTION)["scan_id"][: Sizes.SUBSET]
    subset_m = registered_scans.sensor_places(poses, subset_ids)
    places_m = registered_scans.sensor_places(poses, store.scan_ids)
    lines_m, subset_lines_m = {}, {}
    for extractor, path in walls.items():
        columns = tables.read_table(path, schemas.WALLS, allow_empty=True)
        lines_m[extractor] = length_metrics.table_lines_m(columns)
        in_subset = np.isin(columns["scan_id"], subset_ids)
        subset_lines_m[extractor] = lines_m[extractor][in_subset]
    drawn = {
        "figure_5_8": drive_figures.draw_selection_times(run_times),
        "figure_5_9": drive_figures.draw_places_figure(points_m, places_m, subset_m),
        "figure_5_10": drive_figures.draw_times_figure(run_times),
        "figure_5_11": drive_figures.draw_drive_walls(points_m, subset_lines_m, subset_m),
        "figure_5_12": drive_figures.draw_drive_walls(points_m, lines_m, places_m),
    }
    for path in outputs:
        atomic.write_text(path, figure_files.format_svg(drawn[Path(path).stem]))
    log.log_line(f"draw_thesis_drive: {len(outputs)} figures")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_thesis_drive(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.cluster_hull,
            {extractor: snakemake.input[extractor] for extractor in (OURS, ITERATIVE)},
            snakemake.input.times,
            snakemake.output.figures,
        )
