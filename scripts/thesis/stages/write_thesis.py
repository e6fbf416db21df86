"""Write the report of the thesis's experiments."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from scanplan.stage import log
from scanplan.store import atomic, tables
from scanplan.types import FilePath
from thesis import thesis_schemas
from thesis.page import thesis_page


def write_thesis(
    figures: Sequence[FilePath],
    own_figures: Sequence[FilePath],
    claims: FilePath,
    steps: Sequence[FilePath],
    page: Sequence[FilePath],
    output: FilePath,
) -> None:
    """Write one HTML page with figures, table and claims, which needs no other file.

    Parameters
    ----------
    figures : list of path-like
        figure_<number>.svg.
    own_figures : list of path-like
        orders.svg, gates.svg and alignments.svg: figures that the thesis has not.
    claims : path-like
        claims.parquet.
    steps : (path-like, path-like)
        thesis/steps.parquet of the drive with our limits, and with the thesis's.
    page : list of path-like
        Template, style and the table of deviations.
    output : path-like
        report.html, to write.
    """
    figure_texts = _read_texts(figures)
    text = thesis_page(
        _read_texts(page),
        figure_texts,
        _read_texts(own_figures),
        pd.DataFrame(tables.read_table(claims, thesis_schemas.CLAIMS)),
        *(pd.DataFrame(tables.read_table(path, thesis_schemas.STEPS)) for path in steps),
    )
    atomic.write_text(output, text)
    log.log_line(f"write_thesis: {len(figure_texts)} figures, {len(text) / 1e6:.1f} MB")


def _read_texts(paths: Sequence[FilePath]) -> dict[str, str]:
    return {Path(path).name: Path(path).read_text(encoding="utf-8") for path in paths}


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_thesis(
            list(snakemake.input.figures),
            [snakemake.input[name] for name in ("orders", "gates", "alignments")],
            snakemake.input.claims,
            (snakemake.input.steps[0], snakemake.input.limited[0]),
            list(snakemake.input.page),
            snakemake.output.page,
        )
