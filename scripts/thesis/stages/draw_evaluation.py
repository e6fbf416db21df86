"""Draw how well every ordering's first scans show the true walls (thesis, figure 5.4)."""

import pandas as pd

from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath
from thesis.comparison import evaluation_figure, oracle_figure


def draw_evaluation(
    walls: FilePath,
    aligned: FilePath,
    output: FilePath,
    shares: FilePath,
    *,
    method: str,
    extractor: str,
) -> None:
    """Write the figures as SVG.

    Parameters
    ----------
    walls, aligned : path-like
        evaluation/walls.parquet and evaluation/walls_aligned.parquet.
    output, shares : path-like
        figures/evaluation.svg and figures/oracle_shares.svg, to write.
    method, extractor : str
        The plan's: whose misses and whose bitmap metrics are drawn.
    """
    measures = pd.DataFrame(tables.read_table(walls, schemas.EVALUATION))
    aligned_measures = pd.DataFrame(tables.read_table(aligned, schemas.EVALUATION))
    figure = evaluation_figure.draw_evaluation_figure(
        measures, aligned_measures, method=method, extractor=extractor
    )
    atomic.write_text(output, figure_files.format_svg(figure))
    atomic.write_text(shares, figure_files.format_svg(oracle_figure.draw_oracle_figure(measures)))
    log.log_line(f"draw_evaluation: {len(measures)} subsets")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_evaluation(
            snakemake.input.walls,
            snakemake.input.aligned,
            snakemake.output.figure,
            snakemake.output.shares,
            method=snakemake.params.method,
            extractor=snakemake.params.extractor,
        )
