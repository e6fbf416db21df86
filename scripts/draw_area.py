"""Draw the covered area against the number of scans, for every ordering (thesis, figure 5.6)."""

from collections.abc import Sequence
from pathlib import Path

from scanplan.report import figures
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


def draw_area(selections: Sequence[FilePath], output: FilePath) -> None:
    """Write the figure as SVG.

    Parameters
    ----------
    selections : list of path-like
        selection/<method>.parquet, named after the method.
    output : path-like
        figures/area.svg, to write.
    """
    orderings = {Path(path).stem: tables.read_table(path, schemas.SELECTION) for path in selections}
    atomic.write_text(output, figure_files.format_svg(figures.draw_area_figure(orderings)))
    log.log_line(f"draw_area: {len(orderings)} orderings")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_area(snakemake.input.selections, snakemake.output.figure)
