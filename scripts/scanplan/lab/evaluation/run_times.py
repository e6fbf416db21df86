"""Run times that Snakemake measured."""

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
