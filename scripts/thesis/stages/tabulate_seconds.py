"""Tabulate how long ordering the scans and extracting the walls of the first ones takes."""

from collections.abc import Mapping, Sequence

import pandas as pd

from scanplan.stage import log, run_times
from scanplan.store import schemas, tables
from scanplan.types import FilePath
from thesis import thesis_schemas


def tabulate_seconds(
    evaluated: FilePath,
    ordering: Mapping[str, Sequence[FilePath]],
    extraction: Mapping[str, Sequence[FilePath]],
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
    ordering, extraction : dict of str to sequence of path-like
        What Snakemake measured of order_scans, by method, and of extract_walls, by extractor: of a
        long recording, of each chunk of its scans.
    output : path-like
        evaluation/seconds.parquet, to write.
    """
    order_s = {name: _sum_seconds(paths) for name, paths in ordering.items()}
    extract_s = {name: _sum_seconds(paths) for name, paths in extraction.items()}
    columns = tables.read_table(evaluated, schemas.EVALUATION, ["method", "extractor", "k"])
    subsets = pd.DataFrame(columns)
    timed = subsets[subsets["method"].isin(order_s)]
    share = timed["k"] / timed["k"].max()
    seconds = timed["method"].map(order_s) + share * timed["extractor"].map(extract_s)
    tables.write_table(
        output, thesis_schemas.SECONDS, timed.assign(seconds=seconds).to_dict("list")
    )
    slowest = max(order_s, key=lambda method: order_s[method])
    log.log_line(f"tabulate_seconds: ordering takes at most {order_s[slowest]:.1f} s ({slowest})")


def _sum_seconds(paths: Sequence[FilePath]) -> float:
    return sum(map(run_times.read_job_seconds, paths))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        tabulate_seconds(
            snakemake.input.walls,
            run_times.group_by_name(snakemake.input.ordering, "order_scans"),
            run_times.group_by_name(snakemake.input.extraction, "extract_walls"),
            snakemake.output.seconds,
        )
