"""Tabulate how long ordering the scans and extracting the walls of the first ones takes."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from scanplan.lab.evaluation import run_times
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath


def tabulate_seconds(
    evaluated: FilePath,
    ordering: Mapping[str, FilePath],
    extraction: Mapping[str, FilePath],
    output: FilePath,
) -> None:
    """Write the seconds of every method, extractor and number of scans.

    They differ from run to run. ASSUME extraction takes every scan as long as the next: the first k
    of n scans take k / n of the time of all. The orders that know the truth are no methods and have
    no time.

    Parameters
    ----------
    evaluated : path-like
        evaluation/walls.parquet.
    ordering, extraction : dict of str to path-like
        What Snakemake measured of order_scans, by method, and of extract_walls, by extractor.
    output : path-like
        evaluation/seconds.parquet, to write.
    """
    order_s = {name: run_times.read_job_seconds(path) for name, path in ordering.items()}
    extract_s = {name: run_times.read_job_seconds(path) for name, path in extraction.items()}
    columns = tables.read_table(evaluated, schemas.EVALUATION, ["method", "extractor", "k"])
    subsets = pd.DataFrame(columns)
    timed = subsets[subsets["method"].isin(order_s)]
    share = timed["k"] / timed["k"].max()
    seconds = timed["method"].map(order_s) + share * timed["extractor"].map(extract_s)
    tables.write_table(output, schemas.SECONDS, timed.assign(seconds=seconds).to_dict("list"))
    slowest = max(order_s, key=lambda method: order_s[method])
    log.log_line(f"tabulate_seconds: ordering takes at most {order_s[slowest]:.1f} s ({slowest})")


def _name_by_job(paths: Sequence[FilePath], job: str) -> dict[str, FilePath]:
    """Return the benchmark files of a job by what follows its name in theirs."""
    return {Path(path).stem.removeprefix(f"{job}_"): path for path in paths}


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        tabulate_seconds(
            snakemake.input.walls,
            _name_by_job(snakemake.input.ordering, "order_scans"),
            _name_by_job(snakemake.input.extraction, "extract_walls"),
            snakemake.output.seconds,
        )
