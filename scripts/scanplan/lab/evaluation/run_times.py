"""Run times that Snakemake measured."""

import re
from collections.abc import Sequence
from pathlib import Path

from scanplan.errors import StageError
from scanplan.types import FilePath


def read_job_seconds(path: FilePath, column: str = "s") -> float:
    """Return the seconds of the job that a benchmark file is of.

    Of the clock on the wall by default, of processors as `cpu_time`.

    Raises
    ------
    StageError
        If the file is none of Snakemake's.
    """
    try:
        heads, values = (line.split("\t") for line in Path(path).read_text().splitlines()[:2])
        return float(values[heads.index(column)])
    except (OSError, ValueError) as error:
        raise StageError(
            f"{path}: is no benchmark file ({error}); remove it and run again"
        ) from None


def group_by_name(paths: Sequence[FilePath], job: str) -> dict[str, list[FilePath]]:
    """Return the benchmark files of a job by what follows its name in theirs.

    Parameters
    ----------
    paths : sequence of path-like
        `<job>_<name>.tsv`, or `<job>_<name>_2-of-5.tsv` of a chunk of the scans.
    job : str
    """
    groups: dict[str, list[FilePath]] = {}
    for path in paths:
        name = re.sub(r"_\d+-of-\d+$", "", Path(path).stem.removeprefix(f"{job}_"))
        groups.setdefault(name, []).append(path)
    return groups
