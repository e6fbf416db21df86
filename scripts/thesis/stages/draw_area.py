"""Draw the covered area against the number of scans, for every ordering (thesis, figure 5.6)."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from scanplan.report import figures
from scanplan.selection import orderings
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import Columns, FilePath


def draw_area(selections: Sequence[FilePath], hulls: FilePath, output: FilePath) -> None:
    """Write the figure as SVG.

    Parameters
    ----------
    selections : list of path-like
        selection/<method>.parquet, named after the method.
    hulls : path-like
        hulls.parquet, which measures the area of orders by something else.
    output : path-like
        figures/area.svg, to write.
    """
    polygons = tables.read_table(hulls, schemas.HULLS)
    covered = {
        Path(path).stem: _with_areas(tables.read_table(path, schemas.SELECTION), polygons)
        for path in selections
    }
    atomic.write_text(output, figure_files.format_svg(figures.draw_area_figure(covered)))
    log.log_line(f"draw_area: {len(covered)} orderings")


def _with_areas(selection: Columns, hulls: Columns) -> Columns:
    """Return an ordering with the area that it covers, measured here where it was not yet."""
    if np.isfinite(selection["covered_m2"]).all():
        return selection
    order = np.searchsorted(np.unique(hulls["scan_id"]), selection["scan_id"])
    areas = orderings.measure_area(order, hulls)
    return {**selection, **{f"{name}_m2": values for name, values in areas.items()}}


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_area(snakemake.input.selections, snakemake.input.hulls, snakemake.output.figure)
