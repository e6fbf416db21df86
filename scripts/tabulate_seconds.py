"""Tabulate how long ordering the scans and extracting the walls of the first ones takes."""

from pathlib import Path

import numpy as np

from scanplan.lab.evaluation import run_times
from scanplan.stage import log
from scanplan.store import schemas, tables


def tabulate_seconds(evaluated, ordering, extraction, output):
    """Write the seconds of every method, extractor and number of scans; they differ from run to run.

    ASSUME extraction takes every scan as long as the next: the first k of n scans take k / n of the time of all. The
    orders that know the truth are no methods and have no time.

    Parameters
    ----------
    evaluated : path-like
        evaluation/walls.parquet.
    ordering, extraction : dict of str to path-like
        What Snakemake measured of order_scans, by method, and of extract_walls, by extractor.
    output : path-like
        evaluation/seconds.parquet, to write.
    """
    found = tables.read_table(evaluated, schemas.EVALUATION, ["method", "extractor", "k"])
    order_s, extract_s = (
        {name: run_times.read_job_seconds(path) for name, path in of.items()}
        for of in (ordering, extraction)
    )
    timed = np.isin(found["method"], list(order_s))
    rows = {name: values[timed] for name, values in found.items()}
    share = rows["k"] / rows["k"].max()
    of_order = np.array([order_s[method] for method in rows["method"]])
    of_walls = np.array([extract_s[extractor] for extractor in rows["extractor"]])
    tables.write_table(output, schemas.SECONDS, {**rows, "seconds": of_order + share * of_walls})
    slowest = max(order_s, key=order_s.get)
    log.log_line(f"tabulate_seconds: ordering takes at most {order_s[slowest]:.1f} s ({slowest})")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        tabulate_seconds(
            snakemake.input.walls,
            {
                Path(path).stem.removeprefix("order_scans_"): path
                for path in snakemake.input.ordering
            },
            {
                Path(path).stem.removeprefix("extract_walls_"): path
                for path in snakemake.input.extraction
            },
            snakemake.output.seconds,
        )
