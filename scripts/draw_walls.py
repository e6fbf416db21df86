"""Draw the walls of the plan over the points of the selected scans (thesis, figure 5.11)."""

from typing import Any

from scanplan.report import figures, top_view
from scanplan.selection import stopping
from scanplan.stage import figure_files, log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath


def draw_walls(
    scans: FilePath,
    faces: FilePath,
    registration: FilePath,
    selection: FilePath,
    output: FilePath,
    **stop: Any,
) -> None:
    """Write the figure as SVG.

    Parameters
    ----------
    scans, faces, registration, selection : path-like
        scans.parquet, plan/faces.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        figures/walls.svg, to write.
    **stop
        How many scans are selected, see `stopping.choose_n_scans`.
    """
    store = tables.ScanStore(scans)
    selected_ids, reason = stopping.read_chosen_scans(selection, **stop)
    count = len(selected_ids)
    poses = tables.read_table(registration, schemas.REGISTRATION)
    plan_faces = tables.read_table(faces, schemas.FACES)
    figure = figures.draw_walls_figure(
        top_view.sample_points(store.scans(selected_ids), count),
        plan_faces,
        registered_scans.sensor_places(poses, selected_ids),
    )
    atomic.write_text(output, figure_files.format_svg(figure))
    log.log_line(f"draw_walls: {len(plan_faces['face'])} faces over {count} scans ({reason})")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_walls(
            snakemake.input.scans,
            snakemake.input.faces,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.figure,
            **snakemake.params.stop,
        )
