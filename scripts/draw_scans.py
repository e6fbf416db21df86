"""Draw the registered scans, where they were taken, which were selected (thesis, figure 5.9)."""

from typing import Any

from scanplan.report import figures, top_view
from scanplan.selection import stopping
from scanplan.stage import figure_files, log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath


def draw_scans(
    scans: FilePath, registration: FilePath, selection: FilePath, output: FilePath, **stop: Any
) -> None:
    """Write the figure as SVG.

    Parameters
    ----------
    scans, registration, selection : path-like
        scans.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        figures/scans.svg, to write.
    **stop
        How many scans are selected, see `stopping.choose_n_scans`.
    """
    store = tables.ScanStore(scans)
    selected_ids, reason = stopping.read_chosen_scans(selection, **stop)
    poses = tables.read_table(registration, schemas.REGISTRATION)
    n_scans = len(store.scan_ids)
    shown = top_view.choose_scans(store.scan_ids)
    clouds = log.report_progress(store.scans(shown), "draw_scans", total=len(shown))
    figure = figures.draw_scans_figure(
        top_view.sample_points(clouds, len(shown)),
        registered_scans.sensor_places(poses, store.scan_ids),
        registered_scans.sensor_places(poses, selected_ids),
    )
    atomic.write_text(output, figure_files.format_svg(figure))
    log.log_line(f"draw_scans: {n_scans} scans, {len(selected_ids)} selected ({reason})")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_scans(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.figure,
            **snakemake.params.stop,
        )
