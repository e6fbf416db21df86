"""Draw where rays of scans left out of the plan ended, and whether the plan explains it."""

from scanplan.report import validation_figure
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


def draw_validation(elements: FilePath, rays: FilePath, output: FilePath) -> None:
    """Write the figure as SVG.

    Parameters
    ----------
    elements, rays : path-like
        plan/validation.parquet and plan/validation_rays.parquet.
    output : path-like
        figures/validation.svg, to write.
    """
    judged = tables.read_table(elements, schemas.VALIDATION)
    absent = tables.read_note(elements, schemas.VALIDATION, "absent")
    n_scans = int(tables.read_note(elements, schemas.VALIDATION, "n_scans"))
    n_rays = judged["n_rays"][-1]
    title = f"{judged['share'][-1]:.1%} of {n_rays:,} rays of {n_scans:,} scans are as predicted"
    found = tables.read_table(rays, schemas.VALIDATION_RAYS, allow_empty=True)
    figure = validation_figure.draw_validation_figure(judged, found, absent or title)
    atomic.write_text(output, figure_files.format_svg(figure))
    log.log_line(f"draw_validation: {absent or title}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_validation(snakemake.input.elements, snakemake.input.rays, snakemake.output.figure)
