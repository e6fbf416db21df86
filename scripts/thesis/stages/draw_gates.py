"""Draw what survives algorithm 3's gates, and what fitness rewards."""

import pandas as pd

from scanplan.stage import figure_files, log
from scanplan.store import atomic, tables
from scanplan.types import FilePath
from thesis import thesis_schemas
from thesis.figures import gate_figures


def draw_gates(
    swept: FilePath, alignments: FilePath, gates_figure: FilePath, alignments_figure: FilePath
) -> None:
    """Write two figures as SVG.

    Parameters
    ----------
    swept, alignments : path-like
        thesis/gates.parquet and thesis/alignments.parquet.
    gates_figure, alignments_figure : path-like
        To write.
    """
    survivors = pd.DataFrame(tables.read_table(swept, thesis_schemas.GATES))
    survived = gate_figures.draw_gates(survivors)
    atomic.write_text(gates_figure, figure_files.format_svg(survived))
    pairs = pd.DataFrame(tables.read_table(alignments, thesis_schemas.ALIGNMENTS))
    aligned = gate_figures.draw_alignments(pairs)
    atomic.write_text(alignments_figure, figure_files.format_svg(aligned))
    log.log_line(f"draw_gates: 2 figures, {len(pairs)} alignments")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_gates(
            snakemake.input.gates,
            snakemake.input.alignments,
            snakemake.output.gates,
            snakemake.output.alignments,
        )
