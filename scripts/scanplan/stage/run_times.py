"""Run times that Snakemake measured."""

import csv
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from scanplan.errors import StageError
from scanplan.types import FilePath


class JobCost(NamedTuple):
    """What a job took; NaN where Snakemake could not measure it.

    Attributes
    ----------
    seconds : float
        Of the clock on the wall.
    cpu_s : float
        Of processors.
    memory_mb : float
        Most that it held at once.
    """

    seconds: float
    cpu_s: float
    memory_mb: float


def read_job_costs(paths: Iterable[FilePath]) -> dict[str, JobCost]:
    """Return what each job took, by the name of its benchmark file.

    A file without seconds, or none of Snakemake's, is left out.
    """
    costs = {Path(path).stem: _sum_runs(_read_runs(path)) for path in paths}
    return {job: cost for job, cost in costs.items() if not math.isnan(cost.seconds)}


def _sum_runs(runs: Sequence[Mapping[str, str]]) -> JobCost:
    seconds, cpu_s, memory_mb = (
        [number for run in runs if not math.isnan(number := _float_or_nan(run.get(column)))]
        for column in ("s", "cpu_time", "max_rss")
    )
    return JobCost(
        math.fsum(seconds) if seconds else math.nan,
        math.fsum(cpu_s) if cpu_s else math.nan,
        max(memory_mb, default=math.nan),
    )


def _float_or_nan(text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        return math.nan


def read_job_seconds(path: FilePath, column: str = "s") -> float:
    """Return the seconds of the job that a benchmark file is of.

    Of the clock on the wall by default, of processors as `cpu_time`.

    Raises
    ------
    StageError
        If the file is none of Snakemake's.
    """
    try:
        return float(_read_runs(path)[0][column])
    except (IndexError, KeyError, OSError, TypeError, ValueError) as error:
        raise StageError(
            f"{path}: is no benchmark file ({error}); remove it and run again"
        ) from None


def _read_runs(path: FilePath) -> list[dict[str, str]]:
    """Return what Snakemake measured at each run of a job, by column."""
    with Path(path).open(encoding="utf-8", newline="") as content:
        return list(csv.DictReader(content, delimiter="\t"))


def group_by_name(paths: Sequence[FilePath], job: str) -> dict[str, list[FilePath]]:
    """Return the benchmark files of a job by what follows its name in theirs.

    Parameters
    ----------
    paths : sequence of path-like
        `<job>_<name>.tsv`, or `<job>_<name>_2-of-5.tsv` of a chunk of the scans.
    """
    groups: dict[str, list[FilePath]] = {}
    for path in paths:
        name = re.sub(r"_\d+-of-\d+$", "", Path(path).stem.removeprefix(f"{job}_"))
        groups.setdefault(name, []).append(path)
    return groups
