"""Write the page of the experiments that go beyond the thesis's own."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath
from thesis import thesis_schemas
from thesis.beyond import measurements
from thesis.beyond.shown.experiments import EXPERIMENTS
from thesis.figures import more_figures
from thesis.more_page import more_page


def write_thesis_more(
    evaluated: Sequence[FilePath],
    chosen: Sequence[FilePath],
    surrogates: Sequence[FilePath],
    measured: Mapping[str, Sequence[FilePath]],
    page: Sequence[FilePath],
    output: FilePath,
) -> None:
    """Write one HTML page with figures and tables, which needs no other file.

    Parameters
    ----------
    evaluated, chosen, surrogates : list of path-like
        evaluation/walls.parquet, thesis/confidence.parquet and thesis/surrogates.parquet of every
        seed.
    measured : dict of str to list of path-like
        Tables of the further experiments by the names in `experiments.EXPERIMENTS`.
    page : list of path-like
        Template and style.
    output : path-like
        more.html, to write.
    """
    orders, own = (
        [pd.DataFrame(tables.read_table(path, schemas.EVALUATION)) for path in paths]
        for paths in (evaluated, chosen)
    )
    found = more_figures.join_orders(orders, own)
    ranked = [
        pd.DataFrame(tables.read_table(path, thesis_schemas.SURROGATES)) for path in surrogates
    ]
    figures = {
        "confidence": more_figures.draw_confidence(found),
        "surrogates": more_figures.draw_surrogates(ranked),
    }
    shown = {}
    for name, experiment in EXPERIMENTS.items():
        values = measurements.read_measurements(measured[name])
        figures[name] = experiment.draw(values)
        shown[name] = {
            "title": experiment.title,
            "how": experiment.how,
            "caption": experiment.caption,
            "shows": experiment.conclude(values),
        }
        log.log_line(f"write_thesis_more: {experiment.title}: {shown[name]['shows']}")
    svgs = {name: figure_files.format_svg(figure) for name, figure in figures.items()}
    sources = {Path(path).name: Path(path).read_text(encoding="utf-8") for path in page}
    atomic.write_text(output, more_page(sources, svgs, found, shown))
    log.log_line(f"write_thesis_more: {len(svgs)} figures, {len(ranked)} seeds")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_thesis_more(
            list(snakemake.input.evaluated),
            list(snakemake.input.chosen),
            list(snakemake.input.surrogates),
            {name: list(snakemake.input[name]) for name in EXPERIMENTS},
            list(snakemake.input.page),
            snakemake.output.page,
        )
