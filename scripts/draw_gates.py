"""Draw what survives algorithm 3's gates, and what fitness rewards."""

from scanplan.lab.thesis.figures import gate_figures
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


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
    survivors = gate_figures.draw_gates(tables.read_table(swept, schemas.GATES))
    atomic.write_text(gates_figure, figure_files.format_svg(survivors))
    pairs = tables.read_table(alignments, schemas.ALIGNMENTS)
    atomic.write_text(
        alignments_figure, figure_files.format_svg(gate_figures.draw_alignments(pairs))
    )
    log.log_line(f"draw_gates: 2 figures, {len(pairs['method'])} alignments")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_gates(
            snakemake.input.gates,
            snakemake.input.alignments,
            snakemake.output.gates,
            snakemake.output.alignments,
        )
